//! The numbers of a PLY file, one after another, as text or bytes.

use super::header::{Element, Encoding, Kind};
use super::scalar::Scalar;
use crate::Fault;
use crate::formats::words::{Word, Words};
use crate::watch::{PIECE, Stage};
use std::ops::Range;

/// A walk over the body of a file.
pub(super) struct Body<'a> {
    /// The text, or merely its bytes and the place in them.
    words: Words<'a>,
    encoding: Encoding,
    stage: Stage<'a>,
}

impl<'a> Body<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize, encoding: Encoding) -> Body<'a> {
        Body { words: Words::new(bytes, at, false), encoding, stage: Stage::unwatched() }
    }

    /// The same walk, told to someone.
    pub(super) fn watched(self, stage: Stage<'a>) -> Body<'a> {
        Body { stage, ..self }
    }

    /// Tells every few milliseconds how far the walk is, when it is at the element `index`.
    pub(super) fn tell(&self, index: u64) -> Result<(), Fault> {
        if index.is_multiple_of(PIECE as u64) { self.stage.tell(self.words.at, self.words.bytes.len()) } else { Ok(()) }
    }

    /// Where the next number begins or blanks before it.
    pub(super) fn at(&self) -> usize {
        self.words.at
    }

    fn left(&self) -> u64 {
        (self.words.bytes.len() - self.words.at) as u64
    }

    /// Refuses an element whose count is more than the bytes left can hold.
    pub(super) fn check_room(&self, element: &Element) -> Result<(), Fault> {
        let size = |kind: &Kind| match (self.encoding, kind) {
            // A digit and a blank.
            (Encoding::Ascii, _) => 2,
            (_, Kind::Scalar(scalar)) => scalar.size() as u64,
            (_, Kind::List { count, .. }) => count.size() as u64,
        };
        let least: u64 = element.properties.iter().map(|property| size(&property.kind)).sum();
        // The last number of a text needs no blank.
        let left = self.left() + 1;
        if least.saturating_mul(element.count) > left {
            let name = crate::rigidity::quoted(&element.name);
            let problem = format!(
                "is cut off: the header counts {} of element {name}, of {least} bytes or more, and {} bytes are left",
                element.count,
                self.left()
            );
            return Err(Fault::Container(problem));
        }
        Ok(())
    }

    /// Begins the next element: in text, on a line of its own.
    pub(super) fn begin(&mut self) -> Result<(), String> {
        if self.encoding != Encoding::Ascii || self.words.at == 0 {
            return Ok(());
        }
        // Numbers may stand on several lines, but no line holds numbers of two elements.
        let fresh = matches!(self.words.bytes[self.words.at - 1], b'\n' | b'\r');
        if !fresh && self.words.on_line().is_some() {
            return Err("begins on a line that holds more numbers than the header says".into());
        }
        Ok(())
    }

    /// The next number, where it stands, and its word in a text.
    fn number(&mut self, scalar: Scalar) -> Result<(f64, Range<usize>), String> {
        match self.encoding {
            Encoding::Ascii => {
                let word = self.word()?;
                let number = word.number().ok_or_else(|| format!("{} is not a number", word.shown()))?;
                Ok((number, word.start..word.end()))
            }
            Encoding::Binary { big } => {
                let range = self.skip_bytes(scalar.size() as u64)?;
                Ok((scalar.read(&self.words.bytes[range.clone()], big), range))
            }
        }
    }

    pub(super) fn value(&mut self, scalar: Scalar) -> Result<f64, String> {
        Ok(self.number(scalar)?.0)
    }

    fn word(&mut self) -> Result<Word<'a>, String> {
        self.words.anywhere().ok_or_else(|| "the file breaks off".into())
    }

    fn skip_bytes(&mut self, n: u64) -> Result<Range<usize>, String> {
        if n > self.left() {
            return Err("the file breaks off".into());
        }
        let start = self.words.at;
        self.words.at += n as usize;
        Ok(start..self.words.at)
    }

    /// How many items a list says it has; no more than bytes are left.
    fn count(&mut self, count: Scalar, item: Scalar) -> Result<u64, String> {
        let n = self.value(count)?;
        if n < 0.0 || n.fract() != 0.0 || !n.is_finite() {
            return Err(format!("{n} is no count of a list"));
        }
        let size = if self.encoding == Encoding::Ascii { 2 } else { item.size() as u64 };
        if (n as u64).saturating_mul(size) > self.left() + 1 {
            return Err(format!("a list says it has {n} items, {} bytes are left", self.left()));
        }
        Ok(n as u64)
    }

    /// Passes a property and tells where it stood.
    pub(super) fn skip(&mut self, kind: Kind) -> Result<Range<usize>, String> {
        match (kind, self.encoding) {
            (Kind::Scalar(_), Encoding::Ascii) => self.word().map(|word| word.start..word.end()),
            (Kind::Scalar(scalar), _) => self.skip_bytes(scalar.size() as u64),
            (Kind::List { count, item }, encoding) => {
                let start = self.words.at;
                let n = self.count(count, item)?;
                if encoding == Encoding::Ascii {
                    for _ in 0..n {
                        self.word()?;
                    }
                } else {
                    self.skip_bytes(n * item.size() as u64)?;
                }
                Ok(start..self.words.at)
            }
        }
    }

    /// Reads a list of at most `limit` items into `out`.
    pub(super) fn list(&mut self, [count, item]: [Scalar; 2], limit: u64, out: &mut Vec<f64>) -> Result<(), String> {
        out.clear();
        let n = self.count(count, item)?;
        if n > limit {
            return Err(format!("{n} corners of one polygon or strip are more than the limit of {limit}"));
        }
        for _ in 0..n {
            out.push(self.value(item)?);
        }
        Ok(())
    }

    /// Passes a whole element, of which nothing is read.
    pub(super) fn skip_element(&mut self, element: &Element) -> Result<(), Fault> {
        let sizes: Option<u64> = element.properties.iter().try_fold(0, |sum, property| match property.kind {
            Kind::Scalar(scalar) => Some(sum + scalar.size() as u64),
            Kind::List { .. } => None,
        });
        if let (Encoding::Binary { .. }, Some(size)) = (self.encoding, sizes) {
            let passed = self.skip_bytes(size.saturating_mul(element.count));
            return passed.map(drop).map_err(|problem| self.fault(element, 0, &problem));
        }
        // Without properties there is nothing to pass, however many there are said to be.
        for index in 0..if element.properties.is_empty() { 0 } else { element.count } {
            self.tell(index)?;
            let passed = self
                .begin()
                .and_then(|()| element.properties.iter().try_for_each(|property| self.skip(property.kind).map(drop)));
            passed.map_err(|problem| self.fault(element, index, &problem))?;
        }
        Ok(())
    }

    /// A problem at the place the walk has come to.
    pub(super) fn fault(&self, element: &Element, index: u64, problem: &str) -> Fault {
        let at = self.words.at;
        let place = match self.encoding {
            Encoding::Ascii => self.words.line(at),
            Encoding::Binary { .. } => format!("byte {at}"),
        };
        Fault::at(format!("{place}, {} {index}", crate::rigidity::quoted(&element.name)), problem)
    }

    /// How many bytes follow that are more than blanks in a text.
    pub(super) fn surplus(&self) -> usize {
        let mut rest = self.words.clone();
        match self.encoding {
            Encoding::Ascii => rest.anywhere().map_or(0, |word| rest.bytes.len() - word.start),
            Encoding::Binary { .. } => rest.bytes.len() - rest.at,
        }
    }
}

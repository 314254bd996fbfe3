//! The header of a PLY file: what its body lists, in which order and types.

use super::scalar::Scalar;
use crate::formats::words::{Word, Words, line_end};
use crate::rigidity::quoted;
use crate::{Fault, Warning, budget};
use std::ops::Range;

/// Properties and elements of one file; files of captured scenes have some 60 properties.
const MAX_DECLARATIONS: u64 = 10_000;

/// Strange lines that are told one by one.
const MAX_WARNINGS: usize = 10;

/// How numbers of the body are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Binary { big: bool },
}

/// What a property holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

/// A property of an element.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// Where the header names its type.
    pub(super) type_at: Range<usize>,
}

/// A list in the body.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    /// Where the header's lines about it end, after the line end.
    pub(super) end: usize,
}

impl Element {
    /// The index of a property.
    pub(super) fn property(&self, names: &[&str]) -> Option<usize> {
        self.properties.iter().position(|property| names.contains(&property.name.as_str()))
    }
}

/// The header of a PLY file.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Where the body begins.
    pub(super) body: usize,
    /// What ends its lines.
    pub(super) line_end: &'static str,
    /// What was passed over.
    pub(super) warnings: Vec<Warning>,
    /// Pictures that comments name, as MeshLab writes them.
    pub(super) pictures: Vec<String>,
}

impl Header {
    pub(super) fn parse(bytes: &[u8]) -> Result<Header, Fault> {
        let line_end = magic(bytes)?;
        let mut parser = Parser {
            bytes,
            encoding: None,
            elements: Vec::new(),
            n_declarations: 0,
            warnings: Vec::new(),
            pictures: Vec::new(),
        };
        let mut at = 3 + line_end.len();
        loop {
            let end = (bytes[at..].iter().position(|&b| b == if line_end == "\r" { b'\r' } else { b'\n' }))
                .map(|length| at + length + 1)
                .ok_or_else(|| Fault::Container("is cut off in its header: there is no line end_header".into()))?;
            let mut words = Words::new(&bytes[..end], at, false);
            if parser.line(&mut words, end)? {
                let missing = || Fault::Container("names no format in its header".into());
                let encoding = parser.encoding.ok_or_else(missing)?;
                let Parser { elements, warnings, pictures, .. } = parser;
                return Ok(Header { encoding, elements, body: end, line_end, warnings, pictures });
            }
            at = end;
        }
    }

    /// The index of an element.
    pub(super) fn element(&self, name: &str) -> Option<usize> {
        self.elements.iter().position(|element| element.name == name)
    }
}

/// The line end after the first word of the file, which is `ply`.
fn magic(bytes: &[u8]) -> Result<&'static str, Fault> {
    let foreign = || Fault::Container("is not a PLY file: it does not begin with the line ply".into());
    let rest = bytes.strip_prefix(b"ply").ok_or_else(foreign)?;
    match (line_end(rest, 0), rest.first()) {
        (2, _) => Ok("\r\n"),
        (1, Some(b'\r')) => Ok("\r"),
        (1, _) => Ok("\n"),
        _ => Err(foreign()),
    }
}

struct Parser<'a> {
    bytes: &'a [u8],
    encoding: Option<Encoding>,
    elements: Vec<Element>,
    n_declarations: u64,
    warnings: Vec<Warning>,
    pictures: Vec<String>,
}

impl<'a> Parser<'a> {
    /// Takes one line; true at the end of the header.
    fn line(&mut self, words: &mut Words<'a>, end: usize) -> Result<bool, Fault> {
        let at = words.at;
        let line = || words_line(self.bytes, at);
        let Some(keyword) = words.on_line() else { return Ok(false) };
        match keyword.text {
            b"end_header" => return Ok(true),
            b"comment" if self.pictures.len() < budget::PICTURES => {
                self.pictures.extend(picture(&self.bytes[at..end]));
            }
            b"comment" | b"obj_info" => {}
            b"format" => self.encoding = Some(encoding(words).map_err(|problem| Fault::at(line(), problem))?),
            b"element" => {
                let (name, count) = declared(words).map_err(|problem| Fault::at(line(), problem))?;
                if self.elements.iter().any(|element| element.name == name) {
                    return Err(Fault::at(line(), format!("element {} is declared twice", quoted(&name))));
                }
                self.elements.push(Element { name, count, properties: Vec::new(), end });
            }
            b"property" => {
                let property = property(words).map_err(|problem| Fault::at(line(), problem))?;
                let Some(element) = self.elements.last_mut() else {
                    return Err(Fault::at(line(), "a property comes before any element"));
                };
                element.properties.push(property);
                element.end = end;
            }
            // Some writers forget the word comment.
            _ if self.warnings.len() < MAX_WARNINGS => {
                let text = format!("{} of the header begins with {} and is passed over", line(), keyword.shown());
                self.warnings.push(Warning(text));
            }
            _ => {}
        }
        self.n_declarations += u64::from(matches!(keyword.text, b"element" | b"property"));
        budget::check("elements and properties in the header", self.n_declarations, MAX_DECLARATIONS)?;
        Ok(false)
    }
}

/// The picture that a comment names: `comment TextureFile brick wall.png`.
fn picture(line: &[u8]) -> Option<String> {
    let comment = std::str::from_utf8(line).ok()?.trim().strip_prefix("comment")?;
    let name = comment.trim_start().strip_prefix("TextureFile")?;
    let is_word = name.starts_with([' ', '\t']);
    let name = name.trim().replace('\\', "/");
    let name = name.strip_prefix("./").unwrap_or(&name);
    (is_word && !name.is_empty()).then(|| name.to_owned())
}

fn words_line(bytes: &[u8], at: usize) -> String {
    crate::formats::words::line_of(bytes, at)
}

fn encoding(words: &mut Words<'_>) -> Result<Encoding, String> {
    let shown = |word: Option<Word<'_>>| word.map_or_else(|| "nothing".to_owned(), |word| word.shown());
    let format = words.on_line();
    let encoding = match format.map(|word| word.text) {
        Some(b"ascii") => Encoding::Ascii,
        Some(b"binary_little_endian") => Encoding::Binary { big: false },
        Some(b"binary_big_endian") => Encoding::Binary { big: true },
        _ => {
            let known = "ascii, binary_little_endian and binary_big_endian are known";
            return Err(format!("the format is {}; {known}", shown(format)));
        }
    };
    match words.on_line() {
        Some(version) if version.text == b"1.0" => Ok(encoding),
        other => Err(format!("is PLY version {}; only 1.0 can be read", shown(other))),
    }
}

fn declared(words: &mut Words<'_>) -> Result<(String, u64), String> {
    let name = words.on_line().ok_or("an element without a name")?;
    let count = words.on_line().ok_or_else(|| format!("element {} has no count", name.shown()))?;
    let n = count.whole().ok_or_else(|| format!("{} is no count of elements", count.shown()))?;
    Ok((name.name(), n))
}

fn property(words: &mut Words<'_>) -> Result<Property, String> {
    let first = words.on_line().ok_or("a property without a type")?;
    let scalar = |word: Option<Word<'_>>| {
        let word = word.ok_or("a property without a type")?;
        Scalar::of(word.text).ok_or_else(|| format!("{} is no type of PLY", word.shown()))
    };
    let kind = if first.text == b"list" {
        let count = words.on_line();
        let shown = count.map(|word| word.shown()).unwrap_or_default();
        let count = scalar(count)?;
        if count.whole_range().is_none() {
            return Err(format!("a list cannot be counted in {shown}"));
        }
        Kind::List { count, item: scalar(words.on_line())? }
    } else {
        Kind::Scalar(scalar(Some(first))?)
    };
    let name = words.on_line().ok_or("a property without a name")?;
    Ok(Property { name: name.name(), kind, type_at: first.start..first.end() })
}

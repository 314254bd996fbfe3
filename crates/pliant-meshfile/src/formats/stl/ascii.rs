//! STL as text: solids of facets, each a normal and a loop of three corners.

use super::{Parsed, check_count, turned_normal};
use crate::formats::Edit;
use crate::formats::words::{Word, Words, shortest, shortest_single};
use crate::watch::{PIECE, Stage};
use crate::{Fault, budget};
use glam::{DVec3, Vec3};

/// Where the text begins, behind a mark of its encoding and blanks.
pub(super) fn start(bytes: &[u8]) -> usize {
    let mark = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
    mark + bytes[mark..].iter().take_while(|byte| byte.is_ascii_whitespace()).count()
}

const NO_WORD: Word<'_> = Word { text: b"", start: 0 };

/// What follows next in a text.
enum Piece {
    Solid(String),
    /// Its numbers are those of the walk.
    Facet,
}

/// A walk over the pieces of a text.
struct Walk<'a> {
    words: Words<'a>,
    /// The numbers of the last facet: of its normal, which may be empty words, and of the three corners.
    numbers: [Word<'a>; 12],
}

impl<'a> Walk<'a> {
    fn new(bytes: &'a [u8]) -> Walk<'a> {
        Walk { words: Words::new(bytes, start(bytes), false), numbers: [NO_WORD; 12] }
    }

    fn next(&mut self) -> Result<Option<Piece>, Fault> {
        while let Some(word) = self.words.anywhere() {
            if word.text.eq_ignore_ascii_case(b"solid") {
                return Ok(Some(Piece::Solid(self.words.rest_of_line())));
            }
            if word.text.eq_ignore_ascii_case(b"facet") {
                self.numbers = self.facet()?;
                return Ok(Some(Piece::Facet));
            }
            if !word.text.eq_ignore_ascii_case(b"endsolid") {
                return Err(self.unexpected(Some(word), "solid, facet or endsolid"));
            }
            // The name again.
            self.words.rest_of_line();
        }
        Ok(None)
    }

    fn facet(&mut self) -> Result<[Word<'a>; 12], Fault> {
        let mut numbers = [NO_WORD; 12];
        let (normal, corners) = numbers.split_at_mut(3);
        self.keywords(&["normal"])?;
        let behind = self.words.at;
        // Some writers give no numbers.
        let is_missing = self.words.anywhere().is_some_and(|word| word.text.eq_ignore_ascii_case(b"outer"));
        self.words.at = behind;
        if !is_missing {
            self.triple(normal)?;
        }
        self.keywords(&["outer", "loop"])?;
        for corner in corners.chunks_exact_mut(3) {
            self.keywords(&["vertex"])?;
            self.triple(corner)?;
        }
        self.keywords(&["endloop", "endfacet"])?;
        Ok(numbers)
    }

    fn keywords(&mut self, keywords: &[&str]) -> Result<(), Fault> {
        for keyword in keywords {
            let word = self.words.anywhere();
            if !word.is_some_and(|word| word.text.eq_ignore_ascii_case(keyword.as_bytes())) {
                return Err(self.unexpected(word, keyword));
            }
        }
        Ok(())
    }

    fn triple(&mut self, out: &mut [Word<'a>]) -> Result<(), Fault> {
        for slot in out {
            *slot = self.words.anywhere().ok_or_else(|| self.unexpected(None, "a number"))?;
        }
        Ok(())
    }

    fn unexpected(&self, found: Option<Word<'a>>, expected: &str) -> Fault {
        let place = self.words.line(found.map_or(self.words.bytes.len(), |word| word.start));
        let problem = match found {
            Some(word) if word.text.eq_ignore_ascii_case(b"vertex") && expected == "endloop" => {
                "a facet has more than three corners; STL holds triangles only".to_owned()
            }
            Some(word) => format!("{} stands where {expected} is expected", word.shown()),
            None => format!("the file breaks off where {expected} is expected"),
        };
        Fault::at(place, problem)
    }
}

pub(super) fn parse(bytes: &[u8], name: &str, stage: Stage<'_>) -> Result<Parsed, Fault> {
    let (mut walk, mut out) = (Walk::new(bytes), Parsed::default());
    let mut names = budget::Purse::of_names();
    let mut current = budget::short_name(name.to_owned());
    let mut begins = true;
    while let Some(piece) = walk.next()? {
        if let Piece::Solid(given) = piece {
            let given = if given.is_empty() { name.to_owned() } else { given };
            (current, begins) = (budget::short_name(given), true);
            continue;
        }
        let t = out.positions.len() / 3;
        check_count(t as u64 + 1)?;
        if t.is_multiple_of(PIECE) {
            stage.tell(walk.words.at, bytes.len())?;
        }
        let mut numbers = [0.0; 9];
        for (number, word) in numbers.iter_mut().zip(&walk.numbers[3..]) {
            *number = word
                .finite()
                .map_err(|problem| Fault::at(format!("{}, triangle {t}", walk.words.line(word.start)), problem))?;
        }
        out.positions.extend(numbers.as_chunks().0.iter().map(|&corner| DVec3::from_array(corner)));
        if std::mem::take(&mut begins) {
            names.spend(current.len())?;
            out.solids.push((std::mem::take(&mut current), t..t));
        }
        if let Some((_, triangles)) = out.solids.last_mut() {
            triangles.end = t + 1;
        }
    }
    Ok(out)
}

/// The text again; a number is touched only if it changed.
pub(super) fn rewrite(bytes: &[u8], edit: &Edit<'_>) -> Vec<u8> {
    let (mut walk, mut t) = (Walk::new(bytes), 0);
    let mut out = Vec::with_capacity(bytes.len() + bytes.len() / 8);
    let mut copied = 0;
    let mut replace = |word: Word<'_>, text: String| {
        out.extend_from_slice(&bytes[copied..word.start]);
        out.extend_from_slice(text.as_bytes());
        copied = word.end();
    };
    // The text was read before and holds no error.
    while let Ok(Some(piece)) = walk.next() {
        let Piece::Facet = piece else { continue };
        let words = walk.numbers;
        let old = |i: usize| words[i].number().map_or(f32::NAN, |x| x as f32);
        if let Some(normal) = turned_normal(edit, t, Vec3::new(old(0), old(1), old(2))) {
            (0..3).for_each(|axis| replace(words[axis], shortest_single(normal[axis])));
        }
        for (i, &word) in words[3..].iter().enumerate() {
            let (vertex, axis) = (3 * t + i / 3, i % 3);
            let [old, new] = [edit.mesh.positions, &edit.positions].map(|positions| positions[vertex][axis]);
            if new != old {
                replace(word, shortest(new));
            }
        }
        t += 1;
    }
    out.extend_from_slice(&bytes[copied..]);
    out
}

//! The first words of an OFF file: what its vertices have, and how many there are.

use crate::Fault;
use crate::formats::words::Words;

/// What vertices have besides their place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Has {
    pub(super) normals: bool,
    pub(super) colors: bool,
    pub(super) uvs: bool,
}

/// The header of an OFF file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Header {
    pub(super) has: Has,
    pub(super) n_vertices: u64,
    pub(super) n_faces: u64,
    /// Where the vertices begin.
    pub(super) body: usize,
    /// Whether numbers stand on whatever lines, so that no line holds more than was declared.
    pub(super) free: bool,
}

impl Header {
    pub(super) fn parse(bytes: &[u8], free: bool) -> Result<Header, Fault> {
        let mark = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        let mut words = Words::new(bytes, mark, true);
        let has = keyword(&mut words).map_err(Fault::Container)?;
        let mut count = |what: &str| {
            let word = words.anywhere();
            let shown = word.map_or_else(|| "nothing".into(), |word| word.shown());
            let place = words.line(word.map_or(bytes.len(), |word| word.start));
            let n = word.and_then(|word| word.whole());
            n.ok_or_else(|| Fault::at(place, format!("the number of {what} is expected and {shown} is there")))
        };
        let (n_vertices, n_faces) = (count("vertices")?, count("faces")?);
        // The number of edges, which means nothing, and may be missing.
        if free {
            words.anywhere();
            return Ok(Header { has, n_vertices, n_faces, body: words.at, free });
        }
        words.on_line();
        if let Some(word) = words.on_line() {
            let problem = format!("{} follows the numbers of vertices, faces and edges", word.shown());
            return Err(Fault::at(words.line(word.start), problem));
        }
        Ok(Header { has, n_vertices, n_faces, body: words.at, free })
    }

    /// Numbers at the front of each vertex that no other kind can be mistaken for.
    pub(super) fn n_first(&self) -> usize {
        if self.has.normals { 6 } else { 3 }
    }

    /// Refuses counts that are more than the bytes of the file can hold.
    pub(super) fn check_room(&self, n_bytes: usize) -> Result<(), Fault> {
        let left = n_bytes - self.body;
        // Each number is a blank and a digit; each face has at least the number of its corners.
        let least = self.n_vertices.saturating_mul(2 * self.n_first() as u64).saturating_add(self.n_faces);
        if least > left as u64 {
            return Err(Fault::Container(format!(
                "is cut off: it counts {} vertices and {} faces, of {least} bytes or more, and {left} bytes are left",
                self.n_vertices, self.n_faces
            )));
        }
        Ok(())
    }
}

/// What the first word declares; it may be missing, and counts may stick to it.
fn keyword(words: &mut Words<'_>) -> Result<Has, String> {
    let foreign =
        || "is not an OFF file: it begins neither with OFF nor with its numbers of vertices and faces".to_owned();
    let word = words.anywhere().ok_or_else(foreign)?;
    if word.whole().is_some() {
        words.at = word.start;
        return Ok(Has::default());
    }
    // The longest is STCN4nOFF, with a count behind it.
    let text = word.text[..word.text.len().min(32)].to_ascii_uppercase();
    let end = text.windows(3).position(|window| window == b"OFF").ok_or_else(foreign)?;
    // `nOFF`, unlike `NOFF` and `noff`, tells its dimension; `4OFF` has four.
    let declared = &word.text[..end];
    if declared.contains(&b'4') || (declared.contains(&b'n') && word.text[end..].starts_with(b"OFF")) {
        let kind = word.shown();
        return Err(format!("is an OFF file of the kind {kind}: only points of three dimensions can be read"));
    }
    let mut has = Has::default();
    let mut prefix = &text[..end];
    while let Some(&first) = prefix.first() {
        let (flag, length) = match first {
            b'N' => (&mut has.normals, 1),
            b'C' => (&mut has.colors, 1),
            b'S' if prefix.get(1) == Some(&b'T') => (&mut has.uvs, 2),
            _ => return Err(foreign()),
        };
        *flag = true;
        prefix = &prefix[length..];
    }
    let stuck = &word.text[end + 3..];
    if !stuck.iter().all(u8::is_ascii_digit) {
        return Err(foreign());
    }
    if !stuck.is_empty() {
        words.at = word.start + end + 3;
        return Ok(has);
    }
    let behind = words.at;
    if words.on_line().is_some_and(|word| word.text.eq_ignore_ascii_case(b"binary")) {
        return Err("is a binary OFF file, which is not read: save it as text and open that".into());
    }
    words.at = behind;
    Ok(has)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_word_declares_what_vertices_have() {
        let read = |text: &str| Header::parse(text.as_bytes(), false).map(|h| (h.has, h.n_vertices, h.n_faces));
        let has = |normals, colors, uvs| Has { normals, colors, uvs };
        for (text, expected) in [
            ("OFF 1 2 3\n", has(false, false, false)),
            ("off\n1 2\n", has(false, false, false)),
            ("# shape\nCOFF\n\n1 # of them\n2\n", has(false, true, false)),
            ("CNOFF\n1 2 3", has(true, true, false)),
            ("STNCOFF\n1 2 3", has(true, true, true)),
            ("noff 1 2 0\n", has(true, false, false)),
            ("OFF1 2 3\n", has(false, false, false)),
            ("1 2 3\n", has(false, false, false)),
        ] {
            assert_eq!(read(text).unwrap_or_else(|error| panic!("{text:?}: {error}")), (expected, 1, 2), "{text:?}");
        }
    }

    #[test]
    fn other_first_words_are_refused_by_what_they_are() {
        for (text, expected) in [
            ("", "is not an OFF file"),
            ("SKEL 1 2\n", "is not an OFF file"),
            ("OFFICE\n", "is not an OFF file"),
            ("nOFF 4\n", "of the kind nOFF: only points of three"),
            ("4OFF\n", "of the kind 4OFF: only points of three"),
            ("OFF BINARY\n", "is a binary OFF file"),
            ("OFF\nx", "line 2: the number of vertices is expected and x is there"),
            ("OFF 1", "line 1: the number of faces is expected and nothing is there"),
            ("OFF 1 2 3 4\n", "line 1: 4 follows the numbers"),
        ] {
            let got = Header::parse(text.as_bytes(), false).expect_err(text).to_string();
            assert!(got.contains(expected), "{text:?}: got {got}");
        }
    }
}

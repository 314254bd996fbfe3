//! Statements and words of OBJ text, over bytes, so that any encoding passes and places can be edited.

use std::ops::Range;

/// A line, with its continuations, as a range of the text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Statement<'a> {
    bytes: &'a [u8],
    pub(super) start: usize,
    end: usize,
    /// Whether it goes over several lines.
    is_continued: bool,
}

/// Walks the statements of a text. Lines end at `\n`, `\r\n` or `\r`.
pub(super) struct Statements<'a> {
    bytes: &'a [u8],
    at: usize,
    end: usize,
    line: usize,
}

/// Length of the byte order mark at the start of a text.
fn mark(bytes: &[u8]) -> usize {
    if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 }
}

impl<'a> Statements<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Statements::within(bytes, 0..bytes.len())
    }

    /// Those of a range that begins and ends between statements; lines are counted from its start.
    pub(super) fn within(bytes: &'a [u8], range: Range<usize>) -> Self {
        Statements { bytes, at: range.start.max(mark(bytes)), end: range.end, line: 1 }
    }
}

/// Ranges of about `size` bytes that cover a text and end between statements.
pub(super) fn cuts(bytes: &[u8], size: usize) -> Vec<Range<usize>> {
    let (mut ranges, mut start) = (Vec::new(), 0);
    while start < bytes.len() {
        let end = statement_end_after(bytes, start.saturating_add(size));
        ranges.push(start..end);
        start = end;
    }
    ranges
}

/// The first place from `at` on where a statement certainly has ended: behind a line end that no backslash precedes.
fn statement_end_after(bytes: &[u8], mut at: usize) -> usize {
    while at < bytes.len() {
        let Some(found) = memchr::memchr2(b'\n', b'\r', &bytes[at..]) else { break };
        let mut end = at + found;
        at = end + line_end(bytes, end);
        if bytes[end] == b'\n' && end > 0 && bytes[end - 1] == b'\r' {
            end -= 1;
        }
        if end == 0 || bytes[end - 1] != b'\\' {
            return at;
        }
    }
    bytes.len()
}

impl<'a> Iterator for Statements<'a> {
    /// The statement and the number of its first line, from 1.
    type Item = (Statement<'a>, usize);

    fn next(&mut self) -> Option<Self::Item> {
        let (bytes, start, line) = (self.bytes, self.at, self.line);
        if start >= self.end {
            return None;
        }
        let statement = statement_at(bytes, start);
        let mut at = statement.end;
        self.line += 1 + if statement.is_continued { count_line_ends(&bytes[start..at]) } else { 0 };
        at += line_end(bytes, at);
        self.at = at;
        Some((statement, line))
    }
}

/// The statement that begins at a place.
pub(super) fn statement_at(bytes: &[u8], start: usize) -> Statement<'_> {
    let end = memchr::memchr2(b'\n', b'\r', &bytes[start..]).map_or(bytes.len(), |length| start + length);
    // Only a backslash right before the line end can continue a line.
    if end == bytes.len() || end == start || bytes[end - 1] != b'\\' {
        return Statement { bytes, start, end, is_continued: false };
    }
    continued_statement_at(bytes, start)
}

fn continued_statement_at(bytes: &[u8], start: usize) -> Statement<'_> {
    // A comment that ends in a backslash does not swallow the line after it; in a name `#` begins no comment.
    let (mut end, mut continues, mut holds_name) = (start, true, None);
    let mut after_blank = true;
    while end < bytes.len() {
        let byte = bytes[end];
        if byte == b'#' && after_blank {
            let before = Statement { bytes, start, end, is_continued: true };
            continues &= *holds_name.get_or_insert_with(|| before.holds_name());
        }
        after_blank = is_blank(byte);
        match byte {
            b'\n' | b'\r' => break,
            b'\\' if continues && line_end(bytes, end + 1) > 0 => {
                end += 1 + line_end(bytes, end + 1);
                after_blank = true;
            }
            _ => end += 1,
        }
    }
    Statement { bytes, start, end, is_continued: true }
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\0' | 0x0b | 0x0c)
}

/// Length of the line end at a place, 0 if there is none.
fn line_end(bytes: &[u8], at: usize) -> usize {
    match (bytes.get(at), bytes.get(at + 1)) {
        (Some(b'\r'), Some(b'\n')) => 2,
        (Some(b'\r' | b'\n'), _) => 1,
        _ => 0,
    }
}

fn count_line_ends(bytes: &[u8]) -> usize {
    let (mut at, mut n) = (0, 0);
    while at < bytes.len() {
        let length = line_end(bytes, at);
        n += usize::from(length > 0);
        at += length.max(1);
    }
    n
}

impl<'a> Statement<'a> {
    /// The words before a comment, each with its range in the text.
    pub(super) fn words(self) -> Words<'a> {
        Words { statement: self, at: self.start }
    }

    /// Whether everything after its first word is a name.
    fn holds_name(self) -> bool {
        let keyword = self.words().next();
        keyword.is_some_and(|word| matches!(word.bytes, b"o" | b"g" | b"usemtl" | b"mtllib" | b"newmtl"))
    }

    /// Everything after the first word, as text, without blanks around it: a name may contain blanks and `#`.
    pub(super) fn rest(self) -> String {
        let after = self.words().next().map_or(self.end, |word| word.end);
        String::from_utf8_lossy(&self.bytes[after..self.end]).trim().to_owned()
    }
}

/// A word as a range of the text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) start: usize,
    pub(super) end: usize,
}

impl Word<'_> {
    pub(super) fn number(&self) -> Option<f64> {
        fast_float2::parse(self.bytes).ok()
    }

    pub(super) fn shown(&self) -> String {
        crate::rigidity::quoted(&String::from_utf8_lossy(self.bytes))
    }
}

/// Iterator over the words of a statement.
pub(super) struct Words<'a> {
    statement: Statement<'a>,
    at: usize,
}

impl<'a> Iterator for Words<'a> {
    type Item = Word<'a>;

    fn next(&mut self) -> Option<Word<'a>> {
        let Statement { bytes, end, is_continued, .. } = self.statement;
        // Inside a statement a line end only ever follows a backslash.
        let continuation =
            |at: usize| is_continued && bytes[at] == b'\\' && at + 1 < end && line_end(bytes, at + 1) > 0;
        let mut start = self.at;
        while start < end {
            if continuation(start) {
                start += 1 + line_end(bytes, start + 1);
            } else if is_blank(bytes[start]) {
                start += 1;
            } else {
                break;
            }
        }
        if start >= end || bytes[start] == b'#' {
            self.at = end;
            return None;
        }
        let mut stop = start;
        while stop < end && !is_blank(bytes[stop]) && !continuation(stop) {
            stop += 1;
        }
        self.at = stop;
        Some(Word { bytes: &bytes[start..stop], start, end: stop })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comment_ends_with_its_line_and_a_name_may_hold_its_mark() {
        let text = b"v 1 2 3 # up \\\nv 4 5 6\no a # b \\\nc\nv 7#8 \\\n9\n";
        let got: Vec<(usize, String)> = Statements::new(text).map(|(s, line)| (line, s.rest())).collect();
        let expected = [(1, "1 2 3 # up \\"), (2, "4 5 6"), (3, "a # b \\\nc"), (5, "7#8 \\\n9")];
        assert_eq!(got, expected.map(|(line, rest)| (line, rest.to_owned())));
    }

    #[test]
    fn numbers_are_those_of_the_standard_library() {
        let mut texts: Vec<String> = [
            "0",
            "-0",
            "+1.5",
            "1.",
            ".5",
            "-.5e-3",
            "1e5",
            "1E+5",
            "1e400",
            "-1e400",
            "1e-400",
            "4.9e-324",
            "2e-324",
            "0.1",
            "123456789012345678901234567890",
            "0.30000000000000004",
            "9007199254740993",
            "nan",
            "-NaN",
            "inf",
            "Infinity",
            "-inf",
            "",
            ".",
            "-",
            "+",
            "e5",
            "1e",
            "1e+",
            "0x10",
            "1_000",
            "1,5",
            "1.5f",
            "1d5",
            "--1",
            " 1",
            "1 ",
            "1.2.3",
            "infinit",
            "na",
            "\u{661}",
        ]
        .map(str::to_owned)
        .to_vec();
        let mut state = 1_u64;
        for _ in 0..20_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let number = f64::from_bits(state);
            texts.extend([number.to_string(), format!("{number:e}"), format!("{:.6}", (state >> 40) as f64 / 1e5)]);
        }
        for text in &texts {
            let word = Word { bytes: text.as_bytes(), start: 0, end: text.len() };
            let expected = text.parse::<f64>().ok().map(f64::to_bits);
            // The sign of what is no number means nothing.
            let same = word.number().map(f64::to_bits) == expected || word.number().is_some_and(f64::is_nan);
            assert!(same, "{text:?}: got {:?}, expected {:?}", word.number(), text.parse::<f64>());
        }
    }

    #[test]
    fn cuts_lie_between_statements_and_cover_the_text() {
        let text = b"\xef\xbb\xbfv 1\\\r\n2\r\nv 3\r\r\n\nf 1 2\\\n\\\r3\r# c\\\nv\n\nv 9";
        let whole: Vec<usize> = Statements::new(text).map(|(statement, _)| statement.start).collect();
        for size in 1..text.len() {
            let ranges = cuts(text, size);
            let starts = ranges.iter().cloned().flat_map(|range| Statements::within(text, range));
            let starts: Vec<usize> = starts.map(|(statement, _)| statement.start).collect();
            assert_eq!(starts, whole, "pieces of {size} bytes: {ranges:?}");
            assert!(ranges.windows(2).all(|pair| pair[0].end == pair[1].start), "{ranges:?}");
            assert_eq!(ranges.last().map(|range| range.end), Some(text.len()));
        }
    }

    #[test]
    fn lines_end_and_continue_in_every_way() {
        let text = b"\xef\xbb\xbfv 1 \\\r\n2\\\n3\r# art \\\nf a#b # c\n";
        let got: Vec<(usize, Vec<String>)> = Statements::new(text)
            .map(|(s, line)| (line, s.words().map(|w| String::from_utf8_lossy(w.bytes).into_owned()).collect()))
            .collect();
        let words = |text: &str| text.split(' ').filter(|w| !w.is_empty()).map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(got, [(1, words("v 1 2 3")), (4, words("")), (5, words("f a#b"))]);
    }
}

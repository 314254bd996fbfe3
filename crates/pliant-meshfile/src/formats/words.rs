//! Words of text with blanks and line ends between them, and their places: what the text formats without continuation
//! lines share.

use crate::budget;

/// Walks over the words of a text. Lines end at `\n`, `\r\n` or `\r`.
#[derive(Clone)]
pub(super) struct Words<'a> {
    pub(super) bytes: &'a [u8],
    /// Where the next word is looked for.
    pub(super) at: usize,
    /// Whether `#` begins a comment that lasts to the end of its line.
    comments: bool,
}

/// A word and where it begins in the text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<'a> {
    pub(super) text: &'a [u8],
    pub(super) start: usize,
}

impl<'a> Words<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize, comments: bool) -> Words<'a> {
        Words { bytes, at, comments }
    }

    /// The next word before the end of the line.
    pub(super) fn on_line(&mut self) -> Option<Word<'a>> {
        let bytes = self.bytes;
        let mut start = self.at;
        while start < bytes.len() && is_blank(bytes[start]) {
            start += 1;
        }
        let mut end = start;
        while end < bytes.len() && !is_blank(bytes[end]) && !is_line_end(bytes[end]) {
            if self.comments && bytes[end] == b'#' {
                break;
            }
            end += 1;
        }
        self.at = end;
        (end > start).then(|| Word { text: &bytes[start..end], start })
    }

    /// Goes to the next line, whatever is left of this one; false at the end of the text.
    pub(super) fn next_line(&mut self) -> bool {
        let bytes = self.bytes;
        while self.at < bytes.len() && !is_line_end(bytes[self.at]) {
            self.at += 1;
        }
        let more = self.at < bytes.len();
        self.at += line_end(bytes, self.at);
        more
    }

    /// The next word on this line or a later one.
    pub(super) fn anywhere(&mut self) -> Option<Word<'a>> {
        loop {
            if let Some(word) = self.on_line() {
                return Some(word);
            }
            if !self.next_line() {
                return None;
            }
        }
    }

    /// Everything up to the end of the line as a name, without blanks around it.
    pub(super) fn rest_of_line(&mut self) -> String {
        let start = self.at;
        while self.at < self.bytes.len() && !is_line_end(self.bytes[self.at]) {
            self.at += 1;
        }
        name(&self.bytes[start..self.at])
    }

    /// The line a place is in, for messages: `line 7`.
    pub(super) fn line(&self, at: usize) -> String {
        line_of(self.bytes, at)
    }
}

impl Word<'_> {
    pub(super) fn end(&self) -> usize {
        self.start + self.text.len()
    }

    pub(super) fn number(&self) -> Option<f64> {
        std::str::from_utf8(self.text).ok()?.parse().ok()
    }

    /// A number that is finite, or what is wrong with it.
    pub(super) fn finite(&self) -> Result<f64, String> {
        match self.number() {
            Some(number) if number.is_finite() => Ok(number),
            Some(_) => Err(format!("{} is not finite", self.shown())),
            None => Err(format!("{} is not a number", self.shown())),
        }
    }

    /// A whole number from 0, also one written with a point.
    pub(super) fn whole(&self) -> Option<u64> {
        let digits = |n: u64, &byte: &u8| byte.is_ascii_digit().then(|| n * 10 + u64::from(byte - b'0'));
        // Eighteen digits do not overflow.
        if (1..=18).contains(&self.text.len())
            && let Some(number) = self.text.iter().try_fold(0, digits)
        {
            return Some(number);
        }
        // Up to 2⁵³ floating point tells whole numbers apart.
        self.number().filter(|x| x.fract() == 0.0 && (0.0..9.0e15).contains(x)).map(|x| x as u64)
    }

    pub(super) fn shown(&self) -> String {
        crate::rigidity::quoted(&self.name())
    }

    /// The word as text, cut where it is too long for a name.
    pub(super) fn name(&self) -> String {
        name(self.text)
    }
}

/// Bytes as text without blanks around it; a line of a gigabyte is not copied.
fn name(bytes: &[u8]) -> String {
    let short = &bytes[..bytes.len().min(budget::NAME_BYTES)];
    budget::short_name(String::from_utf8_lossy(short).trim().to_owned())
}

/// The line a place is in, from 1, for messages.
pub(super) fn line_of(bytes: &[u8], at: usize) -> String {
    let (mut i, mut line) = (0, 1);
    while i < at.min(bytes.len()) {
        let length = line_end(bytes, i);
        line += usize::from(length > 0 && i + length <= at);
        i += length.max(1);
    }
    format!("line {line}")
}

fn is_blank(byte: u8) -> bool {
    byte <= b' ' && !is_line_end(byte)
}

pub(super) fn is_line_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

/// Length of the line end at a place, 0 if there is none.
pub(super) fn line_end(bytes: &[u8], at: usize) -> usize {
    match (bytes.get(at), bytes.get(at + 1)) {
        (Some(b'\r'), Some(b'\n')) => 2,
        (Some(b'\r' | b'\n'), _) => 1,
        _ => 0,
    }
}

/// The fewest digits that read back as the same number, without long runs of zeros.
pub(super) fn shortest(x: f64) -> String {
    let size = x.abs();
    // Within these bounds plain digits are no longer than an exponent makes them, by eye.
    if size == 0.0 || (1e-5..1e16).contains(&size) { x.to_string() } else { format!("{x:e}") }
}

/// [`shortest`] among the numbers of single precision.
pub(super) fn shortest_single(x: f32) -> String {
    let size = x.abs();
    if size == 0.0 || (1e-5..1e9).contains(&size) { x.to_string() } else { format!("{x:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_know_their_lines_whatever_ends_them() {
        for end in ["\n", "\r\n", "\r"] {
            let text = ["one two # three", "", "  four", "five"].join(end);
            let mut words = Words::new(text.as_bytes(), 0, true);
            let mut got = Vec::new();
            while let Some(word) = words.anywhere() {
                got.push((word.shown(), words.line(word.start)));
            }
            let expected = [("one", 1), ("two", 1), ("four", 3), ("five", 4)];
            assert_eq!(got, expected.map(|(word, line)| (word.to_owned(), format!("line {line}"))), "{end:?}");
        }
    }

    #[test]
    fn whole_numbers_are_told_from_others() {
        let whole = |text: &str| Word { text: text.as_bytes(), start: 0 }.whole();
        assert_eq!(whole("12"), Some(12));
        assert_eq!(whole("+3"), Some(3));
        assert_eq!(whole("3.0"), Some(3));
        for text in ["-1", "1.5", "nan", "1e99", "99999999999999999999", "x", ""] {
            assert_eq!(whole(text), None, "{text}");
        }
    }

    #[test]
    fn written_numbers_read_back_the_same() {
        for x in [0.0, -0.0, 0.1, 1.0 / 3.0, 1e-300, -1e300, 1e15, 123456.789] {
            let text = shortest(x);
            assert_eq!(text.parse::<f64>().expect("a number").to_bits(), x.to_bits(), "{text}");
            assert!(text.len() < 26, "{text}");
            let single = x as f32;
            let text = shortest_single(single);
            assert_eq!(text.parse::<f32>().expect("a number").to_bits(), single.to_bits(), "{text}");
        }
    }
}

//! Damage to words and lines of text: numbers that are huge, negative or none, lines gone, doubled or swapped.

use crate::random::Random;

/// What may stand where a number or a keyword stood.
const WORDS: &[&str] = &[
    "0",
    "1",
    "-1",
    "2",
    "3",
    "4",
    "255",
    "256",
    "65535",
    "65536",
    "16777216",
    "2147483647",
    "-2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551615",
    "99999999999999999999",
    "1e38",
    "3.5e38",
    "1e308",
    "1e309",
    "-1e309",
    "1e-320",
    "nan",
    "inf",
    "-inf",
    "0x10",
    "1.5",
    "",
    "v",
    "f",
    "f 1 2 3",
    "end",
    "x",
    "\\",
    "#",
    "\u{feff}",
    "é",
    "1/1/1",
    "-1//-1",
];

/// The text with one word or line changed; lines end at `\n`.
pub(super) fn edited(text: &[u8], random: &mut Random) -> Vec<u8> {
    let mut lines: Vec<Vec<u8>> = text.split(|&b| b == b'\n').map(<[u8]>::to_vec).collect();
    let (at, other) = (random.below(lines.len()), random.below(lines.len()));
    match random.below(8) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(other, lines[at].clone()),
        2 => lines.swap(at, other),
        3 => {
            let n = random.below(200);
            let line = lines[at].clone();
            lines.splice(at..at, std::iter::repeat_n(line, n));
        }
        _ => {
            let mut words: Vec<&[u8]> = lines[at].split(|&b| b == b' ').collect();
            let which = random.below(words.len());
            match random.below(4) {
                0 => drop(words.remove(which)),
                1 => words.insert(which, random.pick(WORDS).as_bytes()),
                _ => words[which] = random.pick(WORDS).as_bytes(),
            }
            lines[at] = words.join(&b' ');
        }
    }
    lines.join(&b'\n')
}

//! Tables in Markdown.

use std::fmt::Write as _;
use std::time::Duration;

/// A table whose first `n_names` columns are names; the others are numbers, set to the right.
pub(crate) struct Table {
    text: String,
}

impl Table {
    /// Its header.
    pub(crate) fn new(n_names: usize, header: &[&str]) -> Table {
        let rules = (0..header.len()).map(|column| if column < n_names { "---" } else { "---:" });
        let mut table = Table { text: String::new() };
        table.row(header.iter().map(ToString::to_string));
        table.row(rules.map(str::to_owned));
        table
    }

    /// One more row.
    pub(crate) fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        for cell in cells {
            // A string takes whatever is written to it.
            let _ = write!(self.text, "| {cell} ");
        }
        self.text.push_str("|\n");
    }

    /// The table with an empty line after it.
    pub(crate) fn into_text(mut self) -> String {
        self.text.push('\n');
        self.text
    }
}

/// Three significant digits, no fewer before the point.
pub(crate) fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 6.0);
    format!("{value:.*}", decimals as usize)
}

/// Milliseconds.
pub(crate) fn ms(time: Duration) -> String {
    digits(1e3 * time.as_secs_f64())
}

/// A count with separated thousands.
pub(crate) fn count(n: usize) -> String {
    let plain = n.to_string();
    let mut text = String::new();
    for (i, digit) in plain.chars().enumerate() {
        if i > 0 && (plain.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits_that_count() {
        let pairs = [(0.0, "0"), (1234.5, "1234"), (12.345, "12.3"), (0.012_345, "0.0123"), (9.876, "9.88")];
        for (value, text) in pairs {
            assert_eq!(digits(value), text);
        }
        assert_eq!([count(7), count(1000), count(998_562)], ["7", "1,000", "998,562"]);
    }

    #[test]
    fn tables_are_markdown() {
        let mut table = Table::new(1, &["what", "ms"]);
        table.row(["solve".to_owned(), "1.00".to_owned()]);
        assert_eq!(table.into_text(), "| what | ms |\n| --- | ---: |\n| solve | 1.00 |\n\n");
    }
}

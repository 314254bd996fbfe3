//! Whether the page that is kept is whole: it names what is there and nothing else, its numbers can be read, its pictures
//! are small, and every figure has a statement.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::failure::Failure;
use crate::figures::COUNT;
use crate::page::{FAILS, HOLDS};

/// Bytes of a picture, and of all files, that a repository may be asked to keep (by eye: a page loads at once).
const LARGEST_PICTURE: u64 = 60_000;
const ALL_FILES: u64 = 3_000_000;

/// Checks the page in a folder.
pub(crate) fn run(folder: &Path) -> Result<(), Failure> {
    let page = folder.join("README.md");
    let text = fs::read_to_string(&page).map_err(|source| Failure::File { path: page, source })?;
    let there = files(folder)?;
    let mut faults = of_page(&text, &there);
    let mut total = text.len() as u64;
    for file in &there {
        let path = folder.join(file);
        let bytes = fs::read(&path).map_err(|source| Failure::File { path, source })?;
        total += bytes.len() as u64;
        faults.extend(of_file(file, &bytes));
    }
    if total > ALL_FILES {
        faults.push(format!("all files together have {total} bytes, more than {ALL_FILES}"));
    }
    if !faults.is_empty() {
        return Err(Failure::Faults(faults));
    }
    eprintln!("gallery: the page and its {} files are whole", there.len());
    Ok(())
}

/// Pictures and tables in a folder, by name.
pub(crate) fn files(folder: &Path) -> Result<Vec<String>, Failure> {
    let failed = |source| Failure::File { path: folder.to_owned(), source };
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name().to_string_lossy().into_owned();
        if [".png", ".svg", ".csv"].iter().any(|ending| name.ends_with(ending)) {
            names.push(name);
        }
    }
    names.sort_unstable();
    Ok(names)
}

/// Names in `src="…"` and in `](…)`, other than addresses and headings.
fn named(text: &str) -> BTreeSet<&str> {
    let after = |mark: &'static str, end: char| text.split(mark).skip(1).filter_map(move |rest| rest.split(end).next());
    let is_file = |name: &&str| !name.contains("://") && !name.starts_with('#') && !name.contains('/');
    after("src=\"", '"').chain(after("](", ')')).filter(is_file).collect()
}

fn of_page(text: &str, there: &[String]) -> Vec<String> {
    let named = named(text);
    let mut faults: Vec<String> = Vec::new();
    let missing = named.iter().filter(|name| !there.iter().any(|file| file == *name));
    faults.extend(missing.map(|name| format!("the page names {name}, which is not there")));
    let unnamed = there.iter().filter(|file| !named.contains(file.as_str()));
    faults.extend(unnamed.map(|file| format!("{file} is not on the page")));
    let figures: Vec<&str> = text.split("\n## ").skip(1).collect();
    if figures.len() != COUNT {
        faults.push(format!("the page has {} figures, expected {COUNT}", figures.len()));
    }
    for figure in figures {
        if !figure.contains(HOLDS) && !figure.contains(FAILS) {
            faults.push(format!("{} has no statement", figure.lines().next().unwrap_or_default()));
        }
    }
    faults
}

fn of_file(file: &str, bytes: &[u8]) -> Vec<String> {
    let mut faults = Vec::new();
    if !file.ends_with(".csv") && bytes.len() as u64 > LARGEST_PICTURE {
        faults.push(format!("{file} has {} bytes, more than {LARGEST_PICTURE}", bytes.len()));
    }
    if file.ends_with(".csv")
        && let Err(what) = table(&String::from_utf8_lossy(bytes))
    {
        faults.push(format!("{file}: {what}"));
    }
    faults
}

/// Whether a table has a header, rows, the same number of cells in each, and numbers but for the first cell.
fn table(text: &str) -> Result<(), String> {
    let mut lines = text.lines();
    let n_columns = lines.next().map_or(0, |header| header.split(',').count());
    let mut n_rows = 0;
    for (row, line) in lines.enumerate() {
        let cells: Vec<&str> = line.split(',').collect();
        if cells.len() != n_columns {
            return Err(format!("row {row} has {} cells of {n_columns}", cells.len()));
        }
        let is_number = |cell: &&str| cell.parse::<f64>().is_ok_and(f64::is_finite);
        if let Some(cell) = cells[1..].iter().find(|cell| !is_number(cell)) {
            return Err(format!("row {row}: {cell:?} is no number"));
        }
        n_rows += 1;
    }
    if n_rows == 0 { Err("no rows".to_owned()) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_that_is_kept_is_whole() {
        if let Err(failure) = run(&crate::workspace().join("docs/gallery")) {
            panic!("{failure}; `cargo xtask gallery` makes it anew");
        }
    }

    #[test]
    fn faults_are_found() {
        let page = format!(
            "# T\n[list](#a) [web](https://x.y/z)\n## A\n<img src=\"a.png\">\n- {HOLDS} x\n## B\n[b.csv](b.csv)\n"
        );
        let there = ["b.csv".to_owned(), "c.png".to_owned()];
        let got = of_page(&page, &there);
        let expected = [
            "the page names a.png, which is not there",
            "c.png is not on the page",
            &format!("the page has 2 figures, expected {COUNT}"),
            "B has no statement",
        ];
        assert_eq!(got.iter().collect::<Vec<_>>(), expected.map(|x| x.to_owned()).iter().collect::<Vec<_>>());
        assert_eq!(table("r,n\n1,2\nall,3.5\n"), Ok(()));
        for broken in ["", "r,n\n", "r,n\n1\n", "r,n\n1,two\n", "r,n\n1,NaN\n"] {
            assert!(table(broken).is_err(), "{broken:?}");
        }
        assert!(!of_file("a.png", &vec![0; 60_001]).is_empty());
    }
}

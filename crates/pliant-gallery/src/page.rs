//! The page: figures with their claims, pictures and checked statements, in Markdown that forges show.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use image::RgbaImage;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use pliant::viewport::Headless;

use crate::chart::Chart;
use crate::failure::Failure;
use crate::shots::Shot;

/// How a statement that holds begins, and one that does not.
pub(crate) const HOLDS: &str = "**Holds.**";
pub(crate) const FAILS: &str = "**Does not hold here.**";
/// Widest row of pictures on the page, in pixels: fits the column in which forges show a page.
const PAGE_WIDTH: usize = 840;
/// Up to so many pictures stand in one row; more are set in rows of the usual length, large enough to see something.
const MOST_IN_A_ROW: usize = 4;
const IN_A_ROW: usize = 3;

/// The folder that is filled.
pub(crate) struct Folder {
    path: PathBuf,
    headless: Headless,
    /// Files written so far.
    written: Vec<String>,
}

impl Folder {
    pub(crate) fn new(path: PathBuf) -> Result<Folder, Failure> {
        fs::create_dir_all(&path).map_err(|source| Failure::File { path: path.clone(), source })?;
        Ok(Folder { path, headless: Headless::new()?, written: Vec::new() })
    }

    /// Draws and keeps a picture under this name.
    pub(crate) fn picture(&mut self, name: &str, shot: &Shot<'_>) -> Result<String, Failure> {
        let picture = shot.draw(&self.headless)?;
        let file = format!("{name}.png");
        let bytes = encode(&picture).map_err(|source| Failure::Picture { file: file.clone(), source })?;
        self.write(file, bytes)
    }

    pub(crate) fn chart(&mut self, name: &str, chart: &Chart) -> Result<String, Failure> {
        self.write(format!("{name}.svg"), chart.to_svg().into_bytes())
    }

    /// Rows of numbers under a header.
    pub(crate) fn csv(&mut self, name: &str, header: &[&str], rows: &[Vec<String>]) -> Result<String, Failure> {
        let lines: Vec<String> = rows.iter().map(|row| row.join(",")).collect();
        self.write(format!("{name}.csv"), format!("{}\n{}\n", header.join(","), lines.join("\n")).into_bytes())
    }

    pub(crate) fn write(&mut self, file: String, bytes: Vec<u8>) -> Result<String, Failure> {
        let path = self.path.join(&file);
        fs::write(&path, bytes).map_err(|source| Failure::File { path, source })?;
        self.written.push(file.clone());
        Ok(file)
    }

    /// Removes figures of earlier runs that this one did not write.
    pub(crate) fn remove_stale(&self) -> Result<(), Failure> {
        for file in crate::checking::files(&self.path)? {
            if !self.written.contains(&file) {
                let path = self.path.join(&file);
                fs::remove_file(&path).map_err(|source| Failure::File { path, source })?;
            }
        }
        Ok(())
    }
}

/// An opaque picture, as small as the encoder makes it.
fn encode(picture: &RgbaImage) -> Result<Vec<u8>, image::ImageError> {
    let mut bytes = Vec::new();
    let opaque = image::DynamicImage::ImageRgba8(picture.clone()).to_rgb8();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    opaque.write_with_encoder(encoder)?;
    Ok(bytes)
}

/// A picture of a figure with what is written under it.
#[derive(Clone)]
pub(crate) struct Panel {
    pub(crate) file: String,
    pub(crate) caption: String,
}

impl Panel {
    pub(crate) fn new(file: String, caption: impl Into<String>) -> Panel {
        Panel { file, caption: caption.into() }
    }
}

/// A statement by numbers of this run.
pub(crate) struct Check {
    pub(crate) claim: String,
    pub(crate) holds: bool,
    pub(crate) found: String,
}

impl Check {
    pub(crate) fn new(claim: impl Into<String>, holds: bool, found: impl Into<String>) -> Check {
        Check { claim: claim.into(), holds, found: found.into() }
    }

    pub(crate) fn line(&self) -> String {
        let Check { claim, holds, found } = self;
        format!("{} {claim}: {found}.", if *holds { HOLDS } else { FAILS })
    }
}

/// A figure of the paper.
pub(crate) struct Figure {
    /// As the paper counts, for instance `Figure 3`.
    pub(crate) number: &'static str,
    pub(crate) title: &'static str,
    /// What the paper claims.
    pub(crate) claim: &'static str,
    /// What was done here.
    pub(crate) setup: String,
    pub(crate) rows: Vec<Vec<Panel>>,
    /// In Markdown; empty for none.
    pub(crate) table: String,
    pub(crate) checks: Vec<Check>,
    pub(crate) data: Vec<String>,
}

impl Figure {
    fn to_markdown(&self) -> String {
        let Figure { number, title, claim, setup, rows, table, checks, data } = self;
        let mut text = format!("## {number}: {title}\n\n*The paper:* {claim}\n\n*Here:* {setup}\n\n");
        let in_a_row = |row: &[Panel]| if row.len() > MOST_IN_A_ROW { IN_A_ROW } else { MOST_IN_A_ROW };
        rows.iter().flat_map(|row| row.chunks(in_a_row(row))).for_each(|row| text.push_str(&row_of(row)));
        text.push_str(table);
        for check in checks {
            // A string takes whatever is written to it.
            let _ = writeln!(text, "- {}", check.line());
        }
        if !data.is_empty() {
            let links: Vec<String> = data.iter().map(|file| format!("[{file}]({file})")).collect();
            let _ = write!(text, "\nNumbers: {}\n", links.join(", "));
        }
        text.push('\n');
        text
    }
}

/// Pictures side by side, their captions under them.
fn row_of(row: &[Panel]) -> String {
    let width = PAGE_WIDTH / IN_A_ROW.max(row.len()) - 12;
    let mut text = String::from("<table><tr>\n");
    for Panel { file, caption } in row {
        let size = if file.ends_with(".svg") { String::new() } else { format!(" width=\"{width}\"") };
        let alt = caption.replace("<br>", ", ").replace("<i>", "").replace("</i>", "");
        let _ = writeln!(text, "<td align=\"center\"><img src=\"{file}\"{size} alt=\"{alt}\"><br>{caption}</td>");
    }
    text.push_str("</tr></table>\n\n");
    text
}

/// The whole page.
pub(crate) fn page(figures: &[Figure], foot: &str) -> String {
    let n_checks: usize = figures.iter().map(|figure| figure.checks.len()).sum();
    let failing: Vec<String> = figures.iter().flat_map(failures).collect();
    let verdict = match failing.len() {
        0 => format!("All {n_checks} statements hold."),
        n => format!("Of {n_checks} statements {n} do not hold here:\n\n{}", failing.join("\n")),
    };
    let list: Vec<String> = figures.iter().map(|f| format!("[{}](#{})", f.number, anchor(f))).collect();
    let body: String = figures.iter().map(Figure::to_markdown).collect();
    format!(
        "# The paper's figures, redrawn\n\n{INTRODUCTION}\n\n{verdict}\n\n{}\n\n{body}---\n\n{foot}\n",
        list.join(" · ")
    )
}

/// The statements of a figure that do not hold, as lines of a list.
fn failures(figure: &Figure) -> Vec<String> {
    let line = |check: &Check| format!("- [{}](#{}): {}", figure.number, anchor(figure), check.claim);
    figure.checks.iter().filter(|check| !check.holds).map(line).collect()
}

/// A count with separated thousands.
pub(crate) fn count(n: usize) -> String {
    let plain = n.to_string();
    let mut text = String::new();
    for (place, digit) in plain.chars().enumerate() {
        if place > 0 && (plain.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// What comes before the figures.
const INTRODUCTION: &str = "\
Chen, Gao, Lai and Xia, *Rigidity controllable as-rigid-as-possible shape deformation* (Graphical Models 91, 2017), shows \
what the size r of the neighborhoods does to a surface. Here its experiments are made again, on shapes that come with \
Pliant. Under every figure stand the paper's claim in our words, and statements that were *computed* when this page was \
made: numbers against a criterion, not an impression of the pictures. Where a claim could not be reproduced, it says so.\n\n\
Yellow dots are handles. Unless it says otherwise, every method begins at rest with all rotations the identity, as in the \
paper, and goes on until its energy has settled. *Crossings* are pairs of triangles without a common corner that pierce each \
other. *Stretch* is the mean change of the length of edges, *bending* the mean change of the angle between neighboring faces.";

/// The name that forges give a heading.
fn anchor(figure: &Figure) -> String {
    let heading = format!("{}: {}", figure.number, figure.title).to_lowercase();
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || *c == ' ' || *c == '-');
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

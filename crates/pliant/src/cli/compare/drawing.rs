//! The pictures of a comparison, as PNG.

use glam::DVec3;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use pliant_solver::VertexId;

use super::bench::{Bench, Outcome, is_painted};
use crate::cli::console::Console;
use crate::cli::failure::Failure;
use crate::comparing::{Marks, PICTURE_PX};
use crate::viewport::{Dot, Headless, Line, Pictures as Painter, ViewScene};

/// Lines from where handles were to where they are at most (by eye).
const MOST_LINES: usize = 24;

/// Held vertices that stay where they were, sRGB: the blue of the rigidity ramp.
pub(super) const ANCHOR: [u8; 3] = [70, 120, 214];
/// Held vertices that move, sRGB.
pub(super) const MOVED: [u8; 3] = [226, 106, 40];
/// All others, sRGB: the clay of the renderer before a light ground.
const CLAY: [u8; 3] = [190, 192, 196];

/// End of the rigidity ramp unless an entry is stiffer, as in `pliant render`.
const RAMP_MAX: u16 = 6;

/// The part of the vertices whose energies the common scale covers: a few spikes would leave all the rest dark.
const COVERED: f64 = 0.99;

/// All of them; a PNG each.
pub(super) struct Pictures {
    /// The rest shape with its handles.
    pub(super) rest: Vec<u8>,
    /// By entry.
    pub(super) entries: Vec<EntryPictures>,
    /// The energy of a vertex that has the last color.
    pub(super) energy_end: f64,
    /// r that has the last color.
    pub(super) ramp_max: u16,
}

/// Pictures of one entry.
#[derive(Default)]
pub(super) struct EntryPictures {
    /// Its rigidity on the rest shape, where it is not the same everywhere.
    pub(super) painted: Option<Vec<u8>>,
    /// The bent surface, and the same colored by energy.
    pub(super) bent: Option<[Vec<u8>; 2]>,
}

pub(super) fn draw(
    headless: &Headless,
    bench: &Bench,
    results: &[Outcome],
    console: &mut Console<'_>,
) -> Result<Pictures, Failure> {
    let r_max = bench.rigidity.iter().map(|chosen| chosen.rigidity.max()).max().unwrap_or(RAMP_MAX);
    let ramp_max = r_max.max(RAMP_MAX);
    let energy_end = results.iter().flatten().map(|bent| covered(&bent.strain)).fold(0.0, f32::max);
    let targets = bench.marks_of_targets();
    let (mut drawn, mut painter) = (0, Painter::new(headless)?);
    let mut png = |scene: ViewScene| {
        drawn += 1;
        console.progress(|| format!("drawing picture {drawn}"));
        png(&mut painter, &scene)
    };
    let rest = png(bench.stage.shape(&bench.rest, &bench.marks_of_rest(), &[]))?;
    let mut entries = Vec::with_capacity(results.len());
    for (chosen, outcome) in bench.rigidity.iter().zip(results) {
        let mut pictures = EntryPictures::default();
        if is_painted(&chosen.rigidity) {
            pictures.painted = Some(png(bench.stage.rigidity(&bench.rest, chosen.rigidity.as_slice(), ramp_max))?);
        }
        if let Ok(bent) = outcome {
            // Energies are squares: their roots go like what is seen.
            let scaled =
                |&energy: &f32| if energy_end > 0.0 { (energy / energy_end).clamp(0.0, 1.0).sqrt() } else { 0.0 };
            let values = bent.strain.iter().map(scaled).collect();
            let shape = png(bench.stage.shape(&bent.placed, &targets, &bent.flaws))?;
            pictures.bent = Some([shape, png(bench.stage.energies(&bent.placed, values))?]);
        }
        entries.push(pictures);
    }
    Ok(Pictures { rest, entries, energy_end: energy_end.into(), ramp_max })
}

fn png(painter: &mut Painter<'_>, scene: &ViewScene) -> Result<Vec<u8>, Failure> {
    let pixels = painter.draw(scene, PICTURE_PX)?;
    let drawn = pixels.dimensions().into();
    if drawn != PICTURE_PX {
        return Err(Failure::PictureSize { asked: PICTURE_PX, drawn });
    }
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive);
    // Opaque: a quarter less to be stored.
    image::DynamicImage::from(pixels).to_rgb8().write_with_encoder(encoder)?;
    Ok(bytes)
}

/// The value that nearly all others do not exceed; 0 for none.
fn covered(values: &[f32]) -> f32 {
    let mut values = values.to_vec();
    let Some(last) = values.len().checked_sub(1) else { return 0.0 };
    let rank = ((values.len() as f64 * COVERED) as usize).min(last);
    *values.select_nth_unstable_by(rank, f32::total_cmp).1
}

impl Bench {
    /// Held vertices with their targets, those that move.
    pub(super) fn moved(&self) -> impl Iterator<Item = (VertexId, DVec3)> {
        self.held().filter(|held| !self.stays(held))
    }

    fn stays(&self, &(vertex, target): &(VertexId, DVec3)) -> bool {
        self.stage.is_same(self.mesh.positions()[vertex.index()], target)
    }

    fn held(&self) -> impl Iterator<Item = (VertexId, DVec3)> {
        self.handles.held.iter().copied().zip(self.handles.targets.iter().copied())
    }

    /// Anchors where they are, handles with their ways.
    fn marks_of_rest(&self) -> Marks {
        let moved: Vec<_> = self.moved().collect();
        let lines = moved.iter().step_by(moved.len().div_ceil(MOST_LINES).max(1)).map(|&(vertex, target)| Line {
            a: self.rest[vertex.index()],
            b: self.stage.point(target),
            color: opaque(MOVED),
            width_px: 1.0,
            on_top: true,
        });
        Marks { lines: lines.collect(), ..self.marks_of_targets() }
    }

    /// What is held, in its color, and dots where it should be.
    fn marks_of_targets(&self) -> Marks {
        let dot = |color: [u8; 3]| {
            move |(_, target): (VertexId, DVec3)| Dot {
                position: self.stage.point(target),
                color: opaque(color),
                radius_px: 2.0,
            }
        };
        let staying = self.held().filter(|held| self.stays(held)).map(dot(ANCHOR));
        Marks {
            colors: Some(self.colors().into()),
            dots: self.stage.apart(self.moved().map(dot(MOVED)).chain(staying)),
            lines: Vec::new(),
        }
    }

    fn colors(&self) -> Vec<[u8; 4]> {
        let mut colors = vec![linear(CLAY); self.mesh.n_vertices()];
        for held in self.held() {
            colors[held.0.index()] = linear(if self.stays(&held) { ANCHOR } else { MOVED });
        }
        colors
    }
}

fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 255]
}

/// Linear light of an sRGB color, by the power law that is near enough for colors that only tell things apart.
fn linear(srgb: [u8; 3]) -> [u8; 4] {
    opaque(srgb.map(|byte| (255.0 * (f32::from(byte) / 255.0).powf(2.2)).round() as u8))
}

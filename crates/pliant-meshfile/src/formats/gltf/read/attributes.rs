//! What vertices carry besides their positions: r, and what is for display.

use super::Reader;
use crate::{Fault, rigidity};
use glam::Vec2;
use std::ops::Range;

impl Reader<'_> {
    /// Reads an attribute for a block, unless one of the primitives before gave it.
    pub(super) fn attribute_of(&mut self, block: usize, accessor: Option<usize>, what: Attribute) -> Result<(), Fault> {
        let Some(accessor) = accessor.filter(|_| !self.given.contains(&(block, what))) else { return Ok(()) };
        let checked = self.accessor(accessor)?;
        let vertices = self.blocks[block].vertices.clone();
        let place = || format!("accessor {accessor}");
        if checked.count != vertices.len() {
            let problem = format!("{} of {} vertices, positions of {}", what.words(), checked.count, vertices.len());
            return Err(Fault::at(place(), problem));
        }
        let width = checked.width;
        if !what.widths().contains(&width) {
            return Err(Fault::at(place(), format!("{width} numbers each are no {}", what.words())));
        }
        let numbers = self.numbers(&checked)?;
        let elements = numbers.chunks_exact(width);
        match what {
            Attribute::Rigidity => self.rigidity(vertices, &numbers, accessor)?,
            // glTF has the origin at the upper left.
            Attribute::Uv => {
                let uv = elements.map(|e| Vec2::new(finite(e[0], 0.0), 1.0 - finite(e[1], 1.0)));
                room(&mut self.uvs, vertices, Vec2::ZERO).iter_mut().zip(uv).for_each(|(slot, uv)| *slot = uv);
            }
            Attribute::Color => {
                let color = elements.map(|c| [c[0], c[1], c[2], c.get(3).copied().unwrap_or(1.0)]);
                let color = color.map(|c| c.map(|x| finite(x, 1.0)));
                room(&mut self.colors, vertices, [1.0; 4]).iter_mut().zip(color).for_each(|(slot, c)| *slot = c);
            }
        }
        self.given.insert((block, what));
        Ok(())
    }

    fn rigidity(&mut self, vertices: Range<usize>, numbers: &[f64], accessor: usize) -> Result<(), Fault> {
        for ((i, slot), &r) in room(&mut self.rigidity, vertices, 1).iter_mut().enumerate().zip(numbers) {
            if !(1.0..=f64::from(rigidity::MAX)).contains(&r) || r.fract() != 0.0 {
                let problem = format!("_RIGIDITY is {r}: a rigidity is a whole number from 1 to {}", rigidity::MAX);
                return Err(Fault::at(format!("accessor {accessor}, vertex {i}"), problem));
            }
            *slot = r as u16;
        }
        Ok(())
    }
}

/// Attributes of which a model has one per file vertex, whatever primitives share it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Attribute {
    Rigidity,
    Uv,
    Color,
}

impl Attribute {
    pub(super) fn words(self) -> &'static str {
        match self {
            Attribute::Rigidity => "rigidities",
            Attribute::Uv => "texture coordinates",
            Attribute::Color => "colors",
        }
    }

    /// How many numbers an element may have.
    fn widths(self) -> &'static [usize] {
        match self {
            Attribute::Rigidity => &[1],
            Attribute::Uv => &[2],
            Attribute::Color => &[3, 4],
        }
    }
}

/// The places of some vertices in a list that grows to hold them; vertices that nothing is given for keep `rest`.
fn room<T: Copy>(list: &mut Vec<T>, vertices: Range<usize>, rest: T) -> &mut [T] {
    if list.len() < vertices.end {
        list.resize(vertices.end, rest);
    }
    &mut list[vertices]
}

/// A number for display, `rest` where it is none that single precision holds.
pub(in super::super) fn finite(number: f64, rest: f32) -> f32 {
    let number = number as f32;
    if number.is_finite() { number } else { rest }
}

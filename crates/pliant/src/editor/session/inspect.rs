//! What is known of the vertices that the inspect tool points at.

use glam::DVec3;
use pliant_solver::VertexId;

use super::Session;
use crate::document::part_of_triangle;
use crate::editor::Along;
use crate::solving::SolveState;
use crate::tools::{Card, ToolKind};

/// What can be told of a vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// Which, in the numbering of the surface.
    pub vertex: VertexId,
    /// Its (first) number in the file, where that is another.
    pub in_file: Option<u32>,
    /// Where it is, world units.
    pub position: DVec3,
    /// How far it is from its place at rest.
    pub moved: f64,
    /// r.
    pub rigidity: u16,
    /// Its energy, and what part of the whole that is.
    pub energy: Option<(f64, f64)>,
    /// Length of the edges around in lengths at rest: the smallest and the largest.
    pub stretch: Option<(f64, f64)>,
    /// Part of the file, where there are several.
    pub part: Option<String>,
    /// The handle or anchor that holds it.
    pub held_by: Option<String>,
    /// From the vertex that is pinned: straight, and along the surface once that is asked for.
    pub way: Option<(f64, Option<Along>)>,
}

impl Session {
    /// Whether the solver should tell the energy of every vertex.
    pub(super) fn wants_energies(&self) -> bool {
        self.tool_kind == ToolKind::Inspect
    }

    /// Has the way along the surface measured, if the tool wants to know.
    pub(super) fn measure(&mut self) {
        let wanted = if self.tool_kind == ToolKind::Inspect { self.marks().measured } else { None };
        let is_iterating = self.status.report.as_ref().is_some_and(|report| report.state == SolveState::Iterating);
        match (wanted, &self.open) {
            (Some(ends), Some(open)) => self.measuring.ask(ends, &open.surface, !is_iterating),
            _ => self.measuring.forget(),
        }
    }

    /// The vertices that the inspect tool tells about: where their cards belong, and what is written there.
    pub fn inspections(&mut self) -> Vec<(Card, Inspection)> {
        if self.tool_kind != ToolKind::Inspect {
            return Vec::new();
        }
        let cards = self.marks().cards;
        let first = cards.first().copied();
        let tell = |card: Card| {
            let from = first.filter(|first| first.vertex != card.vertex).map(|first| first.vertex);
            self.inspect(card, from).map(|inspection| (card, inspection))
        };
        cards.iter().copied().filter_map(tell).collect()
    }

    fn inspect(&self, card: Card, from: Option<VertexId>) -> Option<Inspection> {
        let document = self.document()?;
        let (model, scene, v) = (document.model(), document.scene(), card.vertex);
        let (now, rest) = (&document.pose().positions, model.mesh.positions());
        let position = *now.get(v.index())?;
        let report = self.status.report.as_ref();
        let energy = report.and_then(|report| {
            let energy = *report.vertex_energies.as_ref()?.get(v.index())?;
            Some((energy, if report.energy > 0.0 { energy / report.energy } else { 0.0 }))
        });
        let ratio = |&w: &u32| {
            let at_rest = rest[v.index()].distance(rest[w as usize]);
            (at_rest > 0.0).then(|| position.distance(now[w as usize]) / at_rest)
        };
        let ratios = model.mesh.neighbors(v).iter().filter_map(ratio).map(|ratio| (ratio, ratio));
        let in_file = *model.file.weld.vertex_of_point.get(v.index())?;
        let part = part_of_triangle(model, card.triangle as usize).filter(|_| model.file.parts.len() > 1);
        Some(Inspection {
            vertex: v,
            in_file: (in_file != v.0).then_some(in_file),
            position,
            moved: position.distance(rest[v.index()]),
            rigidity: scene.rigidity.as_slice()[v.index()],
            energy,
            stretch: ratios.reduce(|(lo, hi), (ratio, _)| (lo.min(ratio), hi.max(ratio))),
            part: part.map(|part| part.name.clone()),
            held_by: scene.group_holding(v).map(|group| group.name.clone()),
            way: from.map(|from| (position.distance(now[from.index()]), self.measuring.answer([from, v]))),
        })
    }
}

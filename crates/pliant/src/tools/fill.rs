//! The flood fill tool: a click fills a region, a drag spreads a fill from a point.

use std::sync::Arc;

use glam::Vec2;
use pliant_geometry::FacePatches;
use pliant_solver::{Rigidity, VertexId};

use super::grow::Grow;
use super::{Context, Cursor, FillBoundary, Input, Marks, Mirror, Pick, Pointer, Reaction, Tool, ToolKey};
use crate::document::{
    Command, Selection, region_by_selection, region_of_equal_rigidity, region_of_faces, region_of_part, region_of_piece,
};
use crate::viewport::Preview;

/// A press that moves less than this many points is a click (by eye).
const CLICK_PX: f32 = 5.0;

/// Fills regions with r.
#[derive(Default)]
pub(super) struct FillTool {
    hover: Option<Pick>,
    region: Option<Region>,
    state: State,
}

#[derive(Default)]
enum State {
    #[default]
    Idle,
    /// Pressed, and not moved yet.
    Pressed(Pick, Vec2),
    /// Spreading from where it was pressed.
    Growing(Box<Grow>),
}

/// What a click would fill, kept while the pointer stays in it.
struct Region {
    of: Sources,
    /// The triangle it was asked for.
    triangle: u32,
    /// One flag a vertex: reached from the pointer.
    own: Vec<bool>,
    /// What is filled: reached, or the image of what is reached, and not locked.
    vertices: Vec<VertexId>,
    flags: Arc<[bool]>,
}

/// All that a region depends on, besides the mesh.
#[derive(Clone)]
struct Sources {
    boundary: FillBoundary,
    rigidity: Rigidity,
    selection: Selection,
    locked: Selection,
    mirror: Option<Arc<Mirror>>,
    patches: Option<Arc<FacePatches>>,
}

impl Sources {
    fn of(context: &Context<'_>) -> Sources {
        let scene = context.document.scene();
        Sources {
            boundary: context.options.paint.boundary,
            rigidity: scene.rigidity.clone(),
            selection: scene.selection.clone(),
            locked: scene.locked.clone(),
            mirror: context.prepared.mirror.clone(),
            patches: context.prepared.patches.clone(),
        }
    }

    /// Compared by allocation where there is one: this is asked with every move of the pointer.
    fn is(&self, other: &Sources) -> bool {
        let same_set = |a: &Selection, b: &Selection| std::ptr::eq(a.vertices(), b.vertices());
        self.boundary == other.boundary
            && std::ptr::eq(self.rigidity.as_slice(), other.rigidity.as_slice())
            && same_set(&self.selection, &other.selection)
            && same_set(&self.locked, &other.locked)
            && self.mirror.as_ref().map(Arc::as_ptr) == other.mirror.as_ref().map(Arc::as_ptr)
            && self.patches.as_ref().map(Arc::as_ptr) == other.patches.as_ref().map(Arc::as_ptr)
    }
}

impl Region {
    fn at(pick: &Pick, context: &Context<'_>) -> Region {
        let of = Sources::of(context);
        let mut vertices = reached(pick, context).vertices().to_vec();
        let n = context.surface.frame().positions.len();
        let mut own = vec![false; n];
        vertices.iter().for_each(|v| own[v.index()] = true);
        if let Some(mirror) = &of.mirror {
            mirror.add_images(&mut vertices);
        }
        if !of.locked.is_empty() {
            vertices.retain(|&v| !of.locked.contains(v));
        }
        let mut flags = vec![false; n];
        vertices.iter().for_each(|v| flags[v.index()] = true);
        Region { of, triangle: pick.triangle, own, vertices, flags: flags.into() }
    }

    /// Whether a click there would fill the same, as far as can be told without looking for it anew.
    fn holds(&self, pick: &Pick, context: &Context<'_>) -> bool {
        let is_same_place = self.triangle == pick.triangle
            || match self.of.boundary {
                // Corners of a patch belong to its neighbors, too.
                FillBoundary::SharpEdges => self.of.patches.as_ref().is_some_and(|patches| {
                    patches.of_face().get(self.triangle as usize) == patches.of_face().get(pick.triangle as usize)
                }),
                FillBoundary::Part => same_part(context, self.triangle, pick.triangle),
                FillBoundary::Rigidity | FillBoundary::Selection | FillBoundary::Piece => true,
            };
        is_same_place && self.own.get(pick.vertex.index()) == Some(&true) && self.of.is(&Sources::of(context))
    }
}

fn same_part(context: &Context<'_>, a: u32, b: u32) -> bool {
    let parts = &context.document.model().file.parts;
    parts.iter().any(|part| part.triangles.contains(&(a as usize)) && part.triangles.contains(&(b as usize)))
}

/// Vertices that a click on a picked point reaches.
fn reached(pick: &Pick, context: &Context<'_>) -> Selection {
    let (scene, model) = (context.document.scene(), context.document.model());
    let mesh = &model.mesh;
    match context.options.paint.boundary {
        FillBoundary::Rigidity if scene.selection.contains(pick.vertex) => scene.selection.clone(),
        FillBoundary::Rigidity => region_of_equal_rigidity(mesh, &scene.rigidity, pick.vertex),
        FillBoundary::Selection => region_by_selection(mesh, &scene.selection, pick.vertex),
        FillBoundary::SharpEdges => match &context.prepared.patches {
            Some(patches) => region_of_faces(mesh, patches.of_face(), pick.triangle),
            None => Selection::default(),
        },
        FillBoundary::Piece => region_of_piece(mesh, pick.vertex),
        FillBoundary::Part => region_of_part(model, pick.triangle),
    }
}

impl FillTool {
    fn look(&mut self, pointer: Pointer, context: &mut Context<'_>) {
        self.hover = context.surface.pick(pointer.px, &context.view);
        self.find_region(context);
    }

    fn find_region(&mut self, context: &Context<'_>) {
        let Some(pick) = self.hover else { return };
        if !self.region.as_ref().is_some_and(|region| region.holds(&pick, context)) {
            self.region = Some(Region::at(&pick, context));
        }
    }

    fn drag(&mut self, pointer: Pointer, is_last: bool, context: &mut Context<'_>) -> Vec<Command> {
        let mut commands = Vec::new();
        if let State::Pressed(pick, from_px) = self.state
            && pointer.px.distance(from_px) >= CLICK_PX
            && let Some(grow) = Grow::new(&pick, from_px, context)
        {
            self.state = State::Growing(Box::new(grow));
            commands.push(Command::Begin("Fill rigidity"));
        }
        if let State::Growing(grow) = &mut self.state {
            let values = grow.follow(pointer.px, is_last, context);
            if !values.is_empty() {
                commands.push(Command::Paint { values });
            }
        }
        commands
    }

    fn release(&mut self, pointer: Pointer, context: &mut Context<'_>) -> Reaction {
        let mut commands = self.drag(pointer, true, context);
        match std::mem::take(&mut self.state) {
            State::Idle => {}
            State::Growing(_) => commands.push(Command::Commit),
            State::Pressed(pick, _) => {
                self.hover = Some(pick);
                self.find_region(context);
                if let Some(region) = &self.region {
                    let vertices = region.vertices.clone();
                    commands.push(Command::Fill { vertices, r: context.options.rigidity });
                }
            }
        }
        commands.into()
    }
}

impl Tool for FillTool {
    fn handle(&mut self, input: Input, context: &mut Context<'_>) -> Reaction {
        match input {
            Input::Hover(pointer) => self.look(pointer, context),
            Input::Leave => self.hover = None,
            Input::Press(pointer) if matches!(self.state, State::Idle) => {
                self.look(pointer, context);
                if let Some(pick) = self.hover {
                    self.state = State::Pressed(pick, pointer.px);
                }
            }
            Input::Drag(pointer) => return self.drag(pointer, false, context).into(),
            Input::Release(pointer) => return self.release(pointer, context),
            Input::Key(ToolKey::Escape) => {
                return match std::mem::take(&mut self.state) {
                    State::Growing(_) => vec![Command::Cancel].into(),
                    State::Idle | State::Pressed(..) => Reaction::default(),
                };
            }
            Input::Key(ToolKey::Eyedropper) => {
                let r = self.hover.map(|pick| context.document.scene().rigidity.as_slice()[pick.vertex.index()]);
                return Reaction { rigidity: r, ..Reaction::default() };
            }
            Input::Press(_) | Input::DoubleClick(_) | Input::Key(_) => {}
        }
        Reaction::default()
    }

    fn hint(&self, context: &Context<'_>) -> String {
        let r = context.options.rigidity;
        let waits = context.options.paint.boundary == FillBoundary::SharpEdges && context.prepared.patches.is_none();
        match (&self.state, self.hover) {
            (State::Growing(grow), _) => format!(
                "Rigidity {} within {} along the surface, {} vertices · Esc takes it back",
                grow.r(),
                length(grow.radius()),
                grow.n_filled()
            ),
            (State::Pressed(..), _) => "Release to fill the region, drag to spread from here · Esc cancels".into(),
            (State::Idle, Some(_)) if waits => "Looking for sharp edges… · drag spreads from here".into(),
            (State::Idle, Some(pick)) => {
                let n = self.region.as_ref().map_or(0, |region| region.vertices.len());
                let here = context.document.scene().rigidity.as_slice()[pick.vertex.index()];
                format!(
                    "Click gives {n} vertices rigidity {r} · drag spreads it from here · number keys choose · I takes {here}"
                )
            }
            (State::Idle, None) => {
                format!("Click the surface to fill a region with rigidity {r}, or drag to spread it")
            }
        }
    }

    fn marks(&self, context: &Context<'_>) -> Marks {
        match (&self.state, &self.region, self.hover) {
            (State::Growing(grow), ..) => Marks { lines: grow.line(context), ..Marks::default() },
            (_, Some(region), Some(_)) if !region.vertices.is_empty() && region.of.is(&Sources::of(context)) => {
                let preview = Preview { vertices: region.flags.clone(), r: context.options.rigidity };
                let mirror = context.prepared.mirror.as_ref();
                let dots = mirror.map_or_else(Vec::new, |mirror| mirror.dots(context));
                Marks { preview: Some(preview), dots, ..Marks::default() }
            }
            _ => Marks::default(),
        }
    }

    fn cursor(&self) -> Cursor {
        Cursor::Cross
    }

    fn is_active(&self) -> bool {
        !matches!(self.state, State::Idle)
    }

    fn is_over_surface(&self) -> bool {
        self.hover.is_some()
    }

    fn is_behind(&self) -> bool {
        matches!(&self.state, State::Growing(grow) if grow.is_behind())
    }
}

/// A length in model units, with three digits that matter.
fn length(length: f32) -> String {
    if length == 0.0 || !length.is_finite() {
        return "0".into();
    }
    let digits = 2 - length.log10().floor() as i32;
    match digits {
        0..=6 => format!("{length:.*}", digits as usize),
        _ if digits < 0 && digits > -5 => format!("{length:.0}"),
        _ => format!("{length:.2e}"),
    }
}

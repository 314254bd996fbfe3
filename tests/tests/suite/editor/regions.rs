//! Fills by region and by drag, locks and mirrored painting.

use pliant::document::{
    region_by_selection, region_of_equal_rigidity, region_of_faces, region_of_part, region_of_piece,
};
use pliant::tools::{BrushReach, BrushUnit, FillBoundary, MirrorKind};
use pliant_meshfile::Part;
use pliant_solver::{Mesh, Rigidity};

use super::*;

/// Two sheets of 20 cells side by side in one file, as three parts: the first sheet, and the second in two.
fn two_sheets() -> MeshFile {
    let one = sheet(20);
    let (n, faces) = (one.positions.len() as u32, one.triangles.len());
    let beside = one.positions.iter().map(|p| *p + DVec3::new(1.1, 0.0, 0.0));
    let positions = one.positions.iter().copied().chain(beside).collect();
    let triangles = one.triangles.iter().copied().chain(one.triangles.iter().map(|t| t.map(|v| v + n))).collect();
    let mut file = MeshFile::from_triangles("sheets", positions, triangles);
    let part = |name: &str, triangles| Part { name: name.into(), triangles, base_color: [0.8; 4] };
    file.parts = vec![
        part("left", 0..faces),
        part("right, near", faces..faces + 240),
        part("right, far", faces + 240..2 * faces),
    ];
    file
}

/// The vertices for which there is a way from `seed` on which each step is allowed, found by trying all edges until
/// nothing is added.
fn by_brute_force(mesh: &Mesh, seed: u32, allowed: impl Fn(u32, u32) -> bool) -> Vec<VertexId> {
    let mut reached = vec![false; mesh.n_vertices()];
    reached[seed as usize] = true;
    loop {
        let mut added = false;
        for &[a, b] in mesh.edges() {
            for (from, to) in [(a, b), (b, a)] {
                if reached[from as usize] && !reached[to as usize] && allowed(from, to) {
                    reached[to as usize] = true;
                    added = true;
                }
            }
        }
        if !added {
            return (0..).zip(reached).filter(|&(_, reached)| reached).map(|(v, _)| VertexId(v)).collect();
        }
    }
}

#[test]
fn regions_are_those_of_a_search_that_tries_every_edge() {
    let model = Model::from_file(two_sheets()).expect("a good mesh");
    let mesh = &model.mesh;
    let n = mesh.n_vertices() as u32;
    // Patches of three values of r, and a selection with holes.
    let r: Vec<u16> = (0..n).map(|v| 1 + ((v / 63) % 2 + (v % 21) / 8) as u16).collect();
    let selection =
        pliant::document::Selection::new((0..n).filter(|v| v % 7 > 2 || v % 21 < 9).map(VertexId).collect());
    let rigidity = Rigidity::new(r.clone()).expect("in range");
    for seed in [0, 77, 200, 440, 441, 700, n - 1] {
        let expected = by_brute_force(mesh, seed, |_, to| r[to as usize] == r[seed as usize]);
        assert_eq!(region_of_equal_rigidity(mesh, &rigidity, VertexId(seed)).vertices(), expected, "r around {seed}");
        let is_in = |v: u32| selection.contains(VertexId(v));
        let expected = by_brute_force(mesh, seed, |_, to| is_in(to) == is_in(seed));
        assert_eq!(
            region_by_selection(mesh, &selection, VertexId(seed)).vertices(),
            expected,
            "the selection around {seed}"
        );
        let expected = by_brute_force(mesh, seed, |_, _| true);
        assert_eq!(region_of_piece(mesh, VertexId(seed)).vertices(), expected, "the piece of {seed}");
    }
    for face in [0, 799, 800, 1039, 1040, 1599] {
        let part = model.file.parts.iter().find(|part| part.triangles.contains(&face)).expect("a part");
        let mut expected: Vec<_> =
            mesh.triangles()[part.triangles.clone()].as_flattened().iter().map(|&v| VertexId(v)).collect();
        expected.sort_unstable();
        expected.dedup();
        assert_eq!(region_of_part(&model, face as u32).vertices(), expected, "the part of triangle {face}");
        let of_face: Vec<u32> = (0..1600).map(|f| u32::from(f >= 800) + u32::from(f >= 1040)).collect();
        assert_eq!(region_of_faces(mesh, &of_face, face as u32).vertices(), expected, "the patch of triangle {face}");
    }
}

fn with_r(session: &Session, r: u16) -> Vec<VertexId> {
    let all = document(session).scene().rigidity.as_slice();
    (0..).zip(all).filter(|&(_, &x)| x == r).map(|(v, _)| VertexId(v)).collect()
}

#[test]
fn a_click_fills_up_to_the_boundary_that_is_chosen() {
    let mut session = session_with(two_sheets());
    session.take_tool(ToolKind::Fill);
    let rows = |rows: std::ops::Range<u32>| (rows.start * 21..rows.end * 21).map(VertexId).collect::<Vec<_>>();
    for (boundary, r, expected) in [
        (FillBoundary::Piece, 2, rows(0..21)),
        (FillBoundary::Part, 3, rows(21..28)),
        (FillBoundary::Selection, 4, rows(0..5)),
    ] {
        session.apply(Command::Select(rows(0..5), SelectMode::Replace));
        session.options.paint.boundary = boundary;
        session.choose_rigidity(r);
        let v = if boundary == FillBoundary::Part { 441 + middle(3) } else { middle(3) };
        let at = on_screen(&session, v);
        session.input(Input::Hover(pointer(at)));
        let preview = session.marks().preview.expect("a preview of the fill");
        let shown: Vec<VertexId> =
            (0..).zip(preview.vertices.iter()).filter(|&(_, &shown)| shown).map(|(v, _)| VertexId(v)).collect();
        assert_eq!((shown, preview.r), (expected.clone(), r), "the preview of {boundary:?}");
        click(&mut session, at);
        assert_eq!(with_r(&session, r), expected, "{boundary:?}");
    }
}

/// A sheet of 20 × 20 cells that turns by a right angle after row 10.
fn corner() -> MeshFile {
    let flat = sheet(20);
    let bent = flat.positions.iter().map(|p| if p.y > 0.0 { DVec3::new(p.x, 0.0, -p.y) } else { *p }).collect();
    MeshFile::from_triangles("corner", bent, flat.triangles)
}

#[test]
fn sharp_edges_bound_a_fill_as_long_as_they_are_sharper_than_the_angle() {
    let mut session = session_with(corner());
    session.take_tool(ToolKind::Fill);
    session.options.paint.boundary = FillBoundary::SharpEdges;
    for (degrees, n_rows) in [(60.0, 11), (120.0, 21)] {
        session.options.paint.sharp_degrees = degrees;
        session.choose_rigidity(n_rows as u16);
        session.poll();
        wait_until(&mut session, "the sharp edges are found", |session| !session.is_preparing());
        session.poll();
        let at = on_screen(&session, middle(5));
        click(&mut session, at);
        assert_eq!(with_r(&session, n_rows as u16).len(), n_rows * 21, "sharp from {degrees}°");
    }
}

#[test]
fn a_drag_fills_by_distance_in_one_step_and_escape_restores() {
    let mut session = session_with(sheet(20));
    session.apply(Command::Fill { vertices: (0..100).map(VertexId).collect(), r: 3 });
    session.take_tool(ToolKind::Fill);
    session.choose_rigidity(7);
    let before = document(&session).scene().rigidity.clone();
    let steps = document(&session).history().len();
    let from = on_screen(&session, middle(10));
    let center = session.open().expect("open").surface.frame().positions[middle(10) as usize];
    let drag_to = |session: &mut Session, px: f32| session.input(Input::Drag(pointer(from + Vec2::new(px, 0.0))));
    session.input(Input::Press(pointer(from)));
    for px in [20.0, 80.0, 150.0, 60.0] {
        drag_to(&mut session, px);
        while session.tool_is_behind() {
            drag_to(&mut session, px);
        }
        let open = session.open().expect("open");
        let radius = px * open.camera.world_per_px(center, session.viewport_size());
        for (v, p) in open.surface.frame().positions.iter().enumerate() {
            let (r, off) = (document(&session).scene().rigidity.as_slice()[v], p.distance(center));
            // Distances on a plane are right within 1 %; the pixel of the press is half a pixel off.
            let expected =
                if off < 0.97 * radius { Some(7) } else { (off > 1.03 * radius).then_some(before.as_slice()[v]) };
            assert!(expected.is_none_or(|expected| expected == r), "vertex {v} at {off} of {radius}: r = {r}");
        }
    }
    assert!(!session.marks().lines.is_empty(), "the front is shown");
    session.input(Input::Key(ToolKey::Escape));
    assert_eq!(
        (document(&session).scene().rigidity.clone(), document(&session).history().len()),
        (before.clone(), steps)
    );
    drag(&mut session, from, from + Vec2::new(90.0, 0.0));
    assert_eq!(document(&session).history().len(), steps + 1);
    assert_ne!(document(&session).scene().rigidity, before);
    session.undo();
    assert_eq!(document(&session).scene().rigidity, before);
}

#[test]
fn a_drag_does_not_bleed_to_a_sheet_that_only_lies_near() {
    // Folded in the middle, so that the lower half lies a hundredth under the upper one.
    let flat = sheet(20);
    let folded = flat.positions.iter().map(|p| if p.y > 0.0 { DVec3::new(p.x, -p.y, -0.01) } else { *p }).collect();
    let mut session = session_with(MeshFile::from_triangles("folded", folded, flat.triangles));
    session.take_tool(ToolKind::Fill);
    session.choose_rigidity(5);
    let from = on_screen(&session, middle(4));
    let open = session.open().expect("open");
    let position = open.surface.frame().positions[middle(4) as usize];
    // 0.3 to the fold; the sheet below is 0.01 away.
    let px = 0.25 / open.camera.world_per_px(position, session.viewport_size());
    drag(&mut session, from, from + Vec2::new(px, 0.0));
    let filled = with_r(&session, 5);
    assert!(filled.len() > 60, "{} vertices were filled", filled.len());
    assert!(filled.iter().all(|v| v.0 < 11 * 21), "the fill bled through");
}

#[test]
fn locked_vertices_keep_their_rigidity_whatever_is_done() {
    let mut session = session_with(sheet(20));
    let locked: Vec<_> = (100..300).map(VertexId).collect();
    session.apply(Command::Fill { vertices: locked.clone(), r: 4 });
    session.choose_rigidity(4);
    session.lock_current_rigidity(true);
    assert_eq!(document(&session).scene().locked.vertices(), locked);
    let from = on_screen(&session, middle(2));
    let to = on_screen(&session, middle(18));
    session.choose_rigidity(9);
    type Act = fn(&mut Session, Vec2, Vec2);
    let acts: [(&str, Act); 6] = [
        ("a stroke", |session, from, to| {
            session.take_tool(ToolKind::Brush);
            drag(session, from, to);
        }),
        ("a click of the fill", |session, _, to| {
            session.take_tool(ToolKind::Fill);
            click(session, to);
        }),
        ("a drag of the fill", |session, from, to| {
            session.take_tool(ToolKind::Fill);
            drag(session, from, to);
        }),
        ("fill everywhere", |session, _, _| session.apply(Command::FillAll(9))),
        ("fill the selection", |session, _, _| {
            session.select_all(true);
            session.fill_selection();
        }),
        ("learning", |session, _, _| session.apply(Command::Learn(Rigidity::uniform(441, 9)))),
    ];
    for (what, act) in acts {
        act(&mut session, from, to);
        let scene = document(&session).scene();
        assert!(locked.iter().all(|v| scene.rigidity.as_slice()[v.index()] == 4), "{what} changed locked vertices");
        assert!(with_r(&session, 9).len() > 20, "{what} was to change the others");
        session.undo();
    }
    session.lock_all(false);
    session.apply(Command::FillAll(9));
    assert_eq!(with_r(&session, 9).len(), 441);
    // Locks are undone like everything else.
    session.undo();
    session.undo();
    assert_eq!(document(&session).scene().locked.vertices(), locked);
}

#[test]
fn the_brush_locks_and_unlocks() {
    let mut session = session_with(sheet(20));
    session.take_tool(ToolKind::Brush);
    session.options.brush_mode = BrushMode::Lock;
    let at = on_screen(&session, middle(10));
    click(&mut session, at);
    assert!(document(&session).scene().locked.contains(VertexId(middle(10))));
    assert_eq!(document(&session).history().undo_name(), Some("Lock rigidity"));
    let ctrl = Pointer { px: at, modifiers: Modifiers { ctrl: true, shift: false, alt: false } };
    session.input(Input::Press(ctrl));
    session.input(Input::Release(ctrl));
    assert!(document(&session).scene().locked.is_empty());
}

#[test]
fn mirrored_painting_does_the_same_on_both_sides() {
    for kind in [MirrorKind::Plane, MirrorKind::Topology] {
        // A sheet cut by one diagonal is not symmetric in how it hangs together: a roof of two triangles a cell is.
        let mut session = session_with(if kind == MirrorKind::Plane { sheet(20) } else { symmetric_sheet() });
        session.options.paint.mirror.kind = kind;
        session.poll();
        wait_until(&mut session, "the other side is found", |session| session.mirror().is_some());
        let mirror = session.mirror().expect("found").clone();
        assert_eq!((mirror.map.n_alone(), mirror.uneven), (0, None), "{kind:?}");
        let image = |v: VertexId| VertexId(v.0 / 21 * 21 + 20 - v.0 % 21);
        session.choose_rigidity(5);
        for tool in [ToolKind::Brush, ToolKind::Fill] {
            session.take_tool(tool);
            let from = on_screen(&session, 10 * 21 + 4);
            drag(&mut session, from, from + Vec2::new(40.0, 10.0));
            let painted = with_r(&session, 5);
            assert!(painted.contains(&VertexId(10 * 21 + 4)), "{kind:?}, {tool:?}: where the pointer was");
            assert!(painted.iter().all(|&v| painted.contains(&image(v))), "{kind:?}, {tool:?}: on one side only");
            assert!(painted.len() < 400, "{kind:?}, {tool:?}: {} vertices", painted.len());
            session.undo();
            assert!(with_r(&session, 5).is_empty());
        }
        let at = on_screen(&session, 10 * 21 + 4);
        session.take_tool(ToolKind::Brush);
        session.input(Input::Hover(pointer(at)));
        assert_eq!(session.marks().lines.len(), 2 * 48, "a circle on each side");
        session.apply(Command::Select(vec![VertexId(10 * 21 + 4)], SelectMode::Replace));
        session.lock_selection(true);
        assert_eq!(document(&session).scene().locked.vertices(), [VertexId(214), VertexId(226)]);
    }
}

/// The sheet with the diagonals of its right half turned.
fn symmetric_sheet() -> MeshFile {
    let flat = sheet(20);
    let turned = flat.triangles.chunks(2).flat_map(|cell| {
        let ([a, b, c], [_, _, d]) = (cell[0], cell[1]);
        if a % 21 < 10 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    });
    MeshFile::from_triangles("symmetric", flat.positions.clone(), turned.collect())
}

#[test]
fn the_reach_of_the_brush_is_the_surface_its_front_or_all_that_is_under_it() {
    let mut session = session_with(painting::ball());
    session.take_tool(ToolKind::Brush);
    session.options.paint.unit = BrushUnit::Model;
    let center = Vec2::new(400.0, 300.0);
    let depths = |session: &Session| {
        let open = session.open().expect("open");
        let forward = open.camera.forward();
        let depth = |v: VertexId| open.surface.frame().positions[v.index()].dot(forward);
        with_r(session, 6).into_iter().map(depth).collect::<Vec<f32>>()
    };
    for (reach, radius, expect_far, expect_near_only) in [
        (BrushReach::Surface, 0.4, false, true),
        (BrushReach::Through, 0.4, true, false),
        (BrushReach::Surface, 4.0, true, false),
        (BrushReach::Front, 4.0, false, true),
    ] {
        session.options.paint.reach = reach;
        session.options.paint.radius = radius;
        click(&mut session, center);
        let depths = depths(&session);
        assert!(depths.iter().any(|&depth| depth < -0.9), "{reach:?} of {radius}: the nearest point");
        assert_eq!(depths.iter().any(|&depth| depth > 0.9), expect_far, "{reach:?} of {radius}: the far side");
        // Seen from three radii away the rim lies a third before the middle; normals of a coarse ball lean a little.
        assert_eq!(depths.iter().all(|&depth| depth < 0.0), expect_near_only, "{reach:?} of {radius}: the front only");
        session.undo();
    }
}

#[test]
fn a_brush_in_model_units_paints_the_same_from_near_and_far() {
    let mut session = session_with(sheet(20));
    session.take_tool(ToolKind::Brush);
    session.options.paint.unit = BrushUnit::Model;
    session.options.paint.radius = 0.21;
    let mut painted = Vec::new();
    for _ in 0..2 {
        let at = on_screen(&session, middle(10));
        click(&mut session, at);
        painted.push(with_r(&session, 6).len());
        session.undo();
        let size = session.viewport_size();
        session.open_mut().expect("open").camera.zoom(0.4, size * 0.5, size);
    }
    // π · 4.2² cells, give or take a quarter of the rim for the pixel that is hit.
    assert!(painted[0].abs_diff(painted[1]) <= 6 && painted[0].abs_diff(55) <= 8, "{painted:?}");
}

//! Brush, fill and selection.

use super::*;

#[test]
fn front_only_selection_leaves_the_far_side_in_both_projections() {
    use pliant::viewport::Projection;
    for projection in [Projection::Perspective, Projection::Orthographic] {
        let mut session = session_with(ball());
        session.open_mut().expect("open").camera.projection = projection;
        session.options.select_through = false;
        session.take_tool(ToolKind::Select);
        drag(&mut session, Vec2::new(1.0, 1.0), Vec2::new(799.0, 599.0));
        let open = session.open().expect("open");
        let positions = &open.surface.frame().positions;
        let forward = open.camera.forward();
        let selected = &document(&session).scene().selection;
        for (v, position) in positions.iter().enumerate() {
            // The ball has radius 1; a band around the outline may fall either way.
            let depth = position.dot(forward);
            let expected = if depth < -0.5 { Some(true) } else { (depth > 0.2).then_some(false) };
            let got = selected.contains(VertexId(v as u32));
            assert!(
                expected.is_none_or(|expected| expected == got),
                "{projection:?}: vertex {v} at depth {depth}: {got}"
            );
        }
    }
}

/// An octahedron, each face cut into 64 and pushed out to radius 1.
pub(super) fn ball() -> MeshFile {
    let corners = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    let faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    let n = 8;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for [a, b, c] in faces.map(|face| face.map(|corner| corners[corner])) {
        let mut vertex = |i: i32, j: i32| {
            positions.push((a * f64::from(n - i - j) + b * f64::from(i) + c * f64::from(j)).normalize());
            positions.len() as u32 - 1
        };
        for i in 0..n {
            for j in 0..n - i {
                triangles.push([vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)]);
                if i + j + 1 < n {
                    triangles.push([vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
                }
            }
        }
    }
    MeshFile::from_triangles("ball", positions, triangles)
}

#[test]
fn escape_takes_back_the_stroke_under_way() {
    let mut session = session_with(sheet(20));
    session.take_tool(ToolKind::Brush);
    let before = document(&session).scene().rigidity.clone();
    let from = on_screen(&session, middle(10));
    press_and_move(&mut session, from, from + Vec2::new(50.0, 0.0));
    assert_ne!(document(&session).scene().rigidity, before);
    session.input(Input::Key(ToolKey::Escape));
    assert_eq!(document(&session).scene().rigidity, before);
    assert!(document(&session).history().is_empty());
}

#[test]
fn painting_while_a_pose_is_held_changes_the_shape() {
    let mut session = session_with(sheet(20));
    let bottom: Vec<_> = (0..21).map(VertexId).collect();
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: bottom });
    let from = on_screen(&session, middle(18));
    drag(&mut session, from, from + Vec2::new(120.0, 60.0));
    settle(&mut session);
    let soft = document(&session).pose().positions.clone();
    session.take_tool(ToolKind::Brush);
    session.choose_rigidity(6);
    session.options.brush_radius_px = 90.0;
    let middle = on_screen(&session, middle(10));
    drag(&mut session, middle, middle + Vec2::new(40.0, 0.0));
    settle(&mut session);
    let stiff = &document(&session).pose().positions;
    let change = soft.iter().zip(stiff.iter()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(change > 1e-4, "painting r = 6 moved nothing farther than {change}");
    assert_eq!(document(&session).scene().rigidity.max(), 6);
}

#[test]
fn the_brush_stays_within_its_radius_along_the_surface() {
    let mut session = session_with(sheet(20));
    session.take_tool(ToolKind::Brush);
    session.options.brush_radius_px = 40.0;
    let center = on_screen(&session, middle(10));
    click(&mut session, center);
    let r = document(&session).scene().rigidity.clone();
    for v in 0..441 {
        let painted = r.as_slice()[v as usize] == 6;
        let distance = on_screen(&session, v).distance(center);
        // The camera looks at the sheet from an angle, so a circle on it is an ellipse on screen.
        assert!(!painted || distance < 48.0, "vertex {v} at {distance} px was painted");
        assert!(painted || distance > 12.0, "vertex {v} at {distance} px was not painted");
    }
}

#[test]
fn softer_and_stiffer_change_each_vertex_once_a_stroke() {
    let mut session = session_with(sheet(20));
    session.apply(Command::FillAll(4));
    session.take_tool(ToolKind::Brush);
    session.options.brush_mode = BrushMode::Stiffer;
    let at = on_screen(&session, middle(10));
    // In one go: several dabs fall on the same vertices before any of them is carried out.
    session.input(Input::Press(pointer(at)));
    session.input(Input::Drag(pointer(at + Vec2::new(60.0, 0.0))));
    session.input(Input::Release(pointer(at + Vec2::new(60.0, 0.0))));
    let stiffer = document(&session).scene().rigidity.as_slice()[middle(10) as usize];
    assert_eq!((document(&session).scene().rigidity.max(), stiffer), (5, 5));
    session.options.brush_mode = BrushMode::Softer;
    drag(&mut session, at, at + Vec2::new(60.0, 0.0));
    assert_eq!((document(&session).scene().rigidity.min(), document(&session).scene().rigidity.max()), (4, 4));
}

#[test]
fn fill_takes_the_selection_or_else_the_region_of_equal_rigidity() {
    let mut session = session_with(sheet(20));
    let lower: Vec<_> = (0..21 * 8).map(VertexId).collect();
    session.apply(Command::Fill { vertices: lower.clone(), r: 3 });
    session.take_tool(ToolKind::Fill);
    session.choose_rigidity(9);
    let at = on_screen(&session, middle(4));
    click(&mut session, at);
    let count =
        |session: &Session, r| document(session).scene().rigidity.as_slice().iter().filter(|&&x| x == r).count();
    assert_eq!(count(&session, 9), lower.len(), "the region of r = 3, and no more, was to become 9");
    session.apply(Command::Select((0..50).map(VertexId).collect(), SelectMode::Replace));
    session.choose_rigidity(2);
    let at = on_screen(&session, middle(1));
    click(&mut session, at);
    assert_eq!(count(&session, 2), 50, "the selection, and no more, was to become 2");
}

#[test]
fn box_and_lasso_select_what_they_enclose() {
    let mut session = session_with(sheet(20));
    session.take_tool(ToolKind::Select);
    let (lo, hi) = (on_screen(&session, middle(10)) - 30.0, on_screen(&session, middle(10)) + 30.0);
    drag(&mut session, lo, hi);
    let selected = |session: &Session| document(session).scene().selection.clone();
    let expected: Vec<VertexId> = (0..441)
        .filter(|&v| {
            let p = on_screen(&session, v);
            p.cmpge(lo).all() && p.cmple(hi).all()
        })
        .map(VertexId)
        .collect();
    assert!(expected.len() > 3);
    assert_eq!(selected(&session).vertices(), expected);
    session.options.select_shape = SelectShape::Lasso;
    let corners = [lo, Vec2::new(hi.x, lo.y), hi, Vec2::new(lo.x, hi.y)];
    session.input(Input::Press(pointer(lo)));
    corners[1..].iter().for_each(|&p| session.input(Input::Drag(pointer(p))));
    session.input(Input::Release(pointer(corners[3])));
    assert_eq!(selected(&session).vertices(), expected, "the same outline drawn as a lasso");
}

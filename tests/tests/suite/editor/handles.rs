//! Groups of handles and anchors: what belongs to them, and how they are moved.

use super::*;
use glam::{DAffine3, DQuat};
use pliant::document::{Group, GroupColor, GroupId};
use pliant::tools::{Axes, Gizmo, GizmoPart, Pivot, View};

fn groups(session: &Session) -> &[Group] {
    &document(session).scene().groups
}

fn ids(session: &Session) -> Vec<GroupId> {
    groups(session).iter().map(|group| group.id).collect()
}

fn hold(session: &mut Session, kind: GroupKind, vertices: std::ops::Range<u32>) -> GroupId {
    session.apply(Command::Hold { kind, vertices: vertices.map(VertexId).collect() });
    *ids(session).last().expect("a group")
}

/// No vertex in two groups, no empty group, sorted lists, as many positions as vertices, no active group that is gone.
fn assert_sound(session: &Session) {
    let mut seen = std::collections::HashSet::new();
    for group in groups(session) {
        assert!(!group.vertices.is_empty() && group.vertices.is_sorted(), "{}", group.name);
        assert_eq!(group.vertices.len(), group.base.len(), "{}", group.name);
        for v in group.vertices.iter() {
            assert!(seen.insert(*v), "vertex {} is in two groups, one of them {}", v.0, group.name);
        }
    }
    let scene = document(session).scene();
    assert!(scene.active.ids().iter().all(|&id| scene.group(id).is_some()), "an active group is gone");
}

fn target_of(session: &Session, v: u32) -> DVec3 {
    let (vertices, targets) = held_by(groups(session));
    targets[vertices.iter().position(|&held| held == VertexId(v)).expect("a held vertex")]
}

#[test]
fn merging_adding_and_removing_move_nothing_and_keep_every_vertex_in_one_group() {
    let mut session = session_with(sheet(20));
    let a = hold(&mut session, GroupKind::Handle, 0..30);
    let b = hold(&mut session, GroupKind::Handle, 100..120);
    let c = hold(&mut session, GroupKind::Anchor, 200..210);
    let turned = DAffine3::from_rotation_translation(DQuat::from_rotation_y(0.7), DVec3::new(0.1, 0.2, 0.3));
    session.apply(Command::MoveSeveral(vec![(a, DAffine3::from_translation(DVec3::Z)), (b, turned)]));
    settle(&mut session);
    let before: Vec<DVec3> = (0..30).chain(100..120).map(|v| target_of(&session, v)).collect();
    session.apply(Command::Merge(vec![a, b]));
    assert_sound(&session);
    assert_eq!(ids(&session), [b, c], "the last one stays");
    assert_eq!(groups(&session)[0].vertices.len(), 50);
    assert_eq!(groups(&session)[0].motion, turned, "what was moved can still be read");
    for (v, expected) in (0..30).chain(100..120).zip(before) {
        let got = target_of(&session, v);
        // There and back again through a rotation: a few roundings of coordinates near 1.
        assert!(got.distance(expected) < 1e-14, "vertex {v} is held at {got}, expected {expected}");
    }

    // Taken from an anchor, added to a handle that has moved: where the surface is now.
    let now = document(&session).pose().positions.clone();
    session.apply(Command::AddToGroup(b, (195..205).map(VertexId).collect()));
    assert_sound(&session);
    assert_eq!(groups(&session).iter().map(|group| group.vertices.len()).collect::<Vec<_>>(), [60, 5]);
    for v in 195..205_u32 {
        let (got, expected) = (target_of(&session, v), now[v as usize]);
        assert!(got.distance(expected) < 1e-14, "vertex {v} is held at {got}, expected {expected}");
    }
    session.apply(Command::RemoveFromGroup(b, (0..200).map(VertexId).collect()));
    assert_sound(&session);
    assert_eq!(groups(&session)[0].vertices.len(), 5);
    session.apply(Command::RemoveFromGroup(b, (0..300).map(VertexId).collect()));
    assert_sound(&session);
    assert_eq!(ids(&session), [c], "a group without vertices goes");
    for _ in 0..document(&session).history().len() {
        session.undo();
        assert_sound(&session);
    }
    assert!(groups(&session).is_empty());
}

#[test]
fn a_group_flattened_to_nothing_can_still_be_merged() {
    let mut session = session_with(sheet(20));
    let a = hold(&mut session, GroupKind::Handle, 0..5);
    let b = hold(&mut session, GroupKind::Handle, 50..55);
    session.apply(Command::Move { group: b, motion: DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0)) });
    session.apply(Command::Merge(vec![a, b]));
    assert_sound(&session);
    assert_eq!(groups(&session)[0].vertices.len(), 10);
    assert!(groups(&session)[0].targets().all(|target| target.is_finite()));
}

#[test]
fn several_groups_are_active_in_the_order_of_choosing_and_none_that_is_gone() {
    let mut session = session_with(sheet(20));
    let made: Vec<_> = (0..4).map(|k| hold(&mut session, GroupKind::Handle, 10 * k..10 * k + 5)).collect();
    let steps = document(&session).history().len();
    session.apply(Command::ActivateSeveral(vec![made[2], made[0], made[2], made[3]]));
    let active = &document(&session).scene().active;
    assert_eq!(active.ids(), [made[0], made[2], made[3]]);
    assert_eq!(active.lead(), Some(made[3]));
    assert_eq!(active.toggled(made[3]), [made[0], made[2]]);
    assert_eq!(active.toggled(made[1]), [made[0], made[2], made[3], made[1]]);
    assert_eq!(document(&session).history().len(), steps, "choosing is no step");
    session.apply(Command::Release(vec![made[3]]));
    assert_sound(&session);
    assert_eq!(document(&session).scene().active.lead(), Some(made[2]));
    session.apply(Command::Merge(vec![made[2], made[0]]));
    assert_sound(&session);
    session.apply(Command::Merge(vec![made[2]]));
    let errors = |session: &Session| session.notices.list().len();
    assert_eq!(errors(&session), 1, "merging a group that is gone must be refused");
}

#[test]
fn colors_follow_the_kind_until_one_is_chosen_and_do_not_disturb_the_solver() {
    let mut session = session_with(sheet(20));
    let id = hold(&mut session, GroupKind::Handle, 0..5);
    let color = |session: &Session| groups(session)[0].color;
    assert_eq!(color(&session), GroupColor::Yellow);
    session.apply(Command::SetKind(id, GroupKind::Anchor));
    assert_eq!(color(&session), GroupColor::Dark);
    let revision = document(&session).revision();
    session.apply(Command::SetColor(id, GroupColor::Sky));
    session.apply(Command::ShowDots(id, false));
    assert_eq!(document(&session).revision(), revision);
    session.apply(Command::SetKind(id, GroupKind::Handle));
    assert_eq!(color(&session), GroupColor::Sky);
    assert!(!groups(&session)[0].dots);
    session.undo();
    session.undo();
    assert!(groups(&session)[0].dots);
}

/// Two handles on a sheet, the second one active.
fn two_handles(session: &mut Session) -> [GroupId; 2] {
    let a = hold(session, GroupKind::Handle, 40..44);
    [a, hold(session, GroupKind::Handle, 380..384)]
}

fn type_number(session: &mut Session, number: &str) {
    number.chars().for_each(|sign| session.input(Input::Key(ToolKey::Sign(sign))));
}

/// Where a stroke of a part of the gizmo is on screen: where the tool takes that part.
fn find_part(session: &mut Session, part: GizmoPart) -> Vec2 {
    let (size, settings) = (session.viewport_size(), session.options.gizmo);
    let open = session.open().expect("open");
    let view = View { camera: open.camera, size };
    let scene = open.document.scene();
    let at = open.document.model().to_view(settings.place(scene).expect("a gizmo"));
    let center = open.camera.project(at, size).expect("in front of the eye").0;
    let gizmo = Gizmo::new(at, settings.axes(scene, &view), settings.shown, &view);
    // Rings reach 106 points out; a step of 4 finds strokes that are taken from 7 points away.
    let steps = || (-30..=30).map(|k| 4.0 * k as f32);
    let places = steps().flat_map(|y| steps().map(move |x| center + Vec2::new(x, y)));
    places.into_iter().find(|&px| gizmo.hit(px, &view) == Some(part)).unwrap_or_else(|| panic!("no {part:?}"))
}

#[test]
fn a_typed_angle_turns_exactly_about_the_pivot_and_is_one_step() {
    let mut session = session_with(sheet(20));
    let [_, b] = two_handles(&mut session);
    let before: Vec<DVec3> = groups(&session)[1].targets().collect();
    let center = groups(&session)[1].center();
    let steps = document(&session).history().len();
    let ring = find_part(&mut session, GizmoPart::Rotate(2));
    click(&mut session, ring);
    type_number(&mut session, "45");
    session.input(Input::Key(ToolKey::Enter));
    assert_eq!(document(&session).history().undo_name(), Some("Turn handle"));
    assert_eq!(document(&session).history().len(), steps + 1);
    let turn = glam::DMat3::from_rotation_z(45_f64.to_radians());
    let held = document(&session).scene().group(b).expect("the handle").clone();
    for (got, start) in held.targets().zip(&before) {
        let expected = center + turn * (*start - center);
        assert!(got.distance(expected) < 1e-12 * start.distance(center), "{got}, expected {expected}");
    }
    // The surface holds it exactly there.
    settle(&mut session);
    for (v, target) in held.vertices.iter().zip(held.targets()) {
        assert_eq!(document(&session).pose().positions[v.index()], target);
    }
    session.undo();
    let back: Vec<DVec3> = groups(&session)[1].targets().collect();
    assert_eq!(back, before);
    session.redo();
    assert_eq!(document(&session).scene().group(b).expect("the handle").motion, held.motion);
}

#[test]
fn a_number_can_be_mended_taken_back_and_left_by_any_other_command() {
    let mut session = session_with(sheet(20));
    let [a, b] = two_handles(&mut session);
    let steps = document(&session).history().len();
    let motion = |session: &Session, id| document(session).scene().group(id).expect("a handle").motion;
    let arrow = find_part(&mut session, GizmoPart::Move(0));
    // x 0.5 becomes y 0.25 before it is kept.
    click(&mut session, arrow);
    type_number(&mut session, "0.5");
    assert_eq!(motion(&session, b), DAffine3::from_translation(DVec3::X * 0.5));
    session.input(Input::Key(ToolKey::Axis(1)));
    session.input(Input::Key(ToolKey::Erase));
    type_number(&mut session, "25");
    assert_eq!(motion(&session, b), DAffine3::from_translation(DVec3::Y * 0.25));
    session.input(Input::Key(ToolKey::Escape));
    assert_eq!(motion(&session, b), DAffine3::IDENTITY);
    assert_eq!(document(&session).history().len(), steps, "what was taken back left a step");

    // Another command keeps what is typed, and is a step of its own.
    click(&mut session, arrow);
    type_number(&mut session, "0.1");
    session.apply(Command::Rename(a, "Left".into()));
    assert_eq!(document(&session).history().len(), steps + 2);
    assert!(!session.tool_is_active());
    session.undo();
    session.undo();
    assert_eq!((motion(&session, b), document(&session).history().len()), (DAffine3::IDENTITY, steps));

    // A click on the gizmo alone is no step: undo takes back what was before it.
    click(&mut session, arrow);
    session.undo();
    assert_eq!(document(&session).history().len(), steps - 1);
    assert!(!session.tool_is_active());
}

#[test]
fn several_handles_dragged_or_turned_keep_their_places_to_each_other() {
    let mut session = session_with(sheet(20));
    let [a, b] = two_handles(&mut session);
    session.apply(Command::ActivateSeveral(vec![a, b]));
    let apart = |session: &Session| groups(session)[1].center() - groups(session)[0].center();
    let before = apart(&session);
    let from = on_screen(&session, 381);
    drag(&mut session, from, from + Vec2::new(40.0, 25.0));
    assert!(groups(&session)[0].motion.translation.length() > 1e-3, "the other one stayed behind");
    assert!(apart(&session).distance(before) < 1e-12);
    assert_eq!(document(&session).scene().active.lead(), Some(b));

    // About their common middle: what lies between them turns with them.
    let middle = (groups(&session)[0].center() + groups(&session)[1].center()) * 0.5;
    let mut wanted = session.placement().expect("a placement");
    wanted.degrees.z = 90.0;
    session.place_active(wanted);
    let expected = glam::DMat3::from_rotation_z(std::f64::consts::FRAC_PI_2) * before;
    assert!(apart(&session).distance(expected) < 1e-12, "{}, expected {expected}", apart(&session));
    let now = (groups(&session)[0].center() + groups(&session)[1].center()) * 0.5;
    assert!(now.distance(middle) < 1e-12, "the pivot moved from {middle} to {now}");

    // Each about its own: the middles stay.
    session.options.gizmo.pivot = Pivot::Each;
    let centers: Vec<DVec3> = groups(&session).iter().map(Group::center).collect();
    let mut wanted = session.placement().expect("a placement");
    wanted.degrees.x += 30.0;
    session.place_active(wanted);
    for (group, center) in groups(&session).iter().zip(centers) {
        assert!(group.center().distance(center) < 1e-12, "{} moved", group.name);
    }
    // Shift+click lets one go.
    let at = on_screen_of(&session, groups(&session)[0].center());
    let pressed = Pointer { px: at, modifiers: Modifiers { shift: true, ctrl: false, alt: false } };
    session.input(Input::Hover(pressed));
    session.input(Input::Press(pressed));
    session.input(Input::Release(pressed));
    assert_eq!(document(&session).scene().active.ids(), [b]);
}

fn on_screen_of(session: &Session, world: DVec3) -> Vec2 {
    let open = session.open().expect("an open document");
    let position = open.document.model().to_view(world);
    open.camera.project(position, session.viewport_size()).expect("in front of the eye").0
}

#[test]
fn a_drag_locked_to_an_axis_or_a_grid_stays_on_it() {
    let mut session = session_with(sheet(20));
    let [_, b] = two_handles(&mut session);
    session.options.gizmo.step = 0.05;
    let way = |session: &Session| document(session).scene().group(b).expect("a handle").motion.translation;
    let from = on_screen(&session, 381);
    press_and_move(&mut session, from, from + Vec2::new(70.0, 30.0));
    session.input(Input::Key(ToolKey::Axis(1)));
    let locked = way(&session);
    assert!(locked.y != 0.0 && locked.x == 0.0 && locked.z == 0.0, "{locked}");
    let ctrl = Modifiers { shift: false, ctrl: true, alt: false };
    session.input(Input::Drag(Pointer { px: from + Vec2::new(-20.0, 90.0), modifiers: ctrl }));
    let snapped = way(&session).y / 0.05;
    assert!(snapped != 0.0 && (snapped - snapped.round()).abs() < 1e-9, "{snapped} steps");
    session.input(Input::Key(ToolKey::Axis(1)));
    assert!(way(&session).x != 0.0, "the same key frees the axis");
    session.input(Input::Key(ToolKey::Escape));
    assert_eq!(way(&session), DVec3::ZERO);

    // Shift keeps to the axis that the pointer follows most.
    session.input(Input::Press(pointer(from)));
    let shift = Modifiers { shift: true, ctrl: false, alt: false };
    session.input(Input::Drag(Pointer { px: from + Vec2::new(80.0, 6.0), modifiers: shift }));
    let kept = way(&session);
    assert_eq!([kept.x, kept.y, kept.z].iter().filter(|&&x| x != 0.0).count(), 1, "{kept}");
    session.input(Input::Key(ToolKey::Escape));
}

#[test]
fn a_drag_with_alt_lands_on_the_vertex_near_the_pointer_as_far_as_an_axis_lets_it() {
    let mut session = session_with(sheet(20));
    let [_, b] = two_handles(&mut session);
    // Aslant: a way in the plane of the view would leave the sheet.
    session.open_mut().expect("open").camera.orbit(Vec2::new(60.0, 40.0));
    let center = |session: &Session| document(session).scene().group(b).expect("a handle").center();
    let (start, from, vertex) = (center(&session), on_screen_of(&session, center(&session)), 215_u32);
    let there = document(&session).model().mesh.positions()[vertex as usize];
    let near = on_screen(&session, vertex) + Vec2::new(3.0, -4.0);
    press_and_move(&mut session, from, near);
    assert!(center(&session).z.abs() > 1e-2, "without Alt it is on the vertex by itself");
    let alt = Modifiers { alt: true, ..Modifiers::default() };
    session.input(Input::Drag(Pointer { px: near, modifiers: alt }));
    // Pictures have positions in single precision.
    assert!(center(&session).distance(there) < 1e-6, "{}, expected {there}", center(&session));
    let hint = session.with_tool(|tool, context| tool.hint(context)).expect("a hint");
    assert!(hint.contains("vertex 215"), "{hint}");
    session.input(Input::Key(ToolKey::Axis(0)));
    let expected = DVec3::new(there.x, start.y, start.z);
    assert!(center(&session).distance(expected) < 1e-6, "{}, expected {expected}", center(&session));
    session.input(Input::Key(ToolKey::Sign('2')));
    let expected = start + DVec3::X * 2.0;
    assert!(center(&session).distance(expected) < 1e-12, "what is typed counts: {}", center(&session));
    session.input(Input::Key(ToolKey::Escape));
    // Its own vertices are no targets: it would never leave.
    let own = document(&session).scene().group(b).expect("a handle").vertices[0].0;
    let near = on_screen(&session, own);
    press_and_move(&mut session, from, near);
    session.input(Input::Drag(Pointer { px: near, modifiers: alt }));
    let place = document(&session).model().mesh.positions()[own as usize];
    assert!(center(&session).distance(place) > 1e-3, "it landed on its own vertex");
    session.input(Input::Key(ToolKey::Escape));
    assert_eq!(center(&session), start);
}

#[test]
fn local_axes_follow_the_handle_and_view_axes_the_camera() {
    let mut session = session_with(sheet(20));
    let [_, b] = two_handles(&mut session);
    let turn = DQuat::from_rotation_y(0.5);
    let center = groups(&session)[1].center();
    let about = DAffine3::from_translation(center) * DAffine3::from_quat(turn) * DAffine3::from_translation(-center);
    session.apply(Command::Move { group: b, motion: about });
    let middle = |session: &Session| document(session).scene().group(b).expect("a handle").center();
    let forward = session.open().expect("open").camera.forward().as_dvec3();
    for (axes, is_right) in [
        (Axes::World, Box::new(|way: DVec3| way.distance(DVec3::X * 0.2) < 1e-12) as Box<dyn Fn(DVec3) -> bool>),
        (Axes::Local, Box::new(move |way: DVec3| way.distance(turn * DVec3::X * 0.2) < 1e-12)),
        // Camera axes are single precision.
        (Axes::View, Box::new(move |way: DVec3| way.dot(forward).abs() < 1e-7 && (way.length() - 0.2).abs() < 1e-12)),
    ] {
        session.options.gizmo.axes = axes;
        let arrow = find_part(&mut session, GizmoPart::Move(0));
        click(&mut session, arrow);
        type_number(&mut session, "0.2");
        session.input(Input::Key(ToolKey::Enter));
        let way = middle(&session) - center;
        assert!(is_right(way), "{axes:?}: {way}");
        session.undo();
    }
}

#[test]
fn numbers_read_as_they_were_typed_until_the_handle_moves_otherwise() {
    let mut session = session_with(sheet(20));
    let [_, b] = two_handles(&mut session);
    let mut wanted = session.placement().expect("a placement");
    assert_eq!((wanted.translation, wanted.degrees, wanted.scale), (DVec3::ZERO, DVec3::ZERO, DVec3::ONE));
    wanted.degrees.y = 120.0;
    session.place_active(wanted);
    assert_eq!(session.placement(), Some(wanted), "as typed, not as three other turns");
    wanted.translation = DVec3::new(0.25, 0.0, -1.0);
    wanted.scale.x = 2.0;
    session.place_active(wanted);
    assert_eq!(session.placement(), Some(wanted));
    let motion = document(&session).scene().group(b).expect("a handle").motion;
    session.undo();
    session.undo();
    let rest = session.placement().expect("a placement");
    assert!(rest.degrees.abs_diff_eq(DVec3::ZERO, 1e-12), "{rest:?}");
    session.redo();
    session.redo();
    assert_eq!(document(&session).scene().group(b).expect("a handle").motion, motion);
    wanted.scale.y = f64::NAN;
    session.place_active(wanted);
    assert_eq!(document(&session).scene().group(b).expect("a handle").motion, motion, "not a number was taken");
}

#[test]
fn the_pivot_is_picked_under_the_pointer_or_by_the_next_click() {
    let mut session = session_with(sheet(20));
    two_handles(&mut session);
    let at = on_screen(&session, 200);
    session.input(Input::Hover(pointer(at)));
    session.input(Input::Key(ToolKey::Pivot));
    let picked = |session: &Session| match session.options.gizmo.pivot {
        Pivot::Point(point) => point,
        other => panic!("{other:?} is no picked point"),
    };
    let expected = document(&session).pose().positions[200];
    // Single precision picking on a sheet of size 1.
    assert!(picked(&session).distance(expected) < 1e-4, "{}, expected {expected}", picked(&session));
    session.input(Input::Leave);
    session.input(Input::Key(ToolKey::Pivot));
    let n_groups = groups(&session).len();
    let at = on_screen(&session, 100);
    click(&mut session, at);
    assert_eq!(groups(&session).len(), n_groups, "the click placed a handle");
    let expected = document(&session).pose().positions[100];
    assert!(picked(&session).distance(expected) < 1e-4, "{}, expected {expected}", picked(&session));
    // Turned about that point.
    let far = groups(&session)[1].center() - picked(&session);
    let mut wanted = session.placement().expect("a placement");
    wanted.degrees.z = 180.0;
    session.place_active(wanted);
    let now = groups(&session)[1].center() - picked(&session);
    assert!(now.distance(DVec3::new(-far.x, -far.y, far.z)) < 1e-12, "{now}");
}

#[test]
fn clicks_go_through_handles_that_lie_upon_each_other() {
    let mut session = session_with(sheet(20));
    let a = hold(&mut session, GroupKind::Handle, 218..223);
    // Around the same middle, vertex 220.
    let ring = [197, 198, 199, 241, 242, 243].map(VertexId).to_vec();
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: ring });
    let b = *ids(&session).last().expect("a group");
    assert!(groups(&session)[0].center().distance(groups(&session)[1].center()) < 1e-12);
    session.options.show_gizmo = false;
    let at = on_screen(&session, 220);
    let mut led = Vec::new();
    for _ in 0..4 {
        click(&mut session, at);
        led.extend(document(&session).scene().active.lead());
    }
    assert!(led.contains(&a) && led.contains(&b), "{led:?}");
    assert_eq!(groups(&session).len(), 2);
}

//! The inspect tool: numbers of a vertex, and the way between two.

use super::*;
use pliant::editor::{Along, Inspection};

fn inspections(session: &mut Session) -> Vec<Inspection> {
    session.inspections().into_iter().map(|(_, inspection)| inspection).collect()
}

fn hover(session: &mut Session, v: u32) {
    let at = on_screen(session, v);
    session.input(Input::Hover(pointer(at)));
}

#[test]
fn hovering_tells_the_numbers_of_the_vertex_as_it_is_now() {
    let mut session = session_with(sheet(20));
    place_two_handles(&mut session);
    let from = on_screen(&session, middle(17));
    drag(&mut session, from, from + Vec2::new(60.0, -40.0));
    session.take_tool(ToolKind::Inspect);
    assert!(inspections(&mut session).is_empty(), "nothing is pointed at yet");
    settle(&mut session);
    wait_until(&mut session, "the energies are told", |session| {
        session.status.report.as_ref().is_some_and(|report| report.vertex_energies.is_some())
    });
    let v = middle(9);
    hover(&mut session, v);
    let [told] = &inspections(&mut session)[..] else { panic!("one card for one vertex") };
    let (pose, rest) = (document(&session).pose().clone(), document(&session).model().mesh.positions().to_vec());
    assert_eq!((told.vertex, told.rigidity, told.in_file), (VertexId(v), 1, None));
    assert_eq!(told.position, pose.positions[v as usize]);
    assert_eq!(told.moved, pose.positions[v as usize].distance(rest[v as usize]));
    let report = session.status.report.as_ref().expect("settled");
    let energies = report.vertex_energies.clone().expect("asked for");
    let (sum, whole) = (energies.iter().sum::<f64>(), report.energy);
    // A sum of 441 terms in another order.
    assert!((sum - whole).abs() <= 1e-9 * whole, "the energies add up to {sum}, the whole is {whole}");
    assert_eq!(told.energy, Some((energies[v as usize], energies[v as usize] / whole)));
    let (lo, hi) = told.stretch.expect("it has edges");
    assert!(lo <= hi && lo > 0.5 && hi < 2.0, "edges at {lo} to {hi}");
    hover(&mut session, middle(2));
    let held_by = inspections(&mut session)[0].held_by.clone();
    assert_eq!(held_by.as_deref(), Some("Handle 1"));
    session.input(Input::Leave);
    assert!(inspections(&mut session).is_empty());
    assert_eq!(document(&session).history().undo_name(), Some("Move handle"), "looking changes nothing");
}

#[test]
fn two_clicks_measure_the_way_straight_and_along_the_surface() {
    // A quarter of a pipe: the way along it is longer than the straight one.
    let mut pipe = sheet(40);
    pipe.positions.iter_mut().for_each(|p| {
        let angle = p.x * std::f64::consts::FRAC_PI_2;
        *p = DVec3::new(angle.sin(), p.y, angle.cos());
    });
    let mut session = session_with(pipe);
    session.take_tool(ToolKind::Inspect);
    let (a, b) = (20 * 41 + 4, 20 * 41 + 36);
    let [from, to] = [a, b].map(|v| on_screen(&session, v));
    click(&mut session, from);
    hover(&mut session, b);
    let before = inspections(&mut session);
    assert_eq!(before.len(), 2, "the pinned one and the one under the pointer");
    assert_eq!(before[1].way.map(|(_, along)| along), Some(None), "not measured before the click");
    click(&mut session, to);
    let measured = |session: &mut Session| inspections(session).last().and_then(|last| last.way);
    let mut way = None;
    let start = Instant::now();
    while !matches!(way, Some((_, Some(Along::Far(_))))) {
        assert!(start.elapsed() < Duration::from_secs(60), "waited in vain: {way:?}");
        session.poll();
        way = measured(&mut session);
        std::thread::sleep(Duration::from_millis(2));
    }
    let Some((straight, Some(Along::Far(along)))) = way else { panic!("{way:?}") };
    let angle = 0.8 * std::f64::consts::FRAC_PI_2;
    assert!((straight - 2.0 * (angle / 2.0).sin()).abs() < 1e-12, "straight {straight}");
    // Each of 32 pieces is a chord: shorter than its arc by less than a thousandth. Single precision adds less.
    assert!((f64::from(along) - angle).abs() < 1e-3 * angle, "along {along}, expected {angle}");
    session.input(Input::Key(ToolKey::Escape));
    session.input(Input::Leave);
    assert!(inspections(&mut session).is_empty(), "Esc lets go of both");
}

#[test]
fn there_is_no_way_along_the_surface_between_separate_parts() {
    let mut session = session_with(super::selecting::several());
    session.take_tool(ToolKind::Inspect);
    let n = document(&session).model().mesh.n_vertices() as u32;
    for v in [n - 13, n - 25 - 30] {
        let at = on_screen(&session, v);
        click(&mut session, at);
    }
    let start = Instant::now();
    loop {
        session.poll();
        let told = inspections(&mut session);
        assert_eq!(told.len(), 2);
        assert_eq!(told.iter().map(|told| told.part.as_deref()).collect::<Vec<_>>(), [Some("right"), Some("left")]);
        match told[1].way {
            Some((_, Some(Along::Apart))) => break,
            way => assert!(start.elapsed() < Duration::from_secs(60), "waited in vain: {way:?}"),
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

//! What the picture shows: colorings and the numbers behind them.

use super::*;
use pliant::editor::{ColorBy, Crossings};
use pliant::solving::Measure;

fn color_by(session: &mut Session, color_by: ColorBy) {
    let mut look = session.look.clone();
    look.color_by = color_by;
    session.set_look(look);
}

#[test]
fn every_measure_of_a_bent_sheet_is_told_with_its_scale() {
    let mut session = session_with(sheet(20));
    place_two_handles(&mut session);
    let from = on_screen(&session, middle(17));
    drag(&mut session, from, from + Vec2::new(0.0, 90.0));
    settle(&mut session);
    for (color_by_it, measure) in [
        (ColorBy::Energy, Measure::Energy),
        (ColorBy::EnergyDifference, Measure::EnergyDifference),
        (ColorBy::Stretch, Measure::Stretch),
    ] {
        color_by(&mut session, color_by_it);
        wait_until(&mut session, "the measure is told", |session| session.measured().is_some());
        let measured = session.measured().expect("told").clone();
        assert_eq!(measured.measure, measure);
        assert_eq!(measured.values.len(), 21 * 21);
        assert!(measured.values.iter().all(|value| (0.0..=1.0).contains(value)), "{measure:?}");
        assert!(measured.ends[1] > measured.ends[0], "{measure:?}: {:?}", measured.ends);
    }
    // The sheet was squeezed to less than its length: stretch is on the compressed side somewhere, and told as a ratio.
    let stretch = session.measured().expect("told");
    assert!(stretch.values.iter().any(|&value| value < 0.25), "something is compressed");
    assert!((stretch.ends[0] * stretch.ends[1] - 1.0).abs() < 1e-12, "{:?}", stretch.ends);
    color_by(&mut session, ColorBy::Rigidity);
    assert!(session.measured().is_none(), "nothing is measured that nobody looks at");
}

#[test]
fn without_handles_nothing_has_an_energy_and_nothing_is_stretched() {
    let mut session = session_with(sheet(20));
    color_by(&mut session, ColorBy::Stretch);
    wait_until(&mut session, "the stretch is told", |session| session.measured().is_some());
    assert!(session.measured().expect("told").values.iter().all(|&value| value == 0.5));
    color_by(&mut session, ColorBy::Energy);
    settle(&mut session);
    assert!(session.measured().is_none());
}

/// A strip that is bent through itself by its handles, and can be bent back.
fn crossed_sheet() -> Session {
    let mut session = session_with(sheet(20));
    place_two_handles(&mut session);
    let from = on_screen(&session, middle(17));
    // The upper handle goes down past the lower one.
    drag(&mut session, from, from + Vec2::new(4.0, 420.0));
    settle(&mut session);
    session
}

fn look_for_crossings(session: &mut Session, crossings: bool) {
    let mut look = session.look.clone();
    look.crossings = crossings;
    session.set_look(look);
}

#[test]
fn faces_that_cross_are_found_when_the_surface_rests() {
    let mut session = crossed_sheet();
    session.poll();
    assert_eq!(session.crossings(), Crossings::Off, "nobody asked");
    look_for_crossings(&mut session, true);
    wait_until(&mut session, "the search is over", |session| matches!(session.crossings(), Crossings::Found { .. }));
    let positions = document(&session).pose().positions.clone();
    let triangles = document(&session).model().triangles.clone();
    let expected = pliant_geometry::crossings_of_all(&positions, &triangles, &|| true).expect("not stopped");
    let Crossings::Found { n_faces, n_pairs } = session.crossings() else { unreachable!("waited for it") };
    assert_eq!(n_pairs, expected.len());
    let faces = session.crossing_faces().expect("found");
    assert_eq!(faces.len(), n_faces);

    // What moves is looked at anew once it rests; what was undone to is told about itself.
    session.undo();
    session.poll();
    assert!(session.crossing_faces().is_none(), "those of another pose are not shown");
    settle(&mut session);
    wait_until(&mut session, "the search is over", |session| matches!(session.crossings(), Crossings::Found { .. }));
    assert_eq!(session.crossings(), Crossings::Found { n_faces: 0, n_pairs: 0 }, "a flat sheet");
    look_for_crossings(&mut session, false);
    session.poll();
    assert_eq!((session.crossings(), session.crossing_faces().is_none()), (Crossings::Off, true));
}

#[test]
fn the_rest_shape_is_shown_without_changing_anything() {
    let mut session = crossed_sheet();
    let pose = document(&session).pose().clone();
    let bent = session.shown_frame().expect("open").clone();
    session.toggle_rest();
    let rest = session.shown_frame().expect("open").clone();
    let model = document(&session).model().clone();
    for (v, (shown, at_rest)) in rest.positions.iter().zip(model.mesh.positions()).enumerate() {
        assert_eq!(*shown, model.to_view(*at_rest), "vertex {v}");
    }
    session.toggle_rest();
    assert!(Arc::ptr_eq(session.shown_frame().expect("open"), &bent));
    assert_eq!(document(&session).pose(), &pose);
    session.show(Opened::new(model), None);
    assert!(!session.shows_rest(), "another mesh is shown as it is");
}

//! What the picture shows: colorings and the numbers behind them.

use super::*;
use pliant::editor::ColorBy;
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

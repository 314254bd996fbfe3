//! Figure 8: a thin bar with a stiffer middle.

use pliant_solver::{Method, Rigidity};

use crate::bending::settled;
use crate::failure::Failure;
use crate::models::Bar;
use crate::page::{Check, Figure, Folder, Panel};
use crate::shots::{Stage, View};

/// r of what is soft, and what the stiff part has.
const SOFT: u16 = 2;
const STIFF: [u16; 3] = [3, 4, 6];
/// The stiff part, in parts of the length.
const MIDDLE: [f64; 2] = [1.0 / 3.0, 2.0 / 3.0];
const DEGREES: f64 = 150.0;
const VIEW: View = View { yaw: 14.0, pitch: -12.0, roll: -90.0 };

pub(crate) fn figure(into: &mut Folder) -> Result<Figure, Failure> {
    let bar = Bar::open("thin-bar")?;
    let posing = bar.arc(DEGREES);
    let sizes = |stiff: u16| -> Vec<u16> {
        let is_middle = |x: f64| x > MIDDLE[0] * bar.length && x < MIDDLE[1] * bar.length;
        bar.mesh.positions().iter().map(|p| if is_middle(p.x) { stiff } else { SOFT }).collect()
    };
    let mut runs = Vec::new();
    for r in [SOFT].into_iter().chain(STIFF) {
        runs.push((r, settled(&posing, &Method::RRing(Rigidity::new(sizes(r))?))?));
    }
    let surfaces: Vec<&[_]> = runs.iter().map(|(_, run)| run.positions.as_slice()).collect();
    let stage = Stage::new(VIEW, 330, &surfaces);
    let rest = bar.mesh.positions();
    let flat = View { roll: 0.0, ..VIEW };
    let shot = Stage::new(flat, 330, &[rest]).shot(&bar.mesh, rest).with_soft_and_stiff(&sizes(STIFF[0]), STIFF[0]);
    let mut panels = vec![Panel::new(into.picture("fig08-input", &shot)?, "input, the stiff part in red")];
    let (mut bows, mut rows) = (Vec::new(), Vec::new());
    for (r, run) in &runs {
        let bow = bar.bow(&run.positions, MIDDLE);
        let shot =
            stage.shot(&bar.mesh, &run.positions).with_handles(&posing).with_soft_and_stiff(&sizes(*r), STIFF[0]);
        let name = if *r == SOFT { format!("r = {SOFT} all over") } else { format!("r = {r} and {SOFT}") };
        let file = into.picture(&format!("fig08-r{r:02}"), &shot)?;
        panels.push(Panel::new(file, format!("{name}<br>bow {:.4}", bow)));
        rows.push(vec![r.to_string(), run.n_iterations().to_string(), format!("{bow:.6}")]);
        bows.push(bow);
    }
    let list: Vec<String> = bows.iter().map(|bow| format!("{bow:.4}")).collect();
    let below = bows[STIFF.len()] / bows[0];
    Ok(Figure {
        number: "Figure 8",
        title: "two materials on one bar",
        claim: "on a thin bar painted with two sizes, r = 2 for what is soft and 3, 4 or 6 for what is stiff, the stiff middle \
                bends less the larger its r.",
        setup: format!(
            "the thin bar, its middle third stiffer, one end carried along an arc of {DEGREES}°. *Bow* is how far the middle third is from \
             straight, over its length."
        ),
        rows: vec![panels],
        table: String::new(),
        checks: vec![
            Check::new(
                "The middle bends less the larger its r (2, 3, 4, 6)",
                bows.windows(2).all(|pair| pair[1] < pair[0]),
                list.join(", "),
            ),
            Check::new(
                "With r = 6 it bends by less than half of what it does with r = 2 all over",
                below < 0.5,
                format!("{below:.2} of it"),
            ),
        ],
        data: vec![into.csv("fig08", &["r of the middle", "iterations", "bow"], &rows)?],
    })
}

//! Figure 6: one bend, and r from 1 to 20.

use pliant_solver::{Method, Rigidity};

use crate::bending::settled;
use crate::failure::Failure;
use crate::measures::crossings;
use crate::models::Bar;
use crate::page::{Check, Figure, Folder, Panel};
use crate::shots::{Stage, View};

const SIZES: [u16; 5] = [1, 5, 10, 15, 20];
const DEGREES: f64 = 90.0;
const VIEW: View = View { yaw: 20.0, pitch: -16.0, roll: 0.0 };
/// The part of the bar whose bow is measured: away from the handles.
const PART: [f64; 2] = [0.2, 0.8];

pub(crate) fn figure(into: &mut Folder) -> Result<Figure, Failure> {
    let bar = Bar::open("bar")?;
    let posing = bar.arc(DEGREES);
    let mut runs = Vec::new();
    for r in SIZES {
        runs.push(settled(&posing, &Method::RRing(Rigidity::uniform(bar.mesh.n_vertices(), r)))?);
    }
    let rest = bar.mesh.positions();
    let surfaces: Vec<&[_]> = runs.iter().map(|run| run.positions.as_slice()).collect();
    let stage = Stage::new(VIEW, 300, &surfaces);
    let input = Stage::new(VIEW, 300, &[rest]).shot(&bar.mesh, rest).with_handles(&posing);
    let mut panels = vec![Panel::new(into.picture("fig06-input", &input)?, "input")];
    let (mut bows, mut n_crossings, mut rows) = (Vec::new(), 0, Vec::new());
    for (r, run) in SIZES.into_iter().zip(&runs) {
        let shot = stage.shot(&bar.mesh, &run.positions).with_handles(&posing);
        let bow = bar.bow(&run.positions, PART);
        panels.push(Panel::new(into.picture(&format!("fig06-r{r:02}"), &shot)?, format!("r = {r}<br>bow {bow:.3}")));
        let crossing = crossings(&bar.mesh, &run.positions);
        rows.push(vec![r.to_string(), run.n_iterations().to_string(), format!("{bow:.5}"), crossing.to_string()]);
        n_crossings += crossing;
        bows.push(bow);
    }
    let list: Vec<String> = bows.iter().map(|bow| format!("{bow:.3}")).collect();
    Ok(Figure {
        number: "Figure 6",
        title: "from soft to stiff by one number",
        claim: "with the same handles, a larger r (1, 5, 10, 15, 20) gives a more rigid bar: elastic as plastic at r = 1, \
                like metal at r = 15.",
        setup: format!(
            "the bar of figure 3, one end carried along an arc of {DEGREES}°. *Bow* is how far the middle line between a fifth and \
             four fifths of the length is from straight, over its length; an even arc between the handles has 0.12."
        ),
        rows: vec![panels],
        table: String::new(),
        checks: vec![
            Check::new(
                "The larger r, the less the bar gives in to the bend (smaller bow)",
                bows.windows(2).all(|pair| pair[1] < pair[0]),
                list.join(", "),
            ),
            Check::new("No result crosses itself", n_crossings == 0, format!("{n_crossings} crossings")),
        ],
        data: vec![into.csv("fig06", &["r", "iterations", "bow", "crossings"], &rows)?],
    })
}

//! Figure 7: a large deformation by every method.

use glam::{DMat3, DVec3};
use pliant_solver::Rigidity;

use super::contest::{self, Outcome, ring, rivals};
use crate::failure::Failure;
use crate::models::{self, Posing};
use crate::page::{Check, Figure, Folder, Panel, count};
use crate::shots::{Stage, View};

const VIEW: View = View { yaw: 18.0, pitch: -10.0, roll: 0.0 };
/// Tip of the cactus's right arm; what is near is turned about it and shifted.
const TIP: DVec3 = DVec3::new(0.62, 1.50, 0.05);
const REACH: f64 = 0.18;
const DEGREES: f64 = 140.0;
const SHIFT: DVec3 = DVec3::new(0.4, -1.0, 0.2);
/// The cactus stands on y = 0; this much of it is held.
const FOOT: f64 = 0.06;
/// Normals of neighboring faces that are farther apart fold back on each other, degrees.
const FOLD: f64 = 150.0;

pub(crate) fn figure(into: &mut Folder) -> Result<Figure, Failure> {
    let mesh = models::open("cactus")?;
    let turn = DMat3::from_axis_angle(DVec3::NEG_Z, DEGREES.to_radians());
    let posing = Posing::new(mesh.clone(), |_, p| match p.distance(TIP) < REACH {
        _ if p.y < FOOT => Some(p),
        true => Some(turn * (p - TIP) + TIP + SHIFT),
        false => None,
    });
    let mut entries = rivals(mesh.n_vertices());
    entries.push(ring("r = 6", "r06", Rigidity::uniform(mesh.n_vertices(), 6)));
    let outcomes = contest::run(&posing, entries)?;
    let rest = mesh.positions();
    let surfaces: Vec<&[_]> = outcomes.iter().map(Outcome::positions).chain([rest]).collect();
    let stage = Stage::new(VIEW, 300, &surfaces);
    let shot = stage.shot(&mesh, rest).with_handles(&posing);
    let mut panels = vec![Panel::new(into.picture("fig07-input", &shot)?, "input")];
    let list: Vec<_> = outcomes.iter().map(|o| (o, format!("{} crossings", o.crossings))).collect();
    panels.extend(contest::panels(into, "fig07", &stage, &posing, &list)?);
    let (ours, others) = outcomes.split_last().expect("four methods");
    Ok(Figure {
        number: "Figure 7",
        title: "a large deformation, by every method",
        claim: "under a large deformation ARAP, SR-ARAP and embedded deformation show artifacts, among them crossings and details \
                that are blended away; r = 6 has none.",
        setup: format!(
            "an arm of the cactus ({} vertices) is turned by {DEGREES}° and pulled down at once. SR-ARAP with α = 0.02, embedded \
             deformation with 500 nodes, as everywhere on this page.",
            count(mesh.n_vertices())
        ),
        rows: vec![panels],
        table: String::new(),
        checks: checks(ours, others),
        data: vec![contest::csv(into, "fig07", &outcomes)?],
    })
}

fn checks(ours: &Outcome, others: &[Outcome]) -> Vec<Check> {
    let is_clean = |o: &Outcome| o.crossings == 0 && o.sharpest < FOLD;
    let state =
        |o: &Outcome| format!("{} crossings, the sharpest angle between neighbors is {:.0}°", o.crossings, o.sharpest);
    let mut checks = vec![Check::new("By r = 6 nothing crosses and nothing folds over", is_clean(ours), state(ours))];
    let of_other =
        |o: &Outcome| Check::new(format!("By {} something crosses or folds over", o.name), !is_clean(o), state(o));
    checks.extend(others.iter().map(of_other));
    let bending: Vec<String> = others.iter().map(|o| format!("{:.2}° with {}", o.bending, o.name)).collect();
    checks.push(Check::new(
        "r = 6 keeps details best (least bending)",
        others.iter().all(|o| ours.bending < o.bending),
        format!("{:.2}° against {}", ours.bending, bending.join(", ")),
    ));
    checks
}

//! Figures 9 to 11: limbs painted stiff with soft joints, against the same size everywhere and the other methods.

use glam::{DQuat, DVec3};
use pliant_solver::Rigidity;

use super::contest::{self, Outcome, ring, rivals};
use crate::failure::Failure;
use crate::measures::{Hinges, distance};
use crate::models::{self, PoseSet, Posing};
use crate::page::{Check, Figure, Folder, Panel, count};
use crate::shots::{Stage, View};

/// What is painted so is bone, and so is joint.
const BONE: u16 = 5;
const JOINT: u16 = 2;
/// The largest r that is painted: the paper's.
pub(crate) const MOST: u16 = 6;

/// A painted shape with handles.
pub(crate) struct Limbs {
    pub(crate) posing: Posing,
    pub(crate) sizes: Vec<u16>,
    /// Where the vertices should be, where that is known.
    pub(crate) truth: Option<Vec<DVec3>>,
    pub(crate) view: View,
    /// Longer side of the pictures.
    pub(crate) pixels: u32,
}

/// What is said of a figure.
struct Words {
    number: &'static str,
    prefix: &'static str,
    title: &'static str,
    claim: &'static str,
    setup: String,
}

/// An arm of the creature turned at the elbow.
pub(crate) fn arm(into: &mut Folder) -> Result<Figure, Failure> {
    const ELBOW: DVec3 = DVec3::new(0.50, 1.00, 0.12);
    const HAND: DVec3 = DVec3::new(0.80, 1.40, 0.24);
    const HEAD: DVec3 = DVec3::new(0.0, 1.50, 0.14);
    // Upright from the elbow, clear of the head.
    const FOREARM: DVec3 = DVec3::new(-0.02, 0.50, 0.16);
    let mesh = models::open("creature")?;
    let turn = DQuat::from_rotation_arc((HAND - ELBOW).normalize(), FOREARM.normalize());
    let degrees = (HAND - ELBOW).angle_between(FOREARM).to_degrees();
    let posing = Posing::new(mesh, |_, p| {
        let is_still = p.y < 0.03 || (p.y > 1.42 && p.distance(HEAD) < 0.30 && p.z < 0.30);
        let is_hand = p.distance(HAND) < 0.115;
        if is_still { Some(p) } else { is_hand.then(|| turn * (p - ELBOW) + ELBOW) }
    });
    let sizes = models::painted("creature")?;
    let setup = format!(
        "the creature ({} vertices) with soles and head held, its raised hand turned by {degrees:.0}° about the elbow. r = 6 is painted \
         on its bones, 1 at its joints. Captions tell the bending of bones.",
        count(posing.mesh.n_vertices())
    );
    let view = View { yaw: 12.0, pitch: -6.0, roll: 0.0 };
    let limbs = Limbs { posing, sizes, truth: None, view, pixels: 300 };
    let claim = "on a human figure with soft joints painted, an arm bends at its elbow; with ARAP, SR-ARAP and embedded \
                 deformation the bend is not at the elbow, and muscles shrink.";
    draw(into, &limbs, Words { number: "Figure 9", prefix: "fig09", title: "an arm with an elbow", claim, setup })
}

/// The gecko on its legs.
pub(crate) fn legs(into: &mut Folder) -> Result<Figure, Failure> {
    let set = PoseSet::open("gecko")?;
    let limbs = of_set(
        &set,
        "stand",
        &["pelvis", "head", "tail tip", "left forearm", "right forearm", "left shin", "right shin"],
    )?;
    let setup = format!(
        "the gecko ({} vertices) is lifted onto its legs as in the pose *stand* of its file: patches of pelvis, head, tail tip and \
         of the four feet are where that pose has them, everything else is left to the method. r is painted by the distance from \
         the nearest joint, from 1 to 6. Captions tell the mean distance of a vertex from its place in the pose, in diagonals of the \
         bounding box.",
        count(set.mesh.n_vertices())
    );
    let claim = "on a hand, fingers bend at their joints when these are painted soft; with ARAP the finger bends like rubber, \
                 and embedded deformation squeezes the thumb.";
    let words = Words { number: "Figure 10", prefix: "fig10", title: "limbs with several joints", claim, setup };
    draw(into, &Limbs { view: View { yaw: 40.0, pitch: -24.0, roll: 0.0 }, ..limbs }, words)
}

/// The bar of five stiff pieces.
pub(crate) fn pieces(into: &mut Folder) -> Result<Figure, Failure> {
    let set = PoseSet::open("jointed-bar")?;
    let limbs = of_set(&set, "zigzag", &["first", "third", "fifth"])?;
    let setup = format!(
        "a bar of five stiff pieces with four joints ({} vertices) in the pose *zigzag* of its file: patches in the middle of the \
         first, third and fifth piece are where that pose has them. r is painted by the distance from the nearest joint, from 1 to 6. \
         Captions as in figure 10.",
        count(set.mesh.n_vertices())
    );
    let claim = "a further articulated shape: with ARAP, SR-ARAP and embedded deformation distortions like those of figures 9 \
                 and 10, with painted joints a natural result.";
    let words = Words { number: "Figure 11", prefix: "fig11", title: "stiff pieces, soft joints", claim, setup };
    draw(into, &Limbs { view: View { yaw: 20.0, pitch: -35.0, roll: 0.0 }, ..limbs }, words)
}

/// A pose of a set from patches of some of its bones, painted by the truth.
pub(crate) fn of_set(set: &PoseSet, pose: &str, bones: &[&str]) -> Result<Limbs, Failure> {
    let truth = set.pose(pose)?.to_vec();
    let posing = set.held_by(bones, &truth);
    let sizes = set.rings.iter().map(|rings| (rings + 1).min(MOST)).collect();
    Ok(Limbs { posing, sizes, truth: Some(truth), view: View { yaw: 0.0, pitch: 0.0, roll: 0.0 }, pixels: 300 })
}

fn draw(into: &mut Folder, limbs: &Limbs, words: Words) -> Result<Figure, Failure> {
    let Limbs { posing, sizes, view, pixels, .. } = limbs;
    let mesh = &posing.mesh;
    let Words { number, prefix, title, claim, setup } = words;
    let mut entries = rivals(mesh.n_vertices());
    entries.push(ring("painted r", "painted", Rigidity::new(sizes.clone())?));
    let outcomes = contest::run(posing, entries)?;
    let verdicts = verdicts(limbs, &outcomes);
    let rest = mesh.positions();
    let surfaces: Vec<&[_]> = outcomes.iter().map(Outcome::positions).chain([rest]).collect();
    let stage = Stage::new(*view, *pixels, &surfaces);
    let shot = stage.shot(mesh, rest).with_handles(posing).with_rigidity(sizes, MOST);
    let first = Panel::new(into.picture(&format!("{prefix}-input"), &shot)?, "input, painted<br>blue 1, red 6");
    let list: Vec<_> = outcomes.iter().zip(&verdicts).map(|(o, verdict)| (o, verdict.caption())).collect();
    let mut panels = vec![first];
    panels.extend(contest::panels(into, prefix, &stage, posing, &list)?);
    let rows: Vec<Vec<String>> = outcomes.iter().zip(&verdicts).map(|(o, verdict)| verdict.row(o)).collect();
    let data = vec![into.csv(prefix, &header(limbs.truth.is_some()), &rows)?];
    let names: Vec<&str> = outcomes.iter().map(|o| o.name.as_str()).collect();
    let checks = checks(&names, &verdicts);
    Ok(Figure { number, title, claim, setup, rows: vec![panels], table: String::new(), checks, data })
}

/// The column of the table of a figure that has the bending of bones.
pub(crate) const BENDING: usize = 4;

/// The table's columns.
pub(crate) fn header(has_truth: bool) -> Vec<&'static str> {
    let mut header = vec![
        "method",
        "iterations",
        "crossings",
        "stretch of bones",
        "bending of bones",
        "bending of joints over bones",
        "volume ratio",
    ];
    header.extend(has_truth.then_some("distance from the pose"));
    header
}

/// What became of bones and joints.
pub(crate) struct Verdict {
    /// Means over the edges of bones.
    stretch: f64,
    bending: f64,
    /// Bending of joints over that of bones.
    at_joints: f64,
    /// That of all, over that at rest.
    volume: f64,
    /// Mean distance of a vertex from where it should be, in diagonals.
    distance: Option<f64>,
}

impl Verdict {
    pub(crate) fn caption(&self) -> String {
        match self.distance {
            Some(distance) => format!("{:.2} % off", 100.0 * distance),
            None => format!("bones bent by {:.2}°", self.bending),
        }
    }

    pub(crate) fn row(&self, outcome: &Outcome) -> Vec<String> {
        let counts = [outcome.bent.n_iterations().to_string(), outcome.crossings.to_string()];
        let numbers = [Some(self.stretch), Some(self.bending), Some(self.at_joints), Some(self.volume), self.distance];
        let numbers = numbers.into_iter().flatten().map(|number| format!("{number:.5}"));
        [outcome.name.clone()].into_iter().chain(counts).chain(numbers).collect()
    }
}

/// One for each outcome.
pub(crate) fn verdicts(limbs: &Limbs, outcomes: &[Outcome]) -> Vec<Verdict> {
    let mesh = &limbs.posing.mesh;
    let hinges = Hinges::new(mesh);
    let bones = hinges.within(|v| limbs.sizes[v] >= BONE);
    let joints = hinges.within(|v| limbs.sizes[v] <= JOINT);
    let of_outcome = |outcome: &Outcome| {
        let posed = outcome.positions();
        Verdict {
            stretch: bones.stretch(posed),
            bending: bones.bending(posed),
            at_joints: joints.bending(posed) / bones.bending(posed),
            volume: outcome.volume,
            distance: limbs.truth.as_ref().map(|truth| distance(mesh, posed, truth)),
        }
    };
    outcomes.iter().map(of_outcome).collect()
}

/// Two digits behind the point, more where they are needed.
fn short(value: f64) -> String {
    if value.abs() < 0.1 { format!("{value:.3}") } else { format!("{value:.2}") }
}

/// The last one is ours.
pub(crate) fn checks(names: &[&str], verdicts: &[Verdict]) -> Vec<Check> {
    let least = |claim: &str, unit: &str, value: &dyn Fn(&Verdict) -> f64| {
        let values: Vec<f64> = verdicts.iter().map(value).collect();
        let (ours, others) = values.split_last().expect("four methods");
        let listed: Vec<String> =
            others.iter().zip(names).map(|(x, name)| format!("{}{unit} with {name}", short(*x))).collect();
        let holds = others.iter().all(|other| ours < other);
        Check::new(claim, holds, format!("{}{unit} against {}", short(*ours), listed.join(", ")))
    };
    let mut checks = vec![
        least("Bones are bent less than with any other method", "°", &|verdict| verdict.bending),
        least("Bones are stretched less than with any other method", " %", &|verdict| 100.0 * verdict.stretch),
        least(
            "The bend is at the joints: bones have the smallest share of it (bending of bones over that of joints)",
            "",
            &|verdict| 1.0 / verdict.at_joints,
        ),
    ];
    if verdicts.iter().all(|verdict| verdict.distance.is_some()) {
        checks.push(least(
            "It comes nearest to the pose (mean distance of a vertex, in diagonals)",
            " %",
            &|verdict| 100.0 * verdict.distance.unwrap_or(f64::INFINITY),
        ));
    } else {
        checks.push(least("Volume stays nearest to that at rest", " % off", &|verdict| {
            100.0 * (verdict.volume - 1.0).abs()
        }));
    }
    checks
}

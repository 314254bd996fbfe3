//! Figures 12 to 14: r learned from poses, on poses that were not among them.

use std::ops::ControlFlow;
use std::sync::Arc;

use pliant_solver::{Analysis, EnergyTable, PoseLearner, Rigidity, Weights};

use super::contest::{self, Entry, Outcome, ring, rivals};
use super::limbs::{BENDING, Limbs, MOST, checks, header, of_set, verdicts};
use crate::failure::Failure;
use crate::measures::{Hinges, distance};
use crate::models::PoseSet;
use crate::page::{Check, Figure, Folder, Panel};
use crate::shots::{Stage, View};

/// ω in all of the paper's experiments.
const PAPER_OMEGA: f64 = 0.3;
/// Parts of the gecko that are held; between them everything is left to the method.
const FEET: [&str; 7] = ["pelvis", "head", "tail tip", "left forearm", "right forearm", "left shin", "right shin"];
const GECKO_VIEW: View = View { yaw: 40.0, pitch: -24.0, roll: 0.0 };
const FROM_ABOVE: View = View { yaw: 0.0, pitch: -70.0, roll: -90.0 };
/// Longer side of a picture.
const PIXELS: u32 = 300;

/// Figure 12: three poses of the gecko, learned from the others.
pub(crate) fn shapes(into: &mut Folder) -> Result<Figure, Failure> {
    const SHOWN: [(&str, &str, View); 3] = [
        ("stand", "fig12-stand", GECKO_VIEW),
        ("curl", "fig12-curl", FROM_ABOVE),
        ("step left", "fig12-step", FROM_ABOVE),
    ];
    let set = PoseSet::open("gecko")?;
    let poses: Vec<&str> =
        set.names.iter().map(String::as_str).filter(|name| SHOWN.iter().all(|(shown, ..)| shown != name)).collect();
    let table = energies(&set, &poses)?;
    let omega = table.auto_omega();
    let learned = table.learn(omega, 1..=MOST).rigidity;
    let rest = set.mesh.positions();
    let stage = Stage::new(FROM_ABOVE, PIXELS, &[rest]);
    let shot = stage.shot(&set.mesh, rest).with_rigidity(learned.as_slice(), MOST);
    let mut rows = vec![vec![Panel::new(into.picture("fig12-learned", &shot)?, "learned r: blue 1, red 6")]];
    let mut statements = found(&set, &table, omega);
    let mut numbers = Vec::new();
    for (pose, prefix, view) in SHOWN {
        let limbs = of_set(&set, pose, &FEET)?;
        let (panels, of_pose, lines) = against_rivals(into, &limbs, (prefix, view), vec![ours(&learned)])?;
        rows.push(panels);
        // Of four statements the first and the last say most; the numbers of all are in the table.
        let last = of_pose.len() - 1;
        let most = of_pose.into_iter().enumerate().filter(|(place, _)| [0, last].contains(place));
        statements.extend(most.map(|(_, check)| Check { claim: format!("*{pose}:* {}", check.claim), ..check }));
        numbers.extend(lines.into_iter().map(|mut line| {
            line[0] = format!("{pose}: {}", line[0]);
            line
        }));
    }
    Ok(Figure {
        number: "Figure 12",
        title: "r learned from poses",
        claim: "learned from 71 scans of a person, r is large on what is rigid and small at joints; on three deformations it \
                keeps what is rigid while joints bend, where ARAP, SR-ARAP and embedded deformation bend bones and distort joints.",
        setup: format!(
            "the gecko, r from 1 to 6 learned from the {} poses of its file that are not shown. ω = {omega:.4} is chosen from the poses, as \
             the program does by itself. Patches of pelvis, head, tail tip and feet are where the shown pose has them. Its truth is \
             known: what moves as one piece is bone, and the captions tell the mean distance of a vertex from its place.",
            poses.len()
        ),
        rows,
        table: String::new(),
        checks: statements,
        data: vec![into.csv("fig12", &header(true), &numbers)?],
    })
}

/// Figure 13: the gecko's r from few and from many poses.
pub(crate) fn numbers(into: &mut Folder) -> Result<Figure, Failure> {
    const POSE: &str = "stand";
    const HIND: [&str; 4] = ["left thigh", "left shin", "right thigh", "right shin"];
    const SHINS: [&str; 2] = ["left shin", "right shin"];
    let set = PoseSet::open("gecko")?;
    let all: Vec<&str> = set.names.iter().map(String::as_str).filter(|name| *name != POSE).collect();
    // In none of the first two does a knee bend.
    let some = ["look up", "scorpion", "step left", "wave", "curl"];
    let samples: [&[&str]; 3] = [&some[..2], &some, &all];
    let limbs = of_set(&set, POSE, &FEET)?;
    let knees = |r: &[u16]| {
        let of: Vec<u16> = (0..r.len()).filter(|&v| set.is_in_joint_of(v, &SHINS)).map(|v| r[v]).collect();
        of.iter().map(|&r| f64::from(r)).sum::<f64>() / of.len().max(1) as f64
    };
    let hinges = Hinges::new(&set.mesh);
    let legs = hinges.within(|v| set.is_in_bone(v, &HIND));
    let (mut sizes, mut entries) = (Vec::new(), Vec::new());
    for (poses, slug) in samples.into_iter().zip(["few", "some", "all"]) {
        let table = energies(&set, poses)?;
        let rigidity = table.learn(table.auto_omega(), 1..=MOST).rigidity;
        entries.push(ring(format!("{} poses", poses.len()), slug, rigidity.clone()));
        sizes.push(rigidity);
    }
    let outcomes = contest::run(&limbs.posing, entries)?;
    let truth = set.pose(POSE)?;
    let rest = set.mesh.positions();
    let flat = Stage::new(FROM_ABOVE, PIXELS, &[rest]);
    let surfaces: Vec<&[_]> = outcomes.iter().map(Outcome::positions).collect();
    let stage = Stage::new(GECKO_VIEW, PIXELS, &surfaces);
    let (mut maps, mut shapes, mut rows) = (Vec::new(), Vec::new(), Vec::new());
    let (mut bent, mut off, mut apart) = (Vec::new(), Vec::new(), Vec::new());
    for (outcome, rigidity) in outcomes.iter().zip(&sizes) {
        let (r, posed) = (rigidity.as_slice(), outcome.positions());
        let name = format!("fig13-{}", outcome.slug);
        let shot = flat.shot(&set.mesh, rest).with_rigidity(r, MOST);
        maps.push(Panel::new(
            into.picture(&format!("{name}-r"), &shot)?,
            format!("{}<br>mean r of knees {:.1}", outcome.name, knees(r)),
        ));
        let shot = stage.shot(&set.mesh, posed).with_handles(&limbs.posing);
        let (bending, distance) = (legs.bending(posed), 100.0 * distance(&set.mesh, posed, truth));
        shapes.push(Panel::new(into.picture(&name, &shot)?, format!("{}<br>{distance:.2} % off", outcome.name)));
        let differs = r.iter().zip(sizes[2].as_slice()).filter(|(a, b)| a.abs_diff(**b) > 1).count();
        let share = 100.0 * differs as f64 / r.len() as f64;
        rows.push(
            [outcome.name.clone()]
                .into_iter()
                .chain([knees(r), bending, distance, share].map(|x| format!("{x:.4}")))
                .collect(),
        );
        bent.push(bending);
        off.push(distance);
        apart.push(share);
    }
    let knee: Vec<f64> = sizes.iter().map(|rigidity| knees(rigidity.as_slice())).collect();
    let header = [
        "learned from",
        "mean r of knees",
        "bending of the hind legs' bones",
        "distance from the pose in %",
        "vertices whose r differs by more than 1 in %",
    ];
    Ok(Figure {
        number: "Figure 13",
        title: "how many poses it takes",
        claim: "learned from 7 of the 71 scans, joints that do not bend in them are missed and the bones of a leg bend instead; from \
                30 the sizes are much as from all, and the result is plausible.",
        setup: format!(
            "the gecko in the pose *{POSE}* as in figure 12, r learned from {} poses in which no knee bends (*look up*, *scorpion*), from \
             these and *step left*, *wave*, *curl*, and from all {} others.",
            samples[0].len(),
            all.len()
        ),
        rows: vec![maps, shapes],
        table: String::new(),
        checks: vec![
            Check::new(
                "From two poses the knees are missed, from all they are found (mean r inside them)",
                knee[0] > 3.0 && knee[2] < 2.0,
                format!("{:.1} and {:.1}", knee[0], knee[2]),
            ),
            Check::new(
                "Then the bones of the hind legs bend instead",
                bent[0] > 2.0 * bent[2],
                format!("by {:.2}° in the mean, against {:.2}° from all poses", bent[0], bent[2]),
            ),
            Check::new(
                "From five poses the sizes are nearly those from all (fewer than 5 % of the vertices differ by more than one ring)",
                apart[1] < 5.0,
                format!("{:.1} %; from two poses {:.1} %", apart[1], apart[0]),
            ),
            Check::new(
                "From five poses the result is as near to the pose as from all, within a tenth",
                off[1] < 1.1 * off[2],
                format!("{:.3} % against {:.3} % of the diagonal; from two poses {:.3} %", off[1], off[2], off[0]),
            ),
        ],
        data: vec![into.csv("fig13", &header, &rows)?],
    })
}

/// Figure 14: another set, and the same r everywhere besides.
pub(crate) fn uniform(into: &mut Folder) -> Result<Figure, Failure> {
    const POSE: &str = "cobra";
    const SAME: u16 = 3;
    let set = PoseSet::open("jointed-bar")?;
    let poses: Vec<&str> = set.names.iter().map(String::as_str).filter(|name| *name != POSE).collect();
    let table = energies(&set, &poses)?;
    let omega = table.auto_omega();
    let learned = table.learn(omega, 1..=MOST).rigidity;
    let rest = set.mesh.positions();
    let view = View { yaw: 16.0, pitch: -30.0, roll: 0.0 };
    let stage = Stage::new(view, PIXELS, &[rest]);
    let shot = stage.shot(&set.mesh, rest).with_rigidity(learned.as_slice(), MOST);
    let map = Panel::new(into.picture("fig14-learned", &shot)?, "learned r<br>blue 1, red 6");
    let limbs = of_set(&set, POSE, &["first", "third", "fifth"])?;
    let same = ring(format!("r = {SAME} everywhere"), "r03", Rigidity::uniform(set.mesh.n_vertices(), SAME));
    let (panels, mut statements, numbers) = against_rivals(into, &limbs, ("fig14", view), vec![same, ours(&learned)])?;
    statements.push(three_and_arap(&numbers));
    let mut all = found(&set, &table, omega);
    all.append(&mut statements);
    let (first, second) = panels.split_at(2);
    let rows = vec![[vec![map], first.to_vec()].concat(), second.to_vec()];
    Ok(Figure {
        number: "Figure 14",
        title: "learned r against the same r everywhere",
        claim: "on a horse, r = 3 everywhere keeps details better than ARAP, but bends what should be rigid and blends joints away; r \
                learned from poses does neither.",
        setup: format!(
            "the bar of five stiff pieces, r learned from the {} poses of its file other than *{POSE}* (ω = {omega:.4}, chosen from them). \
             Patches of the first, third and fifth piece are where *{POSE}* has them.",
            poses.len()
        ),
        rows,
        table: String::new(),
        checks: all,
        data: vec![into.csv("fig14", &header(true), &numbers)?],
    })
}

/// Whether the bones of the fourth row are bent less than those of the first, which is ARAP's.
fn three_and_arap(rows: &[Vec<String>]) -> Check {
    let bending = |row: usize| rows[row][BENDING].parse::<f64>().unwrap_or(f64::NAN);
    let (arap, same) = (bending(0), bending(3));
    Check::new("r = 3 everywhere bends bones less than ARAP", same < arap, format!("{same:.2}° against {arap:.2}°"))
}

fn ours(learned: &Rigidity) -> Entry {
    ring("learned r", "ours", learned.clone())
}

/// Mean energies of some poses.
fn energies(set: &PoseSet, poses: &[&str]) -> Result<EnergyTable, Failure> {
    let analysis = Arc::new(Analysis::new(set.mesh.clone(), Weights::default()));
    let mut progress = |_| ControlFlow::Continue(());
    let ControlFlow::Continue(mut learner) = PoseLearner::new(analysis, 1..=MOST, &mut progress)? else {
        unreachable!("nobody stops it");
    };
    for pose in poses {
        learner.add(set.pose(pose)?)?;
    }
    Ok(learner.table()?)
}

/// Whether bones come out stiff and joints soft, and what the paper's ω does.
fn found(set: &PoseSet, table: &EnergyTable, omega: f64) -> Vec<Check> {
    let share = |r: &[u16], of: &dyn Fn(usize) -> bool, wanted: &dyn Fn(u16) -> bool| {
        let of: Vec<usize> = (0..r.len()).filter(|&v| of(v)).collect();
        100.0 * of.iter().filter(|&&v| wanted(r[v])).count() as f64 / of.len().max(1) as f64
    };
    let shares = |omega: f64| {
        let learned = table.learn(omega, 1..=MOST).rigidity;
        let r = learned.as_slice();
        // Whose whole neighborhood is one bone, and who is inside a joint.
        let stiff = share(r, &|v| set.rings[v] > MOST, &|r| r >= 5);
        [stiff, share(r, &|v| set.bone[v].is_none(), &|r| r <= 2)]
    };
    let check = |claim: String, [stiff, soft]: [f64; 2]| {
        let text =
            format!("{stiff:.0} % of the vertices deep in bones have r ≥ 5, {soft:.0} % of those in joints r ≤ 2");
        Check::new(claim, stiff >= 95.0 && soft >= 90.0, text)
    };
    vec![
        check(format!("Bones are found stiff and joints soft with ω = {omega:.4}"), shares(omega)),
        check(format!("The paper's ω = {PAPER_OMEGA} finds bones stiff and joints soft, too"), shares(PAPER_OMEGA)),
    ]
}

/// What a contest adds to a figure: pictures, statements, rows of numbers.
type Parts = (Vec<Panel>, Vec<Check>, Vec<Vec<String>>);

/// The other methods, then some of ours, the last of which the statements are about.
fn against_rivals(
    into: &mut Folder,
    limbs: &Limbs,
    (prefix, view): (&str, View),
    more: Vec<Entry>,
) -> Result<Parts, Failure> {
    let entries = rivals(limbs.posing.mesh.n_vertices()).into_iter().chain(more).collect();
    let outcomes = contest::run(&limbs.posing, entries)?;
    let verdicts = verdicts(limbs, &outcomes);
    let surfaces: Vec<&[_]> = outcomes.iter().map(Outcome::positions).collect();
    let stage = Stage::new(view, PIXELS, &surfaces);
    let list: Vec<_> = outcomes.iter().zip(&verdicts).map(|(o, verdict)| (o, verdict.caption())).collect();
    let panels = contest::panels(into, prefix, &stage, &limbs.posing, &list)?;
    let names: Vec<&str> = outcomes.iter().map(|o| o.name.as_str()).collect();
    let rows = outcomes.iter().zip(&verdicts).map(|(o, verdict)| verdict.row(o)).collect();
    Ok((panels, checks(&names, &verdicts), rows))
}

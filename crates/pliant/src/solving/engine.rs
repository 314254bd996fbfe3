//! The solver as the worker holds it: compares each wish with what it has and does the least that is needed.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use pliant_geometry::VertexNormals;
use pliant_solver::{Analysis, LooseComponents, Neighborhoods, SolveError, Solver, Start, StepReport, VertexId};

use super::{SolveReport, SolveRequest, SolveState};
use crate::document::{Group, Pose, held_by};
use crate::viewport::SurfaceFrame;

/// Relative decrease of the energy below which the surface counts as at rest. The paper's γ is 1e-3 for a result; a
/// thousandth of that is below what can be seen on a screen (by eye).
const SETTLED_BELOW: f64 = 1e-6;
/// That many quiet iterations in a row settle it: a single one may be a pause on a slope.
const QUIET_ITERATIONS: u32 = 5;
/// Targets that jump farther than this fraction of the bounding box's diagonal are a new start, not a drag (by eye:
/// a fast mouse moves a tenth of the window in a frame).
const JUMP_FRACTION: f64 = 0.25;
/// Energies kept for the plot.
const PLOTTED_ENERGIES: usize = 300;
/// Iteration times of which the median is shown.
const TIMED_ITERATIONS: usize = 32;

/// A prepared solver and the wish it was prepared for.
pub struct Engine {
    wish: SolveRequest,
    analysis: Arc<Analysis>,
    solver: Option<Solver>,
    held: Vec<VertexId>,
    targets: Vec<DVec3>,
    normals: VertexNormals,
    state: SolveState,
    /// Whether the pose is anything but the rest pose to the last bit. Iterating at rest would only add rounding.
    is_bent: bool,
    /// Whether the pose has changed since it was last reported.
    is_pose_new: bool,
    quiet: u32,
    last: StepReport,
    energies: VecDeque<f64>,
    times_ms: VecDeque<f64>,
}

impl Engine {
    /// Analyzes the mesh of the wish and prepares for it. Seconds on a large mesh.
    pub fn new(wish: SolveRequest) -> Engine {
        let model = wish.model.clone();
        let mut engine = Engine {
            analysis: Arc::new(Analysis::new(model.mesh.clone(), wish.weights)),
            normals: VertexNormals::new(model.mesh.n_vertices(), &model.triangles),
            solver: None,
            held: Vec::new(),
            targets: Vec::new(),
            state: SolveState::Resting,
            is_bent: false,
            is_pose_new: false,
            quiet: 0,
            last: StepReport { energy: 0.0, iteration: 0, relative_decrease: 0.0 },
            energies: VecDeque::new(),
            times_ms: VecDeque::new(),
            wish: wish.clone(),
        };
        engine.rebuild(wish);
        engine
    }

    /// Whether another wish concerns the same mesh and weights, so that the analysis serves.
    pub fn serves(&self, wish: &SolveRequest) -> bool {
        Arc::ptr_eq(&self.wish.model, &wish.model) && self.wish.weights == wish.weights
    }

    /// Whether `adopt` would have to build neighborhoods or factor: worth telling the user before.
    pub fn must_refactor(&self, wish: &SolveRequest) -> bool {
        self.solver.is_none() || self.wish.rigidity != wish.rigidity || !same_held(&self.wish.groups, &wish.groups)
    }

    /// Turns to a new wish for the same mesh and weights with the least work.
    pub fn adopt(&mut self, wish: SolveRequest) {
        debug_assert!(self.serves(&wish), "another mesh or other weights need a new engine");
        let jumped = wish.epoch != self.wish.epoch;
        let relaxed = self.wish.loose != wish.loose;
        let Some(solver) = self.solver.as_mut().filter(|_| !relaxed && !wish.groups.is_empty()) else {
            return self.rebuild(wish);
        };
        let (held, targets) = held_by(&wish.groups);
        let outcome = (|| -> Result<bool, SolveError> {
            let mut changed = jumped;
            if jumped {
                solver.set_pose(&wish.pose.positions)?;
                self.is_bent = !is_rest(&wish);
                self.is_pose_new = true;
            }
            if wish.rigidity != self.wish.rigidity {
                solver.set_rigidity(&wish.rigidity)?;
                changed = true;
            }
            if held != self.held {
                solver.set_held(&held)?;
                self.held = held;
                solver.set_targets(&targets)?;
                changed = true;
            } else if targets != self.targets {
                let diagonal = f64::from(wish.model.diagonal());
                let leap = farthest(&self.targets, &targets) > JUMP_FRACTION * diagonal;
                solver.set_targets(&targets)?;
                if leap && !jumped {
                    solver.start(Start::Auto);
                    self.is_bent = true;
                }
                changed = true;
            }
            Ok(changed)
        })();
        self.targets = targets;
        match outcome {
            Ok(true) => self.go_on(&wish),
            Ok(false) => {}
            Err(error) => self.fail(&error),
        }
        if jumped {
            self.energies.clear();
        }
        self.wish = wish;
    }

    fn rebuild(&mut self, wish: SolveRequest) {
        self.solver = None;
        self.energies.clear();
        self.state = SolveState::Resting;
        let (held, targets) = held_by(&wish.groups);
        if !held.is_empty() {
            match self.build(&wish, &held, &targets) {
                Ok(solver) => {
                    self.solver = Some(solver);
                    self.is_bent = !is_rest(&wish);
                    self.go_on(&wish);
                }
                Err(error) => self.fail(&error),
            }
        }
        (self.held, self.targets, self.wish) = (held, targets, wish);
    }

    fn build(&self, wish: &SolveRequest, held: &[VertexId], targets: &[DVec3]) -> Result<Solver, SolveError> {
        let neighborhoods = Neighborhoods::new(&self.analysis, &wish.rigidity)?;
        let mut solver = Solver::new(self.analysis.clone(), neighborhoods, &wish.rigidity, held, wish.loose)?;
        solver.set_pose(&wish.pose.positions)?;
        solver.set_targets(targets)?;
        Ok(solver)
    }

    /// After a change: iterates again, unless nothing is bent.
    fn go_on(&mut self, wish: &SolveRequest) {
        self.quiet = 0;
        self.state = SolveState::Iterating;
        if !self.is_bent && holds_at_rest(wish) {
            self.state = SolveState::Settled;
            self.energies.clear();
        }
    }

    fn fail(&mut self, error: &SolveError) {
        self.solver = None;
        self.state = SolveState::Failed(error.to_string());
    }

    /// Whether another iteration is worth while.
    pub fn is_busy(&self) -> bool {
        self.state == SolveState::Iterating
    }

    /// One local/global iteration.
    pub fn step(&mut self) {
        let Some(solver) = &mut self.solver else {
            return;
        };
        let start = Instant::now();
        self.last = solver.step();
        (self.is_bent, self.is_pose_new) = (true, true);
        remember(&mut self.times_ms, TIMED_ITERATIONS, start.elapsed().as_secs_f64() * 1e3);
        remember(&mut self.energies, PLOTTED_ENERGIES, self.last.energy);
        let is_quiet = self.last.energy == 0.0 || self.last.relative_decrease < SETTLED_BELOW;
        self.quiet = if is_quiet { self.quiet + 1 } else { 0 };
        if self.quiet >= QUIET_ITERATIONS {
            self.state = SolveState::Settled;
        }
    }

    /// Where things stand, with the surface ready for the picture unless it is as last reported.
    pub fn report(&mut self) -> SolveReport {
        let is_new = std::mem::take(&mut self.is_pose_new);
        let solver = self.solver.as_ref().filter(|_| is_new);
        let pose = solver.map(|solver| Pose { positions: solver.positions().into() });
        let frame = pose.as_ref().map(|pose| Arc::new(self.frame(pose)));
        let wants = self.wish.wants_vertex_energies;
        SolveReport {
            model: self.wish.model.clone(),
            revision: self.wish.revision,
            epoch: self.wish.epoch,
            state: self.state.clone(),
            frame,
            pose,
            energy: self.last.energy,
            iteration: self.last.iteration,
            relative_decrease: self.last.relative_decrease,
            iteration_ms: median(&self.times_ms),
            energies: self.energies.iter().copied().collect(),
            vertex_energies: self.solver.as_ref().filter(|_| wants).map(|solver| scaled(&solver.vertex_energies())),
            remarks: self.remarks(),
        }
    }

    /// View-space positions and normals of a pose of this engine's mesh.
    pub fn frame(&self, pose: &Pose) -> SurfaceFrame {
        let model = &self.wish.model;
        let positions: Vec<_> = pose.positions.iter().map(|&p| model.to_view(p)).collect();
        let mut normals = Vec::new();
        self.normals.compute(&positions, &model.triangles, &mut normals);
        SurfaceFrame { positions, normals }
    }

    fn remarks(&self) -> Vec<String> {
        let Some(solver) = &self.solver else { return Vec::new() };
        let (they, it) = match self.wish.loose {
            LooseComponents::KeepAtRest => ("stay", "stays"),
            LooseComponents::FollowNearest => ("follow the nearest", "follows the nearest"),
        };
        match solver.loose_components() {
            [] => Vec::new(),
            [(n, _)] => vec![format!("a part of {n} vertices has no handle and {it}")],
            parts => vec![format!("{} parts have no handle and {they}", parts.len())],
        }
    }
}

fn is_rest(wish: &SolveRequest) -> bool {
    *wish.pose.positions == *wish.model.mesh.positions()
}

/// Whether every held vertex is held at rest. The first target that moved ends the search.
fn holds_at_rest(wish: &SolveRequest) -> bool {
    let rest = wish.model.mesh.positions();
    wish.groups.iter().all(|group| group.vertices.iter().zip(group.targets()).all(|(v, p)| p == rest[v.index()]))
}

fn same_held(a: &[Group], b: &[Group]) -> bool {
    a.iter().flat_map(|group| group.vertices.iter()).eq(b.iter().flat_map(|group| group.vertices.iter()))
}

fn farthest(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).fold(0.0, f64::max).sqrt()
}

fn remember(queue: &mut VecDeque<f64>, keep: usize, value: f64) {
    if queue.len() == keep {
        queue.pop_front();
    }
    queue.push_back(value);
}

fn median(values: &VecDeque<f64>) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

/// Divides by the 99th percentile, so that one bad vertex does not turn all others blue.
fn scaled(values: &[f64]) -> Arc<[f32]> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let top = sorted.get(sorted.len().saturating_mul(99) / 100).copied().unwrap_or(0.0).max(f64::MIN_POSITIVE);
    values.iter().map(|&value| (value / top).clamp(0.0, 1.0) as f32).collect()
}

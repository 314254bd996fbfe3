//! The document: model, scene, pose and history in one place, with the rules that keep them together.

use std::sync::Arc;

use glam::DVec3;

use super::commands::{Command, CommandError, Surroundings, changed};
use super::{GroupId, History, Model, Scene, Snapshot, poses};

/// World positions of all surface points at one moment. Cheap to clone.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// One position a surface point.
    pub positions: Arc<[DVec3]>,
}

/// Iterations that go on move a surface that was nearly settled by less, in diagonals of it (by eye).
const DRIFT: f64 = 1e-2;

/// What is being edited.
///
/// Two counters order the talk with the solver. The *revision* goes up with everything that matters to it; the *epoch*
/// goes up when the pose jumps (undo, redo, cancel, reset), so that positions computed before the jump can be told from those after it.
pub struct Document {
    model: Arc<Model>,
    scene: Scene,
    pose: Pose,
    history: History,
    /// State before the open step, and its name.
    open_step: Option<(&'static str, Snapshot)>,
    next_group: u32,
    revision: u64,
    epoch: u64,
    /// What is on disk; nothing when this was recovered and is nowhere yet.
    saved: Option<Snapshot>,
    /// Whether the surface has jumped elsewhere than it was saved; known only while the scene is as it was saved.
    is_elsewhere: bool,
}

impl Document {
    /// A freshly opened model at rest.
    pub fn new(model: Arc<Model>) -> Document {
        let scene = Scene::new(&model);
        let pose = Pose { positions: model.mesh.positions().into() };
        Document {
            scene: scene.clone(),
            pose: pose.clone(),
            history: History::default(),
            open_step: None,
            next_group: 1,
            revision: 0,
            epoch: 0,
            saved: Some(Snapshot { scene, pose }),
            is_elsewhere: false,
            model,
        }
    }

    /// A document that was saved and is opened again. `snapshot` must fit the model: as many numbers as it has points.
    pub fn reopened(model: Arc<Model>, snapshot: Snapshot, next_group: u32) -> Document {
        let fresh = Document::new(model);
        let Snapshot { scene, pose } = snapshot.clone();
        Document { scene, pose, next_group, saved: Some(snapshot), ..fresh }
    }

    /// The opened mesh.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// What the user laid over it.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Where its surface is now.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// What can be undone and redone.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Whether a drag or stroke is under way.
    pub fn in_step(&self) -> bool {
        self.open_step.is_some()
    }

    /// Whether something would be lost that a save now would write: anything but the selection and which handle is active.
    pub fn is_modified(&self) -> bool {
        let Some(saved) = &self.saved else { return true };
        self.is_elsewhere || !saved.scene.is_alike(&self.scene)
    }

    /// Notes what is on disk.
    pub fn mark_saved(&mut self, saved: Snapshot) {
        self.saved = Some(saved);
        self.compare_pose();
    }

    /// Notes that nothing of this is on disk.
    pub fn mark_unsaved(&mut self) {
        self.saved = None;
    }

    /// Finds out whether the surface has jumped since it was saved, as a reset pose does. That iterations go on does not count:
    /// they go on from a project that is opened again, too.
    fn compare_pose(&mut self) {
        let Some(saved) = &self.saved else { return };
        let (then, now) = (&saved.pose.positions, &self.pose.positions);
        let limit = DRIFT * f64::from(self.model.diagonal());
        self.is_elsewhere = !Arc::ptr_eq(then, now)
            && saved.scene.is_alike(&self.scene)
            && then.iter().zip(now.iter()).any(|(a, b)| a.distance(*b) > limit);
    }

    /// The current state, cheap.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { scene: self.scene.clone(), pose: self.pose.clone() }
    }

    /// Carries out a command; refused ones leave everything as it was.
    pub fn apply(&mut self, command: Command) -> Result<(), CommandError> {
        match command {
            Command::Begin(name) => {
                self.commit();
                self.open_step = Some((name, self.snapshot()));
            }
            Command::Commit => self.commit(),
            Command::Cancel => self.cancel(),
            command => self.change(command)?,
        }
        Ok(())
    }

    fn change(&mut self, command: Command) -> Result<(), CommandError> {
        let name = command.name();
        let is_step = !matches!(command, Command::Activate(_) | Command::ActivateSeveral(_));
        let resets = command == Command::ResetPose;
        let rest = self.model.mesh.positions();
        let (next, shown) = match command {
            Command::Poses(change) => poses::changed(&self.scene, change, &self.pose)?,
            command => {
                let around = Surroundings { now: &self.pose.positions, rest, next_group: &mut self.next_group };
                (changed(&self.scene, command, around)?, None)
            }
        };
        // Positions that the solver is about to report may be bent although these are not.
        let moves_surface = resets && (next != self.scene || *self.pose.positions != *rest);
        let shown = shown.filter(|pose| next != self.scene || *pose != self.pose);
        if next == self.scene && !moves_surface && shown.is_none() {
            return Ok(());
        }
        if is_step && self.open_step.is_none() {
            self.history.push(name, self.snapshot());
        }
        self.revision += u64::from(!next.solves_like(&self.scene));
        self.scene = next;
        if moves_surface {
            self.jump_to(Pose { positions: self.model.mesh.positions().into() });
        }
        if let Some(pose) = shown {
            self.jump_to(pose);
        }
        Ok(())
    }

    fn commit(&mut self) {
        if let Some((name, before)) = self.open_step.take()
            && before.scene != self.scene
        {
            self.history.push(name, before);
        }
    }

    fn cancel(&mut self) {
        if let Some((_, before)) = self.open_step.take()
            && (before.scene != self.scene)
        {
            self.restore(before);
        }
    }

    /// Takes back the newest step (an open one is canceled instead) and tells its name.
    pub fn undo(&mut self) -> Option<&'static str> {
        if let Some((name, _)) = self.open_step {
            self.cancel();
            return Some(name);
        }
        let now = self.snapshot();
        let (name, before) = self.history.undo(now)?;
        self.restore(before);
        Some(name)
    }

    /// Makes the newest undone step again and tells its name.
    pub fn redo(&mut self) -> Option<&'static str> {
        self.commit();
        let now = self.snapshot();
        let (name, after) = self.history.redo(now)?;
        self.restore(after);
        Some(name)
    }

    fn restore(&mut self, snapshot: Snapshot) {
        self.scene = snapshot.scene;
        self.revision += 1;
        self.jump_to(snapshot.pose);
    }

    /// Goes to the state after the first `n` steps of the history; an open step is canceled first. Whether anything changed.
    pub fn jump(&mut self, n: usize) -> bool {
        self.cancel();
        let state = self.history.jump(n, self.snapshot());
        let changed = state.is_some();
        state.into_iter().for_each(|state| self.restore(state));
        changed
    }

    /// Changes how many bytes the history may take.
    pub fn set_history_budget(&mut self, bytes: usize) {
        self.history.set_budget(bytes);
    }

    fn jump_to(&mut self, pose: Pose) {
        self.epoch += 1;
        self.revision += 1;
        self.pose = pose;
        self.compare_pose();
    }

    /// Makes the current state the one that undo ends at.
    pub fn forget_history(&mut self) {
        self.history = History::default();
        self.mark_saved(self.snapshot());
    }

    /// The id that the next placed group will have.
    pub fn next_group(&self) -> GroupId {
        GroupId(self.next_group)
    }

    /// Goes up with everything that matters to the solver.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Goes up with every jump of the pose.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// Takes over the solver's positions unless they belong to another model or to a time before the last jump.
    /// Answers to an older revision of the same epoch are welcome: during a drag they always are a little late.
    pub fn accept(&mut self, model: &Arc<Model>, epoch: u64, pose: Option<&Pose>) -> bool {
        let current = Arc::ptr_eq(model, &self.model) && epoch == self.epoch;
        if current && let Some(pose) = pose {
            self.pose = pose.clone();
        }
        current
    }
}

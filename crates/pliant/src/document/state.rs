//! The document: model, scene, pose and history in one place, with the rules that keep them together.

use std::sync::Arc;

use glam::DVec3;

use super::commands::{Command, CommandError, Surroundings, changed};
use super::{GroupId, History, Model, Scene, Snapshot};

/// World positions of all surface points at one moment. Cheap to clone.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// One position a surface point.
    pub positions: Arc<[DVec3]>,
}

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
    saved: Snapshot,
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
            saved: Snapshot { scene, pose },
            model,
        }
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

    /// Whether a save now would write something that the last one did not.
    pub fn is_modified(&self) -> bool {
        !Arc::ptr_eq(&self.saved.pose.positions, &self.pose.positions) && self.saved.pose != self.pose
            || self.saved.scene.rigidity != self.scene.rigidity
    }

    /// Notes that the current state is on disk.
    pub fn mark_saved(&mut self, saved: Snapshot) {
        self.saved = saved;
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
        let around = Surroundings { now: &self.pose.positions, rest, next_group: &mut self.next_group };
        let next = changed(&self.scene, command, around)?;
        // Positions that the solver is about to report may be bent although these are not.
        let moves_surface = resets && (next != self.scene || *self.pose.positions != *rest);
        if next == self.scene && !moves_surface {
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

    fn jump_to(&mut self, pose: Pose) {
        self.epoch += 1;
        self.revision += 1;
        self.pose = pose;
    }

    /// Makes the current state the one that undo ends at.
    pub fn forget_history(&mut self) {
        self.history = History::default();
        self.saved = self.snapshot();
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

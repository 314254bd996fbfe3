//! Playing kept poses: a view of the surface, which changes nothing of the document and ends with the first edit.

use std::sync::Arc;

use super::Session;
use crate::document::KeptPose;
use crate::editor::NoticeKind;
use crate::posing::{self, Frames, Player, Repeat};
use crate::solving::SolveRequest;
use crate::viewport::SurfaceFrame;

/// Seconds from one pose to the next, unless others are chosen (by eye).
const SECONDS: f64 = 1.0;

/// The play under way, and how the next one will go.
pub(super) struct Playing {
    player: Option<(Player, Source)>,
    repeat: Repeat,
    seconds: f64,
}

/// What a play was made of: it ends when that changes.
struct Source {
    revision: u64,
    poses: Arc<[KeptPose]>,
}

impl Default for Playing {
    fn default() -> Playing {
        Playing { player: None, repeat: Repeat::default(), seconds: SECONDS }
    }
}

impl Session {
    /// The play, while there is one.
    pub fn player(&self) -> Option<&Player> {
        self.playing.player.as_ref().map(|(player, _)| player)
    }

    /// Why nothing can be played now, if so.
    pub fn play_obstacle(&self) -> Option<&'static str> {
        match self.poses().len() {
            0 | 1 => Some("Keep two poses or more to play between them"),
            _ if self.compare.is_some() => Some("Close the comparison of methods first"),
            _ if self.learning.is_some() => Some("Close the panel in which rigidity is learned first"),
            _ => None,
        }
    }

    /// Begins to play, or stops where it is and goes on.
    pub fn toggle_play(&mut self) {
        if let Some(player) = self.ready_player() {
            player.toggle();
        }
    }

    /// Shows a place of the play: 0 is the first pose, 1 the second, and so on.
    pub fn seek(&mut self, position: f64) {
        if let Some(player) = self.ready_player() {
            player.seek(position);
        }
    }

    /// Back to the document's own surface.
    pub fn stop_playing(&mut self) {
        self.playing.player = None;
    }

    /// What comes behind the last pose, and the seconds from one to the next.
    pub fn pace(&self) -> (Repeat, f64) {
        (self.playing.repeat, self.playing.seconds)
    }

    /// Changes them.
    pub fn set_pace(&mut self, repeat: Repeat, seconds: f64) {
        let seconds = seconds.clamp(*Player::SECONDS.start(), *Player::SECONDS.end());
        let was_closed = std::mem::replace(&mut self.playing.repeat, repeat).is_closed();
        self.playing.seconds = seconds;
        if was_closed != repeat.is_closed() {
            self.play_anew();
        } else if let Some((player, _)) = &mut self.playing.player {
            (player.repeat, player.seconds) = (repeat, seconds);
        }
    }

    /// Goes on where the play is, with other surfaces.
    fn play_anew(&mut self) {
        let Some((before, _)) = self.playing.player.take() else { return };
        if let Some(player) = self.ready_player() {
            player.seek(before.position());
            if before.is_playing() {
                player.toggle();
            }
        }
    }

    /// The last place that can be shown: counted as poses are, from 0.
    pub fn last_place(&self) -> f64 {
        let n = self.poses().len();
        (if self.playing.repeat.is_closed() { n } else { n.saturating_sub(1) }) as f64
    }

    /// Lets time pass; whether the picture moves.
    pub fn advance_play(&mut self, seconds: f64) -> bool {
        let Some((player, _)) = &mut self.playing.player else { return false };
        player.advance(seconds);
        player.is_playing()
    }

    /// The surface of the play, which is shown in place of the document's.
    pub fn played(&self) -> Option<Arc<SurfaceFrame>> {
        self.player()?.surface()
    }

    /// The play ends when what it was made of has changed.
    pub(super) fn check_play(&mut self) {
        let Some((_, source)) = &self.playing.player else { return };
        let is_same = self.document().is_some_and(|document| {
            document.revision() == source.revision && Arc::ptr_eq(&document.scene().poses, &source.poses)
        });
        if !is_same || self.play_obstacle().is_some() {
            self.stop_playing();
        }
    }

    fn ready_player(&mut self) -> Option<&mut Player> {
        if self.play_obstacle().is_some() {
            return None;
        }
        if self.playing.player.is_none() {
            self.cancel_tool();
            let document = self.document()?;
            let (poses, revision) = (document.scene().poses.clone(), document.revision());
            let template = SolveRequest::of(document, None);
            let ground = self.status.report.as_ref().and_then(|report| report.ground.upgrade());
            let wake = self.wake.clone();
            let closed = self.playing.repeat.is_closed();
            let source = posing::Source { poses: poses.clone(), template, ground, closed };
            match Frames::start(source, move || wake()) {
                Ok(frames) => {
                    let player = Player::new(frames, self.playing.repeat, self.playing.seconds);
                    self.playing.player = Some((player, Source { revision, poses }));
                }
                Err(error) => {
                    self.notices.push(NoticeKind::Error, format!("No thread to play with could be started: {error}"));
                }
            }
        }
        self.playing.player.as_mut().map(|(player, _)| player)
    }
}

//! Where a play is in time.

use std::sync::Arc;

use super::Frames;
use crate::viewport::SurfaceFrame;

/// What comes behind the last pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Repeat {
    /// The first one.
    #[default]
    Loop,
    /// The way back.
    PingPong,
    /// Nothing.
    Once,
}

impl Repeat {
    /// All, in the order of menus.
    pub const ALL: [Repeat; 3] = [Repeat::Loop, Repeat::PingPong, Repeat::Once];

    /// Its name.
    pub fn label(self) -> &'static str {
        match self {
            Repeat::Loop => "Loop",
            Repeat::PingPong => "Back and forth",
            Repeat::Once => "Once",
        }
    }
}

/// A play of kept poses: a view of the surface, which changes nothing of the document.
pub struct Player {
    frames: Frames,
    /// In surfaces, from 0.
    at: f64,
    is_playing: bool,
    is_returning: bool,
    /// What comes behind the last pose.
    pub repeat: Repeat,
    /// From one pose to the next.
    pub seconds: f64,
}

impl Player {
    /// How long a pose may take to the next one.
    pub const SECONDS: std::ops::RangeInclusive<f64> = 0.1..=10.0;

    /// At the first pose, not yet playing.
    pub fn new(frames: Frames, repeat: Repeat, seconds: f64) -> Player {
        Player { frames, at: 0.0, is_playing: false, is_returning: false, repeat, seconds }
    }

    /// Its surfaces.
    pub fn frames(&self) -> &Frames {
        &self.frames
    }

    /// Whether time goes on.
    pub fn is_playing(&self) -> bool {
        self.is_playing
    }

    /// Lets time go on, or stops it; at the end it begins anew.
    pub fn toggle(&mut self) {
        self.is_playing = !self.is_playing;
        if self.is_playing && self.repeat == Repeat::Once && self.at >= self.end() {
            self.at = 0.0;
        }
    }

    /// Where it is: 0 at the first pose, 1 at the second, and so on.
    pub fn position(&self) -> f64 {
        self.at / self.frames.per_pose() as f64
    }

    /// The last position.
    pub fn last_position(&self) -> f64 {
        self.end() / self.frames.per_pose() as f64
    }

    /// Goes to a position and stays there.
    pub fn seek(&mut self, position: f64) {
        self.is_playing = false;
        self.at = (position * self.frames.per_pose() as f64).clamp(0.0, self.end());
    }

    fn end(&self) -> f64 {
        self.frames.len().saturating_sub(1) as f64
    }

    /// Lets so many seconds pass.
    pub fn advance(&mut self, seconds: f64) {
        let end = self.end();
        if !self.is_playing || end <= 0.0 {
            return;
        }
        let way = seconds.max(0.0) * self.frames.per_pose() as f64 / self.seconds.max(*Player::SECONDS.start());
        match self.repeat {
            Repeat::Once => {
                self.at = (self.at + way).min(end);
                self.is_playing = self.at < end;
            }
            Repeat::Loop => {
                // The last pose is seen as long as any other surface before the first comes again.
                self.at = (self.at + way) % (end + 1.0);
            }
            Repeat::PingPong => {
                let round = if self.is_returning { 2.0 * end - self.at } else { self.at };
                let round = (round + way) % (2.0 * end);
                self.is_returning = round > end;
                self.at = if self.is_returning { 2.0 * end - round } else { round };
            }
        }
    }

    /// The surface to show now: no two are blended.
    pub fn surface(&self) -> Option<Arc<SurfaceFrame>> {
        self.frames.surface(self.at.round().min(self.end()) as usize)
    }
}

//! Where a play is in time.

use std::sync::Arc;

use super::Frames;
use crate::viewport::SurfaceFrame;

/// What comes behind the last pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Repeat {
    /// The way from it to the first one.
    #[default]
    Loop,
    /// The first one, at once.
    Restart,
    /// The way back.
    PingPong,
    /// Nothing.
    Once,
}

impl Repeat {
    /// All, in the order of menus.
    pub const ALL: [Repeat; 4] = [Repeat::Loop, Repeat::Restart, Repeat::PingPong, Repeat::Once];

    /// Its name.
    pub fn label(self) -> &'static str {
        match self {
            Repeat::Loop => "Loop",
            Repeat::Restart => "Start over",
            Repeat::PingPong => "Back and forth",
            Repeat::Once => "Once",
        }
    }

    /// One sentence more.
    pub fn tooltip(self) -> &'static str {
        match self {
            Repeat::Loop => "On from the last pose to the first, solved as between any two",
            Repeat::Restart => "From the last pose at once to the first",
            Repeat::PingPong => "The way back to the first pose",
            Repeat::Once => "Stop at the last pose",
        }
    }

    /// Whether there is a way from the last pose to the first.
    pub fn is_closed(self) -> bool {
        self == Repeat::Loop
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

    /// Goes to a position and stays there.
    pub fn seek(&mut self, position: f64) {
        self.is_playing = false;
        self.at = (position * self.frames.per_pose() as f64).clamp(0.0, self.end());
    }

    /// The last place, in surfaces: in a loop it is the first one again.
    fn end(&self) -> f64 {
        self.frames.len().saturating_sub(usize::from(!self.repeat.is_closed())) as f64
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
            Repeat::Loop => self.at = (self.at + way) % end,
            Repeat::Restart => {
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
        let number = self.at.round().min(self.end()) as usize;
        self.frames.surface(number % self.frames.len().max(1))
    }
}

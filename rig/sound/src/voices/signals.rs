//! Chimes that tell people of the session: who has the car now, what the car must not do, that the run is over.

use crate::dsp::{Glide, Phase};
use crate::heard::Cue;

/// A note: hertz, and seconds from its begin to the next.
type Note = (f32, f32);

const TAKEOVER: &[Note] = &[(660.0, 0.12), (880.0, 0.12), (1175.0, 0.25)];
const ENDED: &[Note] = &[(660.0, 0.16), (440.0, 0.35)];
const WARNING: &[Note] = &[(988.0, 0.09), (0.0, 0.05), (988.0, 0.09)];
const LEVEL: f32 = 0.16;
const FOLLOWS_S: f32 = 0.008;

/// Plays one chime at a time: one that matters more cuts the other short.
#[derive(Clone, Debug, Default)]
pub struct Signals {
    notes: &'static [Note],
    rank: u8,
    played_s: f32,
    level: Glide,
    hz: f32,
    phase: Phase,
}

impl Signals {
    pub fn hear(&mut self, cues: &[Cue]) {
        let chimes = cues.iter().filter_map(|cue| match cue {
            Cue::Takeover => Some((3, TAKEOVER)),
            Cue::Ended => Some((2, ENDED)),
            Cue::Warning => Some((1, WARNING)),
            Cue::Impact(_) | Cue::Kerb => None,
        });
        for (rank, notes) in chimes {
            if self.notes.is_empty() || rank > self.rank {
                (self.rank, self.notes, self.played_s) = (rank, notes, 0.0);
            }
        }
    }

    pub fn next(&mut self, sample_hz: f32) -> f32 {
        match self.notes {
            [(hz, _), ..] if *hz > 0.0 => {
                self.hz = *hz;
                self.level.set(LEVEL);
            }
            _ => self.level.set(0.0),
        }
        if let [(_, lasts_s), later @ ..] = self.notes {
            self.played_s += 1.0 / sample_hz;
            if self.played_s >= *lasts_s {
                (self.notes, self.played_s) = (later, 0.0);
            }
        }
        let phase = self.phase.next(self.hz, sample_hz);
        self.level.next(FOLLOWS_S, sample_hz) * (phase.sin() + 0.25 * (2.0 * phase).sin())
    }
}

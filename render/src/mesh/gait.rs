//! How joints of people on foot move: standing, walking, running, and between them.

use kernel::ops;

/// Speeds between which walking becomes running, m/s (adults change at about 2.1 m/s; Hreljac 1993).
pub const RUNS_MPS: [f32; 2] = [1.9, 2.9];

/// What a joint does in the course of a stride, radians or metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cycle {
    /// Mean without [`Cycle::lift`].
    pub rest: f32,
    /// Amplitude of the sine.
    pub swing: f32,
    /// Height of a bump once a turn, as of a knee that bends while its leg comes forward.
    pub lift: f32,
    /// Phase of the bump's middle, radians.
    pub lift_at_rad: f32,
}

impl Cycle {
    /// A sine.
    pub const fn new(rest: f32, swing: f32) -> Self {
        Self { rest, swing, lift: 0.0, lift_at_rad: 0.0 }
    }

    /// With a bump.
    pub const fn lifted(self, lift: f32, lift_at_rad: f32) -> Self {
        Self { lift, lift_at_rad, ..self }
    }

    fn scaled(self, factor: f32) -> Self {
        Self { rest: self.rest * factor, swing: self.swing * factor, lift: self.lift * factor, ..self }
    }

    /// `rest + swing * sin(phase) + lift * (0.5 + 0.5 * cos(phase - lift_at))^3`.
    fn at(&self, phase_rad: f32) -> f32 {
        let near = 0.5 + 0.5 * ops::cos(phase_rad - self.lift_at_rad);
        self.rest + self.swing * ops::sin(phase_rad) + self.lift * near * near * near
    }
}

/// A joint's value at every speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gait {
    /// Value of one who stands.
    pub stand: f32,
    /// Of one who walks.
    pub walk: Cycle,
    /// Of one who runs.
    pub run: Cycle,
    /// By how much this joint is ahead of the actor's phase, radians.
    pub lead_rad: f32,
    /// Turns of the joint in one of the actor's phase.
    pub beats: f32,
    /// Speed from which on it is wholly that of one who walks, m/s, more than 0.
    pub walks_mps: f32,
}

impl Gait {
    /// One value at all times.
    pub const fn still(value: f32) -> Self {
        let cycle = Cycle::new(value, 0.0);
        Self { stand: value, walk: cycle, run: cycle, lead_rad: 0.0, beats: 1.0, walks_mps: 1.0 }
    }

    /// The same, so many times as large.
    pub fn scaled(self, factor: f32) -> Self {
        let (walk, run) = (self.walk.scaled(factor), self.run.scaled(factor));
        Self { stand: self.stand * factor, walk, run, ..self }
    }

    /// With `p = phase * beats + lead`, `w = min(1, |speed| / walks)`, and `r` the share of the way from the lower to the
    /// upper of [`RUNS_MPS`], 0 to 1: `stand + (walk(p) - stand) * w =: v`, then `v + (run(p) - v) * r`.
    pub fn value(&self, phase_rad: f32, speed_mps: f32) -> f32 {
        let phase_rad = phase_rad * self.beats + self.lead_rad;
        let walks = (speed_mps.abs() / self.walks_mps).min(1.0);
        let runs = ((speed_mps.abs() - RUNS_MPS[0]) / (RUNS_MPS[1] - RUNS_MPS[0])).clamp(0.0, 1.0);
        let value = self.stand + (self.walk.at(phase_rad) - self.stand) * walks;
        value + (self.run.at(phase_rad) - value) * runs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAIT: Gait = Gait {
        stand: 0.1,
        walk: Cycle::new(0.2, 0.4).lifted(1.0, 3.0),
        run: Cycle::new(-0.3, 0.6),
        lead_rad: 0.5,
        beats: 1.0,
        walks_mps: 0.5,
    };

    #[test]
    fn who_stands_has_no_phase_and_who_walks_has() {
        assert_eq!([0.0, 1.0, 4.0].map(|phase| GAIT.value(phase, 0.0)), [0.1; 3]);
        assert!((GAIT.value(0.0, 1.0) - GAIT.value(2.0, 1.0)).abs() > 0.3);
    }

    #[test]
    fn it_changes_steadily_with_speed() {
        for phase in [0.0, 1.3, 2.9, 5.0] {
            let values: Vec<f32> = (0..400).map(|i| GAIT.value(phase, 0.01 * i as f32)).collect();
            assert!(values.windows(2).all(|v| (v[1] - v[0]).abs() < 0.05), "{phase}");
            assert!((values[399] - GAIT.run.at(phase + 0.5)).abs() < 1e-6);
        }
    }
}

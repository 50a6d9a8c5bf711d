//! How the car moves, as the driver takes it to: what was seen before is carried along.

use kernel::ops;
use kernel::time::TICK_S;

use super::arc::{Arc, Point};
use crate::vision::LATENCY_TICKS;

/// How the car moved in a tick: metres forward, radians to the left.
#[derive(Clone, Copy, Debug)]
pub struct Moved {
    /// Metres along the car's axis.
    pub forward_m: f32,
    /// Radians counter-clockwise.
    pub turned_rad: f32,
}

impl Moved {
    /// By driving an arc for a tick.
    pub fn along(arc: Arc, speed_mps: f32) -> Self {
        let forward_m = speed_mps * TICK_S;
        Self { forward_m, turned_rad: arc.curvature * forward_m }
    }

    /// Where a fixed point is after the movement.
    pub fn shift(&self, (x, y): Point) -> Point {
        self.turn((x - self.forward_m, y))
    }

    /// A direction as it is after the movement.
    pub fn turn(&self, (x, y): Point) -> Point {
        let (sin, cos) = (ops::sin(self.turned_rad), ops::cos(self.turned_rad));
        (x * cos + y * sin, y * cos - x * sin)
    }
}

/// The movements of the last ticks: a mask that is new shows what was there before them.
#[derive(Clone, Copy, Debug)]
pub struct Lag {
    past: [Moved; LATENCY_TICKS as usize],
}

impl Default for Lag {
    fn default() -> Self {
        Self { past: [Moved { forward_m: 0.0, turned_rad: 0.0 }; LATENCY_TICKS as usize] }
    }
}

impl Lag {
    /// Takes in how the car moved in this tick.
    pub fn push(&mut self, moved: Moved) {
        self.past.rotate_left(1);
        self.past[LATENCY_TICKS as usize - 1] = moved;
    }

    /// Where a point of the mask is by now.
    pub fn now(&self, at: Point) -> Point {
        self.past.iter().fold(at, |at, moved| moved.shift(at))
    }
}

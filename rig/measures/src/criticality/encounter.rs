//! Two road users who go on as they are: when they would meet, and what it takes that they do not.
//!
//! Each keeps direction and speed. The pairs (t, u) for which the other's footprint after t seconds and
//! the ego car's after u seconds share ground are convex: the boxes overlap unless one of four axes
//! separates them, and the distance along each is linear in t and u. This *diagram of times*, cut off at
//! the horizon, holds all measures: they collide where it meets the diagonal t = u; it tells by how much
//! time they miss each other elsewhere; and braking bends the diagonal down until it passes below.

use drivers::footprint::Footprint;
use glam::DVec2;
use kernel::scene::{ActorScene, EgoScene};

/// Straight motion says nothing about what comes later, seconds.
pub const HORIZON_S: f64 = 10.0;
/// More than twice what tyres give; told instead of anything above, m/s^2.
pub const MAX_DECELERATION_MPS2: f64 = 20.0;
/// Slower than this one stands, m/s.
const STANDING_MPS: f64 = 0.5;
/// Directions that differ by less than 15 degrees do not cross (sine).
const CROSSING_SINE: f64 = 0.26;
/// Braking as no car can tells what braking does not help against, m/s^2.
const BOUND_MPS2: f64 = 1e4;
const TOUCH_S: f64 = 1e-9;

/// A road user at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mover {
    /// Where it is.
    pub footprint: Footprint,
    /// Speed to the front, m/s; negative in reverse.
    pub speed_mps: f32,
}

impl Mover {
    /// The ego car.
    pub fn of_ego(car: &EgoScene) -> Self {
        Self { footprint: Footprint::of_ego(car), speed_mps: car.speed_mps }
    }

    /// Another road user.
    pub fn of_actor(actor: &ActorScene) -> Self {
        Self { footprint: Footprint::of_actor(actor), speed_mps: actor.speed_mps }
    }

    /// Displacement a second.
    fn velocity(&self) -> DVec2 {
        f64::from(self.speed_mps) * self.footprint.forward.as_dvec2()
    }

    fn stands(&self) -> bool {
        f64::from(self.speed_mps).abs() < STANDING_MPS
    }

    /// Whether the ways of two that move cross at an angle.
    pub fn crosses(&self, other: &Self) -> bool {
        let sine = self.footprint.forward.perp_dot(other.footprint.forward);
        !self.stands() && !other.stands() && f64::from(sine).abs() > CROSSING_SINE
    }
}

/// The diagram of times of the ego car and another.
#[derive(Clone, Debug, PartialEq)]
pub struct Encounter {
    /// Counter-clockwise; x is the other's time, y the ego car's, [0, [`HORIZON_S`]].
    corners: Vec<DVec2>,
    ego_mps: f64,
    crosses: bool,
}

impl Encounter {
    /// Of the ego car and another, as they are now.
    pub fn of(ego: &Mover, other: &Mover) -> Self {
        let square = [(0.0, 0.0), (HORIZON_S, 0.0), (HORIZON_S, HORIZON_S), (0.0, HORIZON_S)];
        let mut corners: Vec<DVec2> = square.into_iter().map(DVec2::from).collect();
        let between = (other.footprint.centre - ego.footprint.centre).as_dvec2();
        for axis in ego.footprint.axes().into_iter().chain(other.footprint.axes()) {
            let reach = f64::from(ego.footprint.reach(axis) + other.footprint.reach(axis));
            let axis = axis.as_dvec2();
            let gradient = DVec2::new(other.velocity().dot(axis), -ego.velocity().dot(axis));
            let distance = |times: DVec2| between.dot(axis) + gradient.dot(times);
            corners = clipped(&corners, |times| distance(times) - reach);
            corners = clipped(&corners, |times| -distance(times) - reach);
        }
        Self { corners, ego_mps: f64::from(ego.speed_mps).abs(), crosses: ego.crosses(other) }
    }

    /// Time to collision, seconds; `None` when both miss each other within the horizon.
    pub fn time_to_collision_s(&self) -> Option<f64> {
        let lead = |times: &DVec2| times.y - times.x;
        let meets = |(from, to): (DVec2, DVec2)| {
            let (a, b) = (lead(&from), lead(&to));
            if a == 0.0 {
                return Some(from.x);
            }
            (a * b < 0.0).then(|| from.x + (to.x - from.x) * a / (a - b))
        };
        self.edges().filter_map(meets).min_by(f64::total_cmp)
    }

    /// Predicted post-encroachment time, seconds: from when one leaves a place to when the other comes
    /// there, least over all places; 0 when they collide. `None` unless their ways cross.
    pub fn post_encroachment_s(&self) -> Option<f64> {
        let leads = || self.corners.iter().map(|times| times.y - times.x);
        let (least, most) = (leads().min_by(f64::total_cmp)?, leads().max_by(f64::total_cmp)?);
        self.crosses.then(|| least.max(-most).max(0.0))
    }

    /// Least constant deceleration with which the ego car does not collide, m/s^2, at most
    /// [`MAX_DECELERATION_MPS2`]. `None` when both miss each other anyway, or when braking does not help.
    pub fn required_deceleration_mps2(&self) -> Option<f64> {
        self.time_to_collision_s()?;
        if self.ego_mps <= 0.0 || !self.is_above(BOUND_MPS2) {
            return None;
        }
        let (mut too_little, mut enough) = (0.0, BOUND_MPS2);
        while enough - too_little > 1e-9 * enough {
            let middle = 0.5 * (too_little + enough);
            if self.is_above(middle) { enough = middle } else { too_little = middle }
        }
        Some(enough.min(MAX_DECELERATION_MPS2))
    }

    /// Whether the ego car passes below the diagram when it brakes.
    fn is_above(&self, deceleration_mps2: f64) -> bool {
        let rate = deceleration_mps2 / self.ego_mps;
        let stop = 1.0 / rate;
        // Metres driven by then, as the time that they take without braking.
        let driven = |t: f64| if t < stop { t - 0.5 * rate * t * t } else { 0.5 * stop };
        self.edges().filter(|(from, to)| from.x < to.x).all(|(from, to)| {
            let slope = (to.y - from.y) / (to.x - from.x);
            let height = |t: f64| from.y + slope * (t - from.x);
            // The difference is concave: it is greatest at an end, where the slopes are equal, or at the stop.
            let candidates = [from.x, to.x, ((1.0 - slope) / rate).min(stop), stop];
            let inside = candidates.into_iter().map(|t| t.clamp(from.x, to.x));
            inside.into_iter().all(|t| driven(t) <= height(t) + TOUCH_S)
        })
    }

    fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> {
        self.corners.iter().copied().zip(self.corners.iter().copied().cycle().skip(1))
    }
}

/// The part of a convex polygon in which a linear function is not positive.
fn clipped(corners: &[DVec2], excess: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (from, to) in corners.iter().copied().zip(corners.iter().copied().cycle().skip(1)) {
        let (a, b) = (excess(from), excess(to));
        if a <= 0.0 {
            kept.push(from);
        }
        if a * b < 0.0 {
            kept.push(from + (to - from) * (a / (a - b)));
        }
    }
    kept
}

#[cfg(test)]
mod tests;

//! How people on foot get past each other.

use glam::Vec2;

use super::body::Body;
use super::nearby::Nearby;
use super::outline::{self, APART_M};

/// People look this far for each other, metres.
pub(super) const SIGHT_M: f32 = 2.5;
/// Sideways distance between their middles at which two without wheels pass each other, metres. Others keep as much more as they
/// are wider, here and below.
const SHOULDER_M: f32 = 0.55;
/// Whoever is farther aside is in nobody's way, metres.
const ASIDE_M: f32 = 0.45;
/// Whoever is less far ahead is beside, metres.
const BESIDE_M: f32 = 0.05;
/// Before whoever is ahead one comes to a stand at this distance, metres, and uses up the rest in this time at the
/// soonest, s.
const BEFORE_M: f32 = 0.48;
const CLOSE_S: f32 = 0.5;
/// People turn aside for those whom they would reach within this time, s.
const SOON_S: f32 = 3.0;
/// Faster than this somebody comes, or goes, m/s.
const MOVES_MPS: f32 = 0.15;
/// Less to the left or right is straight ahead, metres.
const STRAIGHT_M: f32 = 0.15;
/// People at heights farther apart than this do not meet, metres.
const LEVEL_M: f32 = 2.0;

/// Another person, as somebody sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    /// From the one to the other, where their lines are nearest to each other, metres.
    pub to: Vec2,
    pub distance_m: f32,
    /// It never becomes less than this, metres.
    pub apart_m: f32,
    pub velocity: Vec2,
    pub id: u32,
}

/// Everybody in sight of `index`.
pub(super) fn gather(crowd: &Nearby, bodies: &[Body], index: usize, near: &mut Vec<Near>) {
    near.clear();
    let here = bodies[index].position;
    let is_round = !bodies[index].kind.is_wheeled_on_foot();
    for other in crowd.near(index, SIGHT_M) {
        let body = &bodies[other];
        let to = body.position - here;
        let (flat, rise_m) = (to.truncate(), to.z.abs());
        if flat.length_squared() < SIGHT_M * SIGHT_M && rise_m < LEVEL_M {
            let (to, apart_m) = match is_round && !body.kind.is_wheeled_on_foot() {
                true => (flat, APART_M),
                false => outline::apart(&bodies[index], body),
            };
            near.push(Near {
                to,
                distance_m: to.length(),
                apart_m,
                velocity: body.velocity_mps.truncate(),
                id: body.id,
            });
        }
    }
}

/// What others leave to somebody who walks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leeway {
    /// Greatest speed ahead, m/s.
    pub most_mps: f32,
    /// To the left, metres: how far to step aside from whoever is ahead.
    pub aside_m: Option<f32>,
}

/// What the others leave to one who wants to walk along `ahead` at a speed, with so much room to the right (negative)
/// and to the left, metres.
pub(super) fn leeway(near: &[Near], ahead: Vec2, wants_mps: f32, room_m: [f32; 2]) -> Leeway {
    let left = ahead.perp();
    let mut found = Leeway { most_mps: f32::MAX, aside_m: None };
    let mut first = (SOON_S, u32::MAX);
    for other in near {
        let (ahead_m, aside_m) = (other.to.dot(ahead), other.to.dot(left));
        let wider_m = other.apart_m - APART_M;
        if ahead_m < BESIDE_M || aside_m.abs() > SHOULDER_M + wider_m {
            continue;
        }
        let along_mps = other.velocity.dot(ahead);
        let room_ahead_m = (ahead_m - BEFORE_M - wider_m).max(0.0);
        if aside_m.abs() < ASIDE_M + wider_m {
            found.most_mps = found.most_mps.min(along_mps.max(0.0) + room_ahead_m / CLOSE_S);
        }
        let soon = (room_ahead_m / (wants_mps - along_mps).max(1e-3), other.id);
        if along_mps < wants_mps && soon < first {
            first = soon;
            found.aside_m = Some(past(aside_m, SHOULDER_M + wider_m, along_mps, room_m));
        }
    }
    found
}

/// How far to step to the left to pass at a distance somebody who is so far to the left, and goes along at a speed: on the
/// nearer side, if there is room; straight ahead on the right of who comes, and on the left of who goes the same way.
fn past(aside_m: f32, shoulder_m: f32, along_mps: f32, room_m: [f32; 2]) -> f32 {
    let [right_m, left_m] = [aside_m - shoulder_m, aside_m + shoulder_m];
    let rightwards = if aside_m.abs() > STRAIGHT_M { aside_m > 0.0 } else { along_mps < MOVES_MPS };
    let [fits_right, fits_left] = [right_m > room_m[0], left_m < room_m[1]];
    if (rightwards && fits_right) || !fits_left { right_m } else { left_m }
}

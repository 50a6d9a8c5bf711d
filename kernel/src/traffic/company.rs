//! How people on foot get past each other.

use glam::{Vec2, Vec3};

use super::body::Body;
use super::crowd::Crowd;

/// People look this far ahead for each other, metres.
const SIGHT_M: f32 = 2.5;
/// Sideways distance that they like to keep between their middles, metres.
const SHOULDER_M: f32 = 0.7;
/// Nearer to each other than this, sideways or ahead, nobody goes, metres.
const PERSON_M: f32 = 0.5;
/// Whoever is less far ahead than this is beside, metres.
const BESIDE_M: f32 = 0.25;
/// The distance to whoever is ahead is used up in this time at the soonest, s.
const CLOSE_S: f32 = 0.6;
/// People at heights farther apart than this do not meet, metres.
const LEVEL_M: f32 = 2.0;

/// What others leave to somebody who walks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leeway {
    /// Greatest speed ahead, m/s.
    pub most_mps: f32,
    /// To the left, metres: how far away from whoever is ahead, where somebody is to be passed.
    pub aside_m: Option<f32>,
    /// Least and greatest step to the left that runs into nobody, metres.
    pub free_m: [f32; 2],
}

/// What the others leave to `index`, who wants to walk along `ahead` at a speed.
pub(super) fn leeway(crowd: &Crowd, bodies: &[Body], index: usize, ahead: Vec2, wants_mps: f32) -> Leeway {
    let here = bodies[index].position;
    let left = ahead.perp();
    let mut found = Leeway { most_mps: f32::MAX, aside_m: None, free_m: [f32::MIN, f32::MAX] };
    let mut nearest = (SIGHT_M, u32::MAX);
    for body in crowd.near(index, SIGHT_M).map(|other| &bodies[other]) {
        let Some((ahead_m, aside_m)) = seen(here, body.position, ahead, left) else { continue };
        if ahead_m < BESIDE_M {
            let side = usize::from(aside_m > 0.0);
            let gap_m = (aside_m.abs() - PERSON_M).max(0.0);
            let free = &mut found.free_m[side];
            *free = if side == 1 { free.min(gap_m) } else { free.max(-gap_m) };
            continue;
        }
        let along_mps = body.velocity_mps.truncate().dot(ahead);
        if along_mps < wants_mps && (ahead_m, body.id) < nearest {
            nearest = (ahead_m, body.id);
            // To the right where both come straight at each other.
            let side = if aside_m.abs() > 0.15 { -aside_m.signum() } else { -1.0 };
            found.aside_m = Some(aside_m + side * (SHOULDER_M + 0.1));
        }
        if aside_m.abs() < PERSON_M {
            found.most_mps = found.most_mps.min(along_mps.max(0.0) + (ahead_m - PERSON_M).max(0.0) / CLOSE_S);
        }
    }
    found
}

/// How far ahead and to the left another is, if that matters.
fn seen(here: Vec3, there: Vec3, ahead: Vec2, left: Vec2) -> Option<(f32, f32)> {
    let to = there - here;
    let (ahead_m, aside_m) = (to.truncate().dot(ahead), to.truncate().dot(left));
    let matters = ahead_m > -BESIDE_M && ahead_m < SIGHT_M && aside_m.abs() < SHOULDER_M + 0.1 && to.z.abs() < LEVEL_M;
    matters.then_some((ahead_m, aside_m))
}

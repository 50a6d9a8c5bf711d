//! Nobody walks into anybody: of the room between two people each takes half at most in a tick.
//!
//! Everybody decides from where all were at the end of the previous tick. Who moves towards another by no more than half
//! of what is between them beyond [`APART_M`] cannot meet the other, whatever that one does.

use glam::Vec2;

use super::company::{Near, SIGHT_M};

/// The middles of two people are never nearer to each other, metres.
pub(super) const APART_M: f32 = 0.42;
/// Nobody moves farther than this in a tick, metres: whoever is out of sight takes as much.
const MOST_M: f32 = (SIGHT_M - APART_M) * 0.5;
/// Bends of the way and rounding may take so much of that, metres.
const BEND_M: f32 = 0.01;
/// Times that a step is turned along whoever is in its way.
const TURNS: u32 = 3;

/// How far somebody may move towards another who is to stay so far away, metres.
fn half_slack_m(near: &Near, apart_m: f32) -> f32 {
    (0.5 * (near.distance_m - apart_m)).max(0.0)
}

/// Whether a step leaves everybody's half to them.
pub(super) fn is_free(near: &[Near], step: Vec2) -> bool {
    let most_m = step.length();
    let is_over = |n: &Near| {
        let half_m = half_slack_m(n, APART_M - BEND_M);
        most_m > half_m && step.dot(n.to) > half_m * n.distance_m
    };
    most_m < MOST_M + BEND_M && !near.iter().any(is_over)
}

/// The part of a step that leaves everybody's half to them: it goes along those who are in its way.
pub(super) fn free_part(near: &[Near], step: Vec2) -> Vec2 {
    let step = step.clamp_length_max(MOST_M);
    let most_m = step.length();
    let half_m = |n: &Near| half_slack_m(n, APART_M);
    let close = || near.iter().filter(|n| half_m(n) < most_m && n.distance_m > 0.0);
    let mut part = step;
    for _ in 0..TURNS {
        for n in close() {
            part -= n.to / n.distance_m * (part.dot(n.to) / n.distance_m - half_m(n)).max(0.0);
        }
    }
    let share = |n: &Near| {
        let toward_m = part.dot(n.to) / n.distance_m;
        if toward_m > half_m(n) { half_m(n) / toward_m } else { 1.0 }
    };
    part * close().map(share).fold(1.0, f32::min)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn seen(from: Vec2, to: Vec2) -> Near {
        Near { to: to - from, distance_m: to.distance(from), velocity: Vec2::ZERO, id: 1 }
    }

    fn place() -> impl Strategy<Value = Vec2> {
        (-1.0f32..1.0, -1.0f32..1.0).prop_map(|(x, y)| Vec2::new(x, y))
    }

    proptest! {
        /// Whatever everybody in a crowd wants, nobody comes nearer than that to anybody, or nearer at all.
        #[test]
        fn nobody_meets_anybody(crowd in prop::collection::vec((place(), place()), 2..9)) {
            let near = |i: usize| -> Vec<Near> {
                let others = crowd.iter().enumerate().filter(|(j, _)| *j != i);
                others.map(|(_, other)| seen(crowd[i].0, other.0)).collect()
            };
            let after: Vec<Vec2> =
                crowd.iter().enumerate().map(|(i, (place, wish))| *place + free_part(&near(i), *wish)).collect();
            for i in 0..crowd.len() {
                for j in 0..i {
                    let before_m = crowd[i].0.distance(crowd[j].0);
                    prop_assert!(after[i].distance(after[j]) > before_m.min(APART_M) - 1e-5);
                }
            }
        }
    }

    #[test]
    fn who_is_in_the_way_is_slid_along() {
        let near = [seen(Vec2::ZERO, Vec2::new(0.42, 0.1))];
        let part = free_part(&near, Vec2::new(0.02, 0.0));
        assert!(part.x > 0.0 && part.y < 0.0 && part.length() < 0.02, "{part}");
        assert_eq!(free_part(&[], Vec2::X * 0.5), Vec2::X * 0.5);
    }
}

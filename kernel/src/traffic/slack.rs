//! Nobody walks into anybody: of the room between two people each takes half at most in a tick.
//!
//! Everybody decides from where all were at the end of the previous tick. Whose outline moves towards another's by no more than
//! half of what is between them beyond [`Near::apart_m`] cannot meet the other, whatever that one does: outlines are convex, and
//! neither comes over the line half-way across what is between them.

use glam::Vec2;

use super::company::Near;

/// Nobody moves farther than this in a tick, metres: two prams out of each other's sight may take as much and not meet.
const MOST_M: f32 = 0.45;
/// Bends of the way and rounding may take so much of that, metres.
const BEND_M: f32 = 0.01;
/// Times that a step is turned along whoever is in its way.
const TURNS: u32 = 3;

/// Whoever is nearer than that steps aside by so much at most in a tick, metres: else two could stand side by side for ever, as
/// neither may move in the least towards the other.
const BACK_M: f32 = 0.002;

/// How far somebody may move towards another, metres.
fn half_slack_m(near: &Near) -> f32 {
    half_gap_m(near).max(0.0)
}

fn half_gap_m(near: &Near) -> f32 {
    0.5 * (near.distance_m - near.apart_m)
}

/// Whether a step leaves everybody's half to them.
pub(super) fn is_free(near: &[Near], step: Vec2) -> bool {
    let most_m = step.length();
    let is_over = |n: &Near| {
        let half_m = half_slack_m(&Near { apart_m: n.apart_m - BEND_M, ..*n });
        most_m > half_m && step.dot(n.to) > half_m * n.distance_m
    };
    most_m < MOST_M + BEND_M && !near.iter().any(is_over)
}

/// The part of a step that leaves everybody's half to them: it goes along those who are in its way.
pub(super) fn free_part(near: &[Near], step: Vec2) -> Vec2 {
    let step = step.clamp_length_max(MOST_M);
    let most_m = step.length();
    let close = || near.iter().filter(|n| half_slack_m(n) < most_m && n.distance_m > 0.0);
    let mut part = step;
    for _ in 0..TURNS {
        for n in close() {
            let toward_m = part.dot(n.to) / n.distance_m;
            part -= n.to / n.distance_m * (toward_m - half_gap_m(n).max(-BACK_M)).max(0.0);
        }
    }
    let share = |n: &Near| {
        let (toward_m, half_m) = (part.dot(n.to) / n.distance_m, half_slack_m(n));
        if toward_m > half_m { half_m / toward_m } else { 1.0 }
    };
    part * close().map(share).fold(1.0, f32::min)
}

/// Whether a line that moves by a step and turns, from the half `was` to the half `is`, leaves everybody's half to them.
pub(super) fn may_turn(near: &[Near], step: Vec2, was: Vec2, is: Vec2) -> bool {
    near.iter().filter(|n| n.distance_m > 0.0).all(|n| {
        let axis = n.to / n.distance_m;
        let turned_m = is.dot(axis).abs() - was.dot(axis).abs();
        turned_m <= 0.0 || step.dot(axis) + turned_m <= half_slack_m(n)
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::traffic::outline::{APART_M, Outline};

    fn seen(from: Vec2, to: Vec2) -> Near {
        Near { to: to - from, distance_m: to.distance(from), apart_m: APART_M, velocity: Vec2::ZERO, id: 1 }
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

    fn pram() -> impl Strategy<Value = (Outline, Vec2, f32)> {
        let of = |(middle, angle_rad, wish, turn_rad): (Vec2, f32, Vec2, f32)| {
            (
                Outline { middle: middle * 1.5, half: Vec2::from_angle(angle_rad) * 0.45, radius_m: 0.3 },
                wish * 0.1,
                turn_rad,
            )
        };
        (place(), -3.0f32..3.0, place(), -0.3f32..0.3).prop_map(of)
    }

    proptest! {
        /// Nor does a pram come nearer to another than both are wide, however they move and turn.
        #[test]
        fn no_pram_meets_another(prams in prop::collection::vec(pram(), 2..6)) {
            let apart_m = 0.62;
            let near = |i: usize| -> Vec<Near> {
                let others = prams.iter().enumerate().filter(|(j, _)| *j != i);
                let to = others.map(|(_, other)| prams[i].0.to(&other.0));
                to.map(|to| Near { to, distance_m: to.length(), apart_m, velocity: Vec2::ZERO, id: 1 }).collect()
            };
            let after = |i: usize| {
                let (was, wish, turn_rad) = &prams[i];
                let step = free_part(&near(i), *wish);
                let turned = Vec2::from_angle(*turn_rad).rotate(was.half);
                let half = if may_turn(&near(i), step, was.half, turned) { turned } else { was.half };
                Outline { middle: was.middle + step, half, ..*was }
            };
            for i in 0..prams.len() {
                for j in 0..i {
                    let is_apart = |a: &Outline, b: &Outline| a.to(b).length() > apart_m - 1e-5;
                    // Who begins inside of another is no case.
                    prop_assert!(!is_apart(&prams[i].0, &prams[j].0) || is_apart(&after(i), &after(j)));
                }
            }
        }
    }

    #[test]
    fn two_side_by_side_nearer_than_they_may_be_get_on_and_apart() {
        let to = Vec2::Y * 0.55;
        let near = [Near { to, distance_m: 0.55, apart_m: 0.57, velocity: Vec2::ZERO, id: 1 }];
        let part = free_part(&near, Vec2::new(0.02, 1e-4));
        assert!(part.x > 0.019 && part.y < 0.0 && is_free(&near, part), "{part}");
    }

    #[test]
    fn who_is_in_the_way_is_slid_along() {
        let near = [seen(Vec2::ZERO, Vec2::new(0.42, 0.1))];
        let part = free_part(&near, Vec2::new(0.02, 0.0));
        assert!(part.x > 0.0 && part.y < 0.0 && part.length() < 0.02, "{part}");
        assert_eq!(free_part(&[], Vec2::X * 0.4), Vec2::X * 0.4);
    }
}

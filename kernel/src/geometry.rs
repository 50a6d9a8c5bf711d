//! Directions and rectangles on the ground.

use glam::{Quat, Vec2};

use crate::ops;

/// The unit vector of a heading.
pub fn direction(heading_rad: f32) -> Vec2 {
    Vec2::new(ops::cos(heading_rad), ops::sin(heading_rad))
}

/// The rotation about the vertical that turns east to a heading.
pub fn rotation(heading_rad: f32) -> Quat {
    let half = 0.5 * heading_rad;
    Quat::from_xyzw(0.0, 0.0, ops::sin(half), ops::cos(half))
}

/// Whether two rectangles overlap, seen along the axes of the first (separating axes): half the size of
/// the first, the way from its middle to that of the second, the direction of the second's x axis, and
/// half its size. Who is about to be hit is found with it: its last bits are part of every recording.
pub fn rectangles_overlap(half: Vec2, way: Vec2, axis: Vec2, other: Vec2) -> bool {
    let (cos, sin) = (axis.x, axis.y);
    let reach = |along: f32, across: f32| other.x * along.abs() + other.y * across.abs();
    let back = |along: f32, across: f32| half.x * along.abs() + half.y * across.abs();
    way.x.abs() < half.x + reach(cos, sin)
        && way.y.abs() < half.y + reach(sin, cos)
        && (way.x * cos + way.y * sin).abs() < other.x + back(cos, sin)
        && (way.y * cos - way.x * sin).abs() < other.y + back(sin, cos)
}

/// Whether two rectangles overlap, told by their corners in order (separating axes). Props are placed
/// with it: its last bits are part of every map.
pub fn corners_overlap(a: &[Vec2; 4], b: &[Vec2; 4]) -> bool {
    let axes = [a[1] - a[0], a[3] - a[0], b[1] - b[0], b[3] - b[0]];
    axes.iter().all(|axis| {
        let range =
            |r: &[Vec2; 4]| r.iter().map(|c| c.dot(*axis)).fold((f32::MAX, f32::MIN), |(l, h), v| (l.min(v), h.max(v)));
        let ((al, ah), (bl, bh)) = (range(a), range(b));
        al < bh && bl < ah
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Corners of a rectangle.
    fn corners(centre: Vec2, forward: Vec2, half: Vec2) -> [Vec2; 4] {
        let (along, across) = (forward * half.x, forward.perp() * half.y);
        [centre - along - across, centre + along - across, centre + along + across, centre - along + across]
    }

    proptest! {
        #[test]
        fn both_tests_of_rectangles_say_the_same_away_from_touching(
            (x, y, heading_rad) in (-6.0f32..6.0, -6.0f32..6.0, -3.2f32..3.2),
            (a, b, c, d) in (0.1f32..3.0, 0.1f32..3.0, 0.1f32..3.0, 0.1f32..3.0),
        ) {
            let (way, axis) = (Vec2::new(x, y), direction(heading_rad));
            let says = |grow: f32| {
                let (half, other) = (Vec2::new(a, b) + grow, Vec2::new(c, d) + grow);
                let told = (corners(Vec2::ZERO, Vec2::X, half), corners(way, axis, other));
                (rectangles_overlap(half, way, axis, other), corners_overlap(&told.0, &told.1))
            };
            let (less, more) = (says(-1e-3), says(1e-3));
            prop_assert!((!less.0 || more.1) && (!less.1 || more.0), "{less:?} {more:?}");
        }
    }
}

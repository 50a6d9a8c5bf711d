//! What houses hide: the height of the skyline around the eye, raised house by house from near to
//! far, so that what lies behind and below it need not be drawn.
//!
//! It holds wherever houses stand on solid ground: a ray below the top of a house ends at its wall or
//! in the ground before it.

use core::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};
use kernel::map::{Prop, PropKind};
use kernel::ops;

/// Directions around the eye.
const BINS: usize = 1024;

/// The solid part of a house.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Occluder {
    corners: [Vec2; 4],
    top_m: f32,
}

impl Occluder {
    /// The walls of a house up to a height that its roof surely leaves solid.
    pub(crate) fn of(prop: &Prop) -> Option<Self> {
        (prop.kind == PropKind::Building).then(|| {
            let (along, half) = (Vec2::from_angle(prop.heading_rad), 0.5 * prop.size.truncate());
            let corner = |x: f32, y: f32| prop.position.truncate() + along * (x * half.x) + along.perp() * (y * half.y);
            let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            Self { corners, top_m: prop.position.z + 0.6 * prop.size.z }
        })
    }
}

/// The skyline as far as it has been raised. Whoever asks raises one of his own.
#[derive(Clone)]
pub(crate) struct Horizon {
    eye: Vec3,
    /// Slope (rise over distance) below which everything farther is hidden, by direction.
    slopes: [f32; BINS],
    /// Houses that are not part of it yet, the nearest last, with the distance of their far side.
    waiting: Vec<(f32, Occluder)>,
}

impl Horizon {
    pub(crate) fn new(eye: Vec3, occluders: &[Occluder], reach_m: f32) -> Self {
        let far = |o: &Occluder| o.corners.iter().map(|c| c.distance(eye.truncate())).fold(0.0, f32::max);
        let mut waiting: Vec<(f32, Occluder)> =
            occluders.iter().map(|o| (far(o), *o)).filter(|o| o.0 < reach_m).collect();
        waiting.sort_by(|a, b| b.0.total_cmp(&a.0));
        Self { eye, slopes: [f32::NEG_INFINITY; BINS], waiting }
    }

    /// Whether houses hide all of a sphere. Ask by ascending distance of the near side.
    pub(crate) fn hides(&mut self, centre: Vec3, radius_m: f32) -> bool {
        let rel = centre - self.eye;
        let distance = rel.truncate().length();
        let near = distance - radius_m;
        if near <= 1.0 {
            return false;
        }
        while let Some((far, occluder)) = self.waiting.pop_if(|(far, _)| *far <= near) {
            self.raise(&occluder, far);
        }
        let top = rel.z + radius_m;
        let slope = if top > 0.0 { top / near } else { top / (distance + radius_m) };
        let half = ops::asin(radius_m / distance);
        let middle = ops::atan2(rel.y, rel.x);
        let (first, last) = (bin(middle - half).floor() as i32, bin(middle + half).floor() as i32);
        (first..=last).all(|i| self.slopes[i.rem_euclid(BINS as i32) as usize] > slope)
    }

    fn raise(&mut self, occluder: &Occluder, far_m: f32) {
        let rise = occluder.top_m - self.eye.z;
        if rise <= 0.0 {
            return;
        }
        // Angles relative to the first corner cannot wrap: seen from outside, a house spans less than pi.
        let angle = |c: Vec2| ops::atan2(c.y - self.eye.y, c.x - self.eye.x);
        let start = angle(occluder.corners[0]);
        let turns = occluder.corners.map(|c| ops::wrap_angle(angle(c) - start));
        let (low, high) = turns.iter().fold((0.0f32, 0.0f32), |(l, h), &t| (l.min(t), h.max(t)));
        if high - low >= 0.9 * PI {
            return;
        }
        let (first, last) = (bin(start + low).ceil() as i32, bin(start + high).floor() as i32);
        for i in first..last {
            let slope = &mut self.slopes[i.rem_euclid(BINS as i32) as usize];
            *slope = slope.max(rise / far_m);
        }
    }
}

/// Place of a direction among the bins, not wrapped.
fn bin(angle_rad: f32) -> f32 {
    (angle_rad + PI) * (BINS as f32 / TAU)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn house(x: f32, y: f32) -> Occluder {
        let prop = Prop {
            kind: PropKind::Building,
            position: Vec3::new(x, y, 0.0),
            heading_rad: 0.3,
            size: Vec3::new(10.0, 12.0, 10.0),
            variant: 0,
        };
        Occluder::of(&prop).unwrap()
    }

    #[test]
    fn a_house_hides_what_is_behind_and_below_it_only() {
        for turn in 0..16 {
            let ahead = Vec2::from_angle(TAU * turn as f32 / 16.0);
            let at = |distance: f32, aside: f32, z: f32| (ahead * distance + ahead.perp() * aside).extend(z);
            let place = at(30.0, 0.0, 0.0);
            let mut horizon = Horizon::new(Vec3::new(0.0, 0.0, 1.5), &[house(place.x, place.y)], 200.0);
            assert!(!horizon.hides(at(15.0, 0.0, 1.0), 1.0), "in front");
            assert!(!horizon.hides(at(30.0, 0.0, 1.0), 8.0), "the house itself");
            assert!(horizon.hides(at(50.0, 0.0, 1.0), 2.0), "behind");
            assert!(!horizon.hides(at(50.0, 16.0, 1.0), 2.0), "beside");
            assert!(!horizon.hides(at(50.0, 0.0, 9.0), 3.0), "above");
        }
    }
}

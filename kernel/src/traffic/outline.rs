//! People on foot seen from above: circles, and what has wheels as a line along its heading with a radius around it.

use glam::{Vec2, Vec3};

use crate::actor::ActorKind;
use crate::geometry::direction;

use super::body::Body;
use super::walker::{Walker, radians};

/// Radius of who has no wheels, metres.
const PERSON_M: f32 = 0.2;
/// Between two outlines there is always so much, metres.
const SKIN_M: f32 = 0.02;
/// The middles of two without wheels are never nearer to each other, metres.
pub(super) const APART_M: f32 = 2.0 * PERSON_M + SKIN_M;
/// Places of the line at which it is looked at, as shares of its half; a circle has the first alone.
const PLACES: [f32; 3] = [0.0, 1.0, -1.0];

/// Somebody on foot seen from above.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    pub middle: Vec2,
    /// From the middle to the front end of its line; nothing for a circle.
    pub half: Vec2,
    pub radius_m: f32,
}

/// Half of the length of the line of a kind, metres.
pub(super) fn half_m(kind: ActorKind) -> f32 {
    let size_m = kind.size_m();
    if kind.is_wheeled_on_foot() { (size_m.x - size_m.y) * 0.5 } else { 0.0 }
}

fn radius_m(kind: ActorKind) -> f32 {
    if kind.is_wheeled_on_foot() { kind.size_m().y * 0.5 } else { PERSON_M }
}

/// From the nearest place of the line of one to that of another, and how long that is at least, metres.
#[cold]
pub(super) fn apart(one: &Body, other: &Body) -> (Vec2, f32) {
    let (one, other) = (Outline::of(one), Outline::of(other));
    (one.to(&other), one.radius_m + other.radius_m + SKIN_M)
}

impl Outline {
    /// That of somebody where it is.
    pub fn of(body: &Body) -> Self {
        let half_m = half_m(body.kind);
        let half = if half_m > 0.0 { (body.rotation * Vec3::X).truncate() * half_m } else { Vec2::ZERO };
        Self { middle: body.position.truncate(), half, radius_m: radius_m(body.kind) }
    }

    /// The same elsewhere, turned as a walker is.
    pub fn moved(&self, step: Vec2, walker: &Walker) -> Self {
        let half = if self.is_long() { direction(radians(walker.heading)) * self.half.length() } else { Vec2::ZERO };
        Self { middle: self.middle + step, half, ..*self }
    }

    /// Whether it is no circle.
    pub fn is_long(&self) -> bool {
        self.half != Vec2::ZERO
    }

    /// Places that tell how near it is to a box.
    pub fn places(&self) -> impl Iterator<Item = Vec2> + use<> {
        let Self { middle, half, .. } = *self;
        PLACES.into_iter().take(if self.is_long() { PLACES.len() } else { 1 }).map(move |share| middle + half * share)
    }

    /// From the nearest place of its line to that of another's.
    pub fn to(&self, other: &Self) -> Vec2 {
        let from = |place: Vec2| other.nearest(place) - place;
        let back = |place: Vec2| place - self.nearest(place);
        let ways = [
            from(self.middle + self.half),
            from(self.middle - self.half),
            back(other.middle + other.half),
            back(other.middle - other.half),
        ];
        ways.into_iter().min_by(|a, b| a.length_squared().total_cmp(&b.length_squared())).unwrap_or_default()
    }

    /// The place of its line that is nearest to a place.
    fn nearest(&self, place: Vec2) -> Vec2 {
        let along = (place - self.middle).dot(self.half) / self.half.length_squared().max(f32::MIN_POSITIVE);
        self.middle + self.half * along.clamp(-1.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(x: f32, y: f32, half: Vec2) -> Outline {
        Outline { middle: Vec2::new(x, y), half, radius_m: 0.3 }
    }

    #[test]
    fn lines_are_as_far_apart_as_their_nearest_places() {
        let pram = line(0.0, 0.0, Vec2::X * 0.45);
        assert_eq!(pram.to(&line(2.0, 0.0, Vec2::ZERO)), Vec2::X * 1.55);
        assert_eq!(pram.to(&line(0.2, 1.0, Vec2::ZERO)), Vec2::new(0.0, 1.0));
        assert_eq!(pram.to(&line(0.0, 1.0, Vec2::Y * 0.45)), Vec2::new(0.0, 0.55));
        assert_eq!(line(0.0, 1.0, Vec2::Y * 0.45).to(&pram), Vec2::new(0.0, -0.55));
        let person = line(3.0, 4.0, Vec2::ZERO);
        assert_eq!(line(1.0, 1.0, Vec2::ZERO).to(&person), Vec2::new(2.0, 3.0));
    }

    #[test]
    fn the_outline_of_a_kind_fills_its_box() {
        for kind in [ActorKind::Pram, ActorKind::Wheelchair] {
            assert_eq!(2.0 * (half_m(kind) + radius_m(kind)), kind.size_m().x);
            assert_eq!(2.0 * radius_m(kind), kind.size_m().y);
        }
        assert_eq!((half_m(ActorKind::Child), radius_m(ActorKind::Pedestrian)), (0.0, PERSON_M));
    }
}

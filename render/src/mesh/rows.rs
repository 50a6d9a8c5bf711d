//! Rails, fences, walls and hedges on slopes: a row is pieces that stand level in the map, each at the height of its middle.

use std::collections::BTreeMap;

use glam::{IVec2, Vec2};
use kernel::map::{Prop, PropKind};

use super::Mesh;

/// Ends of pieces of a row are no farther apart than this, metres.
const JOINED_M: f32 = 1.0;
/// What is steeper than this is steps, not a slope.
const STEEPEST: f32 = 0.35;

/// How much higher than the middle the rear and the front end of a piece lie, metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rise {
    rear_m: f32,
    front_m: f32,
}

impl Rise {
    /// Those of all objects: of the pieces of rows half of the way up to the next one, and straight on where there is none.
    pub fn of_all(objects: &[Prop]) -> Vec<Self> {
        let ends = Ends::of(objects);
        objects.iter().enumerate().map(|(i, object)| Self::of(object, i, &ends, objects)).collect()
    }

    fn of(object: &Prop, number: usize, ends: &Ends, objects: &[Prop]) -> Self {
        if !is_of_row(object) {
            return Self::default();
        }
        let [rear, front] = Side::BOTH.map(|side| {
            let next = &objects[ends.next(object, number, side)?];
            let share = object.size.x / (object.size.x + next.size.x);
            let up_m = next.position.z - object.position.z;
            let is_slope = up_m.abs() < STEEPEST * 0.5 * (object.size.x + next.size.x);
            is_slope.then_some(share * up_m)
        });
        let straight_on = |other: Option<f32>| other.map_or(0.0, |m| -m);
        Self { rear_m: rear.unwrap_or(straight_on(front)), front_m: front.unwrap_or(straight_on(rear)) }
    }

    /// Tilts the mesh of a piece, which runs along its x axis.
    pub fn tilt(self, mesh: &mut Mesh, length_m: f32) {
        if self == Self::default() {
            return;
        }
        let (middle_m, slope) = (0.5 * (self.rear_m + self.front_m), (self.front_m - self.rear_m) / length_m);
        mesh.vertices.iter_mut().for_each(|v| v.position[2] += middle_m + slope * v.position[0]);
    }
}

fn is_of_row(object: &Prop) -> bool {
    matches!(object.kind, PropKind::Fence | PropKind::Wall | PropKind::GuardRail | PropKind::Hedge)
        && object.size.x > 0.1
}

/// An end of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Rear,
    Front,
}

impl Side {
    const BOTH: [Self; 2] = [Self::Rear, Self::Front];

    fn place(self, object: &Prop) -> Vec2 {
        let half = 0.5 * object.size.x * Vec2::from_angle(object.heading_rad);
        object.position.truncate() + if self == Self::Front { half } else { -half }
    }
}

/// The ends of all pieces of rows, by squares of [`JOINED_M`].
struct Ends(BTreeMap<[i32; 2], Vec<(usize, PropKind, Vec2)>>);

impl Ends {
    fn of(objects: &[Prop]) -> Self {
        let mut ends: BTreeMap<_, Vec<_>> = BTreeMap::new();
        for (number, object) in objects.iter().enumerate().filter(|(_, object)| is_of_row(object)) {
            for at in Side::BOTH.map(|side| side.place(object)) {
                ends.entry(square(at).to_array()).or_default().push((number, object.kind, at));
            }
        }
        Self(ends)
    }

    /// The piece of the same kind whose end is nearest to an end of one.
    fn next(&self, object: &Prop, number: usize, side: Side) -> Option<usize> {
        let (at, kind) = (side.place(object), object.kind);
        let squares = (-1..=1).flat_map(|y| (-1..=1).map(move |x| square(at) + IVec2::new(x, y)));
        let ends = squares.filter_map(|square| self.0.get(&square.to_array())).flatten();
        let others = ends.filter(|(other, of, _)| *other != number && *of == kind);
        let near = others.map(|(other, _, end)| (end.distance(at), *other)).filter(|(away_m, _)| *away_m < JOINED_M);
        near.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|(_, other)| other)
    }
}

fn square(at: Vec2) -> IVec2 {
    (at / JOINED_M).floor().as_ivec2()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::super::model::Detail;
    use super::super::prop;
    use super::*;

    const LENGTH_M: f32 = 3.95;

    /// Pieces of a rail every 4 m along the x axis, at some heights.
    fn row(heights_m: &[f32]) -> Vec<Prop> {
        let piece = |(i, z_m): (usize, &f32)| {
            let (position, size) = (Vec3::new(4.0 * i as f32, 30.0, *z_m), Vec3::new(LENGTH_M, 0.25, 0.8));
            Prop { kind: PropKind::GuardRail, position, heading_rad: 0.0, size, variant: 0 }
        };
        heights_m.iter().enumerate().map(piece).collect()
    }

    /// Heights of the upper edges of a piece at its rear and its front end.
    fn edges_m(object: &Prop, rise: Rise) -> [f32; 2] {
        let mut mesh = prop::mesh(object, Detail::Coarse);
        rise.tilt(&mut mesh, object.size.x);
        let at_end = |sign: f32| {
            let ends = mesh.vertices.iter().filter(move |v| sign * v.position[0] > 0.45 * LENGTH_M);
            object.position.z + ends.map(|v| v.position[2]).fold(f32::MIN, f32::max)
        };
        [at_end(-1.0), at_end(1.0)]
    }

    #[test]
    fn pieces_of_a_row_meet_on_slopes_whichever_way_they_point() {
        let mut row = row(&[0.0, 0.3, 0.7, 0.8, 0.8]);
        row[2].heading_rad = core::f32::consts::PI;
        let rises = Rise::of_all(&row);
        let mut edges: Vec<_> = row.iter().zip(&rises).map(|(piece, rise)| edges_m(piece, *rise)).collect();
        edges[2].reverse();
        for (i, pair) in edges.windows(2).enumerate() {
            assert!((pair[0][1] - pair[1][0]).abs() < 0.03, "joint {i}: {edges:?}");
        }
        assert!(edges[0][0] < 0.8 - 0.1, "the first goes straight on: {edges:?}");
    }

    #[test]
    fn what_stands_alone_or_steps_up_or_is_no_row_stays_level() {
        let level = |objects: &[Prop]| Rise::of_all(objects).iter().all(|rise| *rise == Rise::default());
        assert!(level(&row(&[1.0])) && level(&row(&[0.0, 2.0])) && level(&row(&[0.5, 0.5, 0.5])));
        let mut far = row(&[0.0, 0.4]);
        far[1].position.x += 1.5;
        assert!(level(&far));
        let mut trees = row(&[0.0, 0.4]);
        trees.iter_mut().for_each(|tree| tree.kind = PropKind::Tree);
        assert!(level(&trees));
    }
}

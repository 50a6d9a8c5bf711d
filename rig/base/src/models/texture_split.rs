//! Textured triangles as several: colours are those of vertices, so that more of them show more of a texture.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};

use super::material::Material;

/// Rounds of halving sides.
const ROUNDS: usize = 4;
/// A side is halved where its middle differs by so much from the mean of its ends, of 1.
const DIFFERS: f32 = 0.06;
/// Shorter sides stay whole, metres.
const SHORTEST_M: f32 = 0.03;

/// A corner of a triangle in the model's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    /// Of a texture.
    pub(super) at: Vec2,
    /// Red, green, blue (linear) and alpha of its own.
    pub(super) own: [f32; 4],
}

/// Halves sides of triangles along which the colour bends, up to so many triangles more; `per_m` of the file's units are a metre.
pub(super) fn split(
    corners: &mut Vec<Corner>,
    triangles: &mut Vec<[u32; 3]>,
    (material, per_m): (&Material<'_>, f32),
    room: usize,
) {
    let most = triangles.len() + room;
    for _ in 0..ROUNDS {
        let mut halves = Halves { middles: BTreeMap::new(), corners, material, shortest: SHORTEST_M * per_m };
        let mut finer = Vec::with_capacity(triangles.len());
        for &triangle in triangles.iter() {
            halves.split(triangle, &mut finer);
        }
        if finer.len() == triangles.len() || finer.len() > most {
            return;
        }
        *triangles = finer;
    }
}

struct Halves<'a> {
    /// The corner in the middle of a side, if it is halved, by the side's ends.
    middles: BTreeMap<[u32; 2], Option<u32>>,
    corners: &'a mut Vec<Corner>,
    material: &'a Material<'a>,
    /// In the file's unit.
    shortest: f32,
}

impl Halves<'_> {
    fn split(&mut self, [a, b, c]: [u32; 3], finer: &mut Vec<[u32; 3]>) {
        let middles = [(a, b), (b, c), (c, a)].map(|(from, to)| self.middle(from, to));
        match middles {
            [None, None, None] => finer.push([a, b, c]),
            [Some(ab), Some(bc), Some(ca)] => finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]),
            [Some(ab), None, None] => finer.extend([[a, ab, c], [ab, b, c]]),
            [None, Some(bc), None] => finer.extend([[b, bc, a], [bc, c, a]]),
            [None, None, Some(ca)] => finer.extend([[c, ca, b], [ca, a, b]]),
            [Some(ab), Some(bc), None] => finer.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]),
            [None, Some(bc), Some(ca)] => finer.extend([[bc, c, ca], [b, bc, ca], [b, ca, a]]),
            [Some(ab), None, Some(ca)] => finer.extend([[ca, a, ab], [c, ca, ab], [c, ab, b]]),
        }
    }

    /// The corner in the middle of a side where it is halved: for both triangles beside it alike.
    fn middle(&mut self, from: u32, to: u32) -> Option<u32> {
        let key = [from.min(to), from.max(to)];
        if let Some(known) = self.middles.get(&key) {
            return *known;
        }
        let [one, other] = key.map(|i| self.corners[i as usize]);
        let middle = halfway(&one, &other);
        let is_long = one.position.distance(other.position) > self.shortest;
        let made = (is_long && self.bends(&one, &middle, &other)).then(|| {
            self.corners.push(middle);
            self.corners.len() as u32 - 1
        });
        self.middles.insert(key, made);
        made
    }

    fn bends(&self, one: &Corner, middle: &Corner, other: &Corner) -> bool {
        let colour = |corner: &Corner| self.material.colour(corner.at.to_array(), corner.own).map(f32::sqrt);
        let quarters = [halfway(one, middle), halfway(middle, other)];
        let ends = [colour(one), colour(other)];
        let differs = |at: &Corner, share: f32| {
            let seen = colour(at);
            (0..4).any(|i| (seen[i] - (ends[0][i] * (1.0 - share) + ends[1][i] * share)).abs() > DIFFERS)
        };
        differs(middle, 0.5) || differs(&quarters[0], 0.25) || differs(&quarters[1], 0.75)
    }
}

fn halfway(one: &Corner, other: &Corner) -> Corner {
    let normal = (one.normal + other.normal).normalize_or(Vec3::Z);
    let own = core::array::from_fn(|i| 0.5 * (one.own[i] + other.own[i]));
    Corner { position: 0.5 * (one.position + other.position), normal, at: 0.5 * (one.at + other.at), own }
}

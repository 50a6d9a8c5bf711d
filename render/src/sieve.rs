//! Leaves out triangles of which no sample of a picture shows anything, before they reach a software renderer: those
//! turned away, those beside the picture and those that slip between its samples (Wihlidal 2016, "Optimizing the graphics
//! pipeline with compute"). Such a renderer spends most of its time on a triangle before it finds that out. What is left
//! draws the same picture, bit by bit.

use core::ops::Range;

use glam::{Vec2, Vec3};
use kernel::SceneSnapshot;

use crate::mesh::Vertex;
use crate::view::View;
use crate::wind::Gusts;

/// A triangle with a corner nearer than this is kept, metres ahead of the eye: it may cross the near plane.
const NEAR_M: f32 = 0.2;
/// A place in the picture is known so well, samples: the renderer rounds to 1/256. Far outside of it, as a share of the
/// distance.
const KNOWN_PX: f32 = 0.02;
const KNOWN_SHARE: f32 = 1e-5;
/// Samples that a triangle's box may hold for each to be tried.
const TRIED: usize = 4;

/// A vertex in the picture: samples to the right and downwards, metres ahead.
type Place = Vec3;

/// What a picture shows of triangles.
pub(crate) struct Sieve {
    view: View,
    /// Samples across and down.
    size: Vec2,
    /// Whether pixels' corners are samples too.
    corners: bool,
    /// Of the wind at the tick of the picture.
    gusts: Gusts,
    /// Everything is kept.
    keeps_all: bool,
    /// The vertices of the mesh at hand.
    places: Vec<Place>,
}

impl Sieve {
    /// For a picture of so many samples of a view, and as many corners.
    pub(crate) fn new(view: &View, size: [u32; 2], corners: bool, scene: &SceneSnapshot) -> Self {
        let size = Vec2::new(size[0] as f32, size[1] as f32);
        let gusts = Gusts::new(&scene.weather, scene.tick);
        Self { view: *view, size, corners, gusts, keeps_all: false, places: Vec::new() }
    }

    /// One that leaves nothing out.
    pub(crate) fn open(self) -> Self {
        Self { keeps_all: true, ..self }
    }

    /// Whether any sample may show something of what lies in a box, given by two corners: cells of the ground far away lie
    /// between two rows.
    pub(crate) fn may_show_of(&self, extent: [Vec3; 2]) -> bool {
        let corner = |i: usize| Vec3::new(extent[i & 1].x, extent[i >> 1 & 1].y, extent[i >> 2].z);
        let mut reach = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        for place in (0..8).map(|i| self.place_of(corner(i))) {
            if self.keeps_all || place.z < NEAR_M {
                return true;
            }
            reach = (reach.0.min(place.truncate()), reach.1.max(place.truncate()));
        }
        let holds = |(low, high): (Vec2, Vec2), size: Vec2| {
            let [columns, rows] = samples_between(low, high, size);
            !(columns.is_empty() || rows.is_empty())
        };
        holds(reach, self.size) || self.corners && holds((reach.0 + 0.5, reach.1 + 0.5), self.size + 1.0)
    }

    /// Appends those indices of a mesh whose triangles may be seen. `first` is the index of its first vertex.
    pub(crate) fn sift<'a>(
        &mut self,
        vertices: &[Vertex],
        first: u32,
        lists: impl Iterator<Item = (&'a [u32], &'a mut Vec<u32>)>,
    ) {
        if !self.keeps_all {
            self.place(vertices);
        }
        for (indices, kept) in lists {
            if self.keeps_all {
                kept.extend_from_slice(indices);
                continue;
            }
            for triangle in indices.chunks_exact(3) {
                let corners = [triangle[0], triangle[1], triangle[2]].map(|i| self.places[(i - first) as usize]);
                if self.may_show(corners) {
                    kept.extend_from_slice(triangle);
                }
            }
        }
    }

    /// The same of one mesh's only list.
    pub(crate) fn sifted(&mut self, vertices: &[Vertex], indices: &[u32]) -> Vec<u32> {
        let mut kept = Vec::new();
        self.sift(vertices, 0, core::iter::once((indices, &mut kept)));
        kept
    }

    fn may_show(&self, triangle: [Place; 3]) -> bool {
        // Corners lie where the samples would of a picture that is larger by half a pixel on each side.
        let larger = |p: Place| p + Vec3::new(0.5, 0.5, 0.0);
        may_be_seen(triangle, self.size) || self.corners && may_be_seen(triangle.map(larger), self.size + 1.0)
    }

    fn place(&mut self, vertices: &[Vertex]) {
        let offset = |v: &Vertex, at: Vec3| {
            let share = f32::from(v.sway) / 127.0;
            (share * self.gusts.offset(at.truncate())).extend(0.0)
        };
        let mut kept = core::mem::take(&mut self.places);
        kept.clear();
        kept.extend(vertices.iter().map(|v| {
            let at = Vec3::from_array(v.position);
            self.place_of(if v.sway == 0 { at } else { at + offset(v, at) })
        }));
        self.places = kept;
    }

    fn place_of(&self, at: Vec3) -> Place {
        let View { eye, ahead, right, up, tan_x, tan_y, .. } = self.view;
        let (right, up) = (right / tan_x, up / tan_y);
        let (rel, half) = (at - eye, 0.5 * self.size);
        let ahead_m = rel.dot(ahead);
        let scale = half / ahead_m;
        Vec3::new(half.x + scale.x * rel.dot(right), half.y - scale.y * rel.dot(up), ahead_m)
    }
}

/// Whether any sample may show a triangle, seen from its front.
fn may_be_seen(corners: [Place; 3], size: Vec2) -> bool {
    let [a, b, c] = corners;
    if a.z.min(b.z).min(c.z) < NEAR_M {
        return a.z.max(b.z).max(c.z) > 0.0;
    }
    let [a, b, c] = corners.map(|p| p.truncate());
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let known = known_px(low, high);
    let [columns, rows] = samples_between(low, high, size);
    if columns.is_empty() || rows.is_empty() {
        return false;
    }
    // Twice its area, negative from behind.
    let area = (c - a).perp_dot(b - a);
    let reach = high - low;
    if area < -2.0 * known * (reach.x + reach.y) {
        return false;
    }
    if columns.len() * rows.len() > TRIED {
        return true;
    }
    let edges = [(a, b), (b, c), (c, a)];
    let covers = |sample: Vec2| {
        edges.iter().all(|&(p, q)| {
            let along = q - p;
            (sample - p).perp_dot(along) >= -known * (along.x.abs() + along.y.abs())
        })
    };
    rows.into_iter().any(|row| columns.clone().any(|column| covers(Vec2::new(column as f32, row as f32) + 0.5)))
}

/// How well places between two are known, samples.
fn known_px(low: Vec2, high: Vec2) -> f32 {
    KNOWN_PX + KNOWN_SHARE * low.abs().max(high.abs()).max_element()
}

/// Columns and rows whose samples may lie between two places.
fn samples_between(low: Vec2, high: Vec2, size: Vec2) -> [Range<usize>; 2] {
    let known = known_px(low, high);
    [samples(low.x - known, high.x + known, size.x), samples(low.y - known, high.y + known, size.y)]
}

/// The samples between two places of an axis that has so many; samples lie half a step inside.
fn samples(low: f32, high: f32, count: f32) -> Range<usize> {
    // Truncation of what is not negative: rounding functions are calls here.
    let first = (low + 0.5).clamp(0.0, count) as usize;
    let end = (high + 0.5).clamp(0.0, count) as usize;
    first..end
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Vec2 = Vec2::new(256.0, 128.0);

    fn seen(corners: [(f32, f32); 3]) -> bool {
        may_be_seen(corners.map(|(x, y)| Vec3::new(x, y, 10.0)), SIZE)
    }

    /// The other way round.
    fn behind([a, b, c]: [(f32, f32); 3]) -> [(f32, f32); 3] {
        [a, c, b]
    }

    #[test]
    fn triangles_that_show_a_sample_are_kept_and_others_are_not() {
        // Anticlockwise as it is seen, downwards is positive.
        let at = |x: f32, y: f32, side: f32| [(x, y + side), (x + side, y + side), (x, y)];
        assert!(seen(at(10.0, 10.0, 40.0)) && !seen(behind(at(10.0, 10.0, 40.0))), "turned away");
        assert!(seen(at(10.4, 10.3, 0.4)), "around the sample at 10.5");
        assert!(!seen(at(10.6, 10.6, 0.8)), "between samples");
        assert!(!seen([(10.1, 10.9), (10.9, 11.3), (10.2, 10.6)]), "its box holds a sample, it does not");
        assert!(!seen(at(-20.0, 10.0, 10.0)) && !seen(at(10.0, 140.0, 10.0)), "beside the picture");
        assert!(seen(at(-20.0, 10.0, 30.0)), "partly beside it");
    }

    #[test]
    fn what_crosses_the_near_plane_is_kept_and_what_is_behind_the_eye_is_not() {
        let at = |x: f32, z: f32| Vec3::new(x, 10.0, z);
        assert!(may_be_seen([at(-900.0, -3.0), at(900.0, 4.0), at(10.0, 5.0)], SIZE));
        assert!(!may_be_seen([at(10.0, -3.0), at(20.0, -4.0), at(10.0, -5.0)], SIZE));
    }
}

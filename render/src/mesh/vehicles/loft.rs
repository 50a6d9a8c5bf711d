//! Bodies of vehicles: cross-sections along a vehicle under one skin, with or without arches that wheels steer in.

use core::f32::consts::PI;

use glam::Vec3;
use kernel::ops;

use crate::mesh::model::Detail;
use crate::mesh::skin::skin;
use crate::mesh::{Mesh, Paint};

/// Gap between a car's body and the ground, metres.
pub(super) const CLEARANCE_M: f32 = 0.22;

/// Room around a wheel in its arch, and how deep the arch is, metres.
const ARCH_ROOM_M: f32 = 0.05;
const ARCH_DEPTH_M: f32 = 0.45;

/// The shade that a body's lower edge lies in.
const SILL_SHADE: f32 = 0.6;

/// How much narrower bodies are at the sill, metres.
const TUCK_M: f32 = 0.03;

/// A point in side view: x and z, metres.
type Point = (f32, f32);

/// A cross-section.
#[derive(Clone, Copy, Debug)]
pub(super) struct Station {
    pub(super) x: f32,
    /// Height of its upper edge.
    pub(super) top: f32,
    /// Half of its width where it is widest.
    pub(super) half: f32,
}

/// A cross-section at `x` that is so high and half so wide, metres.
pub(super) const fn at(x: f32, top: f32, half: f32) -> Station {
    Station { x, top, half }
}

/// What the cross-sections of a body have in common, metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    /// Height of the lower edge.
    pub(super) sill: f32,
    /// Height at which they are widest, where they are high enough.
    pub(super) waist: f32,
    /// How far a metre of flank above the waist leans in.
    pub(super) lean: f32,
    /// How much the upper edge is rounded off: across and down.
    pub(super) round: [f32; 2],
}

/// A body.
pub(super) struct Loft<'a> {
    /// From the front to the rear.
    pub(super) stations: &'a [Station],
    pub(super) section: Section,
    /// Openings for wheels, outlines from the front to the rear.
    arches: Vec<[Point; 5]>,
}

impl<'a> Loft<'a> {
    pub(super) fn new(stations: &'a [Station], section: Section) -> Self {
        Self { stations, section, arches: Vec::new() }
    }

    /// With arches over the wheels of some axles.
    pub(super) fn with_arches(mut self, axles: &[f32], wheel_radius: f32) -> Self {
        let radius = wheel_radius + ARCH_ROOM_M;
        let outline = |&x: &f32| {
            // Shoulders lie on the waist, so that no panel has to be cut across.
            let shoulder = |x: f32| (x, self.waist_z(self.station(x)));
            let foot = |x: f32| (x, self.section.sill);
            let (out, top) = (0.65 * radius, (x, wheel_radius + radius));
            [foot(x + radius), shoulder(x + out), top, shoulder(x - out), foot(x - radius)]
        };
        self.arches = axles.iter().map(outline).collect();
        self
    }

    /// The cross-section at `x`.
    pub(super) fn station(&self, x: f32) -> Station {
        let [first, .., last] = self.stations else { return self.stations[0] };
        let between =
            self.stations.windows(2).find(|pair| (pair[1].x..=pair[0].x).contains(&x) && pair[0].x > pair[1].x);
        let end = if x > first.x { first } else { last };
        between.map_or(Station { x, ..*end }, |pair| level(pair[0], pair[1], x))
    }

    /// A point of the flank, `out` metres before it; `side` is the sign of y.
    pub(super) fn flank(&self, x: f32, z: f32, side: f32, out: f32) -> Vec3 {
        Vec3::new(x, side * (self.flank_y(self.station(x), z) + out), z)
    }

    /// A board on each flank, `out` metres before it.
    pub(super) fn boards(&self, mesh: &mut Mesh, paint: Paint, x: [f32; 2], z: [f32; 2], out: f32) {
        for side in [-1.0, 1.0] {
            self.board(mesh, paint, (x, z), side, out);
        }
    }

    /// A board on one flank, `out` metres before it.
    pub(super) fn board(&self, mesh: &mut Mesh, paint: Paint, (x, z): ([f32; 2], [f32; 2]), side: f32, out: f32) {
        mesh.polygon(paint, &self.on_flank(x, z, side, out));
    }

    /// The corners of a board on a flank, counter-clockwise seen from outside, the lower edge first.
    pub(super) fn on_flank(&self, x: [f32; 2], z: [f32; 2], side: f32, out: f32) -> [Vec3; 4] {
        let [from, to] = if side > 0.0 { [x[0].max(x[1]), x[0].min(x[1])] } else { [x[0].min(x[1]), x[0].max(x[1])] };
        [(from, z[0]), (to, z[0]), (to, z[1]), (from, z[1])].map(|(x, z)| self.flank(x, z, side, out))
    }

    /// A polygon on one flank through points in side view that are counter-clockwise seen from the left.
    pub(super) fn pane(&self, mesh: &mut Mesh, paint: Paint, points: &[Point], side: f32, out: f32) {
        let mut ring: Vec<Vec3> = points.iter().map(|&(x, z)| self.flank(x, z, side, out)).collect();
        if side < 0.0 {
            ring.reverse();
        }
        mesh.polygon(paint, &ring);
    }

    /// Dark arcs over the wheels of an axle with its x and their radius, where there are no arches.
    pub(super) fn arc(&self, mesh: &mut Mesh, paint: Paint, (axle, wheel): (f32, f32), steps: u32, out: f32) {
        let radius = wheel + ARCH_ROOM_M;
        let at = |step: u32| {
            let angle = PI * step as f32 / steps as f32;
            (axle + radius * ops::cos(angle), wheel + radius * ops::sin(angle))
        };
        let foot = |share: f32| (axle + share * radius, self.section.sill);
        let over: Vec<Point> = [foot(-0.95)].into_iter().chain([foot(0.95)]).chain((0..=steps).map(at)).collect();
        for side in [-1.0, 1.0] {
            let ring: Vec<Point> = over.iter().rev().copied().collect();
            self.pane(mesh, paint, &ring, side, out);
        }
    }

    /// The corners of a board on the upper side between two stations, `out` metres before it and so much of its width wide,
    /// counter-clockwise seen from outside; the edge at the first x is the first.
    pub(super) fn on_top(&self, x: [f32; 2], share: f32, out: f32) -> [Vec3; 4] {
        let corner = |x: f32, side: f32| {
            let edge = *self.outline(self.station(x), side, false).last().expect("it has a shoulder");
            Vec3::new(x, edge.y * share, edge.z)
        };
        let side = if x[0] > x[1] { -1.0 } else { 1.0 };
        let ring = [corner(x[0], side), corner(x[0], -side), corner(x[1], -side), corner(x[1], side)];
        let normal = (ring[1] - ring[0]).cross(ring[2] - ring[0]).normalize_or_zero();
        ring.map(|p| p + normal * out)
    }

    /// Flanks, top, both ends and underside. Only at its finest it is widest at the waist.
    pub(super) fn add_to(&self, mesh: &mut Mesh, paint: Paint, detail: Detail) {
        let half = |s: &Station, side: f32| self.outline(*s, side, detail == Detail::Fine);
        let across = |s: &Station| {
            let right = half(s, -1.0).into_iter().rev();
            half(s, 1.0).into_iter().chain(right).collect::<Vec<Vec3>>()
        };
        let mut rows: Vec<Vec<Vec3>> = self.stations.iter().map(across).collect();
        let (front, mut rear) = (rows[0].clone(), rows[rows.len() - 1].clone());
        rear.reverse();
        for end in [front, rear] {
            mesh.polygon(paint.shaded(0.85), &end);
        }
        let last = rows[0].len() - 1;
        let floor = [rows[0][0], rows[0][last], rows[rows.len() - 1][last], rows[rows.len() - 1][0]];
        let shade = Paint::plain(paint.tag, [18, 18, 18]);
        mesh.polygon(shade, &floor);
        if self.arches.is_empty() {
            return skin(mesh, |i| if i == 0 || i == last { paint.shaded(SILL_SHADE) } else { paint }, &rows);
        }
        for row in &mut rows {
            *row = row[2..=last - 2].to_vec();
        }
        skin(mesh, |_| paint, &rows);
        for pair in self.stations.windows(2) {
            for cut in self.cut(pair[0], pair[1]).windows(2) {
                for (p, q, side) in [(cut[0], cut[1], 1.0), (cut[1], cut[0], -1.0)] {
                    self.panels(mesh, paint, [p, q], side);
                }
            }
        }
        for arch in &self.arches {
            self.recesses(mesh, shade, arch);
        }
    }

    /// One half of a cross-section from the sill up.
    fn outline(&self, s: Station, side: f32, has_waist: bool) -> Vec<Vec3> {
        let [inset, drop] = self.section.round;
        let shoulder = self.shoulder_z(s);
        let on = |z: f32| Vec3::new(s.x, side * self.flank_y(s, z), z);
        let edge = Vec3::new(s.x, side * (self.flank_y(s, shoulder) - inset), shoulder + drop);
        let waist = has_waist.then(|| on(self.waist_z(s)));
        [Some(on(self.section.sill)), waist, Some(on(shoulder)), Some(edge)].into_iter().flatten().collect()
    }

    /// The flank between two stations: a panel from the waist up, and one below that lies in the shade.
    fn panels(&self, mesh: &mut Mesh, paint: Paint, ends: [Station; 2], side: f32) {
        let point = |s: Station, z: f32| Vec3::new(s.x, side * self.flank_y(s, z), z);
        let [p, q] = ends;
        let [p_waist, q_waist] = ends.map(|s| self.waist_z(s));
        let [p_sill, q_sill] = ends.map(|s| self.sill_z(s.x));
        let [p_top, q_top] = ends.map(|s| self.shoulder_z(s));
        let upper = [point(p, p_sill.max(p_waist)), point(q, q_sill.max(q_waist)), point(q, q_top), point(p, p_top)];
        let lower =
            [point(p, p_sill.min(p_waist)), point(q, q_sill.min(q_waist)), point(q, q_waist), point(p, p_waist)];
        for (corners, paint) in [(upper, paint), (lower, paint.shaded(0.8))] {
            let mut corners = corners.to_vec();
            corners.dedup_by(|a, b| a.distance(*b) < 1e-4);
            if corners[0].distance(corners[corners.len() - 1]) < 1e-4 {
                corners.pop();
            }
            if corners.len() > 2 {
                mesh.polygon(paint, &corners);
            }
        }
    }

    /// What is seen of the inside of the car through an arch, on both sides.
    fn recesses(&self, mesh: &mut Mesh, shade: Paint, arch: &[Point; 5]) {
        for side in [-1.0f32, 1.0] {
            let inside = |&(x, z): &Point| Vec3::new(x, side * (self.station(x).half - ARCH_DEPTH_M), z);
            let outside = |&(x, z): &Point| self.flank(x, z, side, 0.0);
            let mut wall: Vec<Vec3> = arch.iter().map(inside).collect();
            if side > 0.0 {
                wall.reverse();
            }
            mesh.polygon(shade, &wall);
            for pair in arch.windows(2) {
                let (a, b) = if side > 0.0 { (&pair[1], &pair[0]) } else { (&pair[0], &pair[1]) };
                mesh.polygon(shade, &[outside(a), outside(b), inside(b), inside(a)]);
            }
        }
    }

    fn flank_y(&self, s: Station, z: f32) -> f32 {
        let (waist, Section { sill, lean, .. }) = (self.waist_z(s), self.section);
        if z <= waist { s.half - TUCK_M * (waist - z) / (waist - sill) } else { s.half - lean * (z - waist) }
    }

    fn waist_z(&self, s: Station) -> f32 {
        (0.5 * (s.top + self.section.sill)).min(self.section.waist)
    }

    /// Where the rounded edge begins.
    fn shoulder_z(&self, s: Station) -> f32 {
        (s.top - self.section.round[1]).max(0.5 * (s.top + self.waist_z(s)))
    }

    /// The lower edge of the flank.
    fn sill_z(&self, x: f32) -> f32 {
        let pairs = self.arches.iter().flat_map(|arch| arch.windows(2));
        let over = pairs.filter(|pair| (pair[1].0..=pair[0].0).contains(&x));
        let height = |pair: &[Point]| pair[0].1 + (pair[1].1 - pair[0].1) * (x - pair[0].0) / (pair[1].0 - pair[0].0);
        over.map(height).fold(self.section.sill, f32::max)
    }

    /// The stations between two, divided where an arch has a corner.
    fn cut(&self, a: Station, b: Station) -> Vec<Station> {
        let corners = self.arches.iter().flatten().map(|p| p.0).filter(|x| *x > b.x && *x < a.x);
        let mut cuts: Vec<Station> = corners.map(|x| level(a, b, x)).collect();
        cuts.sort_by(|p, q| q.x.total_cmp(&p.x));
        [vec![a], cuts, vec![b]].concat()
    }
}

/// The cross-section on the way from `a` to `b` at `x`.
fn level(a: Station, b: Station, x: f32) -> Station {
    let share = (x - a.x) / (b.x - a.x);
    Station { x, top: a.top + (b.top - a.top) * share, half: a.half + (b.half - a.half) * share }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SemanticTag;

    const STATIONS: [Station; 5] =
        [at(2.0, 0.5, 0.8), at(1.9, 0.8, 0.88), at(-0.1, 1.0, 0.9), at(-2.0, 0.9, 0.86), at(-2.1, 0.5, 0.8)];
    const SECTION: Section = Section { sill: CLEARANCE_M, waist: 0.56, lean: 0.08, round: [0.1, 0.06] };
    const PAINT: Paint = Paint::plain(SemanticTag::Vehicles, [200; 3]);

    /// Middle and normal of every triangle with the red of its first corner.
    fn faces(mesh: &Mesh) -> Vec<(Vec3, Vec3, u8)> {
        let at = |i: u32| Vec3::from_array(mesh.vertices[i as usize].position);
        let face = |[a, b, c]: [u32; 3]| {
            let normal = (at(b) - at(a)).cross(at(c) - at(a));
            ((at(a) + at(b) + at(c)) / 3.0, normal, mesh.vertices[a as usize].colour[0])
        };
        mesh.all_triangles().map(face).collect()
    }

    #[test]
    fn all_of_a_body_looks_outwards() {
        for detail in Detail::ALL {
            let mut mesh = Mesh::default();
            Loft::new(&STATIONS, SECTION).add_to(&mut mesh, PAINT, detail);
            for (middle, normal, _) in faces(&mesh) {
                assert!(normal.dot(middle - Vec3::new(middle.x * 0.8, 0.0, 0.45)) > 0.0, "{middle} looks to {normal}");
            }
        }
    }

    #[test]
    fn arches_are_open_and_what_is_seen_in_them_looks_at_the_wheel() {
        let mut whole = Mesh::default();
        Loft::new(&STATIONS, SECTION).with_arches(&[1.2, -1.2], 0.32).add_to(&mut whole, PAINT, Detail::Fine);
        let (mut flanks, mut recesses) = (0, 0);
        for (middle, normal, red) in faces(&whole) {
            let hub = Vec3::new(1.2 * middle.x.signum(), 0.8 * middle.y.signum(), 0.32);
            if red == 18 && middle.z > CLEARANCE_M + 1e-3 {
                recesses += 1;
                assert!(normal.dot(hub - middle) > 0.0, "{middle} looks away");
            } else if middle.y.abs() > 0.8 && middle.z < 0.7 {
                flanks += 1;
                assert!((middle - hub).with_y(0.0).length() > 0.32, "{middle} is where the wheel is");
                assert!(normal.y * middle.y > 0.0, "{middle} looks inwards");
            }
        }
        assert!(recesses == 4 * (3 + 8) && flanks > 20, "{recesses}, {flanks}");
    }
}

//! The body of a car below its windows, with or without arches that its wheels steer in.

use glam::Vec3;

use super::{Mesh, Paint};

/// Gap between the body and the ground, metres.
pub(super) const CLEARANCE_M: f32 = 0.22;

/// Room around a wheel in its arch, and how deep the arch is, metres.
const ARCH_ROOM_M: f32 = 0.05;
const ARCH_DEPTH_M: f32 = 0.45;

/// A point in side view: x and z, metres.
type Point = (f32, f32);

/// Side view of a body.
pub(super) struct Body<'a> {
    half_width: f32,
    /// Upper edge from the front bumper to the rear bumper.
    belt: &'a [Point],
    /// Openings for wheels, outlines from the front to the rear.
    arches: Vec<[Point; 5]>,
}

impl<'a> Body<'a> {
    pub(super) fn new(half_width: f32, belt: &'a [Point]) -> Self {
        Self { half_width, belt, arches: Vec::new() }
    }

    /// With arches over the wheels of some axles.
    pub(super) fn with_arches(mut self, axles: &[f32], wheel_radius: f32) -> Self {
        let radius = wheel_radius + ARCH_ROOM_M;
        let outline = |&x: &f32| {
            // Shoulders lie on the waist, so that no panel has to be cut across.
            let shoulder = |x: f32| (x, self.waist_z(self.belt_z(x)));
            let foot = |x: f32| (x, CLEARANCE_M);
            let (out, top) = (0.65 * radius, (x, wheel_radius + radius));
            [foot(x + radius), shoulder(x + out), top, shoulder(x - out), foot(x - radius)]
        };
        self.arches = axles.iter().map(outline).collect();
        self
    }

    /// Flanks, bonnet, boot and underside, with the upper edges bevelled.
    pub(super) fn add_to(&self, mesh: &mut Mesh, paint: Paint) {
        let low = |x: f32, side: f32| Vec3::new(x, side * (self.half_width - 0.04), CLEARANCE_M);
        let edge = |p: Point, side: f32| self.at(p.0, p.1, p.1, side);
        for pair in self.belt.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            mesh.polygon(paint, &[edge(a, 1.0), edge(b, 1.0), edge(b, -1.0), edge(a, -1.0)]);
            let cuts = self.cut(a, b);
            for cut in cuts.windows(2) {
                for (p, q, side) in [(cut[0], cut[1], 1.0), (cut[1], cut[0], -1.0)] {
                    self.panels(mesh, paint, [p, q], side);
                }
            }
        }
        let (front, rear) = (self.belt[0], self.belt[self.belt.len() - 1]);
        let dark = paint.shaded(0.45);
        mesh.polygon(dark, &[low(front.0, -1.0), low(front.0, 1.0), edge(front, 1.0), edge(front, -1.0)]);
        mesh.polygon(dark, &[low(rear.0, 1.0), low(rear.0, -1.0), edge(rear, -1.0), edge(rear, 1.0)]);
        let shade = Paint::plain(paint.tag, [18, 18, 18]);
        mesh.polygon(shade, &[low(rear.0, 1.0), low(front.0, 1.0), low(front.0, -1.0), low(rear.0, -1.0)]);
        for arch in &self.arches {
            self.recesses(mesh, shade, arch);
        }
    }

    /// The flank between two points of the belt: a panel from the waist up, and one below that lies in the shade.
    fn panels(&self, mesh: &mut Mesh, paint: Paint, ends: [Point; 2], side: f32) {
        let point = |(x, belt): Point, z: f32| self.at(x, belt, z, side);
        let [upper, lower] = [true, false].map(|is_upper| {
            let [p, q] = ends;
            let [p_waist, q_waist] = ends.map(|(_, z)| self.waist_z(z));
            let [p_sill, q_sill] = ends.map(|(x, _)| self.sill_z(x));
            let mut corners = if is_upper {
                let (p_low, q_low) = (p_sill.max(p_waist), q_sill.max(q_waist));
                vec![point(p, p_low), point(q, q_low), point(q, q.1), point(p, p.1)]
            } else {
                let (p_low, q_low) = (p_sill.min(p_waist), q_sill.min(q_waist));
                vec![point(p, p_low), point(q, q_low), point(q, q_waist), point(p, p_waist)]
            };
            corners.dedup_by(|a, b| a.distance(*b) < 1e-4);
            if corners[0].distance(corners[corners.len() - 1]) < 1e-4 {
                corners.pop();
            }
            corners
        });
        for (corners, paint) in [(upper, paint), (lower, paint.shaded(0.8))] {
            if corners.len() > 2 {
                mesh.polygon(paint, &corners);
            }
        }
    }

    /// What is seen of the inside of the car through an arch, on both sides.
    fn recesses(&self, mesh: &mut Mesh, shade: Paint, arch: &[Point; 5]) {
        for side in [-1.0f32, 1.0] {
            let inside = |&(x, z): &Point| Vec3::new(x, side * (self.half_width - ARCH_DEPTH_M), z);
            let outside = |&(x, z): &Point| self.at(x, self.belt_z(x), z, side);
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

    /// A point of the flank where the belt is at `belt`: widest at the waist.
    fn at(&self, x: f32, belt: f32, z: f32, side: f32) -> Vec3 {
        let w = self.half_width;
        let edge = w - 0.10 * ((belt - 0.6) / 0.4).clamp(0.0, 1.0);
        let waist = self.waist_z(belt);
        let y = if z <= waist {
            w - 0.04 * (waist - z) / (waist - CLEARANCE_M)
        } else {
            w + (edge - w) * (z - waist) / (belt - waist)
        };
        Vec3::new(x, side * y, z)
    }

    fn waist_z(&self, belt: f32) -> f32 {
        (0.5 * (belt + CLEARANCE_M)).min(0.6)
    }

    fn belt_z(&self, x: f32) -> f32 {
        let between = self.belt.windows(2).find(|pair| (pair[1].0..=pair[0].0).contains(&x));
        between.map_or(CLEARANCE_M, |pair| level(pair[0], pair[1], x))
    }

    /// The lower edge of the flank.
    fn sill_z(&self, x: f32) -> f32 {
        let pairs = self.arches.iter().flat_map(|arch| arch.windows(2));
        let over = pairs.filter(|pair| (pair[1].0..=pair[0].0).contains(&x));
        over.map(|pair| level(pair[0], pair[1], x)).fold(CLEARANCE_M, f32::max)
    }

    /// A piece of the belt, divided where an arch has a corner.
    fn cut(&self, a: Point, b: Point) -> Vec<Point> {
        let corners = self.arches.iter().flatten().map(|p| p.0).filter(|x| (b.0..a.0).contains(x) && *x > b.0);
        let mut cuts: Vec<Point> = corners.map(|x| (x, level(a, b, x))).collect();
        cuts.sort_by(|p, q| q.0.total_cmp(&p.0));
        [vec![a], cuts, vec![b]].concat()
    }
}

/// Height of the line from `a` to `b` at `x`.
fn level(a: Point, b: Point, x: f32) -> f32 {
    a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SemanticTag;

    #[test]
    fn arches_are_open_and_what_is_seen_in_them_looks_at_the_wheel() {
        let belt = [(2.0, 0.5), (1.9, 0.8), (-0.1, 1.0), (-2.0, 0.9), (-2.1, 0.5)];
        let mut whole = Mesh::default();
        let paint = Paint::plain(SemanticTag::Vehicles, [200; 3]);
        Body::new(0.9, &belt).with_arches(&[1.2, -1.2], 0.32).add_to(&mut whole, paint);
        let at = |i: u32| Vec3::from_array(whole.vertices[i as usize].position);
        let (mut flanks, mut recesses) = (0, 0);
        for [a, b, c] in whole.all_triangles() {
            let (middle, normal) = ((at(a) + at(b) + at(c)) / 3.0, (at(b) - at(a)).cross(at(c) - at(a)));
            let hub = Vec3::new(1.2 * middle.x.signum(), 0.8 * middle.y.signum(), 0.32);
            if whole.vertices[a as usize].colour[0] == 18 && middle.z > CLEARANCE_M + 1e-3 {
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

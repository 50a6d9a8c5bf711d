//! The wheels of cars and heavier: tyres that steer, rims that roll.

use core::f32::consts::TAU;

use glam::Vec3;
use kernel::ops;

use crate::SemanticTag;
use crate::mesh::model::{Detail, Joint, Model, Part};
use crate::mesh::motion::LAP_M;
use crate::mesh::{Mesh, Paint};

pub(super) const RUBBER: [u8; 3] = [26, 26, 28];
const RIM: [u8; 3] = [150, 152, 156];
const CAP: [u8; 3] = [70, 72, 76];
/// Between the spokes: at rest and half blurred; and what spokes and gaps are together when nobody can tell them apart.
const GAP: [u8; 3] = [30, 31, 33];
const FADED_GAP: [u8; 3] = [76, 77, 80];
const BLUR: [u8; 3] = [104, 106, 109];

/// Speeds from which on spokes are half blurred, and a disc, m/s: half a spoke's way in a twentieth of a second, which eyes
/// take as one moment.
const BLURS_MPS: [f32; 2] = [2.5, 5.0];

const SPOKES: u32 = 5;

/// From the hub to the inner and outer face of a tyre, metres.
const INNER_M: f32 = 0.1;
/// See [`INNER_M`].
pub(super) const OUTER_M: f32 = 0.11;

/// Wheels of a larger radius are seen from inside below the body, metres.
const SHOWS_INSIDE_M: f32 = 0.4;

/// The axles of a vehicle, of which the first one steers.
pub(super) struct Axles {
    /// Where they are.
    pub(super) x_m: Vec<f32>,
    /// From the middle to the hubs on both sides.
    pub(super) y_m: f32,
    pub(super) radius_m: f32,
    /// Whether the body hides their upper halves but for the outer faces.
    pub(super) covered: bool,
}

impl Axles {
    /// A body on wheels.
    pub(super) fn under(&self, body: Mesh, tag: SemanticTag, detail: Detail) -> Model {
        let mut model = Model::rigid(body);
        for (axle, &x) in self.x_m.iter().enumerate() {
            for side in [-1.0, 1.0] {
                let mesh = self.wheel(tag, side, detail);
                let (pivot, joint) =
                    (Vec3::new(x, side * self.y_m, self.radius_m), (axle == 0).then_some(Joint::Steer));
                let wheel = model.add_part(Part { parent: None, pivot, joint, shown_mps: None, mesh });
                if detail == Detail::Fine {
                    self.add_rim(&mut model, wheel, tag, side);
                }
            }
        }
        model
    }

    /// A wheel around its hub whose face looks to `side` (the sign of y).
    fn wheel(&self, tag: SemanticTag, side: f32, detail: Detail) -> Mesh {
        let sides = if detail == Detail::Fine { 14 } else { 8 };
        let (tyre, radius_m) = (Paint::plain(tag, RUBBER), self.radius_m);
        let out = Vec3::Y * side;
        let (inner, outer) = (out * -INNER_M, out * OUTER_M);
        let mut mesh = Mesh::default();
        if self.covered {
            tread(&mut mesh, tyre, side, radius_m, sides);
        } else {
            mesh.tube(tyre, inner, outer, radius_m, radius_m, sides);
        }
        mesh.disc(tyre, outer, out, radius_m, sides);
        if self.covered && radius_m > SHOWS_INSIDE_M && detail == Detail::Fine {
            mesh.disc(tyre.shaded(0.7), inner, -out, radius_m * 0.97, 8);
        }
        if detail == Detail::Fine {
            mesh.disc(tyre.colour(RIM).glossy(80), outer + out * 0.006, out, radius_m * 0.66, 10);
            mesh.disc(tyre.colour(CAP), outer + out * 0.014, out, radius_m * 0.22, 6);
        } else if detail == Detail::Coarse {
            mesh.disc(tyre.colour(BLUR), outer + out * 0.006, out, radius_m * 0.6, 5);
        }
        mesh
    }

    /// What rolls of a wheel. The tyre does too, but nobody can tell.
    fn add_rim(&self, model: &mut Model, wheel: usize, tag: SemanticTag, side: f32) {
        let roll = Some(Joint::Roll { radius_m: rolling_radius_m(self.radius_m) });
        let [fades, blurs] = BLURS_MPS;
        let gaps = |colour: [u8; 3]| gaps(Paint::plain(tag, colour), side, self.radius_m);
        let mut blur = Mesh::default();
        let out = Vec3::Y * side;
        blur.disc(Paint::plain(tag, BLUR).glossy(80), out * (OUTER_M + 0.01), out, self.radius_m * 0.58, 10);
        for (mesh, joint, shown) in [
            (gaps(GAP), roll, [0.0, fades]),
            (gaps(FADED_GAP), roll, [fades, blurs]),
            (blur, None, [blurs, f32::INFINITY]),
        ] {
            model.add_part(Part { parent: Some(wheel), pivot: Vec3::ZERO, joint, shown_mps: Some(shown), mesh });
        }
    }
}

/// The radius next to a wheel's at which whole spokes go by in [`LAP_M`], so that nobody sees a phase begin anew.
fn rolling_radius_m(radius_m: f32) -> f32 {
    let per_m = SPOKES as f32 / TAU;
    LAP_M * per_m / ops::round(LAP_M * per_m / radius_m)
}

/// The lower half of a tyre's tread.
fn tread(mesh: &mut Mesh, tyre: Paint, side: f32, radius_m: f32, sides: u32) {
    let at = |i: u32, out: f32| {
        let angle = -TAU * i as f32 / sides as f32;
        Vec3::new(radius_m * ops::cos(angle), side * out, radius_m * ops::sin(angle))
    };
    for i in 0..sides / 2 {
        let mut ring = [at(i, OUTER_M), at(i + 1, OUTER_M), at(i + 1, -INNER_M), at(i, -INNER_M)];
        if side > 0.0 {
            ring.reverse();
        }
        mesh.polygon(tyre, &ring);
    }
}

/// The gaps between the spokes of a rim, on its face.
fn gaps(paint: Paint, side: f32, radius_m: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for spoke in 0..SPOKES {
        let at = |share: f32, off_rad: f32| {
            let angle = TAU * spoke as f32 / SPOKES as f32 - side * off_rad;
            let radius = radius_m * share;
            Vec3::new(radius * ops::cos(angle), side * (OUTER_M + 0.01), radius * ops::sin(angle))
        };
        mesh.polygon(paint, &[at(0.26, -0.3), at(0.6, -0.42), at(0.6, 0.42), at(0.26, 0.3)]);
    }
    mesh
}

//! People, on foot and riding, with joints at shoulders, elbows, hips and knees.

use core::f32::consts::PI;

use glam::Vec3;

use super::model::{Detail, Model, Swing};
use super::variety::Variety;
use super::{Mesh, Paint};
use crate::SemanticTag;

const SKINS: [[u8; 3]; 5] = [[236, 196, 168], [214, 166, 132], [176, 124, 92], [122, 82, 58], [88, 58, 42]];
const HAIRS: [[u8; 3]; 5] = [[36, 28, 24], [82, 58, 38], [142, 104, 62], [160, 158, 154], [22, 22, 26]];
const TOPS: [[u8; 3]; 12] = [
    [188, 42, 44],
    [42, 78, 142],
    [228, 224, 214],
    [44, 46, 52],
    [214, 168, 52],
    [64, 116, 78],
    [128, 70, 120],
    [92, 140, 176],
    [196, 110, 60],
    [110, 100, 86],
    [222, 140, 160],
    [70, 88, 70],
];
const TROUSERS: [[u8; 3]; 6] = [[40, 52, 82], [34, 34, 38], [98, 86, 70], [126, 128, 132], [62, 66, 52], [76, 96, 130]];
const SHOES: [[u8; 3]; 3] = [[28, 26, 26], [220, 220, 216], [90, 60, 40]];

/// What a person wears.
pub(super) struct Look {
    tag: SemanticTag,
    skin: [u8; 3],
    hair: [u8; 3],
    pub(super) top: [u8; 3],
    legs: [u8; 3],
    shoes: [u8; 3],
    sleeves: bool,
    skirt: bool,
    bag: bool,
    sides: u32,
}

impl Look {
    pub(super) fn of(variety: &mut Variety, tag: SemanticTag, detail: Detail) -> Self {
        Self {
            tag,
            skin: variety.colour(&SKINS),
            hair: variety.colour(&HAIRS),
            top: variety.colour(&TOPS),
            legs: variety.colour(&TROUSERS),
            shoes: variety.pick(&SHOES),
            sleeves: !variety.one_in(3),
            skirt: variety.one_in(4),
            bag: variety.one_in(3),
            sides: match detail {
                Detail::Fine => 8,
                Detail::Coarse => 5,
                Detail::Rough => 3,
            },
        }
    }

    /// Dressed for a saddle.
    pub(super) fn riding(self) -> Self {
        Self { skirt: false, ..self }
    }

    /// Dressed for a chair with a back.
    pub(super) fn sitting(self) -> Self {
        Self { bag: false, ..self.riding() }
    }

    fn paint(&self, colour: [u8; 3]) -> Paint {
        Paint::plain(self.tag, colour)
    }

    /// A limb from `a` to `b` with round ends.
    fn limb(&self, mesh: &mut Mesh, colour: [u8; 3], a: Vec3, b: Vec3, radii: [f32; 2]) {
        mesh.tube(self.paint(colour), a, b, radii[0], radii[1], self.sides);
        if self.sides > 3 {
            let axis = (b - a).normalize_or(Vec3::NEG_Z);
            mesh.disc(self.paint(colour), b, axis, radii[1], self.sides);
        }
    }

    /// Trunk and head around the hips' middle, upright.
    pub(super) fn trunk(&self, helmet: Option<[u8; 3]>) -> Mesh {
        let mut mesh = Mesh::default();
        if self.sides == 3 {
            return self.rough_trunk(helmet);
        }
        let rings = if self.sides > 6 { 6 } else { 4 };
        let top = self.paint(self.top);
        mesh.ellipsoid(self.paint(self.legs), Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.13, 0.17, 0.15), rings, self.sides);
        mesh.ellipsoid(top, Vec3::new(0.0, 0.0, 0.17), Vec3::new(0.125, 0.17, 0.2), rings, self.sides);
        mesh.ellipsoid(top, Vec3::new(0.0, 0.0, 0.36), Vec3::new(0.13, 0.215, 0.2), rings, self.sides);
        mesh.tube(self.paint(self.skin), Vec3::new(0.0, 0.0, 0.5), Vec3::new(0.01, 0.0, 0.62), 0.055, 0.05, self.sides);
        mesh.ellipsoid(
            self.paint(self.skin),
            Vec3::new(0.02, 0.0, 0.7),
            Vec3::new(0.1, 0.08, 0.125),
            rings,
            self.sides,
        );
        let (cover, radii) = match helmet {
            Some(colour) => (self.paint(colour).glossy(120), Vec3::new(0.13, 0.115, 0.12)),
            None => (self.paint(self.hair), Vec3::new(0.105, 0.09, 0.105)),
        };
        mesh.ellipsoid(cover, Vec3::new(-0.02, 0.0, 0.745), radii, rings, self.sides);
        if self.skirt && helmet.is_none() {
            self.limb(&mut mesh, self.legs, Vec3::new(0.0, 0.0, 0.06), Vec3::new(0.0, 0.0, -0.4), [0.15, 0.23]);
        }
        if self.bag {
            let bag = self.paint([60, 62, 70]);
            mesh.cuboid(bag, Vec3::new(-0.27, -0.13, 0.14), Vec3::new(-0.12, 0.13, 0.5));
        }
        mesh
    }

    fn rough_trunk(&self, helmet: Option<[u8; 3]>) -> Mesh {
        let mut mesh = Mesh::default();
        mesh.ellipsoid(self.paint(self.top), Vec3::Z * 0.24, Vec3::new(0.14, 0.21, 0.36), 4, 5);
        let head = self.paint(helmet.unwrap_or(self.hair));
        mesh.ellipsoid(head, Vec3::new(0.0, 0.0, 0.72), Vec3::new(0.1, 0.09, 0.14), 3, 4);
        if self.skirt && helmet.is_none() {
            self.limb(&mut mesh, self.legs, Vec3::Z * 0.06, Vec3::Z * -0.4, [0.15, 0.23]);
        }
        mesh
    }

    /// Upper arm around the shoulder, hanging.
    pub(super) fn upper_arm(&self) -> Mesh {
        let mut mesh = Mesh::default();
        self.limb(&mut mesh, self.top, Vec3::new(0.0, 0.0, 0.03), Vec3::new(0.0, 0.0, -0.28), [0.06, 0.045]);
        mesh
    }

    /// Lower arm with its hand around the elbow, hanging.
    pub(super) fn lower_arm(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let colour = if self.sleeves { self.top } else { self.skin };
        self.limb(&mut mesh, colour, Vec3::new(0.0, 0.0, 0.02), Vec3::new(0.0, 0.0, -0.24), [0.044, 0.034]);
        if self.sides > 3 {
            mesh.ellipsoid(
                self.paint(self.skin),
                Vec3::new(0.0, 0.0, -0.28),
                Vec3::new(0.04, 0.03, 0.07),
                4,
                self.sides,
            );
        }
        mesh
    }

    /// Upper leg around the hip, hanging.
    pub(super) fn thigh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        self.limb(&mut mesh, self.legs, Vec3::new(0.0, 0.0, 0.04), Vec3::new(0.0, 0.0, -0.44), [0.095, 0.066]);
        mesh
    }

    /// Lower leg with its foot around the knee, hanging.
    pub(super) fn shin(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let colour = if self.skirt { self.skin } else { self.legs };
        self.limb(&mut mesh, colour, Vec3::new(0.0, 0.0, 0.03), Vec3::new(0.0, 0.0, -0.38), [0.068, 0.046]);
        if self.sides == 3 {
            return mesh;
        }
        let shoe = self.paint(self.shoes);
        mesh.cuboid(shoe, Vec3::new(-0.08, -0.045, -0.45), Vec3::new(0.18, 0.045, -0.36));
        mesh.polygon(
            shoe,
            &[
                Vec3::new(-0.08, 0.045, -0.45),
                Vec3::new(0.18, 0.045, -0.45),
                Vec3::new(0.18, -0.045, -0.45),
                Vec3::new(-0.08, -0.045, -0.45),
            ],
        );
        mesh
    }
}

/// Height of the hips of a person 1.75 m tall, metres.
const HIP_M: f32 = 0.92;

/// Speed from which on a walker's stride is full, m/s.
const STRIDE_MPS: f32 = 1.3;

/// A swing about the axis to the left: positive angles move a hanging limb backwards.
fn stride(rest_rad: f32, amplitude_rad: f32, lead_rad: f32) -> Option<Swing> {
    Some(Swing { axis: Vec3::Y, rest_rad, amplitude_rad, lead_rad, full_speed_mps: STRIDE_MPS })
}

/// A child's height as a share of that of a grown person.
const CHILD: f32 = 0.76;
/// Upper arms and elbows of one who pushes something, radians.
const PUSHES_RAD: [f32; 2] = [-0.55, -0.5];

/// A person on foot of class Pedestrian, about 1.75 m tall.
pub fn walker(variant: u32, detail: Detail) -> Model {
    strolling(variant, detail, None)
}

/// A child of about nine years.
pub fn child(variant: u32, detail: Detail) -> Model {
    walker(variant, detail).scaled(CHILD)
}

/// A walker who holds something before the chest.
pub(super) fn pusher(variant: u32, detail: Detail) -> Model {
    strolling(variant, detail, Some(PUSHES_RAD.map(|rad| Swing::rigid(Vec3::Y, rad))))
}

/// A walker whose arms swing, or are held.
fn strolling(variant: u32, detail: Detail, arms: Option<[Swing; 2]>) -> Model {
    let mut variety = Variety::of(variant);
    let look = Look::of(&mut variety, SemanticTag::Pedestrian, detail);
    let mut model = Model::default();
    let lean = Some(Swing::rigid(Vec3::Y, 0.04));
    let trunk = model.add(None, Vec3::new(0.0, 0.0, HIP_M), lean, look.trunk(None));
    for (side, lead) in [(1.0f32, 0.0), (-1.0, PI)] {
        let hip = Vec3::new(0.0, side * 0.09, HIP_M - 0.02);
        let thigh = model.add(None, hip, stride(-0.06, 0.48, lead), look.thigh());
        model.add(Some(thigh), Vec3::new(0.0, 0.0, -0.44), stride(0.22, 0.32, lead + 0.9), look.shin());
        // Arms swing against the leg of their side.
        let shoulder = Vec3::new(0.0, side * 0.225, 0.47);
        let swings = (stride(0.02, 0.42, lead + PI), stride(-0.25, 0.18, lead + PI));
        let (at_shoulder, at_elbow) = arms.map_or(swings, |[shoulder, elbow]| (Some(shoulder), Some(elbow)));
        let upper = model.add(Some(trunk), shoulder, at_shoulder, look.upper_arm());
        model.add(Some(upper), Vec3::new(0.0, 0.0, -0.27), at_elbow, look.lower_arm());
    }
    model
}

/// Where a rider sits and how far the rider bends.
pub(super) struct Seat {
    /// Hips above the ground, on the vehicle's axis.
    pub(super) hip: Vec3,
    /// Forward lean of the trunk, radians.
    pub(super) lean_rad: f32,
    /// Thighs: mean angle and amplitude, radians; negative lifts the knee.
    pub(super) thigh_rad: [f32; 2],
    /// Shins: mean angle and amplitude, radians.
    pub(super) shin_rad: [f32; 2],
    /// Upper arms relative to the trunk, radians; negative reaches forward.
    pub(super) arm_rad: f32,
}

/// Adds a rider; the legs turn with the phase all the time, as pedals do.
pub(super) fn ride(model: &mut Model, look: &Look, seat: &Seat, helmet: Option<[u8; 3]>) {
    let pedal = |[rest_rad, amplitude_rad]: [f32; 2], lead_rad: f32| {
        Some(Swing { axis: Vec3::Y, rest_rad, amplitude_rad, lead_rad, full_speed_mps: 0.0 })
    };
    let lean = Some(Swing::rigid(Vec3::Y, seat.lean_rad));
    let trunk = model.add(None, seat.hip, lean, look.trunk(helmet));
    for (side, lead) in [(1.0f32, 0.0), (-1.0, PI)] {
        let hip = seat.hip + Vec3::new(0.0, side * 0.09, -0.02);
        let thigh = model.add(None, hip, pedal(seat.thigh_rad, lead), look.thigh());
        model.add(Some(thigh), Vec3::new(0.0, 0.0, -0.44), pedal(seat.shin_rad, lead + 1.1), look.shin());
        let shoulder = Vec3::new(0.0, side * 0.225, 0.47);
        let upper = model.add(Some(trunk), shoulder, Some(Swing::rigid(Vec3::Y, seat.arm_rad)), look.upper_arm());
        let elbow = Some(Swing::rigid(Vec3::Y, -0.35));
        model.add(Some(upper), Vec3::new(0.0, 0.0, -0.27), elbow, look.lower_arm());
    }
}

//! People, on foot and riding, with joints at hips, knees, ankles, shoulders and elbows.

use core::f32::consts::PI;

use glam::Vec3;

use super::figure::{ARM_OUT, HAND_M, Look, SHIN_M, SHOULDER_M, THIGH_M, UPPER_ARM_M};
use super::outfit::{Carried, Outfit, Stance};
use crate::SemanticTag;
use crate::mesh::Mesh;
use crate::mesh::gait::{Cycle, Gait};
use crate::mesh::model::{Detail, Joint, Model, Part, Swing};
use crate::mesh::variety::Variety;

/// Height of the hips of a person 1.75 m tall, metres.
const HIP_M: f32 = 0.92;
/// Distance of a hip from the middle, metres.
const HIP_Y_M: f32 = 0.088;
/// Speeds from which on legs and arms move as those of one who walks, m/s. Phases advance with the way, so that feet stay
/// where they tread, however slowly.
const LEGS_MPS: f32 = 0.5;
const ARMS_MPS: f32 = 1.4;
/// Where in a stride knees are bent most and ankles stretched, radians.
const KNEE_UP_RAD: f32 = 3.0;
const PUSHED_OFF_RAD: f32 = 2.3;
/// Below this speed one has a telephone in the hand that is held up for it, m/s.
const PHONES_MPS: f32 = 0.4;
/// Top of a head above the hips less the head's share of it, and that share, metres.
const HEAD_M: [f32; 2] = [0.59, 0.24];

/// Upper arms and elbows of one who pushes something, radians.
const PUSHES_RAD: [f32; 2] = [-0.55, -0.5];
/// Of one who holds an umbrella.
const HOLDS_RAD: [f32; 2] = [-0.3, -1.6];
/// Of one who leans on a stick.
const LEANS_RAD: [f32; 2] = [-0.16, -0.3];

/// A person on foot of class Pedestrian. With an umbrella up if it rains on one who has one.
pub fn walker(variant: u32, detail: Detail, under_umbrella: bool) -> Model {
    let mut look = Look::of(&mut Variety::of(variant), SemanticTag::Pedestrian, detail);
    if under_umbrella && look.outfit.carried == Carried::RolledUmbrella {
        look.outfit.carried = Carried::Nothing;
    }
    afoot(&look, under_umbrella)
}

/// A child of 6 to 13 years.
pub fn child(variant: u32, detail: Detail) -> Model {
    afoot(&Look::child(&mut Variety::of(variant), detail), false)
}

/// Whether a walker has an umbrella up in rain of so many percent of a cloudburst.
pub fn has_umbrella_up(variant: u32, rain_pct: f32) -> bool {
    let outfit = Outfit::of(&mut Variety::of(variant), false);
    outfit.umbrella_pct.is_some_and(|from_pct| rain_pct >= from_pct)
}

/// A walker who holds something before the chest.
pub(in crate::mesh) fn pusher(variant: u32, detail: Detail) -> Model {
    let look = Look::of(&mut Variety::of(variant), SemanticTag::Pedestrian, detail);
    let outfit = look.outfit.handed();
    strolling(&Look { outfit, ..look }, 1.0, |_| Arm::Held(PUSHES_RAD)).0
}

fn afoot(look: &Look, under_umbrella: bool) -> Model {
    let outfit = &look.outfit;
    let scale = outfit.build.height_m / (HIP_M + HEAD_M[0] + HEAD_M[1] * outfit.build.head);
    let leans = outfit.carried == Carried::Stick;
    let (mut model, forearms) = strolling(look, scale, |side| match side == look.hand() {
        true if leans => Arm::Held(LEANS_RAD),
        true if outfit.carried.is_in_hand() => Arm::Loaded,
        false if under_umbrella => Arm::Held(HOLDS_RAD),
        _ => Arm::Free,
    });
    let mut hold = |side: f32, rad: [f32; 2], mesh: Mesh| {
        // What is held is upright, whatever the arm does.
        let upright = Some(Swing::rigid(Vec3::Y, -rad[0] - rad[1] - lean(look).stand));
        model.add(Some(forearms[usize::from(side < 0.0)]), Vec3::Z * -HAND_M, upright, mesh);
    };
    if leans {
        hold(look.hand(), LEANS_RAD, look.stick(0.87));
    }
    if under_umbrella {
        hold(-look.hand(), HOLDS_RAD, look.umbrella(-look.hand()));
    }
    let phones = outfit.stance == Stance::Phone && !under_umbrella && look.detail < Detail::Rough;
    if phones {
        let parent = Some(forearms[usize::from(look.hand() > 0.0)]);
        let shown_mps = Some([0.0, PHONES_MPS]);
        model.add_part(Part { parent, pivot: Vec3::ZERO, joint: None, shown_mps, mesh: look.phone() });
    }
    model.scaled(scale)
}

/// What an arm does.
#[derive(Clone, Copy)]
enum Arm {
    /// It swings against the leg of its side.
    Free,
    /// It swings little under what it carries.
    Loaded,
    /// Shoulder and elbow are kept, radians.
    Held([f32; 2]),
}

/// The trunk's forward lean.
fn lean(look: &Look) -> Gait {
    let bent = 0.02 + 0.3 * look.outfit.build.stoop_rad;
    let gait = |value: f32| Cycle::new(value, 0.0);
    Gait {
        stand: bent - 0.02,
        walk: gait(bent + 0.02),
        run: gait(bent + 0.16),
        walks_mps: ARMS_MPS,
        ..Gait::still(0.0)
    }
}

/// Hip, knee and ankle of a leg. `reach` is by how much strides are longer than usual for such a leg.
fn leg(look: &Look, side: f32, reach: f32) -> [Gait; 3] {
    // The leg that bears no weight is bent a little.
    let stand = if side == look.outfit.bears { [-0.01, 0.03, -0.02] } else { [-0.2, 0.31, -0.11] };
    let walk = [
        Cycle::new(-0.04, 0.33 * reach),
        Cycle::new(0.1, 0.0).lifted(0.95, KNEE_UP_RAD),
        Cycle::new(-0.06, -0.16 * reach).lifted(0.45, PUSHED_OFF_RAD),
    ];
    let run = [
        Cycle::new(-0.14, 0.6),
        Cycle::new(0.38, 0.0).lifted(1.2, KNEE_UP_RAD),
        Cycle::new(-0.22, -0.2).lifted(0.5, PUSHED_OFF_RAD),
    ];
    let lead_rad = if side > 0.0 { 0.0 } else { PI };
    let gait =
        |i: usize| Gait { stand: stand[i], walk: walk[i], run: run[i], lead_rad, beats: 1.0, walks_mps: LEGS_MPS };
    [gait(0), gait(1), gait(2)]
}

/// How the hips rise and sink so that one foot or the other is on the ground: fitted to the legs above, within 15 mm.
fn bob(reach: f32) -> Gait {
    let more = reach - 1.0;
    Gait {
        stand: -0.004,
        walk: Cycle::new(-0.001 - 0.043 * more, 0.015 + 0.04 * more),
        run: Cycle::new(-0.057, 0.05),
        lead_rad: 0.75,
        beats: 2.0,
        walks_mps: LEGS_MPS,
    }
}

/// Shoulder and elbow.
fn arm(look: &Look, side: f32, arm: Arm) -> [Gait; 2] {
    let lead_rad = if side > 0.0 { PI } else { 0.0 };
    let swing = match arm {
        Arm::Held(rad) => return rad.map(Gait::still),
        Arm::Free => 1.0,
        Arm::Loaded => 0.25,
    };
    let stand = match look.outfit.stance {
        Stance::Pockets if swing == 1.0 => [0.28, -0.62],
        Stance::Phone if swing == 1.0 && side == look.outfit.bears => [0.12, -2.1],
        _ => [0.03 - 0.5 * lean(look).stand, -0.14],
    };
    let walk = [Cycle::new(0.02, 0.36 * swing), Cycle::new(-0.12 - 0.16 * swing, 0.16 * swing)];
    let run = [Cycle::new(0.12, 0.62 * swing), Cycle::new(-0.4 - 0.95 * swing, 0.2 * swing)];
    let gait =
        |i: usize| Gait { stand: stand[i], walk: walk[i], run: run[i], lead_rad, beats: 1.0, walks_mps: ARMS_MPS };
    [gait(0), gait(1)]
}

impl Look {
    /// A shoulder in the trunk's frame.
    fn shoulder(&self, side: f32) -> Vec3 {
        let y_m = self.outfit.build.shoulders_m - 0.012;
        Vec3::new(self.spine_m(SHOULDER_M), side * y_m, SHOULDER_M)
    }
}

/// An elbow in the upper arm's frame.
fn elbow_at(side: f32) -> Vec3 {
    Vec3::new(0.0, side * ARM_OUT * UPPER_ARM_M, -UPPER_ARM_M)
}

/// Somebody who walks, before it is scaled, and the left and right forearm among its parts.
fn strolling(look: &Look, scale: f32, arms: impl Fn(f32) -> Arm) -> (Model, [usize; 2]) {
    // A stride is as long for everybody: short legs reach farther.
    let reach = (1.0 / scale).clamp(0.94, 1.35);
    let mut model = Model::default();
    let hips = model.add_part(Part {
        parent: None,
        pivot: Vec3::Z * HIP_M,
        joint: Some(Joint::Bob(bob(reach))),
        shown_mps: None,
        mesh: look.hips(),
    });
    let trunk = model.add_stride(hips, Vec3::ZERO, lean(look), look.trunk(None));
    let forearms = [1.0f32, -1.0].map(|side| {
        let [hip, knee, ankle] = leg(look, side, reach);
        let thigh = model.add_stride(hips, Vec3::new(0.0, side * HIP_Y_M, -0.02), hip, look.thigh());
        let shin = model.add_stride(thigh, Vec3::Z * -THIGH_M, knee, look.shin());
        model.add_stride(shin, Vec3::Z * -SHIN_M, ankle, look.foot(side));
        let [shoulder, elbow] = arm(look, side, arms(side));
        let upper = model.add_stride(trunk, look.shoulder(side), shoulder, look.upper_arm(side));
        model.add_stride(upper, elbow_at(side), elbow, look.lower_arm(side))
    });
    (model, forearms)
}

/// Where a rider sits and how far the rider bends.
pub(in crate::mesh) struct Seat {
    /// Hips above the ground, on the vehicle's axis.
    pub(in crate::mesh) hip: Vec3,
    /// Forward lean of the trunk, radians.
    pub(in crate::mesh) lean_rad: f32,
    /// Thighs: mean angle and amplitude, radians; negative lifts the knee.
    pub(in crate::mesh) thigh_rad: [f32; 2],
    /// Shins: mean angle and amplitude, radians.
    pub(in crate::mesh) shin_rad: [f32; 2],
    /// Upper arms relative to the trunk, radians; negative reaches forward.
    pub(in crate::mesh) arm_rad: f32,
}

/// Adds a rider; the legs turn with the phase all the time, as pedals do.
pub(in crate::mesh) fn ride(model: &mut Model, look: &Look, seat: &Seat, helmet: Option<[u8; 3]>) {
    let pedal = |[rest_rad, amplitude_rad]: [f32; 2], lead_rad: f32| {
        Some(Swing { axis: Vec3::Y, rest_rad, amplitude_rad, lead_rad, full_speed_mps: 0.0 })
    };
    let lean = Some(Swing::rigid(Vec3::Y, seat.lean_rad));
    let mut trunk = look.hips();
    trunk.append(&look.trunk(helmet), Vec3::ZERO);
    let trunk = model.add(None, seat.hip, lean, trunk);
    for (side, lead) in [(1.0f32, 0.0), (-1.0, PI)] {
        let hip = seat.hip + Vec3::new(0.0, side * HIP_Y_M, -0.02);
        let thigh = model.add(None, hip, pedal(seat.thigh_rad, lead), look.thigh());
        let knee = Vec3::Z * -THIGH_M;
        let shin = model.add(Some(thigh), knee, pedal(seat.shin_rad, lead + 1.1), look.shin());
        model.add(Some(shin), Vec3::Z * -SHIN_M, None, look.foot(side));
        let shoulder = Swing::rigid(Vec3::Y, seat.arm_rad);
        let upper = model.add(Some(trunk), look.shoulder(side), Some(shoulder), look.upper_arm(side));
        let elbow = Some(Swing::rigid(Vec3::Y, -0.35));
        model.add(Some(upper), elbow_at(side), elbow, look.lower_arm(side));
    }
}

#[cfg(test)]
mod tests;

//! Models: meshes with joints, as plain data.
//!
//! A model is a list of parts. A part's mesh is given around its own pivot; its parent comes before
//! it in the list. A part is posed by
//!
//! ```text
//! to_model(part) = to_model(parent) * translation(pivot + z * joint.rise_m(motion))
//!     * rotation(joint.axis(), joint.angle(motion))
//! ```
//!
//! and left out at speeds where it is not shown. The parent of a part without one is the model
//! itself, whose origin is the centre of its footprint on the ground (x forward, y left, z up). Wind
//! then moves vertices in the world by [`crate::wind::offset`].

use glam::{Affine3A, Quat, Vec3, Vec3A};
use kernel::ops;

use super::gait::Gait;
use super::motion::Motion;
use super::{Mesh, Vertex};

/// How a joint turns with the phase of the gait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// Axis of the joint in the part's frame, a unit vector.
    pub axis: Vec3,
    /// Angle at rest, radians counter-clockwise about the axis.
    pub rest_rad: f32,
    /// Greatest deflection from [`Swing::rest_rad`] at full speed, radians.
    pub amplitude_rad: f32,
    /// By how much this joint is ahead of the actor's phase, radians.
    pub lead_rad: f32,
    /// Speed from which on the deflection is full, m/s; below it shrinks in proportion, and with 0 it
    /// is always full.
    pub full_speed_mps: f32,
}

impl Swing {
    /// A joint that does not move.
    pub fn rigid(axis: Vec3, rest_rad: f32) -> Self {
        Self { axis, rest_rad, amplitude_rad: 0.0, lead_rad: 0.0, full_speed_mps: 0.0 }
    }

    /// `rest + amplitude * sin(phase + lead) * min(1, |speed| / full speed)`.
    pub fn angle(&self, phase_rad: f32, speed_mps: f32) -> f32 {
        let share = if self.full_speed_mps > 0.0 { (speed_mps.abs() / self.full_speed_mps).min(1.0) } else { 1.0 };
        self.rest_rad + self.amplitude_rad * ops::sin(phase_rad + self.lead_rad) * share
    }
}

/// What turns a part against its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Joint {
    /// It swings as its actor walks or pedals.
    Swing(Swing),
    /// It turns about y as its actor walks, radians.
    Stride(Gait),
    /// It rises and sinks as its actor walks, metres, and does not turn.
    Bob(Gait),
    /// It steers: turns about z as the front wheels do.
    Steer,
    /// It rolls: turns about y by the way driven over this radius, metres.
    Roll {
        /// The radius.
        radius_m: f32,
    },
}

impl Joint {
    /// The axis in the part's frame, a unit vector.
    pub fn axis(&self) -> Vec3 {
        match self {
            Self::Swing(swing) => swing.axis,
            Self::Steer => Vec3::Z,
            Self::Stride(_) | Self::Bob(_) | Self::Roll { .. } => Vec3::Y,
        }
    }

    /// The angle at a moment, radians counter-clockwise about the axis.
    pub fn angle(&self, motion: &Motion) -> f32 {
        match self {
            Self::Swing(swing) => swing.angle(motion.phase_rad, motion.speed_mps),
            Self::Stride(gait) => gait.value(motion.phase_rad, motion.speed_mps),
            Self::Bob(_) => 0.0,
            Self::Steer => motion.steer_rad,
            Self::Roll { radius_m } => motion.rolled_m / radius_m,
        }
    }

    /// How far the part is above its pivot at a moment, metres.
    pub fn rise_m(&self, motion: &Motion) -> f32 {
        match self {
            Self::Bob(gait) => gait.value(motion.phase_rad, motion.speed_mps),
            _ => 0.0,
        }
    }
}

/// A rigid part of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Index of the part it hangs on.
    pub parent: Option<usize>,
    /// Where, in the parent's frame, metres.
    pub pivot: Vec3,
    /// How it turns; `None` keeps the parent's direction.
    pub joint: Option<Joint>,
    /// Speeds from and below which it is there, whichever way, m/s; `None` is always.
    pub shown_mps: Option<[f32; 2]>,
    /// Triangles around the pivot.
    pub mesh: Mesh,
}

/// A model at one level of detail.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Parts; parents come before their children.
    pub parts: Vec<Part>,
}

/// How finely a model is made. Shapes agree up to [`Detail::error_m`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detail {
    /// All there is.
    Fine,
    /// For the middle distance.
    Coarse,
    /// For what covers few pixels.
    Rough,
}

impl Detail {
    /// By how much outlines may differ from [`Detail::Fine`], metres.
    pub const fn error_m(self) -> f32 {
        match self {
            Self::Fine => 0.0,
            Self::Coarse => 0.05,
            Self::Rough => 0.2,
        }
    }

    /// Every level, the finest first.
    pub const ALL: [Self; 3] = [Self::Fine, Self::Coarse, Self::Rough];
}

impl Model {
    /// A model of one rigid mesh.
    pub fn rigid(mesh: Mesh) -> Self {
        let mut model = Self::default();
        model.add(None, Vec3::ZERO, None, mesh);
        model
    }

    /// Appends a part that is always there and gives its index.
    pub fn add(&mut self, parent: Option<usize>, pivot: Vec3, swing: Option<Swing>, mesh: Mesh) -> usize {
        self.add_part(Part { parent, pivot, joint: swing.map(Joint::Swing), shown_mps: None, mesh })
    }

    /// Appends a part that turns as somebody walks and gives its index.
    pub fn add_stride(&mut self, parent: usize, pivot: Vec3, gait: Gait, mesh: Mesh) -> usize {
        let joint = Some(Joint::Stride(gait));
        self.add_part(Part { parent: Some(parent), pivot, joint, shown_mps: None, mesh })
    }

    /// Appends a part and gives its index.
    pub fn add_part(&mut self, part: Part) -> usize {
        self.parts.push(part);
        self.parts.len() - 1
    }

    /// How many vertices it has.
    pub fn vertices(&self) -> usize {
        self.parts.iter().map(|part| part.mesh.vertices.len()).sum()
    }

    /// The same smaller or larger.
    pub fn scaled(mut self, factor: f32) -> Self {
        for part in &mut self.parts {
            part.pivot *= factor;
            match &mut part.joint {
                Some(Joint::Roll { radius_m }) => *radius_m *= factor,
                Some(Joint::Bob(gait)) => *gait = gait.scaled(factor),
                _ => {}
            }
            part.mesh.scale(Vec3::splat(factor));
        }
        self
    }

    /// The transform of each part to the model's frame, whether it is shown or not.
    pub fn pose(&self, motion: &Motion) -> Vec<Affine3A> {
        let mut poses: Vec<Affine3A> = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            let turn = part.joint.map_or(Quat::IDENTITY, |j| Quat::from_axis_angle(j.axis(), j.angle(motion)));
            let rise_m = part.joint.map_or(0.0, |joint| joint.rise_m(motion));
            let local = Affine3A::from_rotation_translation(turn, part.pivot + Vec3::Z * rise_m);
            poses.push(part.parent.map_or(local, |parent| poses[parent] * local));
        }
        poses
    }

    /// The meshes that are shown, with their transforms to the model's frame.
    pub fn posed(&self, motion: &Motion) -> impl Iterator<Item = (&Mesh, Affine3A)> {
        let speed_mps = motion.speed_mps.abs();
        let parts = self.parts.iter().zip(self.pose(motion));
        parts.filter(move |(part, _)| part.is_shown(speed_mps)).map(|(part, pose)| (&part.mesh, pose))
    }

    /// All that is shown of it while it stands, as one mesh.
    pub fn at_rest(&self) -> Mesh {
        let mut whole = Mesh::default();
        for (mesh, pose) in self.posed(&Motion::default()) {
            let first = whole.vertices.len();
            whole.append(mesh, Vec3::ZERO);
            for vertex in &mut whole.vertices[first..] {
                let position = pose.transform_point3a(Vec3A::from_array(vertex.position)).to_array();
                let n = pose.matrix3 * Vec3A::from_array(vertex.normal.map(f32::from));
                *vertex = Vertex { position, normal: n.round().to_array().map(|n| n as i8), ..*vertex };
            }
        }
        whole
    }
}

impl Part {
    /// Whether it is there at a speed, m/s, 0 or more.
    pub fn is_shown(&self, speed_mps: f32) -> bool {
        self.shown_mps.is_none_or(|[from, to]| (from..to).contains(&speed_mps))
    }
}

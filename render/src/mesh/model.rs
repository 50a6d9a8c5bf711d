//! Models: meshes with joints, as plain data.
//!
//! A model is a list of parts. A part's mesh is given around its own pivot; its parent comes before
//! it in the list. A part is posed by
//!
//! ```text
//! to_model(part) = to_model(parent) * translation(pivot) * rotation(swing.axis, swing.angle(..))
//! ```
//!
//! where the parent of a part without one is the model itself, whose origin is the centre of its
//! footprint on the ground (x forward, y left, z up). Wind then moves vertices in the world by
//! [`crate::wind::offset`].

use glam::{Affine3A, Quat, Vec3};
use kernel::ops;

use super::Mesh;

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

/// A rigid part of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Index of the part it hangs on.
    pub parent: Option<usize>,
    /// Where, in the parent's frame, metres.
    pub pivot: Vec3,
    /// How it turns; `None` keeps the parent's direction.
    pub swing: Option<Swing>,
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
        Self { parts: vec![Part { parent: None, pivot: Vec3::ZERO, swing: None, mesh }] }
    }

    /// Appends a part and gives its index.
    pub fn add(&mut self, parent: Option<usize>, pivot: Vec3, swing: Option<Swing>, mesh: Mesh) -> usize {
        self.parts.push(Part { parent, pivot, swing, mesh });
        self.parts.len() - 1
    }

    /// The same smaller or larger.
    pub fn scaled(mut self, factor: f32) -> Self {
        for part in &mut self.parts {
            part.pivot *= factor;
            part.mesh.scale(Vec3::splat(factor));
        }
        self
    }

    /// The transform of each part to the model's frame.
    pub fn pose(&self, phase_rad: f32, speed_mps: f32) -> Vec<Affine3A> {
        let mut poses: Vec<Affine3A> = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            let turn =
                part.swing.map_or(Quat::IDENTITY, |s| Quat::from_axis_angle(s.axis, s.angle(phase_rad, speed_mps)));
            let local = Affine3A::from_rotation_translation(turn, part.pivot);
            poses.push(part.parent.map_or(local, |parent| poses[parent] * local));
        }
        poses
    }
}

//! What a tyre stands on.

use glam::Vec3;

use crate::map_data::SurfaceKind;

/// How a surface holds tyres and brakes their rolling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// Greatest coefficient of friction, at the slip where the tyre holds best.
    pub peak: f32,
    /// Coefficient of friction of a tyre that slides.
    pub sliding: f32,
    /// Coefficient of rolling resistance.
    pub rolling: f32,
}

/// Dry surfaces.
///
/// Ratios of sliding to peak friction and rolling resistance: Wong, *Theory of Ground Vehicles*, tables of average
/// road adhesion and of rolling resistance (asphalt 0.9 and 0.75 with tyres of their time; gravel 0.6 and 0.55; rolling
/// 0.013 on asphalt, 0.05 on unpaved ground). Peak on asphalt: Euro NCAP demands 0.9 of a test track for emergency
/// braking, today's tyres reach more. Setts and grass: Burg and Moser, *Handbuch Verkehrsunfallrekonstruktion*
/// (0.5 to 0.7 and 0.35 to 0.45).
pub const fn grip(kind: SurfaceKind) -> Grip {
    match kind {
        SurfaceKind::Road => Grip { peak: 1.0, sliding: 0.8, rolling: 0.013 },
        SurfaceKind::RoadLine => Grip { peak: 0.9, sliding: 0.7, rolling: 0.013 },
        SurfaceKind::Sidewalk => Grip { peak: 0.9, sliding: 0.75, rolling: 0.013 },
        // Setts between the rails.
        SurfaceKind::Ground => Grip { peak: 0.7, sliding: 0.58, rolling: 0.02 },
        SurfaceKind::Terrain => Grip { peak: 0.45, sliding: 0.38, rolling: 0.05 },
    }
}

/// The ground below a wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footing {
    /// Way from where the spring is fixed to the body down to the ground, along the car's z axis, metres.
    pub distance_m: f32,
    /// Unit normal of the ground, along the car's axes.
    pub normal: Vec3,
    /// What it is made of.
    pub kind: SurfaceKind,
}

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
///
/// Gravel is that of a road, packed by those who drive on it: its figures are Wong's, its rolling resistance that of
/// rolled gravel. On loose gravel a locked wheel digs in and pushes a heap along, so that a car with anti-lock brakes
/// needs a longer way than one without (by 27 % on average, Forkenbrock et al., NHTSA 1999); that is not modelled.
const fn dry(kind: SurfaceKind) -> Grip {
    match kind {
        SurfaceKind::Road => Grip { peak: 1.0, sliding: 0.8, rolling: 0.013 },
        SurfaceKind::RoadLine => Grip { peak: 0.9, sliding: 0.7, rolling: 0.013 },
        SurfaceKind::Sidewalk => Grip { peak: 0.9, sliding: 0.75, rolling: 0.013 },
        SurfaceKind::Ground | SurfaceKind::Setts | SurfaceKind::Track | SurfaceKind::Rail => {
            Grip { peak: 0.7, sliding: 0.58, rolling: 0.02 }
        }
        SurfaceKind::Terrain | SurfaceKind::Water => Grip { peak: 0.45, sliding: 0.38, rolling: 0.05 },
        SurfaceKind::Gravel => Grip { peak: 0.6, sliding: 0.55, rolling: 0.02 },
    }
}

/// The same wet through, at a walking pace: peak and sliding friction.
///
/// Asphalt and slabs: Wong, ibidem (wet asphalt 0.5 to 0.7 and 0.45 to 0.6 against 0.8 to 0.9 and 0.75 dry; wet concrete
/// 0.8 and 0.7). Paint: EN 1436 asks of wet markings for 45 units of the pendulum tester, its lowest class (S1). Setts and
/// grass: Burg and Moser, ibidem (wet 0.35 to 0.5 and 0.2 to 0.3). Gravel: Baker and Fricke, *The Traffic-Accident
/// Investigation Manual* (packed 0.4 to 0.6 wet against 0.5 to 0.8 dry, sliding faster than 50 km/h).
const fn wet(kind: SurfaceKind) -> [f32; 2] {
    match kind {
        SurfaceKind::Road => [0.75, 0.55],
        SurfaceKind::RoadLine => [0.5, 0.4],
        SurfaceKind::Sidewalk => [0.7, 0.58],
        SurfaceKind::Ground | SurfaceKind::Setts | SurfaceKind::Track | SurfaceKind::Rail => [0.45, 0.37],
        SurfaceKind::Terrain | SurfaceKind::Water => [0.28, 0.22],
        SurfaceKind::Gravel => [0.55, 0.5],
    }
}

/// The speed at which water carries a tyre of 2.3 bar, m/s: Horne and Joyner 1965, 6.35 km/h times the root of the
/// pressure in kPa.
const AQUAPLANING_MPS: f32 = 26.7;
/// Water that tread and texture cannot drain any more, mm: from there on a tyre floats at that speed.
const FLOATING_MM: f32 = 3.0;
/// Share of the friction that is left to a tyre that floats.
const FLOATING_SHARE: f32 = 0.05;

/// The ground below a wheel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footing {
    /// Way from where the spring is fixed to the body down to the ground, along the car's z axis, metres.
    pub distance_m: f32,
    /// Unit normal of the ground, along the car's axes.
    pub normal: Vec3,
    /// What it is made of.
    pub kind: SurfaceKind,
    /// How wet it is, 0 to 1.
    pub wet: f32,
    /// Water on it, mm.
    pub water_mm: f32,
}

impl Footing {
    /// How it holds a tyre at a speed of the car, m/s. The pressure of water under the tyre grows with the square of the
    /// speed, and carries that share of the load; what it carries has no friction.
    pub fn grip(&self, speed_mps: f32) -> Grip {
        let (dry, [peak, sliding]) = (dry(self.kind), wet(self.kind));
        let speed = speed_mps / AQUAPLANING_MPS;
        let carried = speed * speed * (self.water_mm / FLOATING_MM).min(1.0);
        let pressed = (1.0 - carried).max(FLOATING_SHARE);
        let mix = |dry: f32, wet: f32| (dry + (wet - dry) * self.wet) * pressed;
        Grip { peak: mix(dry.peak, peak), sliding: mix(dry.sliding, sliding), rolling: dry.rolling }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn footing(kind: SurfaceKind, wet: f32, water_mm: f32) -> Footing {
        Footing { distance_m: 1.0, normal: Vec3::Z, kind, wet, water_mm }
    }

    #[test]
    fn a_dry_surface_holds_alike_at_any_speed() {
        for &kind in SurfaceKind::ALL {
            assert_eq!(footing(kind, 0.0, 0.0).grip(60.0), dry(kind));
        }
    }

    #[test]
    fn more_water_and_more_speed_never_hold_better() {
        for &kind in SurfaceKind::ALL {
            let peak = |wet: f32, water_mm: f32, speed_mps: f32| footing(kind, wet, water_mm).grip(speed_mps).peak;
            for k in 0..20 {
                let (a, b) = (k as f32 / 20.0, (k + 1) as f32 / 20.0);
                assert!(peak(a, 0.4, 20.0) > peak(b, 0.4, 20.0));
                assert!(peak(1.0, 5.0 * a, 20.0) >= peak(1.0, 5.0 * b, 20.0));
                assert!(peak(1.0, 1.0, 40.0 * a) >= peak(1.0, 1.0, 40.0 * b));
            }
        }
    }

    #[test]
    fn a_tyre_floats_in_deep_water_at_hornes_speed_and_not_on_a_wet_road() {
        // 10.35 mph times the root of the pressure in psi.
        let floats_mps = 10.35 * f64::sqrt(2.3 * 14.504) * 0.44704;
        let at = |water_mm: f32| footing(SurfaceKind::Road, 1.0, water_mm).grip(floats_mps as f32).peak;
        assert!(at(4.0) < 0.1 && at(0.4) > 0.6, "{} {}", at(4.0), at(0.4));
        assert!(footing(SurfaceKind::Road, 1.0, 4.0).grip(50.0 / 3.6).peak > 0.5);
    }
}

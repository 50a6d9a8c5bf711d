//! The force between a tyre and the ground: the brush model up to its peak (Pacejka, *Tire and Vehicle Dynamics*,
//! chapter 3; Svendenius 2003), from there falling to sliding friction as in TMeasy (Rill), alike in all directions.
//!
//! The tread is elastic, and its deflection is state: it builds up over the relaxation length while the wheel rolls,
//! and holds the car like a spring where it does not, in the manner of LuGre (Canudas de Wit et al. 1995), so that
//! the same equations drive, brake, slide and stand.

use glam::Vec2;

use super::surface::Grip;

/// Load that the figures below are of, N.
pub const NOMINAL_LOAD_N: f32 = 3433.5;
/// Slip stiffness by load: force by load and unit of slip.
pub const SLIP_STIFFNESS: f32 = 22.0;
/// A load of twice the nominal one makes the stiffness by load smaller by 1 / (1 + this).
pub const STIFFNESS_LOSS: f32 = 0.4;
/// The same of friction.
pub const FRICTION_LOSS: f32 = 0.1;
/// Way on which a deflection builds up, metres.
pub const RELAXATION_M: f32 = 0.3;
/// Beyond this multiple of the slip of greatest force, the tyre only slides.
pub const SLIDING_SLIPS: f32 = 3.0;
/// Damping of the tread by its stiffness, s.
pub const DAMPING_S: f32 = 0.03;
/// Half the length of the patch that touches the ground, metres.
const HALF_PATCH_M: f32 = 0.09;

/// A tyre under a load on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tyre {
    /// Greatest force, N.
    pub limit_n: f32,
    /// Share of it that is left when the tyre slides.
    pub sliding: f32,
    /// Slip at which the force is greatest: sliding speed by rolling speed.
    pub peak_slip: f32,
    /// Stiffness of the tread, N/m.
    pub stiffness_n_per_m: f32,
}

impl Tyre {
    /// The tyre under a load, N.
    pub fn new(load_n: f32, grip: &Grip) -> Self {
        let over = load_n / NOMINAL_LOAD_N - 1.0;
        let limit_n = grip.peak * load_n / (1.0 + FRICTION_LOSS * over);
        let by_slip_n = SLIP_STIFFNESS * load_n / (1.0 + STIFFNESS_LOSS * over);
        Self {
            limit_n,
            sliding: grip.sliding / grip.peak,
            peak_slip: 3.0 * grip.peak * (1.0 + STIFFNESS_LOSS * over)
                / (SLIP_STIFFNESS * (1.0 + FRICTION_LOSS * over)),
            stiffness_n_per_m: by_slip_n / RELAXATION_M,
        }
    }

    /// Share of the greatest force at a slip, counted in slips of greatest force.
    pub fn share(&self, slips: f32) -> f32 {
        if slips < 1.0 {
            return slips * (3.0 - slips * (3.0 - slips));
        }
        let way = ((slips - 1.0) / (SLIDING_SLIPS - 1.0)).min(1.0);
        1.0 - (1.0 - self.sliding) * way * way * (3.0 - 2.0 * way)
    }

    /// How fast the deflection fades, 1/s, at a sliding and a rolling speed, m/s: such that the force of steady slip is
    /// that of the curve.
    pub fn fading_per_s(&self, sliding_mps: f32, rolling_mps: f32) -> f32 {
        let peak_mps = rolling_mps.abs() * self.peak_slip;
        if sliding_mps < peak_mps {
            let slips = sliding_mps / peak_mps;
            return 3.0 * rolling_mps.abs() / (RELAXATION_M * (3.0 - slips * (3.0 - slips)));
        }
        let slips = if peak_mps > 0.0 { sliding_mps / peak_mps } else { SLIDING_SLIPS };
        3.0 * sliding_mps / (RELAXATION_M * self.peak_slip * self.share(slips))
    }

    /// Keeps a force inside the friction circle, N.
    pub fn held(&self, force_n: Vec2) -> Vec2 {
        let square = force_n.length_squared();
        if square > self.limit_n * self.limit_n { force_n * (self.limit_n / square.sqrt()) } else { force_n }
    }

    /// How far behind the middle of the patch the side force acts, metres.
    pub fn trail_m(&self, slips: f32) -> f32 {
        let adhering = (1.0 - slips).max(0.0);
        HALF_PATCH_M * adhering * adhering * adhering / (3.0 - slips.min(1.0) * (3.0 - slips.min(1.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRY: Grip = Grip { peak: 1.0, sliding: 0.8, rolling: 0.013 };

    #[test]
    fn the_curve_starts_with_its_stiffness_peaks_once_and_falls_to_sliding() {
        let tyre = Tyre::new(NOMINAL_LOAD_N, &DRY);
        let force = |slip: f32| tyre.limit_n * tyre.share(slip / tyre.peak_slip);
        assert!((force(1e-3) / 1e-3 / NOMINAL_LOAD_N - SLIP_STIFFNESS).abs() < 0.3);
        assert!((force(tyre.peak_slip) - NOMINAL_LOAD_N).abs() < 1.0);
        assert!((force(9.0) - 0.8 * NOMINAL_LOAD_N).abs() < 1.0);
        let forces: Vec<f32> = (0..300).map(|k| force(k as f32 * 0.002)).collect();
        let peak = forces.iter().position(|f| *f == forces.iter().copied().fold(0.0, f32::max)).expect("a peak");
        assert!(forces[..peak].is_sorted() && forces[peak..].is_sorted_by(|a, b| a >= b));
        assert!((forces[67] - forces[70]).abs() < 60.0, "no step at the peak");
    }

    #[test]
    fn steady_slip_gives_the_curve_rolling_or_locked() {
        let tyre = Tyre::new(4000.0, &DRY);
        for (sliding, rolling) in [(0.1, 20.0), (1.5, 10.0), (4.0, 9.0), (8.0, 0.5), (12.0, 0.0)] {
            let deflection = sliding / tyre.fading_per_s(sliding, rolling);
            let slips = if rolling > 0.0 { sliding / rolling / tyre.peak_slip } else { f32::MAX };
            let expected = tyre.limit_n * tyre.share(slips);
            let force = deflection * tyre.stiffness_n_per_m;
            assert!((force / expected - 1.0).abs() < 1e-4, "{force} {expected} at {sliding} of {rolling} m/s");
        }
    }

    #[test]
    fn twice_the_load_holds_less_than_twice() {
        let (one, two) = (Tyre::new(3000.0, &DRY), Tyre::new(6000.0, &DRY));
        assert!(two.limit_n > 1.7 * one.limit_n && two.limit_n < 1.95 * one.limit_n);
        assert!(two.stiffness_n_per_m < 1.7 * one.stiffness_n_per_m);
    }
}

//! Water on the road: a film where it is wet, and puddles where the ground is low.

use glam::Vec2;

use super::fields::Weather;
use crate::ops;

/// Film on a road that is wet through, and what a cloudburst adds to it, mm. Gallaway et al., *Pavement and Geometric
/// Design Criteria for Minimizing Hydroplaning* (FHWA-RD-79-31), give 0.6 to 1.0 mm above the texture for 50 mm an hour
/// and one or two lanes with a fall of 2 %.
const FILM_MM: f32 = 0.4;
const RAIN_FILM_MM: f32 = 0.6;
/// Wet through are roads from this share of rain or puddles on: an assumption.
const WET_FROM: f32 = 0.5;
/// Difference between the highest and the lowest places of a road where water gathers, mm: ruts of a road in use.
const RELIEF_MM: f32 = 8.0;
/// Distance between the places whose height is drawn, metres.
const CELL_M: f32 = 3.0;

/// Water on the roads of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Water {
    /// How wet the ground is, 0 to 1.
    pub wet: f32,
    /// Water above the texture of a road without puddles, mm.
    pub film_mm: f32,
    /// Height of the puddles over the lowest places, as share of the relief.
    pub level: f32,
}

impl Water {
    /// What a weather leaves on roads.
    pub fn of(weather: &Weather) -> Self {
        let [rain, level, wetness] =
            [weather.precipitation_pct, weather.puddles_pct, weather.wetness_pct].map(|pct| pct / 100.0);
        let wet = (rain.max(level) / WET_FROM).max(wetness).min(1.0);
        Self { wet, film_mm: FILM_MM * wet + RAIN_FILM_MM * rain, level }
    }

    /// Depth at a place of a paved surface, mm.
    pub fn depth_mm(&self, at: Vec2) -> f32 {
        let puddle_mm = if self.level > 0.0 { (self.level - height(at)).max(0.0) * RELIEF_MM } else { 0.0 };
        self.film_mm + puddle_mm
    }
}

/// Height of the ground in its relief, 0 to 1: smooth between corners of squares. The renderer has the same function.
fn height(at: Vec2) -> f32 {
    let cell = Vec2::new(ops::floor(at.x / CELL_M), ops::floor(at.y / CELL_M));
    let inside = at / CELL_M - cell;
    let t = inside * inside * (3.0 - 2.0 * inside);
    let (x, y) = (cell.x as i32, cell.y as i32);
    let row = |y: i32| corner(x, y) + (corner(x.wrapping_add(1), y) - corner(x, y)) * t.x;
    row(y) + (row(y.wrapping_add(1)) - row(y)) * t.y
}

/// Drawn for a corner of the squares, 0 to 1.
fn corner(x: i32, y: i32) -> f32 {
    let mut h = (x as u32).wrapping_mul(0x9e37_79b1) ^ (y as u32).wrapping_mul(0x85eb_ca77);
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    ((h ^ (h >> 15)) >> 8) as f32 / 16_777_216.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(puddles_pct: f32) -> f32 {
        let water = Water::of(&Weather { puddles_pct, ..Weather::dry(0.0, 0.0, 45.0, 0.0) });
        let places = (0..10_000).map(|k| Vec2::new((k % 100) as f32 * 1.37 - 60.0, (k / 100) as f32 * 1.21 - 60.0));
        places.filter(|at| water.depth_mm(*at) > water.film_mm).count() as f32 / 10_000.0
    }

    #[test]
    fn puddles_grow_from_nothing_to_everything() {
        let shares = [0.0, 20.0, 50.0, 80.0, 100.0].map(covered);
        assert!(shares.is_sorted_by(|a, b| a < b), "{shares:?}");
        assert!(shares[0] == 0.0 && shares[4] > 0.999 && (shares[2] - 0.5).abs() < 0.05, "{shares:?}");
    }

    #[test]
    fn the_ground_has_no_steps() {
        for k in 0..20_000 {
            let at = Vec2::new(k as f32 * 0.011 - 110.0, k as f32 * 0.007);
            let step = (height(at) - height(at + Vec2::new(0.01, -0.01))).abs();
            assert!((0.0..=1.0).contains(&height(at)) && step < 0.02, "{at} {step}");
        }
    }

    #[test]
    fn rain_and_puddles_wet_the_road_and_dry_weather_does_not() {
        let dry = Weather::dry(100.0, 100.0, 45.0, 0.0);
        assert_eq!(Water::of(&dry), Water::default());
        assert_eq!(Water::default().depth_mm(Vec2::new(3.0, 4.0)), 0.0);
        assert_eq!(Water::of(&Weather { precipitation_pct: 25.0, ..dry }).wet, 0.5);
        assert_eq!(Water::of(&Weather { puddles_pct: 60.0, ..dry }).wet, 1.0);
        assert_eq!(Water::of(&Weather { wetness_pct: 30.0, ..dry }).wet, 0.3);
    }
}

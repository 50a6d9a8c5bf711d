//! What the weather means for those who drive and walk.

use super::fields::Weather;
use super::water::Water;

/// How much slower one drives on a wet road, and in a cloudburst on top of that. FHWA, *How Do Weather Events Impact
/// Roads?*: 2 to 13 % in light rain, 3 to 16 % in heavy rain on motorways.
const WET_SPEED_LOSS: f32 = 0.05;
const RAIN_SPEED_LOSS: f32 = 0.08;
/// How much farther one keeps behind others. FHWA, ibidem: capacity falls by 4 to 11 % in light and by 10 to 30 % in
/// heavy rain; Prevedouros and Kongsil 2003: by 8.4 and 20 %.
const WET_HEADWAY: f32 = 0.08;
const RAIN_HEADWAY: f32 = 0.12;
/// How much more gently one brakes on a wet road: an assumption.
const WET_BRAKE_LOSS: f32 = 0.1;
/// What a wet road takes from the hardest braking: the grip of tyres on asphalt.
const WET_GRIP_LOSS: f32 = 0.25;
/// How much people on foot hurry in a cloudburst (Knoblauch, Pietrucha and Nitzburg 1996 found them faster in rain).
const RAIN_HURRY: f32 = 0.1;
/// Reaction and braking within the distance that one sees: AASHTO's stopping sight distance, s and m/s².
const SIGHT_REACTION_S: f32 = 2.5;
const SIGHT_BRAKE_MPS2: f32 = 3.4;

/// What weather changes about road users, as factors: all exactly 1 in dry weather without fog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Of the speed that is aimed at.
    pub speed: f32,
    /// Of the time headway.
    pub headway: f32,
    /// Of comfortable braking.
    pub brake: f32,
    /// Of the hardest braking.
    pub grip: f32,
    /// Of the speed of people on foot.
    pub pace: f32,
    /// The speed from which one stops within sight, m/s; infinite without fog.
    pub sight_mps: f32,
}

impl Default for Conditions {
    fn default() -> Self {
        Self { speed: 1.0, headway: 1.0, brake: 1.0, grip: 1.0, pace: 1.0, sight_mps: f32::INFINITY }
    }
}

impl Conditions {
    /// Those of a weather.
    pub fn of(weather: &Weather) -> Self {
        let (wet, rain) = (Water::of(weather).wet, 0.01 * weather.precipitation_pct);
        Self {
            speed: 1.0 - WET_SPEED_LOSS * wet - RAIN_SPEED_LOSS * rain,
            headway: 1.0 + WET_HEADWAY * wet + RAIN_HEADWAY * rain,
            brake: 1.0 - WET_BRAKE_LOSS * wet,
            grip: 1.0 - WET_GRIP_LOSS * wet,
            pace: 1.0 + RAIN_HURRY * rain,
            sight_mps: sight_mps(weather.visibility_m()),
        }
    }
}

/// The speed whose stopping sight distance is so long, m/s.
fn sight_mps(visibility_m: f32) -> f32 {
    let (t, b) = (SIGHT_REACTION_S, SIGHT_BRAKE_MPS2);
    b * ((t * t + 2.0 * visibility_m / b).sqrt() - t)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRY: Weather = Weather::dry(100.0, 100.0, -20.0, 0.0);

    #[test]
    fn dry_weather_changes_nothing() {
        assert_eq!(Conditions::of(&DRY), Conditions::default());
    }

    #[test]
    fn heavy_rain_is_within_what_was_measured() {
        let rain = Conditions::of(&Weather { precipitation_pct: 100.0, ..DRY });
        assert!((0.84..0.97).contains(&rain.speed) && (1.1..1.3).contains(&rain.headway), "{rain:?}");
        let drizzle = Conditions::of(&Weather { precipitation_pct: 15.0, ..DRY });
        assert!(drizzle.speed > rain.speed && drizzle.speed < 1.0 && drizzle.pace < rain.pace, "{drizzle:?}");
    }

    #[test]
    fn one_stops_within_sight() {
        for fog_density_pct in [5.0, 20.0, 60.0, 100.0] {
            let fog = Weather { fog_density_pct, ..DRY };
            let v = f64::from(Conditions::of(&fog).sight_mps);
            let stops_m = 2.5 * v + v * v / (2.0 * 3.4);
            assert!((stops_m / f64::from(fog.visibility_m()) - 1.0).abs() < 1e-3, "{stops_m}");
        }
    }
}

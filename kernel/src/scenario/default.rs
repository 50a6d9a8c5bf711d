//! The scenario that a map and a seed stand for: weather and traffic in the ranges of the paper.

use crate::car::CarSetup;
use crate::map::{self, LaneKind};
use crate::rng::{self, Stream};
use crate::traffic::{HazardLevel, Population, TrafficCounts};
use crate::weather::Weather;

use super::fields::{EgoStart, MAX_SPEED_KMH, Rules, Scenario};

/// Fewest and most actors on a map (paper, section 3).
const ACTORS: [f32; 2] = [50.0, 150.0];
/// Actors for each kilometre of driving lane, between those.
const ACTORS_PER_KM: f32 = 12.0;
/// Longest run, seconds.
const MAX_SECONDS: u32 = 600;
/// Longest time after a takeover, seconds: enough to leave a junction and stop.
const TAKEOVER_S: u32 = 10;
/// Cloudiness and wind in percent and height of the sun in degrees (paper, section 3).
const CLOUDS_PCT: [f32; 2] = [0.0, 30.0];
const WIND_PCT: [f32; 2] = [0.0, 50.0];
const SUN_ALTITUDE_DEG: [f32; 2] = [20.0, 90.0];
const SUN_AZIMUTH_DEG: [f32; 2] = [0.0, 360.0];

impl Scenario {
    /// The default scenario of a map for a seed: weather drawn from the paper's ranges, and as many
    /// actors as the size of a bundled map asks for (100 on a foreign one).
    pub fn default_for(map: &str, seed: u64) -> Self {
        // A tenth of a percent or a degree, so that the text of a scenario is short.
        let draw = |what, [low, high]: [f32; 2]| {
            let tenths = ((high - low) * 10.0) as u32;
            low + rng::below(seed, Stream::Scenario, what, 0, tenths + 1) as f32 / 10.0
        };
        Self {
            map: map.to_owned(),
            seed,
            traffic: counts(actors_on(map), draw(4, [0.5, 2.0])),
            hazards: HazardLevel::Natural.rates(),
            weather: Weather::dry(
                draw(0, CLOUDS_PCT),
                draw(1, WIND_PCT),
                draw(2, SUN_ALTITUDE_DEG),
                draw(3, SUN_AZIMUTH_DEG),
            ),
            later: None,
            ego: EgoStart { lane: None, s_m: 0.0 },
            car: CarSetup::default(),
            rules: Rules {
                max_speed_kmh: MAX_SPEED_KMH,
                max_seconds: MAX_SECONDS,
                brake_threshold: 0.1,
                steer_threshold: 0.1,
                least_intervention_kmh: 0.0,
                takeover_s: TAKEOVER_S,
            },
            story: None,
        }
    }
}

fn actors_on(map: &str) -> f32 {
    let [least, most] = ACTORS;
    let Some(network) = map::bundled(map) else { return (least + most) / 2.0 };
    let driving = network.lanes.iter().filter(|lane| lane.kind == LaneKind::Driving);
    let km = driving.map(|lane| lane.length_m).sum::<f32>() / 1000.0;
    (km * ACTORS_PER_KM).clamp(least, most)
}

/// 45 % cars, 5 % motorcycles, 10 % bicycles, 40 % people on foot.
fn counts(actors: f32, jaywalks_per_min: f32) -> TrafficCounts {
    let share = |share: f32| (actors * share) as u16;
    let (motorcycles, bicycles, pedestrians) = (share(0.05), share(0.1), share(0.4));
    let cars = actors as u16 - motorcycles - bicycles - pedestrians;
    TrafficCounts { cars, motorcycles, bicycles, pedestrians, jaywalks_per_min, drivers: Population::USUAL }
}

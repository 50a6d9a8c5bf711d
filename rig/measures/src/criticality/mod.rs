//! How critical a situation was: traces of metrics over time and their extremes.
//!
//! The metrics are those of Westhofen et al. 2022 (Criticality Metrics for Automated Driving, Archives of
//! Computational Methods in Engineering), for the ego car and the road user for whom each is worst.
//! Predictions let both go on straight at their present speeds for at most [`HORIZON_S`]; road users are
//! the boxes around them. Who is on a bridge above or below is left out; so are parked cars and scenery, except by the
//! predicted encroachment.

mod encounter;
mod extreme;
mod observed;

use std::ops::RangeInclusive;
use std::sync::Arc;

use base::words;
use drivers::footprint::on_level;
use drivers::safety::{LOOK_TICKS, Looks, predicted_encroachment};
use kernel::scene::{ActorScene, SceneSnapshot};
use kernel::time::{CLIP_STRIDE_TICKS, Tick};
use kernel::{RoadNetwork, World};
use replay::{Error, Log, Replayer};
use serde::{Deserialize, Serialize};

use encounter::{Encounter, Mover};
use observed::Tracks;

pub use encounter::{HORIZON_S, MAX_DECELERATION_MPS2};
pub use extreme::Extreme;

/// An encroachment within this time is critical (Westhofen et al. 2022), seconds.
pub const CRITICAL_S: f64 = drivers::safety::CRITICAL_S as f64;
/// Ticks from one sample to the next: 0.1 s.
pub const SAMPLE_TICKS: Tick = CLIP_STRIDE_TICKS;
/// How many samples it takes until everyone's change of speed is known.
pub const WARM_UP_SAMPLES: Tick = 3;
/// Others beyond this distance are not looked at, metres: at 60 km/h each, they meet no sooner than in
/// [`HORIZON_S`].
const NEAR_M: f32 = 340.0;

const _: () = assert!(SAMPLE_TICKS == LOOK_TICKS, "changes of speed are those between two looks");

/// A value and whom it concerns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// Seconds or m/s^2.
    pub value: f64,
    /// The other road user, as in `pedestrian 12`.
    pub with: String,
}

/// The metrics at a tick.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sample {
    /// The tick.
    pub tick: Tick,
    /// Time to collision (TTC), seconds.
    pub ttc_s: Option<Worst>,
    /// Predicted post-encroachment time (PrET), seconds: the time between the one's leaving and the
    /// other's reaching a place where their ways cross; 0 on a collision course.
    pub pret_s: Option<Worst>,
    /// Required longitudinal deceleration of the ego car, m/s^2, at most [`MAX_DECELERATION_MPS2`]; none
    /// where nothing is ahead, or braking does not help.
    pub required_deceleration_mps2: Option<Worst>,
    /// With whom the ego car is predicted to collide within [`CRITICAL_S`] when it keeps to its route and
    /// vehicles to their lanes, as `aeye inspect` counts hazards.
    pub encroachment: Option<String>,
}

/// How critical a window was at its worst.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Extremes {
    /// Least time to collision, seconds.
    pub min_ttc_s: Option<Extreme>,
    /// Least predicted post-encroachment time, seconds.
    pub min_pret_s: Option<Extreme>,
    /// Greatest required deceleration, m/s^2.
    pub max_required_deceleration_mps2: Option<Extreme>,
    /// Post-encroachment time (PET) of the ways that were really driven, seconds: the least time from
    /// when the one left a place to when the other came there, where they crossed; 0 in a collision.
    pub pet_s: Option<Extreme>,
}

/// The trace of a window and its extremes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Criticality {
    /// The extremes.
    #[serde(flatten)]
    pub extremes: Extremes,
    /// Ten samples a second.
    pub samples: Vec<Sample>,
}

impl Criticality {
    /// That of a corner case, from the start of its window to the end of what it holds; `None` for a
    /// recording. Simulates the case again; fails where a tick differs or another kernel made it.
    pub fn of_case(log: &Log, network: &Arc<RoadNetwork>) -> Result<Option<Self>, Error> {
        let Some(case) = &log.manifest.case else { return Ok(None) };
        Self::of(log, network, case.from..=log.last_tick()).map(Some)
    }

    /// That of a window of a log, sampled from its first tick on; fails as [`Criticality::of_case`] does.
    pub fn of(log: &Log, network: &Arc<RoadNetwork>, window: RangeInclusive<Tick>) -> Result<Self, Error> {
        let mut replayer = Replayer::new(log, network.clone())?;
        let (mut sampler, mut tracks, mut samples) = (Sampler::default(), Tracks::default(), Vec::new());
        loop {
            let (world, scene) = (replayer.world(), replayer.world().scene());
            let inside = window.contains(&scene.tick);
            if inside {
                tracks.add(&scene);
            }
            if scene.tick.abs_diff(*window.start()).is_multiple_of(SAMPLE_TICKS) {
                let sample = sampler.look(world, &scene);
                samples.extend(inside.then_some(sample));
            }
            if scene.tick >= *window.end() || replayer.step()?.is_none() {
                return Ok(Self::summing_up(samples, &tracks));
            }
        }
    }

    fn summing_up(samples: Vec<Sample>, tracks: &Tracks) -> Self {
        let least =
            |of: fn(&Sample) -> &Option<Worst>| extremes(&samples, of).min_by(|a, b| a.value.total_cmp(&b.value));
        let extremes = Extremes {
            min_ttc_s: least(|sample| &sample.ttc_s),
            min_pret_s: least(|sample| &sample.pret_s),
            max_required_deceleration_mps2: extremes(&samples, |sample| &sample.required_deceleration_mps2)
                .max_by(|a, b| a.value.total_cmp(&b.value).then(b.tick.cmp(&a.tick))),
            pet_s: tracks.post_encroachment(),
        };
        Self { extremes, samples }
    }
}

fn extremes(samples: &[Sample], of: fn(&Sample) -> &Option<Worst>) -> impl Iterator<Item = Extreme> {
    samples.iter().filter_map(move |sample| {
        let Worst { value, with } = of(sample).clone()?;
        Some(Extreme { value, tick: sample.tick, with })
    })
}

/// Takes a sample every [`SAMPLE_TICKS`], remembering how everyone changed speed.
#[derive(Debug, Default)]
pub struct Sampler(Looks);

impl Sampler {
    /// The sample of a world whose scene is this.
    pub fn look(&mut self, world: &World, scene: &SceneSnapshot) -> Sample {
        self.0.look(scene);
        Sample::of(scene, predicted_encroachment(world, scene, &self.0).map(|encroachment| encroachment.comment()))
    }
}

impl Sample {
    fn of(scene: &SceneSnapshot, encroachment: Option<String>) -> Self {
        let ego = Mover::of_ego(&scene.ego);
        let near = |actor: &&ActorScene| {
            let is_near = actor.position.truncate().distance(ego.footprint.centre) < NEAR_M;
            is_near && on_level(actor.position, scene.ego.position)
        };
        let encounters: Vec<(String, Encounter)> = scene
            .actors
            .iter()
            .filter(near)
            .map(|actor| (words::actor(actor), Encounter::of(&ego, &Mover::of_actor(actor))))
            .collect();
        let values = |of: fn(&Encounter) -> Option<f64>| {
            let worst = move |(with, encounter): &(String, Encounter)| {
                Some(Worst { value: of(encounter)?, with: with.clone() })
            };
            encounters.iter().filter_map(worst)
        };
        let by_value = |a: &Worst, b: &Worst| a.value.total_cmp(&b.value);
        Self {
            tick: scene.tick,
            ttc_s: values(Encounter::time_to_collision_s).min_by(by_value),
            pret_s: values(Encounter::post_encroachment_s).min_by(by_value),
            required_deceleration_mps2: values(Encounter::required_deceleration_mps2).max_by(by_value),
            encroachment,
        }
    }
}

//! What was the case, whoever saw it: when a hazard began and ended, and when the car moved.

use std::sync::Arc;

use drivers::safety::{Encroachment, FORGET_TICKS, LOOK_TICKS, Looks, Touched, predicted_encroachment};
use kernel::RoadNetwork;
use kernel::time::Tick;
use replay::{Error, Log, Replayer};
use serde::Serialize;

use super::following::Following;
use super::log::end_of_driving;
use super::mistakes::{Mistake, Mistakes};

/// An encroachment that is predicted for a shorter time is nobody's to react to.
const LASTING_TICKS: Tick = 6;
/// How everyone changes speed is known this long after a log begins; an onset before is not.
const WARM_UP_TICKS: Tick = 3 * LOOK_TICKS;

/// Slower than this the car stands, m/s.
const STANDSTILL_MPS: f32 = 0.5;

/// What was the case in a log until the safety driver intervened.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Truth {
    /// The hazards, by ascending tick.
    pub episodes: Vec<Episode>,
    /// Kilometres driven meanwhile.
    pub km: f64,
    /// Whether the car moved, for each tick after the log's first.
    pub moving: Vec<bool>,
    /// What following the route asks of the steering wheel, for each tick after the log's first: the driver has seen
    /// the tick before.
    pub following: Vec<Following>,
}

/// A time in which an encroachment is predicted.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Episode {
    /// The first tick at which it is.
    pub onset: Tick,
    /// The last tick at which it is; gaps of less than 0.2 s do not end it.
    pub end: Tick,
    /// With whom at the onset: `walker` or `vehicle`.
    pub label: &'static str,
    /// What was to be seen at the onset.
    pub what: String,
    /// The mistake that brought it about (the precipitating event of Hankey et al. 2016): of the one who would be touched
    /// at the onset, or of the one right ahead of him for whom he brakes hard, begun within the 5 s before (a door: 10 s).
    /// `None` where it was the ego car's own doing or that of traffic without a mistake.
    pub mistake: Option<Mistake>,
}

/// The truth about a log, by simulating it again.
pub fn find(log: &Log, network: &Arc<RoadNetwork>) -> Result<Truth, Error> {
    let mut replayer = Replayer::new(log, network.clone())?;
    // Speeds are compared over the time between two looks: each tick has the looks that end at it.
    let mut looks: [Looks; LOOK_TICKS as usize] = Default::default();
    let (mut episodes, mut moving) = (Episodes::starting_at(log.first_tick()), Vec::new());
    let (mut following, mut mistakes) = (Vec::new(), Mistakes::default());
    let from_mm = replayer.world().odometer_mm();
    while replayer.world().tick() < end_of_driving(log) {
        following.push(Following::of(replayer.world(), &replayer.world().scene().ego));
        replayer.step()?;
        let world = replayer.world();
        let (tick, scene) = (world.tick(), world.scene());
        let looks = &mut looks[(tick % LOOK_TICKS) as usize];
        looks.look(&scene);
        mistakes.hear(tick, world.last_events());
        let hazard = predicted_encroachment(world, &scene, looks);
        episodes.see(tick, hazard, |whom| mistakes.behind(whom, &scene, looks));
        moving.push(scene.ego.speed_mps.abs() > STANDSTILL_MPS);
    }
    let km = (replayer.world().odometer_mm() - from_mm) as f64 / 1e6;
    Ok(Truth { episodes: episodes.finish(), km, moving, following })
}

/// Joins ticks to episodes.
struct Episodes {
    first: Tick,
    found: Vec<Episode>,
}

impl Episodes {
    fn starting_at(first: Tick) -> Self {
        Self { first, found: Vec::new() }
    }

    /// What is predicted at a tick, and the mistake behind touching somebody; ticks come in order.
    fn see(&mut self, tick: Tick, hazard: Option<Encroachment>, mistake: impl Fn(Touched) -> Option<Mistake>) {
        let Some(hazard) = hazard else { return };
        match self.found.last_mut().filter(|e| tick < e.end + FORGET_TICKS) {
            Some(episode) => episode.end = tick,
            None => {
                let (label, what) = (hazard.label().name(), hazard.comment());
                let mistake = mistake(hazard.whom);
                self.found.push(Episode { onset: tick, end: tick, label, what, mistake });
            }
        }
    }

    fn finish(self) -> Vec<Episode> {
        let counts = |e: &Episode| e.onset > self.first + WARM_UP_TICKS && e.end + 1 >= e.onset + LASTING_TICKS;
        self.found.into_iter().filter(counts).collect()
    }
}

#[cfg(test)]
mod tests {
    use kernel::scene::ActorKind;
    use proptest::prelude::*;

    use super::*;

    fn hazard() -> Encroachment {
        Encroachment { whom: Touched::Actor(3, ActorKind::Pedestrian), after_s: 1.0 }
    }

    /// Onsets and ends, told tick by tick.
    fn joined(first: Tick, predicted: &[bool]) -> Vec<(Tick, Tick)> {
        let mut episodes = Episodes::starting_at(first);
        for (tick, is_predicted) in (first + 1..).zip(predicted) {
            episodes.see(tick, is_predicted.then(hazard), |_| None);
        }
        episodes.finish().iter().map(|e| (e.onset, e.end)).collect()
    }

    #[test]
    fn short_gaps_do_not_end_a_hazard_and_flickers_are_none() {
        let mut predicted = vec![false; 400];
        predicted[100..130].fill(true);
        predicted[110] = false;
        predicted[130 + 10..150].fill(true);
        predicted[200..205].fill(true);
        predicted[300..306].fill(true);
        assert_eq!(joined(0, &predicted), [(101, 150), (301, 306)]);
    }

    #[test]
    fn an_onset_before_the_speeds_are_known_is_not_known() {
        assert_eq!(joined(500, &[true; 100]), []);
        let late = [vec![false; 18], vec![true; 50]].concat();
        assert_eq!(joined(500, &late), [(519, 568)]);
    }

    proptest! {
        #[test]
        fn episodes_are_the_runs_after_gaps_are_filled(
            runs in prop::collection::vec((1usize..40, any::<bool>()), 1..40),
        ) {
            let mut predicted = vec![false; 30];
            runs.iter().for_each(|(length, on)| predicted.extend(vec![*on; *length]));
            // Another way round: fill each gap that is short enough, then list what is left.
            let on: Vec<usize> = (0..predicted.len()).filter(|i| predicted[*i]).collect();
            let mut filled = predicted.clone();
            for pair in on.windows(2).filter(|pair| pair[1] - pair[0] < FORGET_TICKS as usize) {
                filled[pair[0]..pair[1]].fill(true);
            }
            let mut expected = Vec::new();
            for stretch in filled.chunk_by(|a, b| a == b).scan(1, |at, part| {
                let from = *at;
                *at += part.len();
                Some((from, part))
            }) {
                let (from, part) = stretch;
                if part[0] && part.len() >= LASTING_TICKS as usize {
                    expected.push((from as Tick, (from + part.len() - 1) as Tick));
                }
            }
            prop_assert_eq!(joined(0, &predicted), expected);
        }
    }
}

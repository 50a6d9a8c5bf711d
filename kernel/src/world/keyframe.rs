//! The compact state at a keyframe tick, and the naming of differences.

use std::fmt;

use xxhash_rust::xxh3::xxh3_128;

use crate::actor::FIRST_STORY_ID;
use crate::car::{RunningGear, Wheel};
use crate::map::RoadNetwork;
use crate::motion::Motion;
use crate::state::{State, StateHash, first_difference};
use crate::story::Stage;
use crate::time::Tick;
use crate::traffic::TrafficState;

use super::error::WorldError;
use super::snapshot::{PARTS, Parts};

/// The compact state of the world at a keyframe tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keyframe {
    /// Its tick.
    pub tick: Tick,
    /// Canonical bytes of the whole state; their hash is that of the tick.
    pub bytes: Vec<u8>,
}

/// A value that differs between two states.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldDifference {
    /// One of [`PARTS`].
    pub part: String,
    /// Id of the actor, if the field belongs to one.
    pub actor: Option<u32>,
    /// Name of the field.
    pub field: String,
    /// Value in `self`.
    pub expected: String,
    /// Value in the other.
    pub got: String,
}

impl fmt::Display for FieldDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.part)?;
        if let Some(actor) = self.actor {
            write!(f, ", actor {actor}")?;
        }
        write!(f, ", {}: expected {}, got {}", self.field, self.expected, self.got)
    }
}

impl Keyframe {
    /// Hash of its tick.
    pub fn hash(&self) -> StateHash {
        StateHash(xxh3_128(&self.bytes))
    }

    /// The first field in which this keyframe (as recorded) and another (as computed) differ.
    pub fn difference(&self, computed: &Keyframe) -> Result<Option<FieldDifference>, WorldError> {
        let (left, left_traffic) = self.read()?;
        let (right, right_traffic) = computed.read()?;
        Ok(difference((&left, &left_traffic), (&right, &right_traffic)))
    }

    /// The state, not yet checked against a map.
    pub(super) fn read(&self) -> Result<(Parts, TrafficState), WorldError> {
        let tick = self.tick;
        let (parts, traffic) = Parts::read(&self.bytes).map_err(|source| WorldError::Keyframe { tick, source })?;
        if parts.input.tick != tick {
            let reason = format!("its state is that of tick {}", parts.input.tick);
            return Err(WorldError::State { tick, reason });
        }
        Ok((parts, traffic))
    }
}

/// The first field in which two states differ.
pub(super) fn difference(
    (left, left_traffic): (&Parts, &TrafficState),
    (right, right_traffic): (&Parts, &TrafficState),
) -> Option<FieldDifference> {
    let vehicle = |at: usize| left_traffic.vehicles.get(at).map(|v| u32::from(v.id));
    let walker = |at: usize| left_traffic.walkers.get(at).map(|w| u32::from(w.id));
    let loose = |at: usize| left.bodies.loose.get(at).map(|l| l.id);
    let none = |_| None;
    let actor = |at: usize| Some(FIRST_STORY_ID + at as u32);
    let in_part = |part| {
        let (path, expected, got, actor) = match part {
            0 => named(&left.input, &right.input, none),
            1 => named(&left.ego, &right.ego, none),
            2 => named(&left_traffic.vehicles, &right_traffic.vehicles, vehicle),
            3 => named(&left_traffic.walkers, &right_traffic.walkers, walker),
            4 => named(&left.bodies, &right.bodies, loose),
            5 => named(&left.run, &right.run, none),
            _ => named(&left.output, &right.output, none).or_else(|| named(&left.story, &right.story, actor)),
        }?;
        Some(FieldDifference { part: PARTS[part].to_owned(), actor, field: path, expected, got })
    };
    (0..PARTS.len()).find_map(in_part)
}

type Named = (String, String, String, Option<u32>);

/// The first difference of a part. An index of `[]`, `loose[]` or `actors[]` becomes the actor's id.
fn named<T: State>(left: &T, right: &T, actor_at: impl Fn(usize) -> Option<u32>) -> Option<Named> {
    let (path, expected, got) = first_difference(left, right)?;
    let listed = path.strip_prefix('[').or_else(|| path.strip_prefix("loose["));
    let listed = listed.or_else(|| path.strip_prefix("actors["));
    let split = listed.and_then(|rest| rest.split_once(']'));
    let actor = split.and_then(|(index, _)| actor_at(index.parse().ok()?));
    let field = match (actor, split) {
        (Some(_), Some((_, field))) => field.trim_start_matches('.').to_owned(),
        _ => path,
    };
    Some((field, expected, got, actor))
}

/// Farthest place and highest speed that the engine can deal with; far beyond what a run reaches.
const MOST_POSITION_M: f32 = 1e6;
const MOST_SPEED: f32 = 1e3;

fn fits(motion: &Motion) -> bool {
    motion.position.abs().max_element() < MOST_POSITION_M
        && motion.velocity_mps.abs().max_element() < MOST_SPEED
        && motion.spin_radps.abs().max_element() < MOST_SPEED
        && (motion.rotation.length_squared() - 1.0).abs() < 1e-3
}

fn rolls(gear: &RunningGear) -> bool {
    let wheel = |wheel: &Wheel| {
        wheel.spin_radps.abs() < 10.0 * MOST_SPEED
            && wheel.travel_m.abs() < 1.0
            && wheel.tread_m.abs().max_element() < 1.0
    };
    gear.wheels.iter().all(wheel) && gear.wheel_angle_rad.abs() < 1.0 && gear.meant_yaw_radps.abs() < MOST_SPEED
}

/// Refuses a state that was never written by a world on this map.
pub(super) fn check(parts: &Parts, network: &RoadNetwork) -> Result<(), String> {
    let lanes = &parts.ego.route.lanes;
    let known = |lane: &u32| (*lane as usize) < network.lanes.len();
    if lanes.is_empty() || !lanes.iter().all(known) {
        return Err(format!("ego.route.lanes is {lanes:?}, expected lanes of map {}", network.name));
    }
    if !fits(&parts.ego.car.motion) {
        return Err(format!("ego.car.motion is {:?}, expected a possible motion", parts.ego.car.motion));
    }
    if !rolls(&parts.ego.car.gear) {
        return Err(format!("ego.car.gear is {:?}, expected a possible one", parts.ego.car.gear));
    }
    let ascending = |ids: &mut dyn Iterator<Item = u32>| {
        let ids: Vec<u32> = ids.collect();
        ids.is_sorted_by(|a, b| a < b)
    };
    let bodies = &parts.bodies;
    if !ascending(&mut bodies.near.iter().copied()) || !ascending(&mut bodies.loose.iter().map(|l| l.id)) {
        return Err("the ids of bodies do not ascend".to_owned());
    }
    let parked = &network.places().parked;
    if let Some(unknown) = bodies.pushed().iter().find(|loose| parked.of_id(loose.id).is_none()) {
        return Err(format!("body {} is loose, expected a parked car of map {}", unknown.id, network.name));
    }
    match bodies.loose.iter().find(|loose| !fits(&loose.motion)) {
        Some(loose) => Err(format!("motion of actor {} is {:?}, expected a possible motion", loose.id, loose.motion)),
        None => Ok(()),
    }
}

/// Refuses a story's state without that story, and the other way round.
pub(super) fn check_story(parts: &Parts, stage: Option<&Stage>, network: &RoadNetwork) -> Result<(), String> {
    match (stage, &parts.story) {
        (Some(stage), Some(story)) => stage.check(story, network),
        (None, None) => Ok(()),
        (Some(_), None) => Err("its run has no story, expected that of the scenario".to_owned()),
        (None, Some(_)) => Err("its run has a story, expected none".to_owned()),
    }
}

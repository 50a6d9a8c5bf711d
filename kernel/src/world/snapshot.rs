//! The whole state of a world as one list of parts.
//!
//! A tick's hash is taken over exactly the bytes that a keyframe holds, so nothing can be hashed but
//! not saved, or saved but not hashed.

use xxhash_rust::xxh3::xxh3_128;

use crate::arbiter::{Applied, Arbiter, Intervention};
use crate::controls::{Controls, Seat, TickInput};
use crate::ego::Ego;
use crate::events::Event;
use crate::map::RoadNetwork;
use crate::route::Route;
use crate::scenario::Scenario;
use crate::state;
use crate::state::{DecodeError, Reader, State};
use crate::story::StoryState;
use crate::time::Tick;
use crate::traffic::{TrafficState, Vehicle, Walker};
use crate::watch::Watch;

use super::bodies::Bodies;

/// Parts of the state with a hash of their own, in the order of their bytes and of
/// [`World::part_hashes`](super::World::part_hashes).
pub const PARTS: [&str; 7] = ["input", "ego", "vehicles", "pedestrians", "bodies", "arbiter", "output"];

state! {
    /// What entered: the scenario once, controls at every tick.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct InputPart {
        /// Digest of scenario and map ([`origin`]), so that every hash says what its run started from.
        pub origin: u128,
        /// The tick that was reached.
        pub tick: Tick,
        /// The controls that led there.
        pub controls: TickInput,
    }
}

state! {
    /// The ego car and where it shall drive.
    #[derive(Clone, Debug, PartialEq)]
    pub struct EgoPart {
        /// The car.
        pub car: Ego,
        /// Its route.
        pub route: Route,
    }
}

state! {
    /// The run.
    #[derive(Clone, Debug, PartialEq)]
    pub struct RunPart {
        /// Who is in control.
        pub arbiter: Arbiter,
        /// What was going on in the last tick.
        pub watch: Watch,
        /// Tick of the last keyframe.
        pub keyframe_at: Tick,
    }
}

state! {
    /// What the tick gave.
    #[derive(Clone, Debug, PartialEq)]
    pub struct OutputPart {
        /// What the arbitration let through.
        pub applied: Applied,
        /// The intervention, in the tick in which it happens.
        pub intervention: Option<Intervention>,
        /// Events of this tick.
        pub events: Vec<Event>,
    }
}

/// xxh3-128 over the canonical bytes of a scenario and the digest of its map.
pub(super) fn origin(scenario: &Scenario, network: &RoadNetwork) -> u128 {
    let mut bytes = scenario.to_bytes();
    network.digest.write(&mut bytes);
    xxh3_128(&bytes)
}

impl Default for OutputPart {
    fn default() -> Self {
        let applied = Applied { controls: Controls::default(), steering: Seat::Semantic, pedals: Seat::Semantic };
        Self { applied, intervention: None, events: Vec::new() }
    }
}

/// Everything but traffic, which keeps its own state.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parts {
    pub input: InputPart,
    pub ego: EgoPart,
    pub bodies: Bodies,
    pub run: RunPart,
    pub output: OutputPart,
    /// How far the story has come, if there is one. Its bytes are the last ones, of the part output; without a story there
    /// are none, and states are as they were before there were stories.
    pub story: Option<StoryState>,
}

/// Appends the canonical bytes of one part.
type Writer<'a> = &'a dyn Fn(&mut Vec<u8>);

impl Parts {
    /// Appends the canonical bytes of the whole state; gives the end of each part.
    pub fn write(&self, traffic: &TrafficState, out: &mut Vec<u8>) -> [usize; PARTS.len()] {
        let mut ends = [0; PARTS.len()];
        let parts: [Writer<'_>; PARTS.len()] = [
            &|out| self.input.write(out),
            &|out| self.ego.write(out),
            &|out| traffic.vehicles.write(out),
            &|out| traffic.walkers.write(out),
            &|out| self.bodies.write(out),
            &|out| self.run.write(out),
            &|out| {
                self.output.write(out);
                self.story.iter().for_each(|story| story.write(out));
            },
        ];
        for (part, end) in parts.iter().zip(&mut ends) {
            part(out);
            *end = out.len();
        }
        ends
    }

    /// Reads what [`Parts::write`] wrote.
    pub fn read(bytes: &[u8]) -> Result<(Self, TrafficState), DecodeError> {
        let r = &mut Reader::new(bytes);
        let (input, ego) = (InputPart::read(r)?, EgoPart::read(r)?);
        let traffic = TrafficState { vehicles: Vec::<Vehicle>::read(r)?, walkers: Vec::<Walker>::read(r)? };
        let (bodies, run, output) = (Bodies::read(r)?, RunPart::read(r)?, OutputPart::read(r)?);
        let story = if r.remaining() > 0 { Some(StoryState::read(r)?) } else { None };
        let parts = Self { input, ego, bodies, run, output, story };
        if r.remaining() > 0 { Err(r.error("the end")) } else { Ok((parts, traffic)) }
    }
}

//! The world: everything that happens in a tick.

mod bodies;
mod error;
mod keyframe;
mod snapshot;
mod start;

use std::sync::Arc;

use glam::Vec3;
use xxhash_rust::xxh3::{xxh3_64, xxh3_128};

use crate::arbiter::{Applied, Arbiter, Intervention};
use crate::controls::{Controls, TickInput};
use crate::ego;
use crate::events::{Event, EventKind, Hud};
use crate::light::LightPhase;
use crate::map::RoadNetwork;
use crate::physics::{Physics, Touched};
use crate::scenario::Scenario;
use crate::scene::{ActorScene, EgoScene, SceneSnapshot, quantise};
use crate::signals;
use crate::state::StateHash;
use crate::time::{KEYFRAME_TICKS, Tick, seconds};
use crate::traffic::{Obstacle, Surroundings, Traffic};
use crate::watch::{self, Log, Watch};

use snapshot::Parts;

pub use error::WorldError;
pub use keyframe::{FieldDifference, Keyframe};
pub use snapshot::PARTS;

/// How long a keyframe that is due waits while the ego car touches an actor.
pub const KEYFRAME_GRACE_TICKS: Tick = seconds(2);

/// What a tick gave.
#[derive(Clone, Debug, PartialEq)]
pub struct TickOutput {
    /// The tick that was reached.
    pub tick: Tick,
    /// Hash over the tick's inputs, the state after it, and its outputs.
    pub hash: StateHash,
    /// What the arbitration let through.
    pub applied: Applied,
    /// The intervention, in the tick in which it happens.
    pub intervention: Option<Intervention>,
    /// Events of this tick, in a fixed order.
    pub events: Vec<Event>,
    /// Distance driven so far, millimetres.
    pub odometer_mm: u64,
    /// The state, at keyframe ticks.
    pub keyframe: Option<Keyframe>,
}

/// The simulated world. `Clone` copies the engine's caches too; use it for rewinds and forks.
#[derive(Clone)]
pub struct World {
    scenario: Arc<Scenario>,
    network: Arc<RoadNetwork>,
    parts: Parts,
    traffic: Traffic,
    physics: Physics,
    bytes: Vec<u8>,
    ends: [usize; PARTS.len()],
    scratch: Scratch,
}

/// Working memory; its contents mean nothing between ticks.
#[derive(Clone, Default)]
struct Scratch {
    obstacles: Vec<Obstacle>,
    near: Vec<u32>,
    touched: Touched,
}

impl World {
    /// A world at tick 0. The scenario's map is refused when it has another name than `network`.
    pub fn new(scenario: &Scenario, network: &Arc<RoadNetwork>) -> Result<Self, WorldError> {
        let (parts, traffic) = start::begin(scenario, network)?;
        Ok(Self::assemble(Arc::new(scenario.clone()), network, parts, traffic))
    }

    /// The world as it was at a keyframe, bit for bit. Refuses another map as [`World::new`] does.
    pub fn resume(scenario: &Scenario, network: &Arc<RoadNetwork>, keyframe: &Keyframe) -> Result<Self, WorldError> {
        start::check_map(scenario, network)?;
        let (parts, traffic) = keyframe.read()?;
        let wrong = |reason| WorldError::State { tick: keyframe.tick, reason };
        keyframe::check(&parts, network).map_err(wrong)?;
        let counts = &scenario.traffic;
        let traffic = Traffic::resume(counts, scenario.seed, network.ways(), traffic).map_err(wrong)?;
        Ok(Self::assemble(Arc::new(scenario.clone()), network, parts, traffic))
    }

    fn assemble(scenario: Arc<Scenario>, network: &Arc<RoadNetwork>, parts: Parts, traffic: Traffic) -> Self {
        let mut physics = Physics::new(network.statics(), &parts.ego.car.motion);
        parts.bodies.insert_all(traffic.bodies(), &mut physics);
        let (network, ends) = (network.clone(), Default::default());
        let mut world =
            Self { scenario, network, parts, traffic, physics, bytes: Vec::new(), ends, scratch: Scratch::default() };
        world.encode();
        world
    }

    /// Advances by one tick.
    pub fn step(&mut self, input: &TickInput) -> TickOutput {
        self.parts.input.tick += 1;
        self.parts.input.controls = *input;
        self.parts.output.events.clear();
        self.arbitrate(input);
        self.move_everyone();
        self.watch();
        let due = self.keyframe_due();
        if due {
            self.parts.run.keyframe_at = self.tick();
        }
        self.encode();
        TickOutput {
            tick: self.tick(),
            hash: self.hash(),
            applied: self.parts.output.applied,
            intervention: self.parts.output.intervention,
            events: self.parts.output.events.clone(),
            odometer_mm: self.odometer_mm(),
            keyframe: due.then(|| self.start_over()),
        }
    }

    fn arbitrate(&mut self, input: &TickInput) {
        let (tick, speed_mps) = (self.tick(), self.parts.ego.car.speed_mps());
        let decision = self.parts.run.arbiter.arbitrate(tick, input, &self.scenario.rules, speed_mps);
        let mut log = Log { events: &mut self.parts.output.events, speed_mps };
        if decision.armed {
            log.note(EventKind::Armed);
        }
        if decision.intervention.is_some() {
            log.note(EventKind::Intervention);
        }
        let pressed = input.semantic.has(Controls::SEEN) || input.safety.has(Controls::SEEN);
        self.parts.run.watch.buttons(pressed, &mut log);
        self.parts.output.applied = decision.applied;
        self.parts.output.intervention = decision.intervention;
    }

    /// Traffic decides from the state of the previous tick, then physics moves what is near.
    fn move_everyone(&mut self) {
        let Scratch { obstacles, near, .. } = &mut self.scratch;
        let (car, bodies) = (&mut self.parts.ego.car, &mut self.parts.bodies);
        obstacles.clear();
        obstacles.extend(bodies.loose.iter().map(bodies::Loose::obstacle));
        let ego = Obstacle {
            id: 0,
            position: car.middle(),
            heading_rad: car.heading_rad(),
            velocity_mps: car.motion.velocity_mps,
            size_m: ego::SIZE_M,
        };
        self.traffic.step(&Surroundings { tick: self.parts.input.tick, ego, loose: obstacles });
        bodies.prepare(self.traffic.bodies(), car, &mut self.physics, near);
        let forces = car.actuate(&self.parts.output.applied.controls);
        self.physics.step(&forces);
        car.moved(self.physics.ego());
        bodies.moved(&self.parts.run.watch.touching, &mut self.physics);
    }

    /// Finds what began in this tick, and whether it ends the run.
    fn watch(&mut self) {
        let (tick, network) = (self.tick(), &*self.network);
        let Parts { ego, run, output, .. } = &mut self.parts;
        let (car, speed_mps) = (&ego.car, ego.car.speed_mps());
        let light = ego.route.light_ahead(network);
        let strayed = ego.route.follow(network, self.scenario.seed, car.middle(), car.heading_rad());
        let mut log = Log { events: &mut output.events, speed_mps };

        self.physics.touched(&mut self.scratch.touched);
        let collided = run.watch.contacts(&self.scratch.touched, &mut log);
        let red = |group| signals::phase(network, self.scenario.seed, group, tick).0 == LightPhase::Red;
        if light.is_some_and(|light| !strayed && red(light.group) && ego.route.passed(network, &light)) {
            log.note(EventKind::RedLight);
        }
        let limit_mps = ego.route.limit_mps(network, &self.scenario);
        let wrong_way = watch::wrong_way(network, car, tick);
        run.watch.rules(limit_mps, self.physics.off_road(), wrong_way, &mut log);
        if run.arbiter.judge(tick, collided, speed_mps, &self.scenario.rules) {
            log.note(EventKind::Ended);
        }
    }

    /// A keyframe is due every [`KEYFRAME_TICKS`]; it waits while the ego car touches an actor, as
    /// physics then depends most on what is not saved, but not for long.
    fn keyframe_due(&self) -> bool {
        let (tick, run) = (self.tick(), &self.parts.run);
        let due_at = tick - tick % KEYFRAME_TICKS;
        let touching = !run.watch.touching.is_empty();
        run.keyframe_at < due_at && (!touching || tick >= due_at + KEYFRAME_GRACE_TICKS)
    }

    /// Makes the keyframe of this tick and goes on from it as any replay will.
    fn start_over(&mut self) -> Keyframe {
        let keyframe = Keyframe { tick: self.tick(), bytes: self.bytes.clone() };
        // Only a state that was forged, far from what a run can reach, does not resume: it goes on.
        if let Ok(resumed) = Self::resume(&self.scenario, &self.network, &keyframe) {
            *self = resumed;
        }
        keyframe
    }

    fn encode(&mut self) {
        self.bytes.clear();
        self.ends = self.parts.write(self.traffic.state(), &mut self.bytes);
    }

    /// The current tick.
    pub fn tick(&self) -> Tick {
        self.parts.input.tick
    }

    /// The keyframe of tick 0; only valid before the first step.
    pub fn initial_keyframe(&self) -> Keyframe {
        Keyframe { tick: self.tick(), bytes: self.bytes.clone() }
    }

    /// Size of the canonical bytes of the state.
    pub fn state_bytes(&self) -> usize {
        self.bytes.len()
    }

    /// Hash of the current state, of the last input and output: that of the last [`TickOutput`].
    pub fn hash(&self) -> StateHash {
        StateHash(xxh3_128(&self.bytes))
    }

    /// A hash for each of [`PARTS`].
    pub fn part_hashes(&self) -> [u64; PARTS.len()] {
        std::array::from_fn(|part| {
            let start = if part == 0 { 0 } else { self.ends[part - 1] };
            xxh3_64(&self.bytes[start..self.ends[part]])
        })
    }

    /// The first named value in which this world and another differ, with its part and actor.
    pub fn difference(&self, other: &World) -> Option<FieldDifference> {
        keyframe::difference((&self.parts, self.traffic.state()), (&other.parts, other.traffic.state()))
    }

    /// What there is to see, on the grid of [`crate::scene::quantise`].
    pub fn scene(&self) -> SceneSnapshot {
        let (tick, car) = (self.tick(), &self.parts.ego.car);
        let phase = |group| signals::phase(&self.network, self.scenario.seed, group, tick).0;
        let mut scene = SceneSnapshot {
            tick,
            ego: EgoScene {
                position: car.motion.position,
                rotation: car.motion.rotation,
                speed_mps: car.speed_mps(),
                wheel_angle_rad: car.wheel_angle_rad,
            },
            actors: self.actors().collect(),
            lights: (0..self.network.light_groups.len() as u32).map(phase).collect(),
            weather: self.scenario.weather,
        };
        quantise(&mut scene);
        scene
    }

    fn actors(&self) -> impl Iterator<Item = ActorScene> + '_ {
        self.traffic.bodies().iter().map(|body| {
            let loose = self.parts.bodies.loose(body.id).map(|loose| loose.motion);
            let (position, rotation) = loose.map_or((body.position, body.rotation), |m| (m.position, m.rotation));
            let velocity = loose.map_or(body.velocity_mps, |m| m.velocity_mps);
            ActorScene {
                id: body.id,
                kind: body.kind,
                variant: body.variant,
                position,
                rotation,
                speed_mps: velocity.dot(rotation * Vec3::X),
                phase_rad: body.phase_rad,
                braking: body.braking && loose.is_none(),
            }
        })
    }

    /// What the HUD shows.
    pub fn hud(&self) -> Hud {
        self.parts.ego.route.hud(&self.network, &self.scenario, self.tick(), &self.parts.ego.car)
    }

    /// What goes on around the ego car; its beginnings are the events.
    pub fn watch_state(&self) -> &Watch {
        &self.parts.run.watch
    }

    /// Where the run stands.
    pub fn arbiter(&self) -> &Arbiter {
        &self.parts.run.arbiter
    }

    /// The middle of the ego car's route ahead, from the car on, points about 1 m apart.
    pub fn route_ahead(&self, distance_m: f32) -> Vec<Vec3> {
        self.parts.ego.route.ahead(&self.network, distance_m)
    }

    /// Distance driven so far, millimetres.
    pub fn odometer_mm(&self) -> u64 {
        self.parts.ego.car.odometer_um / 1000
    }

    /// The map.
    pub fn network(&self) -> &Arc<RoadNetwork> {
        &self.network
    }

    /// The scenario.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Events of the last tick.
    pub fn last_events(&self) -> &[Event] {
        &self.parts.output.events
    }
}

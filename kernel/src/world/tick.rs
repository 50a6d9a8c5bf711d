//! What happens in a tick, in which order.

use std::sync::Arc;

use xxhash_rust::xxh3::xxh3_128;

use crate::arbiter::After;
use crate::controls::{Controls, TickInput};
use crate::events::EventKind;
use crate::light::LightPhase;
use crate::map::RoadNetwork;
use crate::physics::{Physics, Touched};
use crate::scenario::Scenario;
use crate::signals;
use crate::state::StateHash;
use crate::story::{Around, Stage};
use crate::time::{KEYFRAME_TICKS, Tick, seconds};
use crate::traffic::{Body, Obstacle, Surroundings, Traffic};
use crate::watch::{self, Log};
use crate::weather::{Conditions, Water};

use super::error::WorldError;
use super::keyframe::{self, Keyframe};
use super::output::TickOutput;
use super::snapshot::{PARTS, Parts, origin};
use super::{bodies, doors, start};

/// How long a keyframe that is due waits while the ego car touches an actor.
pub const KEYFRAME_GRACE_TICKS: Tick = seconds(2);

/// The run ends so far before the end of a road from which nobody can drive on, metres.
const END_M: f32 = 10.0;

/// The simulated world. `Clone` copies the engine's caches too; use it for rewinds and forks.
#[derive(Clone)]
pub struct World {
    pub(super) scenario: Arc<Scenario>,
    pub(super) network: Arc<RoadNetwork>,
    pub(super) parts: Parts,
    pub(super) traffic: Traffic,
    pub(super) stage: Option<Arc<Stage>>,
    physics: Physics,
    pub(super) bytes: Vec<u8>,
    pub(super) ends: [usize; PARTS.len()],
    scratch: Scratch,
}

/// Working memory; its contents mean nothing between ticks.
#[derive(Clone, Default)]
struct Scratch {
    obstacles: Vec<Obstacle>,
    bodies: Vec<Body>,
    near: Vec<u32>,
    touched: Touched,
}

impl World {
    /// A world at tick 0. The scenario's map is refused when it has another name than `network`.
    pub fn new(scenario: &Scenario, network: &Arc<RoadNetwork>) -> Result<Self, WorldError> {
        let stage = start::stage(scenario, network)?;
        let (parts, traffic) = start::begin(scenario, network, stage.as_deref())?;
        Ok(Self::assemble(Arc::new(scenario.clone()), network, parts, (traffic, stage)))
    }

    /// The world as it was at a keyframe, bit for bit. Refuses another map as [`World::new`] does, and a
    /// keyframe of a run with another scenario.
    pub fn resume(scenario: &Scenario, network: &Arc<RoadNetwork>, keyframe: &Keyframe) -> Result<Self, WorldError> {
        let world = Self::fork(scenario, network, keyframe)?;
        if world.parts.input.origin == keyframe.read()?.0.input.origin {
            return Ok(world);
        }
        let reason = "its run has another scenario, or another map".to_owned();
        Err(WorldError::State { tick: keyframe.tick, reason })
    }

    /// The world as it was at a keyframe, to go on under another scenario of the same map: a run of its own,
    /// whose log begins with [`World::initial_keyframe`].
    pub fn fork(scenario: &Scenario, network: &Arc<RoadNetwork>, keyframe: &Keyframe) -> Result<Self, WorldError> {
        start::check_map(scenario, network)?;
        let stage = start::stage(scenario, network)?;
        let (mut parts, traffic) = keyframe.read()?;
        parts.input.origin = origin(scenario, network);
        let wrong = |reason| WorldError::State { tick: keyframe.tick, reason };
        keyframe::check(&parts, network).map_err(wrong)?;
        keyframe::check_story(&parts, stage.as_deref(), network).map_err(wrong)?;
        let counts = &scenario.traffic;
        let traffic = Traffic::resume(counts, scenario.seed, network.ways(), traffic).map_err(wrong)?;
        let traffic = traffic.with_hazards(&scenario.hazards);
        Ok(Self::assemble(Arc::new(scenario.clone()), network, parts, (traffic, stage)))
    }

    fn assemble(
        scenario: Arc<Scenario>,
        network: &Arc<RoadNetwork>,
        parts: Parts,
        (mut traffic, stage): (Traffic, Option<Arc<Stage>>),
    ) -> Self {
        traffic.know_doors(parts.input.tick);
        let mut physics = Physics::new(network.statics(), &parts.ego.car.motion);
        let mut all = Vec::new();
        parts.bodies.insert_all(everybody(&traffic, stage.as_deref(), &parts, &mut all), &mut physics);
        let (network, ends) = (network.clone(), Default::default());
        let mut world = Self {
            scenario,
            network,
            parts,
            traffic,
            stage,
            physics,
            bytes: Vec::new(),
            ends,
            scratch: Scratch::default(),
        };
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
        let tick = self.parts.input.tick;
        // People notice the weather once a second; what a story makes of it they know at once.
        let conditions = Conditions::of(&self.weather_at(tick - tick % seconds(1)));
        let water = Water::of(&self.weather_at(tick));
        let Scratch { obstacles, near, bodies: all, .. } = &mut self.scratch;
        obstacles.clear();
        obstacles.extend(self.parts.bodies.loose.iter().map(bodies::Loose::obstacle));
        let ego = doors::ego_obstacle(&self.parts.ego.car);
        let ego_flags = self.parts.output.applied.controls.flags;
        let before = self.stage.as_ref().zip(self.parts.story.clone());
        if let (Some(stage), Some(story)) = (&self.stage, &mut self.parts.story) {
            let (network, touching) = (&*self.network, self.parts.run.watch.touching.as_slice());
            let ego_on_road = !self.parts.run.watch.off_road;
            let seed = self.scenario.seed;
            let taken_over = self.parts.output.intervention.is_some();
            stage
                .step(story, &Around { tick, seed, network, ego, loose: obstacles, touching, ego_on_road, taken_over });
        }
        if let Some((stage, story)) = &before {
            // Traffic decides from where they were.
            let held = |o: &Obstacle| obstacles.binary_search_by_key(&o.id, |loose| loose.id).is_ok();
            let playing: Vec<Obstacle> = stage.obstacles(story).filter(|o| !held(o)).collect();
            obstacles.extend(playing);
            obstacles.sort_unstable_by_key(|o| o.id);
        }
        let lights = before.as_ref().map_or(&[][..], |(_, story)| &story.lights);
        self.traffic.step(&Surroundings { tick, ego, ego_flags, loose: obstacles, lights, conditions });
        let mut log = Log { events: &mut self.parts.output.events, speed_mps: self.parts.ego.car.speed_mps() };
        self.traffic.told_near(ego.position).for_each(|(kind, actor)| log.with(kind, actor));
        let parked = &self.network.places().parked;
        let all = everybody(&self.traffic, self.stage.as_deref(), &self.parts, all);
        let (car, bodies) = (&mut self.parts.ego.car, &mut self.parts.bodies);
        bodies.prepare(all, parked, car, &mut self.physics, near);
        match self.stage.as_ref().zip(self.parts.story.as_ref()).and_then(|(stage, story)| stage.carried(story)) {
            Some((middle, rotation)) => self.physics.carry(car, middle, rotation),
            None => self.physics.drive(car, &self.parts.output.applied.controls, &self.scenario.car, &water),
        }
        self.physics.step(car);
        bodies.moved(&self.parts.run.watch.touching, &mut self.physics);
    }

    /// Finds what began in this tick, and whether it ends the run.
    fn watch(&mut self) {
        let (tick, network) = (self.tick(), &*self.network);
        let Parts { ego, bodies, run, output, story, .. } = &mut self.parts;
        let (car, speed_mps) = (&ego.car, ego.car.speed_mps());
        let light = ego.route.light_ahead(network);
        let strayed = ego.route.follow(network, self.scenario.seed, car.middle(), car.heading_rad());
        let mut log = Log { events: &mut output.events, speed_mps };

        let touched = &mut self.scratch.touched;
        self.physics.touched(touched);
        let played = self.stage.iter().zip(story.as_ref()).flat_map(|(stage, story)| stage.open_doors(story, tick));
        let open = doors::open_doors(&self.traffic, bodies, tick, car).chain(played);
        doors::heed(open, car, touched, &mut log);
        let collided = run.watch.contacts(touched, &mut log);
        let held = story.as_ref().map_or(&[][..], |story| &story.lights);
        let red = |group| signals::shown(network, self.scenario.seed, held, group, tick).0 == LightPhase::Red;
        if light.is_some_and(|light| !strayed && red(light.group) && ego.route.passed(network, &light)) {
            log.note(EventKind::RedLight);
        }
        let limit_mps = ego.route.limit_mps(network, &self.scenario);
        let wrong_way = watch::wrong_way(network, car, tick);
        run.watch.rules(limit_mps, self.physics.off_road(), wrong_way, &mut log);
        let in_junction = network.lanes[ego.route.lanes[0] as usize].junction.is_some();
        let road_ends = ego.route.ends_in_m(network).is_some_and(|ends_in_m| ends_in_m < END_M);
        let at_end = road_ends || story.as_ref().is_some_and(|story| story.over);
        let after = After { collided, in_junction, at_end, speed_mps };
        if run.arbiter.judge(tick, &after, &self.scenario.rules) {
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

    /// Hash of the current state, of the last input and output: that of the last [`TickOutput`].
    pub fn hash(&self) -> StateHash {
        StateHash(xxh3_128(&self.bytes))
    }

    /// Distance driven so far, millimetres.
    pub fn odometer_mm(&self) -> u64 {
        self.parts.ego.car.odometer_um / 1000
    }
}

/// Traffic and those who play a story, by ascending id; `all` is working memory.
fn everybody<'a>(traffic: &'a Traffic, stage: Option<&Stage>, parts: &Parts, all: &'a mut Vec<Body>) -> &'a [Body] {
    let Some((stage, story)) = stage.zip(parts.story.as_ref()) else { return traffic.bodies() };
    all.clear();
    all.extend_from_slice(traffic.bodies());
    all.extend(stage.bodies(story));
    all
}

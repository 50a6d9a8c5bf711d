//! What there is to see of a world from outside.

use std::sync::Arc;

use glam::Vec3;
use xxhash_rust::xxh3::xxh3_64;

use crate::arbiter::Arbiter;
use crate::car::Footing;
use crate::controls::Controls;
use crate::events::{Event, Hud};
use crate::map::{LightGroupId, RoadNetwork, SurfaceKind};
use crate::motion::Motion;
use crate::scenario::Scenario;
use crate::scene::{ActorScene, EgoScene, SceneSnapshot, lamps, quantise};
use crate::signals::{self, HeldLight, LightPhase};
use crate::time::Tick;
use crate::traffic::{Body, Missing};
use crate::watch::Watch;
use crate::weather::{Water, Weather};

use super::doors;
use super::keyframe::{self, FieldDifference, Keyframe};
use super::snapshot::PARTS;
use super::tick::World;

impl World {
    /// The keyframe that a run begins with; only valid before the first step.
    pub fn initial_keyframe(&self) -> Keyframe {
        Keyframe { tick: self.tick(), bytes: self.bytes.clone() }
    }

    /// Road users that the scenario asks for and the map has no room for.
    pub fn missing(&self) -> Missing {
        self.traffic.missing()
    }

    /// Size of the canonical bytes of the state.
    pub fn state_bytes(&self) -> usize {
        self.bytes.len()
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

    /// Names of the events of its story that did not begin so far.
    pub fn waiting_events(&self) -> impl Iterator<Item = &str> {
        let told = self.stage.as_ref().zip(self.parts.story.as_ref());
        told.into_iter().flat_map(|(stage, story)| stage.waiting(story))
    }

    /// The scenario's weather at a tick, as its story has changed it so far.
    pub fn weather_at(&self, tick: Tick) -> Weather {
        let from = self.scenario.weather_at(tick);
        let told = self.stage.as_ref().zip(self.parts.story.as_ref());
        told.map_or(from, |(stage, story)| stage.weather(story, from))
    }

    /// What there is to see, on the grid of [`crate::scene::quantise`].
    pub fn scene(&self) -> SceneSnapshot {
        let (tick, car) = (self.tick(), &self.parts.ego.car);
        let phase = |group| self.light(group);
        let weather = self.weather_at(tick);
        let lit = weather.calls_for_headlights();
        let mut scene = SceneSnapshot {
            tick,
            ego: EgoScene {
                position: car.motion.position,
                rotation: car.motion.rotation,
                speed_mps: car.speed_mps(),
                wheel_angle_rad: car.gear.wheel_angle_rad,
                // Headlights come on by themselves in the dark, as everybody's do.
                lamps: lamps_of(&self.parts.output.applied.controls) | if lit { lamps::HEADLIGHTS } else { 0 },
            },
            actors: self.actors(lit).chain(self.pushed_cars()).chain(self.doors()).collect(),
            lights: (0..self.network.light_groups.len() as u32).map(phase).collect(),
            weather,
        };
        quantise(&mut scene);
        scene
    }

    fn actors(&self, lit: bool) -> impl Iterator<Item = ActorScene> + '_ {
        let lights = move |body: &Body| if lit && body.kind.is_vehicle() { lamps::HEADLIGHTS } else { 0 };
        let playing = self.stage.iter().zip(&self.parts.story).flat_map(|(stage, story)| stage.bodies(story));
        self.traffic.bodies().iter().copied().chain(playing).map(move |body| {
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
                lamps: if loose.is_none() { body.lamps | lights(&body) } else { 0 },
            }
        })
    }

    /// Parked cars that were pushed, where they are now.
    fn pushed_cars(&self) -> impl Iterator<Item = ActorScene> + '_ {
        let parked = &self.network.places().parked;
        self.parts.bodies.pushed().iter().map(|loose| {
            let Motion { position, rotation, velocity_mps, .. } = loose.motion;
            ActorScene {
                id: loose.id,
                kind: loose.kind,
                variant: parked.of_id(loose.id).map_or(0, |prop| prop.variant),
                position,
                rotation,
                speed_mps: velocity_mps.dot(rotation * Vec3::X),
                phase_rad: 0.0,
                lamps: 0,
            }
        })
    }

    /// Open doors of parked cars.
    fn doors(&self) -> impl Iterator<Item = ActorScene> + '_ {
        let parked = doors::open_doors(&self.traffic, &self.parts.bodies, self.tick(), &self.parts.ego.car);
        let played = self.stage.iter().zip(&self.parts.story);
        let played = played.flat_map(|(stage, story)| stage.open_doors(story, self.tick()));
        parked.chain(played).map(|door| doors::scene_of(&door))
    }

    /// Lights that the story holds.
    pub(super) fn held_lights(&self) -> &[HeldLight] {
        self.parts.story.as_ref().map_or(&[], |story| &story.lights)
    }

    /// What a traffic light shows.
    pub fn light(&self, group: LightGroupId) -> LightPhase {
        signals::shown(&self.network, self.scenario.seed, self.held_lights(), group, self.tick()).0
    }

    /// What the HUD shows.
    pub fn hud(&self) -> Hud {
        self.parts.ego.route.hud(&self.network, &self.scenario, |group| self.light(group), &self.parts.ego.car)
    }

    /// Torque of the road on the front wheels about their steering axes, N m, positive to the right: what a driver's
    /// hands feel, before any assistance.
    pub fn aligning_torque_nm(&self) -> f32 {
        self.parts.ego.car.gear.aligning_torque_nm
    }

    /// Greatest coefficient of friction of the road under the ego car without paint and puddles in the present weather,
    /// at its speed; beside roads that of asphalt.
    pub fn friction(&self) -> f32 {
        let (water, car) = (Water::of(&self.weather_at(self.tick())), &self.parts.ego.car);
        let below = self.network.ground(car.middle()).map(|ground| ground.kind);
        let kind = below.filter(|kind| matches!(kind, SurfaceKind::Gravel | SurfaceKind::Setts));
        let road = Footing {
            distance_m: 0.0,
            normal: Vec3::Z,
            kind: kind.unwrap_or(SurfaceKind::Road),
            wet: water.wet,
            water_mm: water.film_mm,
        };
        road.grip(car.speed_mps()).peak
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

#[cfg(test)]
impl World {
    /// How far the story has come.
    pub fn parts_of_story(&self) -> Option<&crate::story::StoryState> {
        self.parts.story.as_ref()
    }

    /// The canonical bytes of the state.
    pub fn state_of_now(&self) -> Vec<u8> {
        self.bytes.clone()
    }
}

/// The lamps that burn when a car is driven so.
fn lamps_of(controls: &Controls) -> u8 {
    let brake = if controls.brake > 0 { lamps::BRAKE } else { 0 };
    let flags = [
        (Controls::INDICATE_LEFT, lamps::LEFT),
        (Controls::INDICATE_RIGHT, lamps::RIGHT),
        (Controls::LIGHTS, lamps::HEADLIGHTS),
    ];
    flags.iter().filter(|(flag, _)| controls.has(*flag)).fold(brake, |on, (_, lamp)| on | lamp)
}

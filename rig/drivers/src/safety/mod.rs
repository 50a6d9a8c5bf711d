//! The simulated safety driver: sees what a person would see, leaves the semantic driver time to act, and reacts with a
//! human delay.

mod encounter;
mod eyes;
mod forecast;
mod hazard;
mod looks;

use glam::Vec2;
use kernel::rng::{self, Stream};
use kernel::scene::{ActorScene, SceneSnapshot};
use kernel::time::{TICK_HZ, Tick, seconds};
use kernel::{Controls, Seat, World, ops};

use eyes::Eyes;
use replay::Label;

use super::Driver;
use crate::footprint::{self, Footprint, on_level};
use crate::single_track;
use crate::temper::Temper;
pub use encounter::{CRITICAL_S, Encroachment, Touched, encroachers, label_of, predicted_encroachment};
pub use eyes::in_sight;
pub use hazard::{Hazard, Source};
pub use looks::{LOOK_TICKS, Looks};

/// Reaction times are log-normal with this mean (Dixit et al. 2016), seconds, and spread.
const REACTION_MEAN_S: f32 = 0.83;
const REACTION_SIGMA: f32 = 0.35;
/// Shortest and longest reaction, seconds.
const REACTION_RANGE_S: [f32; 2] = [0.35, 2.5];
/// A hazard that is gone for this long is over.
pub const FORGET_TICKS: Tick = 12;
/// But who seemed in danger is watched for longer: when they are again, the foot is ready. So long after an alarming look the
/// driver is alert, too.
const ALERT_TICKS: Tick = seconds(2);
/// Share of the reaction time that an alert driver takes for the next contact. Expected signals are answered after 0.7 to
/// 0.75 s, unexpected ones after 1.25 s (Green 2000).
const EXPECTED: f32 = 0.6;
/// Share of the road's braking that has to be needed before it is no longer the semantic driver's turn.
pub const URGENT: f32 = 0.6;
/// Standing without a red light ahead gets boring after this time.
pub const BORING_TICKS: Tick = seconds(60);
/// The same behind somebody who stands in the way, whom they see, so that they know what it waits for; and so far before the
/// car that is, metres.
pub const QUEUE_TICKS: Tick = seconds(180);
const QUEUE_M: f32 = 8.0;
/// Deceleration of the full brake is asked for at once.
const BRAKE: f32 = 1.0;
/// How far ahead on the route the car is steered to, metres.
const STEER_TO_M: usize = 8;

/// Sees what can be seen from the seat, and takes over when it gets dangerous.
#[derive(Clone, Debug)]
pub struct SafetyBot {
    /// Number of the person, who has reaction times of their own.
    person: u64,
    temper: Temper,
    /// From here on an attentive one does not trust the semantic driver to act: see [`Hazard::urgency`].
    urgent: f32,
    eyes: Eyes,
    looks: Looks,
    /// The hazards of the moment, and those just over.
    feared: Vec<Feared>,
    /// Until when the driver is alert.
    alert_until: Tick,
    /// Why it took over.
    reason: Option<Hazard>,
    /// Since when the car stands with nothing to wait for.
    stands_since: Option<Tick>,
    /// And since when with nobody before it.
    free_since: Option<Tick>,
}

/// A hazard that was seen.
#[derive(Clone, Copy, Debug)]
struct Feared {
    source: Source,
    /// When it was last seen.
    last: Tick,
    /// When the reaction time is over.
    ready: Tick,
}

impl Feared {
    /// How long it stays in mind.
    fn lasts_ticks(&self) -> Tick {
        if matches!(self.source, Source::Contact(_)) { ALERT_TICKS } else { FORGET_TICKS }
    }
}

impl Default for SafetyBot {
    fn default() -> Self {
        Self::of_person(0)
    }
}

impl SafetyBot {
    /// Who sits there in the run of a seed.
    pub fn drawn(seed: u64) -> Self {
        Self::default().with_temper(Temper::drawn(seed, Seat::Safety))
    }

    /// One of many, of whom [`SafetyBot::default`] is number 0, all attentive: they differ in their reaction times.
    pub fn of_person(person: u64) -> Self {
        Self {
            person,
            temper: Temper::default(),
            urgent: URGENT,
            eyes: Eyes::default(),
            looks: Looks::default(),
            feared: Vec::new(),
            alert_until: 0,
            reason: None,
            stands_since: None,
            free_since: None,
        }
    }

    /// The same person with another threshold than [`URGENT`].
    pub fn with_urgent(self, urgent: f32) -> Self {
        Self { urgent, ..self }
    }

    /// The same person in another temper.
    pub fn with_temper(self, temper: Temper) -> Self {
        Self { temper, ..self }
    }

    /// Why it took over, once it has.
    pub fn reason(&self) -> Option<&Hazard> {
        self.reason.as_ref()
    }

    fn look(&mut self, world: &World) {
        let scene = world.scene();
        self.looks.look(&scene);
        self.eyes.look(world.network(), &scene);
        let found = hazard::find(world, &scene, &self.looks, &self.eyes);
        for hazard in found.hazards {
            self.fear(hazard, world);
        }
        if found.is_alarming {
            self.alert_until = world.tick() + ALERT_TICKS;
        }
        self.feared.retain(|feared| world.tick() < feared.last + feared.lasts_ticks());
        if self.is_bored(world, &scene) && self.reason.is_none() {
            let comment = "nothing moves".into();
            self.reason = Some(Hazard { label: Label::Boredom, comment, source: Source::Standstill, urgency: 0.0 });
        }
    }

    /// Acts once the reaction time is over and the hazard presses. The foot is ready by then.
    fn fear(&mut self, hazard: Hazard, world: &World) {
        let tick = world.tick();
        let feared = match self.feared.iter().position(|feared| feared.source == hazard.source) {
            Some(at) => &mut self.feared[at],
            None => {
                let ready = tick + self.reaction_ticks(&hazard, world);
                self.feared.push_mut(Feared { source: hazard.source, last: tick, ready })
            }
        };
        feared.last = tick;
        let is_ready = tick >= feared.ready;
        let is_worse = self.reason.as_ref().is_none_or(|reason| hazard.urgency > reason.urgency);
        if is_ready && hazard.urgency >= self.temper.vigour() * self.urgent && is_worse {
            self.reason = Some(hazard);
        }
    }

    /// From now until it can act against a hazard that it sees for the first time.
    fn reaction_ticks(&self, hazard: &Hazard, world: &World) -> Tick {
        let tick = world.tick();
        let is_expected = tick < self.alert_until && matches!(hazard.source, Source::Contact(_));
        let share = if is_expected { EXPECTED } else { 1.0 };
        let unexpected_ticks = reaction_ticks(world.scenario().seed, self.person, tick) as f32;
        (share * self.temper.reaction_factor() * unexpected_ticks) as Tick
    }

    fn is_bored(&mut self, world: &World, scene: &SceneSnapshot) -> bool {
        let hud = world.hud();
        let waits = hud.light.is_some_and(|light| light != kernel::signals::LightPhase::Green);
        if hud.speed_mps > 0.3 || waits {
            (self.stands_since, self.free_since) = (None, None);
            return false;
        }
        if is_blocked(scene) {
            self.free_since = None;
        } else {
            self.free_since.get_or_insert(world.tick());
        }
        let lasts = |since: Option<Tick>, ticks| since.is_some_and(|since| world.tick() >= since + ticks);
        self.stands_since.get_or_insert(world.tick());
        lasts(self.free_since, BORING_TICKS) || lasts(self.stands_since, QUEUE_TICKS)
    }
}

/// Whether somebody stands right before the car.
fn is_blocked(scene: &SceneSnapshot) -> bool {
    let car = Footprint::of_ego(&scene.ego);
    let half = Vec2::new(0.5 * QUEUE_M, car.half.y);
    let ahead = Footprint { centre: car.centre + (car.half.x + half.x) * car.forward, half, ..car };
    let is_there = |a: &ActorScene| on_level(a.position, scene.ego.position) && ahead.overlaps(&Footprint::of_actor(a));
    scene.actors.iter().any(is_there)
}

impl Driver<World> for SafetyBot {
    fn controls(&mut self, world: &World) -> Controls {
        if world.tick().is_multiple_of(LOOK_TICKS) && self.reason.is_none() {
            self.look(world);
        }
        match &self.reason {
            None => Controls::default(),
            Some(hazard) => {
                let steer = if hazard.steers() { steer_back(world) } else { 0.0 };
                Controls::from_fractions(steer, 0.0, BRAKE)
            }
        }
    }
}

/// Log-normal reaction time of a person to a hazard that began at a tick.
fn reaction_ticks(seed: u64, person: u64, since: Tick) -> Tick {
    // Box and Muller 1958; 1 - u is never 0.
    let draw = |number| rng::unit(seed, Stream::Driver, 2 * person + number, since);
    let normal = (-2.0 * ops::ln(1.0 - draw(0))).sqrt() * ops::cos(core::f32::consts::TAU * draw(1));
    let median_s = REACTION_MEAN_S * ops::exp(-0.5 * REACTION_SIGMA * REACTION_SIGMA);
    let [least, most] = REACTION_RANGE_S;
    let reaction_s = (median_s * ops::exp(REACTION_SIGMA * normal)).clamp(least, most);
    (reaction_s * TICK_HZ as f32) as Tick
}

/// Steering back to the route (pure pursuit), [-1, 1].
fn steer_back(world: &World) -> f32 {
    let car = world.scene().ego;
    let route = world.route_ahead(STEER_TO_M as f32 + 1.0);
    let Some(target) = route.get(STEER_TO_M).or(route.last()) else { return 0.0 };
    single_track::pursuit(car.position.truncate(), footprint::forward(&car), target.truncate())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reactions_are_human() {
        let mean = (0..2000).map(|i| reaction_ticks(7, i % 4, i) as f32).sum::<f32>() / 2000.0 / TICK_HZ as f32;
        assert!((mean - REACTION_MEAN_S).abs() < 0.04, "{mean}");
        assert_eq!(reaction_ticks(7, 0, 3), reaction_ticks(7, 0, 3));
        assert_ne!(reaction_ticks(7, 0, 3), reaction_ticks(7, 1, 3));
    }

    #[test]
    fn who_is_alert_answers_the_next_contact_sooner() {
        let network = kernel::map::bundled("city").expect("it is bundled");
        let world = World::new(&kernel::Scenario::default_for("city", 7), &network).expect("it fits");
        let hazard = |source| Hazard { label: Label::Walker, comment: String::new(), source, urgency: 1.0 };
        let contact = Source::Contact(Touched::Actor(1, kernel::scene::ActorKind::Child));
        let ticks = |alert_until, source| {
            SafetyBot { alert_until, ..SafetyBot::default() }.reaction_ticks(&hazard(source), &world)
        };
        let unexpected_ticks = reaction_ticks(7, 0, world.tick());
        assert_eq!(ticks(0, contact), unexpected_ticks);
        assert_eq!(ticks(60, contact), (EXPECTED * unexpected_ticks as f32) as Tick);
        assert_eq!(ticks(60, Source::LaneLeft), unexpected_ticks);
    }
}

//! Whose mistake brought a hazard about.

use std::collections::BTreeMap;

use base::words;
use drivers::footprint::Footprint;
use drivers::safety::{Looks, Touched};
use kernel::events::{Event, EventKind};
use kernel::scene::{ActorScene, SceneSnapshot};
use kernel::time::{Tick, seconds};
use serde::Serialize;

/// A mistake brings hazards about for so long after it began: a light that is run is passed within this time, and what
/// was braked for or cut in before is met.
const LASTS_TICKS: Tick = seconds(5);
/// A door stands open for up to 8 s, and takes a second each to open and to close.
const DOOR_LASTS_TICKS: Tick = seconds(10);
/// Harder braking than this answers a mistake right ahead, m/s^2.
const ANSWER_MPS2: f32 = 2.5;
/// Who is ahead is at most so far away and so far aside, metres from middle to middle.
const AHEAD_M: f32 = 30.0;
const ASIDE_M: f32 = 1.5;

/// A mistake of another, as its event tells.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Mistake {
    /// When it began.
    pub tick: Tick,
    /// Kind of the event, as `HazardBraking`.
    pub kind: String,
    /// Number of the road user who makes it.
    pub actor: u32,
    #[serde(skip)]
    pub(super) words: String,
}

/// The mistakes that others make.
#[derive(Debug, Default)]
pub struct Mistakes {
    /// The last one of each.
    last: BTreeMap<u32, (Tick, Event)>,
}

impl Mistakes {
    /// Takes in what happened in a tick; ticks come in order.
    pub fn hear(&mut self, tick: Tick, events: &[Event]) {
        let mistakes = events.iter().filter(|event| is_mistake(event.kind));
        self.last.extend(mistakes.map(|event| (event.actor, (tick, *event))));
    }

    /// That which brings it about that somebody is predicted to be touched: his own, or that of the one right ahead of
    /// him for whom he brakes hard.
    pub fn behind(&self, whom: Touched, scene: &SceneSnapshot, looks: &Looks) -> Option<Mistake> {
        let Touched::Actor(id, kind) = whom else { return None };
        self.of(scene.tick, id).or_else(|| {
            let actor = scene.actors.iter().find(|actor| actor.id == id)?;
            let answers = !kind.is_on_foot() && looks.actor_mps2(actor) < -ANSWER_MPS2;
            answers.then(|| right_ahead(actor, scene)).flatten().and_then(|ahead| self.of(scene.tick, ahead.id))
        })
    }

    fn of(&self, now: Tick, id: u32) -> Option<Mistake> {
        let (tick, event) = self.last.get(&id)?;
        let lasts_ticks = if event.kind == EventKind::HazardDoor { DOOR_LASTS_TICKS } else { LASTS_TICKS };
        (now <= tick + lasts_ticks).then(|| Mistake {
            tick: *tick,
            kind: format!("{:?}", event.kind),
            actor: id,
            words: words::event(event),
        })
    }
}

/// Whether an event is a mistake of others.
fn is_mistake(kind: EventKind) -> bool {
    use EventKind::{HazardBraking, HazardCutIn, HazardDoor, HazardPullOut, HazardRedLight, HazardRollingStop};
    matches!(kind, HazardRedLight | HazardRollingStop | HazardBraking | HazardCutIn | HazardPullOut | HazardDoor)
}

/// The nearest vehicle straight ahead of another.
fn right_ahead<'a>(actor: &ActorScene, scene: &'a SceneSnapshot) -> Option<&'a ActorScene> {
    let from = Footprint::of_actor(actor);
    let ahead_m = |other: &&ActorScene| (other.position.truncate() - from.centre).dot(from.forward);
    let aside_m = |other: &&ActorScene| (other.position.truncate() - from.centre).perp_dot(from.forward);
    let vehicles = scene.actors.iter().filter(|other| other.id != actor.id && !other.kind.is_on_foot());
    vehicles
        .filter(|other| (0.0..AHEAD_M).contains(&ahead_m(other)) && aside_m(other).abs() < ASIDE_M)
        .min_by(|a, b| ahead_m(a).total_cmp(&ahead_m(b)))
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use kernel::scene::ActorKind;
    use kernel::{Scenario, World, map};

    use super::*;

    const BRAKES: Event = Event { kind: EventKind::HazardBraking, actor: 7, speed_mps: 9.0 };

    fn car(id: u32, x_m: f32, y_m: f32, speed_mps: f32) -> ActorScene {
        let (kind, position, rotation) = (ActorKind::Car, Vec3::new(x_m, y_m, 0.0), Quat::IDENTITY);
        ActorScene { id, kind, variant: 0, position, rotation, speed_mps, phase_rad: 0.0, lamps: 0 }
    }

    fn scene(tick: Tick, actors: Vec<ActorScene>) -> SceneSnapshot {
        let network = map::bundled("city").expect("it is bundled");
        let world = World::new(&Scenario::default_for("city", 1), &network).expect("it fits");
        SceneSnapshot { tick, actors, ..world.scene() }
    }

    /// Who is told to have made the mistake that makes the ego car touch car 5, which slows by a speed between two looks.
    fn blamed(mistakes: &Mistakes, tick: Tick, slower_mps: f32, others: &[ActorScene]) -> Option<u32> {
        let mut looks = Looks::default();
        let at = |speed_mps| scene(tick, [&[car(5, 0.0, 0.0, speed_mps)], others].concat());
        looks.look(&at(10.0 + slower_mps));
        looks.look(&at(10.0));
        mistakes.behind(Touched::Actor(5, ActorKind::Car), &at(10.0), &looks).map(|mistake| mistake.actor)
    }

    #[test]
    fn a_mistake_is_of_whom_it_was_made_and_wears_off() {
        let mut mistakes = Mistakes::default();
        mistakes.hear(100, &[BRAKES, Event { kind: EventKind::RedLight, actor: 5, ..BRAKES }]);
        assert_eq!(blamed(&mistakes, 110, 0.0, &[]), None, "car 5 has made none");
        mistakes.hear(120, &[Event { actor: 5, ..BRAKES }]);
        assert_eq!(blamed(&mistakes, 120, 0.0, &[]), Some(5));
        assert_eq!(blamed(&mistakes, 120 + LASTS_TICKS, 0.0, &[]), Some(5));
        assert_eq!(blamed(&mistakes, 121 + LASTS_TICKS, 0.0, &[]), None);
    }

    #[test]
    fn a_door_is_a_hazard_for_as_long_as_it_stands_open() {
        let mut mistakes = Mistakes::default();
        mistakes.hear(900, &[Event { kind: EventKind::HazardDoor, actor: 5, speed_mps: 0.0 }]);
        assert_eq!(blamed(&mistakes, 900 + seconds(8), 0.0, &[]), Some(5));
        assert_eq!(blamed(&mistakes, 901 + DOOR_LASTS_TICKS, 0.0, &[]), None);
    }

    #[test]
    fn who_brakes_hard_right_behind_a_mistake_is_its_victim() {
        let mut mistakes = Mistakes::default();
        mistakes.hear(100, &[BRAKES]);
        let found = |slower_mps: f32, others: &[ActorScene]| blamed(&mistakes, 130, slower_mps, others);
        let ahead = car(7, 12.0, 0.5, 4.0);
        assert_eq!(found(0.5, &[ahead]), Some(7));
        assert_eq!(found(0.1, &[ahead]), None, "he brakes gently");
        assert_eq!(found(0.5, &[ahead, car(8, 8.0, 0.0, 4.0)]), None, "another is between them");
        assert_eq!(found(0.5, &[car(7, 12.0, 3.0, 4.0)]), None, "in another lane");
        assert_eq!(found(0.5, &[car(7, -12.0, 0.0, 4.0)]), None, "behind");
    }
}

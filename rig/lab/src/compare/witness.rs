//! Who came into the ego car's way in a case, by the truth.

use base::words;
use drivers::safety::{Looks, Touched, encroachers, label_of};
use kernel::arbiter::Outcome;
use kernel::events::EventKind;
use kernel::scene::{ActorKind, ActorScene};
use kernel::time::Tick;
use kernel::{SceneSnapshot, World};
use render::{instance_of_actor, instance_of_parked};
use replay::{Label, Log};
use serde::{Deserialize, Serialize};

/// What is true of a case, whoever looks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// Tick of each frame.
    pub ticks: Vec<Tick>,
    /// Whom the intervention (or the collision nobody prevented) is about.
    pub hazard: Option<Hazard>,
    /// Instances of the people on foot that the ego car was predicted to touch in any frame.
    pub people_on_path: Vec<u16>,
    /// The kernel that made the case, if it is another: who came into the way is then not known.
    pub other_kernel: Option<String>,
}

/// A road user or parked car that the ego car was about to touch.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hazard {
    /// Its instance in frames.
    pub instance: u16,
    /// As in `pedestrian 31`.
    pub what: String,
}

/// Watches a replay, frame by frame. A frame is as long after the one before as the safety driver's looks
/// are apart, once there were looks enough to feel whether the car brakes.
#[derive(Default)]
pub struct Witness {
    looks: Looks,
    ticks: Vec<Tick>,
    /// Who was predicted to be touched within 2 s in each frame, first contact first.
    touched: Vec<Vec<Touched>>,
    actors: Vec<(u32, ActorKind)>,
}

impl Witness {
    /// Takes in a frame.
    pub fn look(&mut self, world: &World, scene: &SceneSnapshot) {
        self.looks.look(scene);
        self.ticks.push(scene.tick);
        let feels = self.ticks.len() >= Looks::ENOUGH;
        self.touched.push(if feels { encroachers(world, scene, &self.looks) } else { Vec::new() });
        self.actors = scene.actors.iter().map(|actor: &ActorScene| (actor.id, actor.kind)).collect();
    }

    /// What has been seen of a log, whose frames have these ticks.
    pub fn facts(&self, log: &Log, ticks: Vec<Tick>) -> Facts {
        let kernel = &log.manifest.kernel;
        let people =
            self.touched.iter().flatten().filter(|t| matches!(t, Touched::Actor(_, kind) if kind.is_on_foot()));
        let mut people_on_path: Vec<u16> = people.map(|t| instance(*t)).collect();
        people_on_path.sort_unstable();
        people_on_path.dedup();
        let hazard = self.collision(log).or_else(|| self.last_encroacher(log));
        let hazard = hazard.map(|touched| Hazard { instance: instance(touched), what: what(touched) });
        let other_kernel = (*kernel != kernel::identity()).then(|| kernel.clone());
        Facts { ticks, hazard, people_on_path, other_kernel }
    }

    /// With whom a missed case ended.
    fn collision(&self, log: &Log) -> Option<Touched> {
        log.summary.as_ref().filter(|summary| summary.outcome == Some(Outcome::Missed))?;
        let (_, event) = log.events.iter().rfind(|(_, event)| event.kind == EventKind::CollisionActor)?;
        let (id, kind) = self.actors.iter().find(|(id, _)| *id == event.actor)?;
        Some(Touched::Actor(*id, *kind))
    }

    /// Of the last frame in which anyone was about to be touched the first one; only of the kind that the
    /// case's label names, if there is a label.
    fn last_encroacher(&self, log: &Log) -> Option<Touched> {
        let label = log.annotation.as_ref().map(|annotation| annotation.label);
        let is_meant = |touched: &&Touched| label.is_none_or(|label| label == label_of_touched(**touched));
        self.touched.iter().rev().find_map(|frame| frame.iter().find(is_meant)).copied()
    }
}

fn label_of_touched(touched: Touched) -> Label {
    match touched {
        Touched::Actor(_, kind) => label_of(kind),
        Touched::Parked(_) => Label::Vehicle,
    }
}

/// As [`render::Frame::instance_ids`] numbers them.
fn instance(touched: Touched) -> u16 {
    match touched {
        Touched::Actor(id, _) => instance_of_actor(id),
        Touched::Parked(number) => instance_of_parked(number),
    }
}

fn what(touched: Touched) -> String {
    match touched {
        Touched::Actor(id, kind) => format!("{} {id}", words::road_user(kind)),
        Touched::Parked(_) => "parked car".into(),
    }
}

//! With whom the ego car will collide in the next seconds, by the truth, if nobody changes his mind.

use base::words;
use kernel::World;
use kernel::map::PropKind;
use kernel::scene::{ActorKind, ActorScene, FIRST_PARKED_ID, SceneSnapshot};
use replay::Label;

use super::forecast::{EgoWay, actor_after, driven_m};
use super::looks::Looks;
use crate::footprint::{Footprint, forward, middle, on_level};

/// An encroachment predicted within this time is critical (Westhofen et al. 2022), seconds.
pub const CRITICAL_S: f32 = 2.0;
/// Step of the prediction, seconds.
const STEP_S: f32 = 0.1;
/// How far around the car others matter, metres.
pub const NEAR_M: f32 = 60.0;
/// Slower than this the ego car is not predicted to touch anybody, m/s.
const STANDS_MPS: f32 = 0.5;

/// Somebody who is predicted to be touched, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encroachment {
    /// Who.
    pub whom: Touched,
    /// Seconds from now.
    pub after_s: f32,
}

impl Encroachment {
    /// What it is called to overlook them.
    pub fn label(&self) -> Label {
        match self.whom {
            Touched::Actor(_, kind) => label_of(kind),
            Touched::Parked(_) => Label::Vehicle,
        }
    }

    /// As in `pedestrian 31, 1.2 s before contact`.
    pub fn comment(&self) -> String {
        let whom = match self.whom {
            Touched::Actor(id, kind) => format!("{} {id}", words::road_user(kind)),
            Touched::Parked(_) => "parked car".into(),
        };
        format!("{whom}, {:.1} s before contact", self.after_s)
    }
}

/// The actor or parked car that the ego car is predicted to touch first, within 2 s.
pub fn predicted_encroachment(world: &World, scene: &SceneSnapshot, looks: &Looks) -> Option<Encroachment> {
    if scene.ego.speed_mps < STANDS_MPS {
        return None;
    }
    let way = EgoWay::new(world, &scene.ego, looks.ego_mps2().min(0.0));
    Others::near(world, scene, looks).on_the_road().encroachments(&way, CRITICAL_S).next()
}

/// Everyone whom the ego car is predicted to touch within 2 s, first contact first.
pub fn encroachers(world: &World, scene: &SceneSnapshot, looks: &Looks) -> Vec<Touched> {
    let mut found: Vec<Touched> = Vec::new();
    if scene.ego.speed_mps < STANDS_MPS {
        return found;
    }
    let way = EgoWay::new(world, &scene.ego, looks.ego_mps2().min(0.0));
    let others = Others::near(world, scene, looks).on_the_road();
    for Encroachment { whom, .. } in others.encroachments(&way, CRITICAL_S) {
        if !found.contains(&whom) {
            found.push(whom);
        }
    }
    found
}

/// Who is predicted to be touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touched {
    /// A road user, by id and kind.
    Actor(u32, ActorKind),
    /// A parked car, by its number among the map's.
    Parked(usize),
}

/// Seconds ahead at which the prediction looks.
fn steps(up_to_s: f32) -> impl Iterator<Item = f32> {
    (1..=(up_to_s / STEP_S) as u32).map(|step| step as f32 * STEP_S)
}

/// Who is around the ego car and matters.
pub struct Others<'a> {
    world: &'a World,
    looks: &'a Looks,
    actors: Vec<&'a ActorScene>,
    parked: Vec<(usize, Footprint)>,
}

impl<'a> Others<'a> {
    /// Of a scene.
    pub fn near(world: &'a World, scene: &'a SceneSnapshot, looks: &'a Looks) -> Self {
        let near = |p: glam::Vec3| (p.truncate() - middle(&scene.ego)).length() < NEAR_M;
        let actors = scene.actors.iter().filter(|a| near(a.position) && matters(scene, a)).collect();
        let parked = world.network().props.iter().filter(|p| p.kind == PropKind::ParkedCar).enumerate();
        // Those that were pushed are among the actors.
        let gone = |n: usize| scene.actors.iter().any(|a| a.id == FIRST_PARKED_ID + n as u32);
        let parked =
            parked.filter(|(n, p)| near(p.position) && !gone(*n)).map(|(n, p)| (n, Footprint::of_prop(p))).collect();
        Self { world, looks, actors, parked }
    }

    /// Leaves out people beside the road, who may stop at the kerb.
    fn on_the_road(mut self) -> Self {
        let network = self.world.network();
        self.actors.retain(|actor| !actor.kind.is_on_foot() || network.on_road(actor.position));
        self
    }

    /// Leaves out whom the safety driver has not seen.
    pub fn seen(mut self, is_seen: impl Fn(&ActorScene) -> bool) -> Self {
        self.actors.retain(|actor| is_seen(actor));
        self
    }

    /// Who is touched within some seconds, and again with every step as long as the contact lasts.
    pub fn encroachments(&self, way: &EgoWay, up_to_s: f32) -> impl Iterator<Item = Encroachment> {
        let at = move |after_s: f32| way.at(after_s).map(|ego| (after_s, ego));
        let touched = |(after_s, ego): (f32, Footprint)| {
            let touched: Vec<Touched> = self.touched(&ego, after_s).collect();
            touched.into_iter().map(move |whom| Encroachment { whom, after_s })
        };
        steps(up_to_s).filter_map(at).flat_map(touched)
    }

    /// Whether somebody on foot is touched within some seconds.
    pub fn touches_people(&self, way: &EgoWay, up_to_s: f32) -> bool {
        let actors = self.actors.iter().filter(|a| a.kind.is_on_foot()).copied().collect();
        let people = Self { actors, parked: Vec::new(), ..*self };
        people.encroachments(way, up_to_s).next().is_some()
    }

    /// One of them alone.
    pub fn only(&self, whom: Touched) -> Self {
        let actors = self.actors.iter().filter(|a| whom == Touched::Actor(a.id, a.kind)).copied().collect();
        let parked = self.parked.iter().filter(|(n, _)| whom == Touched::Parked(*n)).copied().collect();
        Self { actors, parked, ..*self }
    }

    /// Whether anybody is touched within some seconds on a way, before the ego car stands.
    pub fn touches(&self, way: &EgoWay, up_to_s: f32) -> bool {
        let moves = |t_s: &f32| way.speed_mps_at(*t_s) > 0.0;
        let mut at = steps(up_to_s).take_while(moves).filter_map(|t_s| Some((t_s, way.at(t_s)?)));
        at.any(|(t_s, ego)| self.touched(&ego, t_s).next().is_some())
    }

    /// Who shares ground with the ego car in `t_s` seconds: actors, then parked cars.
    fn touched(&self, ego: &Footprint, t_s: f32) -> impl Iterator<Item = Touched> {
        let actor_at = move |actor: &ActorScene| {
            let driven_m = driven_m(actor.speed_mps, self.looks.actor_mps2(actor).min(0.0), t_s);
            actor_after(self.world.network(), actor, driven_m)
        };
        let actors = self.actors.iter().filter(move |a| actor_at(a).overlaps(ego));
        let parked = self.parked.iter().filter(move |(_, p)| p.overlaps(ego));
        actors.map(|a| Touched::Actor(a.id, a.kind)).chain(parked.map(|(n, _)| Touched::Parked(*n)))
    }
}

/// What it is called to overlook an actor.
pub fn label_of(kind: ActorKind) -> Label {
    if kind.is_on_foot() { Label::Walker } else { Label::Vehicle }
}

/// Whether braking for an actor makes sense: vehicles must not follow, and nobody may be on another level.
fn matters(scene: &SceneSnapshot, actor: &ActorScene) -> bool {
    if !on_level(actor.position, scene.ego.position) {
        return false;
    }
    if actor.kind.is_on_foot() {
        return true;
    }
    let ahead_m = (actor.position.truncate() - middle(&scene.ego)).dot(forward(&scene.ego));
    let same_way = Footprint::of_actor(actor).forward.dot(forward(&scene.ego)) > 0.5;
    ahead_m > 0.0 || !same_way
}

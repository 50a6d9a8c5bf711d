//! What the safety driver fears, and why.

use base::words;
use glam::Vec2;
use kernel::car::GRAVITY_MPS2;
use kernel::events::Hud;
use kernel::map::PropKind;
use kernel::scene::{ActorKind, ActorScene, FIRST_PARKED_ID, SceneSnapshot};
use kernel::signals::LightPhase;
use kernel::{World, ego, ops};
use replay::Label;

use super::forecast::{EgoWay, actor_after, driven_m};
use super::looks::Looks;
use crate::footprint::{Footprint, forward, middle};

/// An encroachment predicted within this time is critical (Westhofen et al. 2022), seconds.
pub const CRITICAL_S: f32 = 2.0;
/// Step of the prediction, seconds.
const STEP_S: f32 = 0.1;
/// How far around the car others matter, metres.
const NEAR_M: f32 = 60.0;
/// Time over which the wheels' angle is taken to stay as it is, seconds.
const STEERING_S: f32 = 0.7;
/// Distance from the middle of the lane that is too far, metres; more inside junctions, whose lanes
/// are only ideas.
const OFF_LANE_M: f32 = 1.6;
const OFF_LANE_IN_JUNCTION_M: f32 = 2.3;
/// Deceleration before a red light that is too hard to be meant, m/s^2, and as a share of what the road allows.
const RED_LIGHT_MPS2: f32 = 5.0;
const RED_LIGHT_SHARE: f32 = 0.6;
/// Angle against the route from which the car drives the wrong way (cosine).
const WRONG_WAY_COS: f32 = 0.3;

/// Something that makes the safety driver take over unless it passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Hazard {
    /// What the semantic driver did wrong.
    pub label: Label,
    /// What is to be seen, for the case's comment.
    pub comment: String,
    /// Steering helps, not braking alone.
    pub steer: bool,
    /// Who is predicted to be touched, if somebody is.
    pub whom: Option<Touched>,
}

/// The most pressing hazard, by the present look and the ones before.
pub fn find(world: &World, scene: &SceneSnapshot, looks: &Looks) -> Option<Hazard> {
    let way = EgoWay::new(world, &scene.ego, looks.ego_mps2());
    encroachment(world, scene, &way, looks)
        .or_else(|| red_light(&world.hud(), &way, world.friction()))
        .or_else(|| leaving_lane(world, scene))
}

/// The actor or parked car that the ego car is predicted to touch first, within 2 s.
pub fn predicted_encroachment(world: &World, scene: &SceneSnapshot, looks: &Looks) -> Option<Hazard> {
    encroachment(world, scene, &EgoWay::new(world, &scene.ego, looks.ego_mps2()), looks)
}

fn encroachment(world: &World, scene: &SceneSnapshot, way: &EgoWay, looks: &Looks) -> Option<Hazard> {
    let others = Others::near(world, scene, looks)?;
    steps().find_map(|t_s| {
        let touched = others.touched(&way.at(t_s)?, t_s).next()?;
        let (label, name) = match touched {
            Touched::Actor(id, kind) => (label_of(kind), format!("{} {id}", words::road_user(kind))),
            Touched::Parked(_) => (Label::Vehicle, "parked car".into()),
        };
        Some(Hazard { whom: Some(touched), ..hazard(label, format!("{name}, {t_s:.1} s before contact")) })
    })
}

/// Everyone whom the ego car is predicted to touch within 2 s, first contact first.
pub fn encroachers(world: &World, scene: &SceneSnapshot, looks: &Looks) -> Vec<Touched> {
    let way = EgoWay::new(world, &scene.ego, looks.ego_mps2());
    let mut found: Vec<Touched> = Vec::new();
    let Some(others) = Others::near(world, scene, looks) else { return found };
    for t_s in steps() {
        let Some(ego) = way.at(t_s) else { continue };
        for touched in others.touched(&ego, t_s) {
            if !found.contains(&touched) {
                found.push(touched);
            }
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
fn steps() -> impl Iterator<Item = f32> {
    (1..=(CRITICAL_S / STEP_S) as u32).map(|step| step as f32 * STEP_S)
}

/// Who is around the ego car and matters.
struct Others<'a> {
    world: &'a World,
    looks: &'a Looks,
    actors: Vec<&'a ActorScene>,
    parked: Vec<(usize, Footprint)>,
}

impl<'a> Others<'a> {
    /// `None` while the ego car stands, which touches nobody.
    fn near(world: &'a World, scene: &'a SceneSnapshot, looks: &'a Looks) -> Option<Self> {
        if scene.ego.speed_mps < 0.5 {
            return None;
        }
        let near = |p: glam::Vec3| (p.truncate() - middle(&scene.ego)).length() < NEAR_M;
        let actors = scene.actors.iter().filter(|a| near(a.position) && matters(world, scene, a)).collect();
        let parked = world.network().props.iter().filter(|p| p.kind == PropKind::ParkedCar).enumerate();
        // Those that were pushed are among the actors.
        let gone = |n: usize| scene.actors.iter().any(|a| a.id == FIRST_PARKED_ID + n as u32);
        let parked =
            parked.filter(|(n, p)| near(p.position) && !gone(*n)).map(|(n, p)| (n, Footprint::of_prop(p))).collect();
        Some(Self { world, looks, actors, parked })
    }

    /// Who shares ground with the ego car in `t_s` seconds: actors, then parked cars.
    fn touched(&self, ego: &Footprint, t_s: f32) -> impl Iterator<Item = Touched> {
        let actor_at = move |actor: &ActorScene| {
            let driven_m = driven_m(actor.speed_mps, self.looks.actor_mps2(actor), t_s);
            actor_after(self.world.network(), actor, driven_m)
        };
        let actors = self.actors.iter().filter(move |a| actor_at(a).overlaps(ego));
        let parked = self.parked.iter().filter(move |(_, p)| p.overlaps(ego));
        actors.map(|a| Touched::Actor(a.id, a.kind)).chain(parked.map(|(n, _)| Touched::Parked(*n)))
    }
}

fn hazard(label: Label, comment: String) -> Hazard {
    Hazard { label, comment, steer: false, whom: None }
}

/// What it is called to overlook an actor.
pub fn label_of(kind: ActorKind) -> Label {
    if kind.is_on_foot() { Label::Walker } else { Label::Vehicle }
}

/// Whether braking for an actor makes sense: people must be on the road, and vehicles not follow.
fn matters(world: &World, scene: &SceneSnapshot, actor: &ActorScene) -> bool {
    if actor.kind.is_on_foot() {
        return world.network().on_road(actor.position);
    }
    let ahead_m = (actor.position.truncate() - middle(&scene.ego)).dot(forward(&scene.ego));
    let same_way = Footprint::of_actor(actor).forward.dot(forward(&scene.ego)) > 0.5;
    ahead_m > 0.0 || !same_way
}

fn red_light(hud: &Hud, way: &EgoWay, friction: f32) -> Option<Hazard> {
    let to_line_m = f32::from(hud.light_distance_m).max(0.5);
    let hardest_mps2 = RED_LIGHT_MPS2.min(RED_LIGHT_SHARE * friction * GRAVITY_MPS2);
    let too_fast = hud.speed_mps * hud.speed_mps / (2.0 * to_line_m) > hardest_mps2;
    let runs_it = hud.light == Some(LightPhase::Red) && too_fast && way.driven_m(10.0) > to_line_m + 1.0;
    runs_it.then(|| hazard(Label::Rules, format!("red light in {to_line_m:.0} m")))
}

/// Leaving the lane or the road, or driving against the route.
fn leaving_lane(world: &World, scene: &SceneSnapshot) -> Option<Hazard> {
    let car = &scene.ego;
    if car.speed_mps < 1.0 {
        return None;
    }
    let route: Vec<Vec2> = world.route_ahead(20.0).iter().map(|p| p.truncate()).collect();
    let [first, second, ..] = route[..] else { return None };
    if forward(car).dot((second - first).normalize_or(Vec2::X)) < WRONG_WAY_COS {
        return Some(Hazard { steer: true, ..hazard(Label::Rules, "driving against the route".into()) });
    }
    let soon = soon(car);
    let off_m = route.windows(2).map(|w| distance_m(soon, w[0], w[1])).fold(f32::INFINITY, f32::min);
    let in_junction = world.hud().arrow.distance_m == 0;
    let allowed_m = if in_junction { OFF_LANE_IN_JUNCTION_M } else { OFF_LANE_M };
    (off_m > allowed_m).then(|| {
        let on_road = world.network().on_road(soon.extend(car.position.z));
        let what = if on_road { "lane" } else { "road" };
        Hazard { steer: true, ..hazard(Label::Rules, format!("leaving the {what}, {off_m:.1} m off")) }
    })
}

/// The middle of the car a moment ahead, when the wheels stay as they are.
fn soon(car: &kernel::scene::EgoScene) -> Vec2 {
    let way_m = car.speed_mps * STEERING_S;
    let turned = -way_m * ops::tan(car.wheel_angle_rad) / ego::WHEELBASE_M;
    let (sin, cos) = (ops::sin(0.5 * turned), ops::cos(0.5 * turned));
    middle(car) + way_m * Vec2::new(cos, sin).rotate(forward(car))
}

fn distance_m(point: Vec2, from: Vec2, to: Vec2) -> f32 {
    let along = to - from;
    let share = ((point - from).dot(along) / along.length_squared().max(1e-6)).clamp(0.0, 1.0);
    (point - from - share * along).length()
}

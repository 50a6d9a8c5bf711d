//! What the safety driver fears, and how pressing it is.

use glam::Vec2;
use kernel::car::GRAVITY_MPS2;
use kernel::events::Hud;
use kernel::scene::{EgoScene, SceneSnapshot};
use kernel::signals::LightPhase;
use kernel::{World, ego, ops};
use replay::Label;

use super::encounter::{Encroachment, Others, Touched};
use super::eyes::Eyes;
use super::forecast::{EgoWay, MARGIN_M};
use super::looks::Looks;
use crate::footprint::{forward, middle};

/// Contacts are feared when they are so near, seconds.
const FEARED_S: f32 = 3.0;
/// They are looked for so long after somebody began to brake, who stops in twice the time that the way takes at full speed, seconds.
const BRAKING_S: f32 = 2.0 * FEARED_S;
/// Slower than this the car stands, m/s, and who is in its way is watched as if it pulled away so, m/s^2.
const CREEPS_MPS: f32 = 0.1;
const PULLS_AWAY_MPS2: f32 = 2.0;
/// Room kept around a car that stands, metres, and speed from which it is [`MARGIN_M`], m/s.
const CREEPING_MARGIN_M: f32 = 0.05;
const MARGIN_AT_MPS: f32 = 2.0;
/// Whoever walks so near to the car's way may step into it, metres.
const BESIDE_M: f32 = 1.0;
/// Braking that is tried out, as shares of what the road allows.
const TRIED: u32 = 20;
/// Nothing but the full brake helps, or something else than braking.
const PRESSING: f32 = 1.0;
/// Time over which the wheels' angle is taken to stay as it is, seconds.
const STEERING_S: f32 = 0.7;
/// Distance from the middle of the lane that is too far, metres; more inside junctions, whose lanes
/// are only ideas.
const OFF_LANE_M: f32 = 1.6;
const OFF_LANE_IN_JUNCTION_M: f32 = 2.3;
/// Angle against the route from which the car drives the wrong way (cosine).
const WRONG_WAY_COS: f32 = 0.3;

/// What a hazard is about; a driver reacts to each in a time of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Somebody will be touched.
    Contact(Touched),
    /// A red light will be run.
    RedLight,
    /// The car drives against its route.
    WrongWay,
    /// The car leaves its lane or the road.
    LaneLeft,
    /// Nothing moves.
    Standstill,
}

/// Something that makes the safety driver take over when it presses.
#[derive(Clone, Debug, PartialEq)]
pub struct Hazard {
    /// What it is about.
    pub source: Source,
    /// What the semantic driver did wrong.
    pub label: Label,
    /// What is to be seen, for the case's comment.
    pub comment: String,
    /// The least braking from now on that averts it, as a share of what the road allows; 1 where none does, or where
    /// steering is what helps.
    pub urgency: f32,
}

impl Hazard {
    fn new(source: Source, urgency: f32, comment: String) -> Self {
        Self { source, label: Label::Rules, comment, urgency }
    }

    /// Steering helps, not braking alone.
    pub fn steers(&self) -> bool {
        matches!(self.source, Source::WrongWay | Source::LaneLeft)
    }
}

/// What a look finds.
pub struct Found {
    /// Contacts with those who were seen, first contact first, then breaches of rules.
    pub hazards: Vec<Hazard>,
    /// Somebody will be touched, or is on foot beside the car's way.
    pub is_alarming: bool,
}

/// All hazards, by the present look and the ones before.
pub fn find(world: &World, scene: &SceneSnapshot, looks: &Looks, eyes: &Eyes) -> Found {
    let stands = scene.ego.speed_mps < CREEPS_MPS;
    let ego_mps2 = if stands { PULLS_AWAY_MPS2 } else { looks.ego_mps2() };
    let way = EgoWay::new(world, &scene.ego, ego_mps2).turned_as(&scene.ego).with_margin(margin_m(scene.ego.speed_mps));
    let grip_mps2 = world.friction() * GRAVITY_MPS2;
    let others = Others::near(world, scene, looks).seen(|actor| eyes.know(actor.id));
    let mut hazards = contacts(&others, &way, grip_mps2);
    let is_alarming = !hazards.is_empty() || others.touches_people(&way.wider(BESIDE_M), FEARED_S);
    hazards.extend(red_light(&world.hud(), &way, grip_mps2));
    hazards.extend(leaving_lane(world, scene));
    Found { hazards, is_alarming }
}

/// Room that is kept on each side, metres: who creeps by sees that there is some.
fn margin_m(speed_mps: f32) -> f32 {
    CREEPING_MARGIN_M + (MARGIN_M - CREEPING_MARGIN_M) * (speed_mps / MARGIN_AT_MPS).clamp(0.0, 1.0)
}

fn contacts(others: &Others<'_>, way: &EgoWay, grip_mps2: f32) -> Vec<Hazard> {
    let mut first: Vec<Encroachment> = Vec::new();
    for encroachment in others.encroachments(way, FEARED_S) {
        if first.iter().all(|known| known.whom != encroachment.whom) {
            first.push(encroachment);
        }
    }
    let hazard = |encroachment: &Encroachment| Hazard {
        source: Source::Contact(encroachment.whom),
        label: encroachment.label(),
        comment: encroachment.comment(),
        urgency: braking_share(&others.only(encroachment.whom), way, grip_mps2),
    };
    first.iter().map(hazard).collect()
}

/// The least braking from now on by which nobody is touched, as a share of what the road allows.
fn braking_share(others: &Others<'_>, way: &EgoWay, grip_mps2: f32) -> f32 {
    let shares = (1..TRIED).map(|step| step as f32 / TRIED as f32);
    let helps = |share: &f32| !others.touches(&way.braking(share * grip_mps2), BRAKING_S);
    shares.into_iter().find(helps).unwrap_or(PRESSING)
}

fn red_light(hud: &Hud, way: &EgoWay, grip_mps2: f32) -> Option<Hazard> {
    let to_line_m = f32::from(hud.light_distance_m).max(0.5);
    let runs_it = hud.light == Some(LightPhase::Red) && way.driven_m(10.0) > to_line_m + 1.0;
    let needed_mps2 = hud.speed_mps * hud.speed_mps / (2.0 * to_line_m);
    let urgency = (needed_mps2 / grip_mps2).min(PRESSING);
    runs_it.then(|| Hazard::new(Source::RedLight, urgency, format!("red light in {to_line_m:.0} m")))
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
        return Some(Hazard::new(Source::WrongWay, PRESSING, "driving against the route".into()));
    }
    let soon = soon(car);
    let off_m = route.windows(2).map(|w| distance_m(soon, w[0], w[1])).fold(f32::INFINITY, f32::min);
    let in_junction = world.hud().arrow.distance_m == 0;
    let allowed_m = if in_junction { OFF_LANE_IN_JUNCTION_M } else { OFF_LANE_M };
    (off_m > allowed_m).then(|| {
        let on_road = world.network().on_road(soon.extend(car.position.z));
        let what = if on_road { "lane" } else { "road" };
        Hazard::new(Source::LaneLeft, PRESSING, format!("leaving the {what}, {off_m:.1} m off"))
    })
}

/// The middle of the car a moment ahead, when the wheels stay as they are.
fn soon(car: &EgoScene) -> Vec2 {
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

#[cfg(test)]
mod tests {
    use glam::Quat;
    use kernel::scene::{ActorKind, ActorScene};
    use kernel::{RoadNetwork, Scenario, map};

    use super::super::predicted_encroachment;
    use super::*;

    /// Somebody on foot 12 m ahead, so far beside the road that the car, at 8 m/s, and they meet in its lane.
    fn walks_to_the_road(world: &World) -> ActorScene {
        let way: Vec<_> = world.route_ahead(15.0);
        let (here, along) = (way[12], (way[13] - way[12]).normalize());
        let right = glam::Vec3::new(along.y, -along.x, 0.0);
        let beside = |step: u32| here + 0.25 * step as f32 * right;
        let off = (1..40).map(beside).find(|p| !world.network().on_road(*p)).expect("the road has a side");
        let position = off + 0.3 * right;
        let meet_s = (12.0 - 0.5 * ego::SIZE_M.x) / 8.0;
        ActorScene {
            id: 9_999,
            kind: ActorKind::Pedestrian,
            variant: 0,
            position,
            rotation: Quat::from_rotation_arc(glam::Vec3::X, -right),
            speed_mps: position.distance(here) / meet_s,
            phase_rad: 0.0,
            lamps: 0,
        }
    }

    /// After two looks at a scene.
    fn looked(network: &RoadNetwork, scene: &SceneSnapshot) -> (Looks, Eyes) {
        let (mut looks, mut eyes) = (Looks::default(), Eyes::default());
        for _ in 0..2 {
            looks.look(scene);
            eyes.look(network, scene);
        }
        (looks, eyes)
    }

    /// Before the car moves, so that nobody is surprised when it does.
    #[test]
    fn who_stands_before_a_standing_car_is_watched_and_feared_when_it_moves() {
        let network = map::bundled("city").expect("it is bundled");
        let world = World::new(&Scenario::default_for("city", 3), &network).expect("it fits");
        let mut scene = world.scene();
        let mut person = walks_to_the_road(&world);
        let front = middle(&scene.ego) + (0.5 * ego::SIZE_M.x + 0.5) * forward(&scene.ego);
        (person.position, person.speed_mps) = (front.extend(scene.ego.position.z), 0.0);
        scene.actors = vec![person];
        let urgency = |speed_mps: f32, scene: &mut SceneSnapshot| {
            scene.ego.speed_mps = speed_mps;
            let (looks, eyes) = looked(&network, scene);
            let found = find(&world, scene, &looks, &eyes);
            let source = Source::Contact(Touched::Actor(9_999, ActorKind::Pedestrian));
            found.hazards.iter().find(|hazard| hazard.source == source).map(|hazard| hazard.urgency)
        };
        let [stands, creeps, drives] = [0.0, 0.2, 3.0].map(|speed_mps| urgency(speed_mps, &mut scene));
        assert!(stands.is_some_and(|urgency| urgency < 0.1), "{stands:?}");
        assert!(creeps.is_some(), "{creeps:?}");
        assert_eq!(drives, Some(PRESSING));
    }

    #[test]
    fn a_car_that_drives_fears_whom_it_passes_by_a_hands_breadth_and_one_that_creeps_does_not() {
        let network = map::bundled("city").expect("it is bundled");
        let world = World::new(&Scenario::default_for("city", 3), &network).expect("it fits");
        let mut scene = world.scene();
        let mut person = walks_to_the_road(&world);
        let forward = forward(&scene.ego);
        let beside_m = 0.5 * (ego::SIZE_M.y + person.kind.size_m().y) + 0.1;
        let place = middle(&scene.ego) + (0.5 * ego::SIZE_M.x + 1.0) * forward + beside_m * forward.perp();
        (person.position, person.rotation) = (place.extend(scene.ego.position.z), scene.ego.rotation);
        person.speed_mps = 0.0;
        scene.actors = vec![person];
        let is_feared = |speed_mps: f32, scene: &mut SceneSnapshot| {
            scene.ego.speed_mps = speed_mps;
            let (looks, eyes) = looked(&network, scene);
            !find(&world, scene, &looks, &eyes).hazards.is_empty()
        };
        assert_eq!([0.5, 3.0].map(|speed_mps| is_feared(speed_mps, &mut scene)), [false, true]);
    }

    #[test]
    fn who_walks_towards_the_road_is_feared_and_in_no_measure() {
        let network = map::bundled("city").expect("it is bundled");
        let mut scenario = Scenario::default_for("city", 3);
        scenario.traffic.pedestrians = 1;
        let world = World::new(&scenario, &network).expect("it fits");
        let mut scene = world.scene();
        scene.ego.speed_mps = 8.0;
        scene.actors = vec![walks_to_the_road(&world)];
        let (looks, eyes) = looked(&network, &scene);
        let whom = Touched::Actor(9_999, ActorKind::Pedestrian);
        let feared = find(&world, &scene, &looks, &eyes).hazards;
        assert!(feared.iter().any(|hazard| hazard.source == Source::Contact(whom)), "{feared:?}");
        assert_eq!(predicted_encroachment(&world, &scene, &looks), None);
    }
}

//! What is small, through a long lens: people, riders, lights, signs and poles are too few pixels of a driver's picture to have a
//! bar of their own there, so a camera at the driver's eye is pointed at each and sees nothing else.

use glam::{Quat, Vec3};
use kernel::map::{PropKind, RoadNetwork};
use kernel::scene::{ActorKind, SceneSnapshot};
use render::{Camera, Mount, Renderer, SemanticTag};

use super::bvh::Bvh;
use super::pose::Rays;
use super::tally::{Count, Failures, Tally};
use super::trace;

/// Of the lens's pictures, pixels.
const SIDE: u32 = 96;
/// Who stands so far from the eye, metres.
const NEAR_M: f32 = 4.0;
const FAR_M: f32 = 70.0;
/// So many of each kind are looked at in a moment.
const OF_A_KIND: usize = 4;

const CLASSES: [SemanticTag; 4] =
    [SemanticTag::Pedestrian, SemanticTag::TrafficLight, SemanticTag::TrafficSign, SemanticTag::Pole];
/// Share of a class's pixels that must be of it, and of these the share that must be of the right one.
const SAME: f64 = 0.985;
const SAME_ONE: f64 = 0.995;
/// Fewer pixels of a class say nothing.
const PIXELS: u32 = 400;

/// Something to look at: its middle, and how much of it, metres.
struct Target {
    class: SemanticTag,
    middle: Vec3,
    size_m: f32,
}

fn targets(network: &RoadNetwork, scene: &SceneSnapshot) -> Vec<Target> {
    let on_foot_or_riding = [ActorKind::Pedestrian, ActorKind::Bicycle, ActorKind::Motorcycle];
    let people = scene.actors.iter().filter(|actor| on_foot_or_riding.contains(&actor.kind)).map(|actor| Target {
        class: SemanticTag::Pedestrian,
        middle: actor.position + 0.9 * Vec3::Z,
        size_m: 2.0,
    });
    let lights = network.light_heads.iter().map(|head| Target {
        class: SemanticTag::TrafficLight,
        middle: head.position + head.height_m * Vec3::Z,
        size_m: 1.2,
    });
    let props = network.props.iter().filter_map(|prop| match prop.kind {
        PropKind::Sign => Some(Target {
            class: SemanticTag::TrafficSign,
            middle: prop.position + (prop.size.z - 0.4) * Vec3::Z,
            size_m: 1.0,
        }),
        PropKind::Lamp | PropKind::SignalPole => {
            Some(Target { class: SemanticTag::Pole, middle: prop.position + 1.2 * Vec3::Z, size_m: 0.6 })
        }
        _ => None,
    });
    people.chain(lights).chain(props).collect()
}

/// Cameras at the driver's eye that look at the nearest of each kind, ahead.
fn lenses(network: &RoadNetwork, scene: &SceneSnapshot) -> Vec<Camera> {
    let (eye, ahead) = Camera::driver(SIDE, SIDE).pose(&scene.ego);
    let mut near: Vec<(f32, Target)> = targets(network, scene)
        .into_iter()
        .map(|target| (target.middle.distance(eye), target))
        .filter(|(distance, target)| {
            let depth = (target.middle - eye).dot(ahead * Vec3::X);
            (NEAR_M..FAR_M).contains(distance) && depth > 0.5 * distance
        })
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let of = |class| near.iter().filter(move |(_, target)| target.class == class).take(OF_A_KIND);
    CLASSES.into_iter().flat_map(of).map(|(_, target)| lens(eye, target)).collect()
}

fn lens(eye: Vec3, target: &Target) -> Camera {
    let towards = target.middle - eye;
    let (across, distance) = (towards.truncate().length(), towards.length());
    let yaw = Quat::from_rotation_z(towards.y.atan2(towards.x));
    Camera {
        mount: Mount::World,
        position: eye,
        rotation: yaw * Quat::from_rotation_y(-towards.z.atan2(across)),
        fov_x_rad: 2.0 * (0.7 * target.size_m / distance).atan(),
        ..Camera::driver(SIDE, SIDE)
    }
}

/// Adds what lenses see of a moment.
pub fn look(network: &RoadNetwork, scene: &SceneSnapshot, bvh: &Bvh, renderer: &mut Renderer, tally: &mut Tally) {
    for camera in lenses(network, scene) {
        let frame = renderer.draw(scene, &camera).unwrap();
        tally.add(&frame, &trace(bvh, &Rays::of_still(&camera), SIDE));
    }
}

/// What is below its bar among the classes of which enough was seen, which are at least so many.
pub fn failures(tally: &Tally, at_least: usize, failures: &mut Failures) {
    let seen: Vec<SemanticTag> =
        CLASSES.into_iter().filter(|class| tally.classes[*class as usize].all >= PIXELS).collect();
    if seen.len() < at_least {
        failures.0.push(format!("only {} small classes were seen, not {at_least}", seen.len()));
    }
    for class in seen {
        let (what, count) = (class.name(), tally.classes[class as usize]);
        failures.expect(&format!("{what} through the lens"), Count::share(count.same, count.all), SAME);
        failures.expect(&format!("{what}, the right one"), Count::share(count.who, count.same), SAME_ONE);
    }
}

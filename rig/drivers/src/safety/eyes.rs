//! Whom the safety driver can see from the seat, and whom they have seen.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};
use kernel::RoadNetwork;
use kernel::map::{Prop, PropKind};
use kernel::ops;
use kernel::scene::{ActorScene, SceneSnapshot};
use kernel::time::{Tick, seconds};
use render::Camera;

use super::encounter::NEAR_M;
use crate::footprint::{Footprint, forward};

/// How much of somebody's height has to be hidden: what is seen is the head, or the roof.
const HEAD_SHARE: f32 = 0.9;
/// Looks that it takes to see how somebody moves.
const LOOKS: u32 = 2;
/// Somebody who went out of sight is remembered for so long.
const REMEMBERED_TICKS: Tick = seconds(1);

/// Everybody who was seen of late.
#[derive(Clone, Debug, Default)]
pub struct Eyes(BTreeMap<u32, Sighting>);

#[derive(Clone, Copy, Debug)]
struct Sighting {
    last: Tick,
    looks: u32,
}

impl Eyes {
    /// Takes in what is to be seen now.
    pub fn look(&mut self, network: &RoadNetwork, scene: &SceneSnapshot) {
        self.0.retain(|_, sighting| scene.tick <= sighting.last + REMEMBERED_TICKS);
        for id in in_sight(network, scene) {
            let looks = self.0.get(&id).map_or(0, |sighting| sighting.looks) + 1;
            self.0.insert(id, Sighting { last: scene.tick, looks });
        }
    }

    /// Whether somebody was seen long enough to know how they move.
    pub fn know(&self, id: u32) -> bool {
        self.0.get(&id).is_some_and(|sighting| sighting.looks >= LOOKS)
    }
}

/// The ids of the actors near the ego car of whom the driver's picture shows a head or a roof.
pub fn in_sight(network: &RoadNetwork, scene: &SceneSnapshot) -> Vec<u32> {
    let view = View::new(network, scene);
    scene.actors.iter().filter(|actor| view.sees(actor)).map(|actor| actor.id).collect()
}

/// What the picture can show, which is the camera's of both drivers, and what stands around it and may hide others.
struct View {
    camera: Camera,
    eye: Vec3,
    forward: Vec2,
    /// Whose it is, its ground and its top.
    covers: Vec<(Option<u32>, Footprint, f32)>,
}

impl View {
    fn new(network: &RoadNetwork, scene: &SceneSnapshot) -> Self {
        let camera = Camera::driver(1, 1);
        let eye = scene.ego.position + scene.ego.rotation * camera.position;
        let near = |p: Vec3, size: Vec3| (p - eye).truncate().length() < NEAR_M + size.truncate().length();
        let props = network.props.iter().filter(|p| hides(p) && near(p.position, p.size));
        let props = props.map(|p| (None, Footprint::of_prop(p), p.position.z + p.size.z));
        let actors = scene.actors.iter().filter(|a| !a.kind.is_on_foot() && near(a.position, a.kind.size_m()));
        let actors = actors.map(|a| (Some(a.id), Footprint::of_actor(a), a.position.z + a.kind.size_m().z));
        Self { camera, eye, forward: forward(&scene.ego), covers: props.chain(actors).collect() }
    }

    /// Whether the middle or a side of somebody's head or roof is in sight.
    fn sees(&self, actor: &ActorScene) -> bool {
        let top_m = actor.position.z + HEAD_SHARE * actor.kind.size_m().z;
        let footprint = Footprint::of_actor(actor);
        let across = (footprint.centre - self.eye.truncate()).normalize_or(Vec2::X).perp();
        let half_m = HEAD_SHARE * footprint.reach(across);
        let is_near = (footprint.centre - self.eye.truncate()).length() < NEAR_M;
        let points = [0.0, half_m, -half_m].map(|aside_m| (footprint.centre + aside_m * across).extend(top_m));
        is_near && points.into_iter().any(|point| self.is_in_picture(point) && self.is_open(point, actor.id))
    }

    fn is_in_picture(&self, point: Vec3) -> bool {
        let way = (point - self.eye).truncate();
        let (ahead_m, aside_m) = (way.dot(self.forward), self.forward.perp_dot(way).abs());
        ahead_m > 0.0 && aside_m < ahead_m * ops::tan(0.5 * self.camera.fov_x_rad)
    }

    fn is_open(&self, point: Vec3, whose: u32) -> bool {
        let others = self.covers.iter().filter(|(id, ..)| *id != Some(whose));
        !others.into_iter().any(|(_, ground, top_m)| covers(self.eye, point, ground, *top_m))
    }
}

/// What nobody looks through; trees, lamps, signs and rails leave gaps.
fn hides(prop: &Prop) -> bool {
    matches!(prop.kind, PropKind::Building | PropKind::Wall | PropKind::Hedge | PropKind::ParkedCar)
}

/// Whether the straight line from an eye to a point passes through a box below its top.
fn covers(eye: Vec3, point: Vec3, ground: &Footprint, top_m: f32) -> bool {
    let (from, way) = (eye.truncate() - ground.centre, (point - eye).truncate());
    let (mut enters, mut leaves) = (0.0_f32, 1.0_f32);
    for (axis, half_m) in ground.axes().into_iter().zip(ground.half.to_array()) {
        let (start, rate) = (from.dot(axis), way.dot(axis));
        if rate.abs() < 1e-6 {
            if start.abs() > half_m {
                return false;
            }
            continue;
        }
        let [first, last] = [(-half_m - start) / rate, (half_m - start) / rate];
        enters = enters.max(first.min(last));
        leaves = leaves.min(first.max(last));
    }
    // The line is lowest at one of its ends within the box.
    let lowest_m = [enters, leaves].map(|share| eye.z + share * (point.z - eye.z)).into_iter().fold(f32::MAX, f32::min);
    enters < leaves && lowest_m < top_m
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wall(top_m: f32) -> (Footprint, f32) {
        (Footprint { centre: Vec2::new(10.0, 0.0), forward: Vec2::Y, half: Vec2::new(3.0, 0.2) }, top_m)
    }

    #[test]
    fn a_wall_hides_who_is_behind_it_and_below_its_top() {
        let eye = Vec3::new(0.0, 0.0, 1.5);
        let is_hidden = |point: Vec3, top_m: f32| covers(eye, point, &wall(top_m).0, wall(top_m).1);
        assert!(is_hidden(Vec3::new(20.0, 0.0, 1.6), 2.0));
        assert!(!is_hidden(Vec3::new(9.0, 0.0, 1.6), 2.0), "before it");
        assert!(!is_hidden(Vec3::new(20.0, 8.0, 1.6), 2.0), "beside it");
        assert!(!is_hidden(Vec3::new(20.0, 0.0, 1.6), 1.4), "above it");
        assert!(is_hidden(Vec3::new(20.0, 0.0, 1.0), 1.4), "a child behind a car");
    }

    /// Against an oracle: points on the line, one by one.
    #[test]
    fn lines_meet_boxes_as_their_points_do() {
        use proptest::prelude::*;
        let numbers = proptest::array::uniform10(-1.0f32..1.0);
        proptest!(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() }, |(n in numbers)| {
            let eye = Vec3::new(20.0 * n[0], 20.0 * n[1], 1.5);
            let point = Vec3::new(20.0 * n[2], 20.0 * n[3], 1.5 + n[4]);
            let half = Vec2::new(3.0 + 2.0 * n[5], 1.5 + n[6]);
            let ground = Footprint { centre: 5.0 * Vec2::new(n[7], n[8]), forward: Vec2::from_angle(3.0 * n[9]), half };
            let inside = |margin_m: f32| (0..=2000).any(|step| {
                let at = eye.lerp(point, step as f32 / 2000.0);
                let local = at.truncate() - ground.centre;
                let [forward, left] = ground.axes();
                at.z < 1.4 + margin_m
                    && local.dot(forward).abs() < half.x + margin_m
                    && local.dot(left).abs() < half.y + margin_m
            });
            let found = covers(eye, point, &ground, 1.4);
            prop_assert!(!found || inside(0.03));
            prop_assert!(found || !inside(-0.03));
        });
    }
}

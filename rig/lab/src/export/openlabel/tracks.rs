//! The objects of a window, frame by frame.

use std::collections::{BTreeMap, BTreeSet};

use base::words;
use glam::{Quat, Vec3};
use kernel::scene::{ActorScene, SceneSnapshot};
use kernel::time::TICK_HZ;
use viewers::boxes::{RoadUser, road_users};

use super::document::{
    Cuboid, Data, Element, Frame, FrameProperties, InFrame, Interval, Numbered, Pointer, Pose, Transform, Value,
};
use super::kinds;
use super::tags::SCENARIO_TAGS;

/// The coordinate system of everything: that of the map, x to the east, y to the north, z up.
pub const WORLD: &str = "world";
/// That of the ego car's rear axle on the ground: x ahead, y left, z up.
pub const EGO: &str = "ego";
/// Number of the ego car among the objects; others have those of the recording, from 1 on.
const EGO_UID: u32 = 0;
/// Names of what is told of an object.
const BOX: &str = "box";
const SPEED: &str = "speed_mps";

/// Objects and frames that grow by a scene at a time.
#[derive(Default)]
pub struct Tracks {
    pub objects: Numbered<Element>,
    pub frames: Numbered<Frame>,
    /// Boxes in all frames.
    pub boxes: usize,
}

impl Tracks {
    /// Adds the next frame.
    pub fn add(&mut self, scene: &SceneSnapshot) {
        let number = self.frames.len() as u32;
        let ids = std::iter::once(EGO_UID).chain(scene.actors.iter().map(|actor| actor.id));
        let speeds = std::iter::once(scene.ego.speed_mps).chain(scene.actors.iter().map(|actor| actor.speed_mps));
        let told = road_users(scene).zip(speeds).map(|(user, speed_mps)| in_frame(&user, speed_mps));
        let objects: Numbered<InFrame> = ids.zip(told).collect();
        self.boxes += objects.len();
        self.see(EGO_UID, number, ego);
        for actor in &scene.actors {
            self.see(actor.id, number, || other(actor));
        }
        let to_world = pose(scene.ego.position, scene.ego.rotation);
        let transform = Transform { src: EGO, dst: WORLD, transform_src_to_dst: to_world };
        let timestamp = scene.tick as f64 / f64::from(TICK_HZ);
        let transforms = [("ego_to_world", transform)].into();
        let frame_properties = FrameProperties { timestamp, tick: scene.tick, transforms };
        let frame = Frame { frame_properties, objects, events: Numbered::new(), actions: Numbered::new() };
        self.frames.insert(number, frame);
    }

    /// Tells of an object that it is in a frame.
    fn see(&mut self, uid: u32, frame: u32, new: impl FnOnce() -> Element) {
        let element = self.objects.entry(uid).or_insert_with(new);
        match element.frame_intervals.last_mut() {
            Some(last) if last.frame_end + 1 == frame => last.frame_end = frame,
            _ => element.frame_intervals.push(Interval { frame_start: frame, frame_end: frame }),
        }
    }

    /// The classes that there are, as far as the ontology has them.
    pub fn classes(&self) -> BTreeSet<&'static str> {
        self.objects.values().filter_map(|object| kinds::told(&object.r#type)).collect()
    }

    /// Tells where the data of each object is, once all frames are there.
    pub fn point(&mut self) {
        for element in self.objects.values_mut() {
            let pointer = |r#type| Pointer { r#type, frame_intervals: element.frame_intervals.clone() };
            element.object_data_pointers = BTreeMap::from([(BOX, pointer("cuboid")), (SPEED, pointer("num"))]);
        }
    }
}

fn ego() -> Element {
    Element { name: EGO.into(), r#type: kinds::EGO.into(), ontology_uid: Some(SCENARIO_TAGS), ..element() }
}

fn other(actor: &ActorScene) -> Element {
    let class = kinds::class(actor.kind);
    let ontology_uid = kinds::told(class).map(|_| SCENARIO_TAGS);
    Element { name: words::actor(actor), r#type: class.into(), ontology_uid, ..element() }
}

fn element() -> Element {
    Element { coordinate_system: Some(WORLD), ..Element::default() }
}

fn in_frame(user: &RoadUser, speed_mps: f32) -> InFrame {
    let Pose { quaternion: [qx, qy, qz, qw], translation: [x, y, z] } = pose(user.middle, user.rotation);
    let Vec3 { x: length, y: width, z: height } = user.size_m;
    let val = [x, y, z, qx, qy, qz, qw, length, width, height];
    let cuboid = vec![Cuboid { name: BOX, val, coordinate_system: WORLD }];
    let num = vec![Value { name: SPEED, val: speed_mps.into() }];
    InFrame { object_data: Data { cuboid, num, ..Data::default() } }
}

/// A place and a rotation.
pub fn pose(position: Vec3, rotation: Quat) -> Pose {
    Pose { quaternion: rotation.normalize().to_array(), translation: position.to_array() }
}

//! The messages of a trace, one scene after the other.

use std::collections::BTreeSet;

use kernel::RoadNetwork;
use kernel::scene::SceneSnapshot;

use super::environment::conditions;
use super::ids;
use super::lanes::{boundaries, lanes};
use super::lights::Lights;
use super::messages::{GroundTruth, MovingObject};
use super::moving::Followed;
use super::place::{Frame, timestamp};
use super::schema::VERSION;
use super::things::{signs, things};

/// What does not change from message to message, and what is known of the scene before.
pub struct Worlds<'a> {
    network: &'a RoadNetwork,
    frame: Frame,
    map: String,
    proj: Option<String>,
    lights: Lights,
    followed: Followed,
    /// The map was told.
    is_told: bool,
}

impl<'a> Worlds<'a> {
    /// Those on a map, whose file is so called and says so where it lies on the Earth.
    pub fn on(network: &'a RoadNetwork, map: String, proj: Option<String>) -> Self {
        let (frame, lights) = (Frame { origin_m: network.origin_m }, Lights::of(network));
        Self { network, frame, map, proj, lights, followed: Followed::default(), is_told: false }
    }

    /// Looks at a scene before the first message.
    pub fn warm_up(&mut self, scene: &SceneSnapshot) {
        self.followed.look(scene, self.frame);
    }

    /// The message of a scene; the first one holds the map as well.
    pub fn message(&mut self, scene: &SceneSnapshot) -> GroundTruth {
        let moving_object = self.followed.look(scene, self.frame);
        let mut message = GroundTruth {
            version: VERSION,
            timestamp: timestamp(scene.tick),
            host_vehicle_id: ids::EGO,
            traffic_light: self.lights.burning(self.network, &scene.lights, self.frame),
            environmental_conditions: conditions(&scene.weather),
            proj_string: self.proj.clone(),
            map_reference: self.map.clone(),
            ..GroundTruth::default()
        };
        if !self.is_told {
            self.tell_map(&moving_object, &mut message);
            self.is_told = true;
        }
        message.moving_object = moving_object;
        message
    }

    fn tell_map(&self, moving: &[MovingObject], message: &mut GroundTruth) {
        let pushed: BTreeSet<u64> = moving.iter().map(|object| object.id.value).collect();
        message.stationary_object = things(self.network, &pushed, self.frame);
        message.traffic_sign = signs(self.network, self.frame);
        message.lane = lanes(self.network, self.frame);
        message.lane_boundary = boundaries(self.network, self.frame);
    }
}

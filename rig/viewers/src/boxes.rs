//! Road users as boxes, for viewers that have no models of them.

use base::words;
use glam::{Quat, Vec3};
use kernel::ego::{CENTRE_M, SIZE_M};
use kernel::scene::{ActorKind, ActorScene, SceneSnapshot};
use render::SemanticTag;

/// Frame of everything that stands still.
pub const MAP: &str = "map";
/// Frame of the ego car, and the name of its box.
pub const EGO: &str = "ego";
/// The ego car differs from every class, [0, 1].
const EGO_COLOUR: [f32; 3] = [0.95, 0.85, 0.1];

/// The box around a road user.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadUser {
    /// Its name within the run, as in `pedestrian 12`.
    pub name: String,
    /// Middle of the box, metres.
    pub middle: Vec3,
    /// Rotation from the box's axes (x forward, y left, z up) to the world's.
    pub rotation: Quat,
    /// Length, width and height, metres.
    pub size_m: Vec3,
    /// Colour of its class (the ego car has its own), red, green and blue, [0, 1].
    pub colour: [f32; 3],
}

/// Every road user of a scene, the ego car first.
pub fn road_users(scene: &SceneSnapshot) -> impl Iterator<Item = RoadUser> {
    let ego = scene.ego;
    let car = RoadUser {
        name: EGO.into(),
        middle: ego.position + ego.rotation * CENTRE_M,
        rotation: ego.rotation,
        size_m: SIZE_M,
        colour: EGO_COLOUR,
    };
    std::iter::once(car).chain(scene.actors.iter().map(actor))
}

fn actor(actor: &ActorScene) -> RoadUser {
    let ActorScene { position, rotation, .. } = *actor;
    let size_m = actor.kind.size_m();
    let middle = position + rotation * Vec3::Z * (size_m.z / 2.0);
    RoadUser { name: words::actor(actor), middle, rotation, size_m, colour: fractions(class(actor.kind).colour()) }
}

/// A colour of 0 to 255 as fractions.
pub fn fractions(rgb: [u8; 3]) -> [f32; 3] {
    rgb.map(|channel| f32::from(channel) / 255.0)
}

fn class(kind: ActorKind) -> SemanticTag {
    match kind {
        ActorKind::Car | ActorKind::Van | ActorKind::Suv | ActorKind::Emergency | ActorKind::Door => {
            SemanticTag::Vehicles
        }
        ActorKind::Truck => SemanticTag::Truck,
        ActorKind::Bus => SemanticTag::Bus,
        ActorKind::Motorcycle | ActorKind::Scooter => SemanticTag::Motorcycle,
        ActorKind::Bicycle | ActorKind::CargoBike => SemanticTag::Bicycle,
        ActorKind::Tram => SemanticTag::Train,
        ActorKind::Obstacle => SemanticTag::Dynamic,
        ActorKind::Pedestrian | ActorKind::Child | ActorKind::Pram | ActorKind::Wheelchair => SemanticTag::Pedestrian,
    }
}

//! What is published, and its layout: messages of Foxglove's schemas (github.com/foxglove/schemas) as
//! JSON, and telemetry of our own.

use glam::{Quat, Vec3};
use kernel::scene::SceneSnapshot;
use serde_json::{Value, json};

use crate::boxes::{EGO, MAP, RoadUser, road_users};
use crate::telemetry::Telemetry;

/// How long an actor stays in sight after it was told of last, nanoseconds.
const LIFETIME_NS: u64 = 500_000_000;
const INFO: u32 = 2;

/// A channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topic {
    /// Pose of the ego car.
    Transform,
    /// Every road user as a box.
    Scene,
    /// Speed, controls, who is in control, ages.
    Telemetry,
    /// What happened.
    Events,
    /// What the safety driver sees.
    SafetyCamera,
    /// What the semantic driver sees.
    SemanticCamera,
}

impl Topic {
    /// Every topic.
    pub const ALL: [Self; 6] =
        [Self::Transform, Self::Scene, Self::Telemetry, Self::Events, Self::SafetyCamera, Self::SemanticCamera];

    /// Number of its channel.
    pub fn channel(self) -> u32 {
        self as u32 + 1
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Transform => "/tf",
            Self::Scene => "/scene",
            Self::Telemetry => "/telemetry",
            Self::Events => "/events",
            Self::SafetyCamera => "/camera/safety",
            Self::SemanticCamera => "/camera/semantic",
        }
    }

    /// Name of its messages' layout.
    pub fn schema_name(self) -> &'static str {
        match self {
            Self::Transform => "foxglove.FrameTransform",
            Self::Scene => "foxglove.SceneUpdate",
            Self::Telemetry => "aeye.Telemetry",
            Self::Events => "foxglove.Log",
            Self::SafetyCamera | Self::SemanticCamera => "foxglove.CompressedImage",
        }
    }

    /// Its messages' layout as a JSON schema.
    pub fn schema(self) -> Value {
        match self {
            Self::Transform => object(json!({
                "timestamp": time(), "parent_frame_id": string(), "child_frame_id": string(),
                "translation": xyz(), "rotation": xyzw(),
            })),
            Self::Scene => {
                let pose = object(json!({ "position": xyz(), "orientation": xyzw() }));
                let colour = object(json!({ "r": number(), "g": number(), "b": number(), "a": number() }));
                let cube = object(json!({ "pose": pose, "size": xyz(), "color": colour }));
                let entity = object(json!({
                    "timestamp": time(), "frame_id": string(), "id": string(), "lifetime": time(),
                    "frame_locked": { "type": "boolean" }, "cubes": array(cube),
                }));
                object(json!({ "deletions": array(object(json!({}))), "entities": array(entity) }))
            }
            Self::Telemetry => {
                let seat = object(json!({ "steer": number(), "throttle": number(), "brake": number() }));
                object(json!({
                    "timestamp": time(), "run": integer(), "tick": integer(), "phase": string(),
                    "steering": string(), "pedals": string(), "speed_mps": number(), "limit_mps": number(),
                    "odometer_m": number(), "mask_age_ms": number(), "late_ms": number(), "slowed_ms": number(),
                    "semantic": seat, "safety": seat,
                }))
            }
            Self::Events => object(json!({
                "timestamp": time(), "level": integer(), "message": string(), "name": string(),
                "file": string(), "line": integer(),
            })),
            Self::SafetyCamera | Self::SemanticCamera => object(json!({
                "timestamp": time(), "frame_id": string(), "format": string(),
                "data": { "type": "string", "contentEncoding": "base64" },
            })),
        }
    }
}

fn object(properties: Value) -> Value {
    json!({ "type": "object", "properties": properties })
}

fn array(items: Value) -> Value {
    json!({ "type": "array", "items": items })
}

fn number() -> Value {
    json!({ "type": "number" })
}

fn integer() -> Value {
    json!({ "type": "integer" })
}

fn string() -> Value {
    json!({ "type": "string" })
}

fn time() -> Value {
    object(json!({ "sec": integer(), "nsec": integer() }))
}

fn xyz() -> Value {
    object(json!({ "x": number(), "y": number(), "z": number() }))
}

fn xyzw() -> Value {
    object(json!({ "x": number(), "y": number(), "z": number(), "w": number() }))
}

/// A time or duration, nanoseconds.
fn stamp(ns: u64) -> Value {
    json!({ "sec": ns / 1_000_000_000, "nsec": ns % 1_000_000_000 })
}

fn vector(v: Vec3) -> Value {
    json!({ "x": v.x, "y": v.y, "z": v.z })
}

fn rotation(q: Quat) -> Value {
    json!({ "x": q.x, "y": q.y, "z": q.z, "w": q.w })
}

/// Pose of the ego car's rear axle on the ground.
pub fn transform(scene: &SceneSnapshot, time_ns: u64) -> Value {
    json!({
        "timestamp": stamp(time_ns), "parent_frame_id": MAP, "child_frame_id": EGO,
        "translation": vector(scene.ego.position), "rotation": rotation(scene.ego.rotation),
    })
}

/// Every road user as a box.
pub fn scene(scene: &SceneSnapshot, time_ns: u64) -> Value {
    let entities: Vec<Value> = road_users(scene).map(|user| entity(user, time_ns)).collect();
    json!({ "deletions": [], "entities": entities })
}

fn entity(user: RoadUser, time_ns: u64) -> Value {
    let [r, g, b] = user.colour;
    let cube = json!({
        "pose": { "position": vector(user.middle), "orientation": rotation(user.rotation) },
        "size": vector(user.size_m), "color": { "r": r, "g": g, "b": b, "a": 1.0 },
    });
    json!({
        "timestamp": stamp(time_ns), "frame_id": MAP, "id": user.name, "lifetime": stamp(LIFETIME_NS),
        "frame_locked": false, "metadata": [], "arrows": [], "cubes": [cube], "spheres": [], "cylinders": [],
        "lines": [], "triangles": [], "texts": [], "models": [],
    })
}

/// The figures of a tick.
pub fn telemetry(telemetry: &Telemetry, time_ns: u64) -> Value {
    let milliseconds = |us: u64| us as f64 / 1e3;
    let seat = |controls: kernel::Controls| {
        json!({
            "steer": controls.steer_fraction(), "throttle": controls.throttle_fraction(),
            "brake": controls.brake_fraction(),
        })
    };
    json!({
        "timestamp": stamp(time_ns),
        "run": telemetry.run,
        "tick": telemetry.tick,
        "phase": format!("{:?}", telemetry.phase).to_lowercase(),
        "steering": format!("{:?}", telemetry.steering).to_lowercase(),
        "pedals": format!("{:?}", telemetry.pedals).to_lowercase(),
        "speed_mps": telemetry.speed_mps,
        "limit_mps": telemetry.limit_mps,
        "odometer_m": telemetry.odometer_mm as f64 / 1e3,
        "mask_age_ms": telemetry.mask_age_us.map(milliseconds),
        "late_ms": milliseconds(telemetry.late_us),
        "slowed_ms": milliseconds(telemetry.slowed_us),
        "semantic": telemetry.input.map(|input| seat(input.semantic)),
        "safety": telemetry.input.map(|input| seat(input.safety)),
    })
}

/// Something that happened.
pub fn event(text: &str, time_ns: u64) -> Value {
    json!({
        "timestamp": stamp(time_ns), "level": INFO, "message": text, "name": "aeye", "file": "", "line": 0,
    })
}

/// A picture as a PNG file in base 64.
pub fn image(png: &str, time_ns: u64) -> Value {
    json!({ "timestamp": stamp(time_ns), "frame_id": EGO, "data": png, "format": "png" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::maps::Map;
    use kernel::World;

    /// Every field of a message is in its schema, and the other way round.
    fn fits(message: &Value, schema: &Value, may_lack: &[&str]) {
        let names = |value: &Value| -> Vec<String> { value.as_object().expect("an object").keys().cloned().collect() };
        let known = names(&schema["properties"]);
        assert!(known.iter().all(|name| message.get(name).is_some()), "{known:?} {message}");
        let extra: Vec<String> = names(message).into_iter().filter(|name| !known.contains(name)).collect();
        assert_eq!(extra, may_lack);
    }

    #[test]
    fn messages_have_the_fields_of_their_schemas() {
        let map = Map::find("city").unwrap();
        let world = World::new(&map.scenario(1), &map.network).unwrap();
        let snapshot = world.scene();
        fits(&transform(&snapshot, 7), &Topic::Transform.schema(), &[]);
        let update = scene(&snapshot, 1_500_000_000);
        fits(&update, &Topic::Scene.schema(), &[]);
        let entities = update["entities"].as_array().unwrap();
        assert_eq!(entities.len(), 1 + snapshot.actors.len());
        let schema = &Topic::Scene.schema()["properties"]["entities"]["items"];
        let unused = ["arrows", "cylinders", "lines", "metadata", "models", "spheres", "texts", "triangles"];
        fits(&entities[0], schema, &unused);
        fits(&entities[0]["cubes"][0], &schema["properties"]["cubes"]["items"], &[]);
        assert_eq!(entities[0]["timestamp"], json!({ "sec": 1, "nsec": 500_000_000 }));
        fits(&telemetry(&Telemetry::of_world(&world, 1), 7), &Topic::Telemetry.schema(), &[]);
        fits(&event("Armed", 7), &Topic::Events.schema(), &[]);
        fits(&image("iVBO", 7), &Topic::SafetyCamera.schema(), &[]);
    }

    #[test]
    fn boxes_stand_on_the_ground_around_their_actors() {
        let map = Map::find("city").unwrap();
        let snapshot = World::new(&map.scenario(1), &map.network).unwrap().scene();
        let update = scene(&snapshot, 0);
        for (actor, entity) in snapshot.actors.iter().zip(update["entities"].as_array().unwrap().iter().skip(1)) {
            let z = entity["cubes"][0]["pose"]["position"]["z"].as_f64().unwrap() as f32;
            let height = z - actor.position.z - actor.kind.size_m().z / 2.0;
            assert!(height.abs() < 0.2, "{actor:?}: {height}");
        }
    }
}

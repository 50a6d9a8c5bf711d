//! A trace of OSI holds what the world holds, as its own schema and the standard say, and is made again byte for byte.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec3, Vec3};
use kernel::ego;
use kernel::map::PropKind;
use kernel::scene::{SceneSnapshot, lamps};
use kernel::time::Tick;
use mcap::read::LinearReader;
use mcap::records::{Metadata, Record};
use replay::{Recording, Replayer, nanoseconds};
use serde_json::Value;
use tests::command::aeye;
use tests::protobuf::Types;
use tests::recordings::{ALONE, record};
use tests::scenes::busy_city;

const TICKS: Tick = 240;

fn recorded(folder: &Path) -> PathBuf {
    let path = folder.join("a.mcap");
    fs::write(&path, record(&busy_city(), TICKS, ALONE)).unwrap();
    path
}

/// A trace as it is read by its own schema.
struct Trace {
    summary: mcap::Summary,
    records: Vec<Metadata>,
    /// Time of each message, and what is in it.
    messages: Vec<(u64, Value)>,
}

fn read(path: &Path) -> Trace {
    let bytes = fs::read(path).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().expect("an index");
    let channel: &Arc<mcap::Channel<'_>> = summary.channels.values().next().expect("a channel");
    let schema = channel.schema.as_ref().expect("a schema");
    assert_eq!((schema.name.as_str(), schema.encoding.as_str()), ("osi3.GroundTruth", "protobuf"));
    let types = Types::read(&schema.data);
    let messages = mcap::MessageStream::new(&bytes).unwrap().map(|message| {
        let message = message.unwrap();
        assert_eq!(message.log_time, message.publish_time);
        (message.log_time, types.message(".osi3.GroundTruth", &message.data))
    });
    let records = LinearReader::new(&bytes).unwrap().filter_map(|record| match record.unwrap() {
        Record::Metadata(metadata) => Some(metadata),
        _ => None,
    });
    let (messages, records) = (messages.collect(), records.collect());
    Trace { summary, records, messages }
}

fn export(options: &str, recording: &Path, out: &Path) {
    let (code, said) = aeye(&format!("export --format osi {options}"), &[recording], out);
    assert_eq!(code, 0, "{said}");
}

fn vector(value: &Value) -> DVec3 {
    let [x, y, z] = ["x", "y", "z"].map(|axis| value[axis].as_f64().expect("a number"));
    DVec3::new(x, y, z)
}

fn near(told: DVec3, known: Vec3, within: f64) {
    assert!(told.distance(known.as_dvec3()) < within, "{told}, expected {known}");
}

fn list<'a>(message: &'a Value, field: &str) -> &'a [Value] {
    message[field].as_array().map_or(&[], Vec::as_slice)
}

fn id(value: &Value) -> u64 {
    value["id"]["value"].as_u64().expect("a number")
}

#[test]
fn a_trace_is_what_the_standard_calls_one() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("osi.mcap");
    export("--last 2s", &recorded(dir.path()), &out);
    let Trace { summary, records, messages } = read(&out);
    let of_standard: Vec<&Metadata> = records.iter().filter(|record| record.name == "net.asam.osi.trace").collect();
    assert_eq!(of_standard.len(), 1, "exactly one");
    for (name, value) in [("version", "3.8.0"), ("min_osi_version", "3.8.0"), ("max_osi_version", "3.8.0")] {
        assert_eq!(of_standard[0].metadata[name], value);
    }
    let is_version = |text: &str| text.split('.').count() == 3 && text.split('.').all(|n| n.parse::<u32>().is_ok());
    assert!(["min_protobuf_version", "max_protobuf_version"].iter().all(|n| is_version(&of_standard[0].metadata[*n])));
    assert_eq!((summary.channels.len(), summary.schemas.len()), (1, 1));
    let channel = summary.channels.values().next().unwrap();
    assert_eq!((channel.topic.as_str(), channel.message_encoding.as_str()), ("ground_truth", "protobuf"));
    assert_eq!(channel.metadata["net.asam.osi.trace.channel.osi_version"], "3.8.0");
    assert!(is_version(&channel.metadata["net.asam.osi.trace.channel.protobuf_version"]));
    assert!(!summary.chunk_indexes.is_empty() && summary.chunk_indexes.iter().all(|chunk| chunk.compression == "zstd"));
    // Ten a second, each at the time that it tells.
    let expected: Vec<u64> = (TICKS - 114..=TICKS).step_by(6).map(nanoseconds).collect();
    assert_eq!(messages.iter().map(|(time, _)| *time).collect::<Vec<_>>(), expected);
    for (time, message) in &messages {
        let [seconds, nanos] = ["seconds", "nanos"].map(|part| message["timestamp"][part].as_u64().unwrap());
        assert_eq!(seconds * 1_000_000_000 + nanos, *time);
        assert_eq!(message["version"]["version_minor"], 8);
        assert_eq!((&message["map_reference"], message.get("proj_string")), (&Value::from("city.xodr"), None));
    }
}

#[test]
fn everybody_is_where_the_world_has_them() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, out) = (recorded(dir.path()), dir.path().join("osi.mcap"));
    export("--fps 60 --from 2s --to 3s", &recording, &out);
    let messages = read(&out).messages;
    assert_eq!(messages.len(), 61);
    let recording = Recording::open(&recording).unwrap();
    let mut replayer = Replayer::new(recording.log(), recording.network().unwrap()).unwrap();
    let mut before: Option<Value> = None;
    for (tick, (_, message)) in (120..).zip(messages) {
        replayer.run_to(tick).unwrap();
        let scene = replayer.world().scene();
        same_people(&message, &scene);
        same_ego(&message, &scene);
        same_lights(&message, &scene);
        // What the standard says of velocities: a step of it leads from place to place.
        if let Some(before) = &before {
            let steps = list(before, "moving_object").iter().zip(list(&message, "moving_object"));
            for (was, is) in steps.filter(|(was, is)| id(was) == id(is)) {
                let (way, mps) = (place(is) - place(was), vector(&is["base"]["velocity"]));
                assert!(way.distance(mps / 60.0) < 0.02, "{}: {way} at {mps}", id(is));
            }
        }
        before = Some(message);
    }
}

fn place(object: &Value) -> DVec3 {
    vector(&object["base"]["position"])
}

fn same_people(message: &Value, scene: &SceneSnapshot) {
    let objects = list(message, "moving_object");
    assert_eq!(objects.len(), scene.actors.len() + 1);
    for (actor, object) in scene.actors.iter().zip(&objects[1..]) {
        let size_m = actor.kind.size_m();
        assert_eq!(id(object), u64::from(actor.id));
        near(place(object), actor.position + actor.rotation * Vec3::Z * (0.5 * size_m.z), 1e-4);
        near(vector(&object["base"]["velocity"]), actor.rotation * Vec3::X * actor.speed_mps, 1e-3);
        let sizes = ["length", "width", "height"].map(|side| object["base"]["dimension"][side].as_f64().unwrap());
        assert_eq!(sizes.map(|side| side as f32), size_m.to_array());
        let ahead = actor.rotation * Vec3::X;
        let yaw = object["base"]["orientation"]["yaw"].as_f64().unwrap();
        assert!((yaw - f64::from(ahead.y.atan2(ahead.x))).abs() < 1e-5);
        let is_vehicle = object["type"] == "TYPE_VEHICLE";
        assert_eq!(is_vehicle, !actor.kind.is_on_foot(), "{:?}", actor.kind);
        assert_eq!(object.get("vehicle_classification").is_some(), is_vehicle);
        if is_vehicle {
            let lights = &object["vehicle_classification"]["light_state"];
            let brakes = actor.lamps & lamps::BRAKE != 0;
            assert_eq!(lights["brake_light_state"] == "BRAKE_LIGHT_STATE_NORMAL", brakes);
        }
    }
}

fn same_ego(message: &Value, scene: &SceneSnapshot) {
    let car = &list(message, "moving_object")[0];
    assert_eq!((id(car), &message["host_vehicle_id"]["value"]), (0, &Value::from(0)));
    // From the middle of the box to the rear axle, which is above the place that the scene tells.
    let rear = scene.ego.rotation * vector(&car["vehicle_attributes"]["bbcenter_to_rear"]).as_vec3();
    let axle = scene.ego.position + scene.ego.rotation * Vec3::Z * ego::WHEEL_RADIUS_M;
    near(place(car) + rear.as_dvec3(), axle, 1e-4);
    let along = vector(&car["base"]["velocity"]).dot((scene.ego.rotation * Vec3::X).as_dvec3());
    assert!((along - f64::from(scene.ego.speed_mps)).abs() < 1e-3, "{along}");
}

fn same_lights(message: &Value, scene: &SceneSnapshot) {
    let lit = list(message, "traffic_light").iter().filter(|lamp| lamp["classification"]["mode"] == "MODE_CONSTANT");
    let mut told: BTreeMap<&str, usize> = BTreeMap::new();
    lit.for_each(|lamp| *told.entry(lamp["classification"]["color"].as_str().unwrap()).or_default() += 1);
    let mut known: BTreeMap<&str, usize> = BTreeMap::new();
    for head in &busy_city().network.light_heads {
        let color = ["COLOR_RED", "COLOR_YELLOW", "COLOR_GREEN"][scene.lights[head.group as usize] as usize];
        *known.entry(color).or_default() += 1;
    }
    assert_eq!(told, known);
}

#[test]
fn the_map_is_in_the_first_message_and_numbers_differ() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("osi.mcap");
    export("--last 1s", &recorded(dir.path()), &out);
    let messages = read(&out).messages;
    let network = busy_city().network;
    let first = &messages[0].1;
    let count = |field: &str| list(first, field).len();
    let signs = network.props.iter().filter(|prop| prop.kind == PropKind::Sign).count();
    assert_eq!((count("lane"), count("lane_boundary")), (network.lanes.len(), 2 * network.lanes.len()));
    assert_eq!((count("traffic_sign"), count("stationary_object")), (signs, network.props.len() - signs));
    let kinds = ["moving_object", "stationary_object", "traffic_sign", "traffic_light", "lane", "lane_boundary"];
    let mut numbers: Vec<u64> = kinds.iter().flat_map(|kind| list(first, kind)).map(id).collect();
    let all = numbers.len();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), all);
    for (_, message) in &messages[1..] {
        assert!(
            ["stationary_object", "traffic_sign", "lane", "lane_boundary"].iter().all(|k| message.get(k).is_none())
        );
        assert_eq!(list(message, "traffic_light").len(), 3 * network.light_heads.len());
    }
}

#[test]
fn the_same_again_is_the_same_and_what_is_none_is_not_touched() {
    let dir = tempfile::tempdir().unwrap();
    let recording = recorded(dir.path());
    let at = |name: &str| dir.path().join(name);
    for name in ["first.mcap", "second.mcap"] {
        export("--last 1s", &recording, &at(name));
    }
    let bytes = fs::read(at("first.mcap")).unwrap();
    assert!(bytes == fs::read(at("second.mcap")).unwrap());
    let written = || fs::metadata(at("first.mcap")).unwrap().modified().unwrap();
    let before = written();
    export("--last 1s", &recording, &at("first.mcap"));
    assert_eq!(written(), before, "what is there is kept");
    // A whole folder, in which the trace is no case.
    fs::write(at("first.mcap"), &bytes[..bytes.len() - 1]).unwrap();
    export("--last 1s", &recording, &at("first.mcap"));
    assert!(fs::read(at("first.mcap")).unwrap() == bytes, "one without an end is made anew");
    for (options, out, expected) in [
        ("export --format osi", "a.mcap", "a.mcap: exists already and is no export"),
        ("export --format osi --checkpoint truth", "no.mcap", "osi holds no masks"),
        ("export --format osi --camera top", "no.mcap", "--camera is for moving pictures"),
        ("export --format osi --fps 1 --from 2.1s --to 2.2s", "no.mcap", "no message falls into the window"),
    ] {
        let (code, said) = aeye(options, &[&recording], &at(out));
        assert!(code != 0 && said.contains(expected) && !said.contains('\n'), "{options}: {code} {said}");
        assert!(!at("no.mcap").exists());
    }
}

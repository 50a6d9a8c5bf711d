//! Labels of OpenLABEL are where the world has everybody, and tell what happened; they are made again byte for byte.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use glam::DVec3;
use kernel::ego;
use replay::{Recording, Replayer};
use serde_json::Value;
use tests::command::aeye;
use tests::recordings::{TAKEOVER, recorded};

const OPTIONS: &str = "export --format openlabel --size 64x32";

fn labels(file: &Path) -> Value {
    let document: Value = serde_json::from_slice(&fs::read(file).unwrap()).unwrap();
    document["openlabel"].clone()
}

/// What is numbered, by number.
fn numbered(value: &Value) -> BTreeMap<u64, &Value> {
    let entries = value.as_object().expect("an object").iter();
    entries.map(|(number, entry)| (number.parse().expect("a number"), entry)).collect()
}

fn vector(values: &[Value]) -> DVec3 {
    DVec3::from_slice(&values.iter().map(|value| value.as_f64().expect("a number")).collect::<Vec<_>>())
}

/// Text, number or whether of a name, in an element's data.
fn told<'a>(element: &'a Value, kind: &str, name: &str) -> &'a Value {
    let values = element["event_data"][kind].as_array().expect("values");
    &values.iter().find(|value| value["name"] == name).unwrap_or_else(|| panic!("no {name} in {element}"))["val"]
}

#[test]
fn boxes_are_where_the_world_has_everybody() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let out = dir.path().join("a.json");
    // The format follows from the ending.
    assert_eq!(aeye("export --last 2s", &[&case], &out), (0, String::new()));
    let (labels, log) = (labels(&out), Recording::open(&case).unwrap().into_log());
    let mut replayer = Replayer::new(&log, log.manifest.network().unwrap()).unwrap();
    let (frames, objects) = (numbered(&labels["frames"]), numbered(&labels["objects"]));
    assert_eq!(frames.keys().copied().collect::<Vec<_>>(), (0..20).collect::<Vec<_>>());
    for (number, frame) in frames {
        let properties = &frame["frame_properties"];
        let tick = properties["tick"].as_u64().unwrap();
        assert_eq!((tick, properties["timestamp"].as_f64()), (TAKEOVER - 6 * (19 - number), Some(tick as f64 / 60.0)));
        replayer.seek(tick).unwrap();
        let scene = replayer.world().scene();
        let here = numbered(&frame["objects"]);
        let expected = std::iter::once(0).chain(scene.actors.iter().map(|actor| u64::from(actor.id)));
        assert!(here.keys().copied().eq(expected), "tick {tick}");
        let to_world = &properties["transforms"]["ego_to_world"]["transform_src_to_dst"];
        let translation = vector(to_world["translation"].as_array().unwrap());
        assert!(translation.distance(scene.ego.position.as_dvec3()) < 1e-4, "tick {tick}: {translation}");
        let place = |uid: u64| {
            let object = &here[&uid]["object_data"]["cuboid"][0];
            let val = object["val"].as_array().unwrap();
            assert_eq!((val.len(), object["coordinate_system"].as_str()), (10, Some("world")));
            (vector(&val[..3]), vector(&val[7..]))
        };
        assert!(place(0).1.distance(ego::SIZE_M.as_dvec3()) < 1e-6);
        for actor in &scene.actors {
            let (middle, size_m) = place(actor.id.into());
            let above = middle - actor.position.as_dvec3();
            assert!((above.length() - size_m.z / 2.0).abs() < 1e-3, "{actor:?}: {middle}");
            let intervals = objects[&actor.id.into()]["frame_intervals"].as_array().unwrap();
            let within = |i: &Value| (i["frame_start"].as_u64()..=i["frame_end"].as_u64()).contains(&Some(number));
            assert_eq!(intervals.iter().filter(|i| within(i)).count(), 1, "{actor:?} in {intervals:?}");
        }
    }
}

#[test]
fn what_happened_has_its_frames_and_what_was_said_of_it() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, _) = recorded(dir.path());
    let out = dir.path().join("a.json");
    assert_eq!(aeye(OPTIONS, &[&recording], &out), (0, String::new()));
    let (labels, log) = (labels(&out), Recording::open(&recording).unwrap().into_log());
    let (events, frames) = (numbered(&labels["events"]), numbered(&labels["frames"]));
    assert_eq!(events.len(), log.events.len() + 1, "and the corner case");
    for (uid, event) in &events {
        let (interval, tick) = (&event["frame_intervals"][0], told(event, "num", "tick").as_f64().unwrap());
        assert_eq!(interval["frame_start"], interval["frame_end"]);
        let frame = frames[&interval["frame_start"].as_u64().unwrap()];
        let behind = tick - frame["frame_properties"]["tick"].as_f64().unwrap();
        assert!((0.0..6.0).contains(&behind), "{event}");
        assert!(numbered(&frame["events"]).contains_key(uid), "{event}");
    }
    let case = events.values().find(|event| event["type"] == "CornerCase").expect("a corner case");
    assert_eq!(told(case, "num", "tick").as_f64(), Some(TAKEOVER as f64));
    assert_eq!((told(case, "text", "label"), told(case, "text", "comment")), (&"rules".into(), &"a <test>".into()));
    assert_eq!(told(case, "boolean", "by_brake"), &Value::Bool(true));
    let actions = numbered(&labels["actions"]);
    let parts = actions.values().map(|action| {
        let interval = &action["frame_intervals"][0];
        (
            action["type"].as_str().unwrap(),
            interval["frame_start"].as_u64().unwrap(),
            interval["frame_end"].as_u64().unwrap(),
        )
    });
    let parts: Vec<_> = parts.collect();
    let last = frames.len() as u64 - 1;
    let from = parts[1].1;
    assert_eq!(frames[&from]["frame_properties"]["tick"].as_u64(), Some(TAKEOVER));
    assert_eq!(parts, [("SemanticDriverDrives", 0, from - 1), ("SafetyDriverDrives", from, last)]);
    let tags: Vec<_> = numbered(&labels["tags"]).values().map(|tag| tag["type"].as_str().unwrap().to_owned()).collect();
    for expected in ["DaySunElevation", "VehicleCar", "VehicleCycle", "HumanPedestrian"] {
        assert!(tags.iter().any(|tag| tag == expected), "{expected} in {tags:?}");
    }
    let boundary = labels["ontologies"]["0"]["boundary_list"].as_array().unwrap();
    assert!(tags.iter().all(|tag| boundary.contains(&tag.as_str().into())), "{tags:?} in {boundary:?}");
}

#[test]
fn they_are_made_again_or_kept_and_take_nobodys_place() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let at = |name: &str| dir.path().join(name);
    let read = |name: &str| fs::read(at(name)).unwrap();
    for name in ["first.json", "second.json"] {
        assert_eq!(aeye(OPTIONS, &[&case], &at(name)), (0, String::new()));
    }
    assert!(read("first.json") == read("second.json"));
    let written = || fs::metadata(at("first.json")).unwrap().modified().unwrap();
    let before = written();
    assert_eq!((aeye(OPTIONS, &[&case], &at("first.json")).0, written()), (0, before));
    assert_eq!(aeye("export --format openlabel --last 1s", &[&case], &at("first.json")).0, 0);
    assert!(read("first.json") != read("second.json"), "other options make it anew");
    fs::write(at("mine.json"), "{\"mine\": 1}").unwrap();
    for (options, out, words) in [
        (OPTIONS, "mine.json", "mine.json: exists already and is no export"),
        ("export --format openlabel --checkpoint truth", "new.json", "openlabel holds no masks of networks"),
        ("export --format openlabel", "new.xosc", "new.xosc: expected a folder, or a file *.json"),
        ("export --format openlabel --from 500s", "new.json", "nothing of that window"),
    ] {
        let (code, said) = aeye(options, &[&case], &at(out));
        assert!(code != 0 && said.contains(words) && !said.contains('\n'), "{options} {out}: {code}, {said:?}");
    }
    assert_eq!(read("mine.json"), b"{\"mine\": 1}");
    assert!(!at("new.json").exists());
}

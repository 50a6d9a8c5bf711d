//! Exports hold what their recordings hold, at its time, and are made again byte for byte.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use aeye::cli::Cli;
use aeye::exit;
use base::failure::sentence;
use clap::Parser;
use foxglove::messages::{CompressedImage, FrameTransform, FrameTransforms, Log as Line, PoseInFrame, SceneUpdate};
use glam::{DQuat, DVec3};
use kernel::time::Tick;
use prost::Message;
use render::Camera;
use replay::{Case, Log, Recording, Replayer, nanoseconds};
use tests::recordings::{TAKEOVER, WITH_TAKEOVER, record};
use tests::scenes::busy_city;

/// Recording and case of the city, in a folder.
fn files(folder: &Path) -> (PathBuf, PathBuf) {
    let scene = busy_city();
    let bytes = record(&scene, TAKEOVER + 180, WITH_TAKEOVER);
    let recording = Recording::from_bytes(&bytes).unwrap();
    let window = Case::window(recording.log()).expect("an intervention");
    let case = Case::cut(&recording, &scene.network, window).unwrap().encode().unwrap();
    let paths = (folder.join("a.mcap"), folder.join("a.case.mcap"));
    fs::write(&paths.0, bytes).unwrap();
    fs::write(&paths.1, case).unwrap();
    paths
}

/// Exit code and sentence of `aeye export`.
fn export(arguments: &[&str]) -> (u8, String) {
    let cli = Cli::try_parse_from([&["aeye", "--json", "export"], arguments].concat()).expect("a valid command line");
    let result = aeye::run(&cli);
    (exit::number(&result), result.err().map(|e| sentence(&e)).unwrap_or_default())
}

/// Messages by topic: their times and bytes.
type Topics = BTreeMap<String, Vec<(u64, Vec<u8>)>>;

fn topics(file: &Path) -> Topics {
    let bytes = fs::read(file).unwrap();
    assert!(mcap::Summary::read(&bytes).unwrap().is_some(), "no index");
    let mut topics = Topics::new();
    let mut last = 0;
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        let schema = message.channel.schema.as_ref().expect("a schema");
        assert_eq!((schema.encoding.as_str(), message.channel.message_encoding.as_str()), ("protobuf", "protobuf"));
        let ours = ["telemetry.Telemetry", "criticality.Criticality"].contains(&schema.name.as_str());
        assert!(ours || schema.name.starts_with("foxglove."), "{}", schema.name);
        assert!(!schema.data.is_empty() && message.log_time == message.publish_time && message.log_time >= last);
        last = message.log_time;
        topics.entry(message.channel.topic.clone()).or_default().push((message.log_time, message.data.into_owned()));
    }
    topics
}

fn read<M: Message + Default>(messages: &[(u64, Vec<u8>)]) -> Vec<M> {
    messages.iter().map(|(_, bytes)| M::decode(bytes.as_slice()).unwrap()).collect()
}

fn times(messages: &[(u64, Vec<u8>)]) -> Vec<u64> {
    messages.iter().map(|(time, _)| *time).collect()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn an_export_holds_every_frame_pose_and_event_at_its_time() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = files(dir.path());
    let out = |name: &str| dir.path().join(name);
    for name in ["first.mcap", "second.mcap"] {
        let arguments = [case.to_str().unwrap(), "--checkpoint", "early", "--size", "64x32", "--out"];
        let (code, sentence) = export(&[arguments.as_slice(), &[out(name).to_str().unwrap()]].concat());
        assert_eq!(code, 0, "{sentence}");
    }
    assert_eq!(fs::read(out("first.mcap")).unwrap(), fs::read(out("second.mcap")).unwrap());
    let (topics, log) = (topics(&out("first.mcap")), Recording::open(&case).unwrap().into_log());

    let ticks: Vec<Tick> = (log.first_tick()..=log.last_tick()).collect();
    let to = log.manifest.case.as_ref().unwrap().to;
    let pictured = |tick: &&Tick| tick.abs_diff(to) % 6 == 0;
    let nanos = |ticks: &mut dyn Iterator<Item = &Tick>| ticks.map(|tick| nanoseconds(*tick)).collect::<Vec<_>>();
    let frames = nanos(&mut ticks.iter().filter(pictured));
    for topic in ["rgb", "truth", "predicted/early", "calibration"] {
        assert_eq!(times(&topics[&format!("/camera/{topic}")]), frames, "{topic}");
    }
    for topic in ["/tf", "/actors", "/criticality"] {
        assert_eq!(times(&topics[topic]), frames, "{topic}");
    }
    assert_eq!(times(&topics["/ego/pose"]), nanos(&mut ticks.iter()));
    assert_eq!(times(&topics["/telemetry"]), nanos(&mut ticks[1..].iter()));
    assert_eq!(times(&topics["/events"]), nanos(&mut log.events.iter().map(|(tick, _)| tick)));
    let lines: Vec<Line> = read(&topics["/events"]);
    assert!(lines.iter().any(|l| l.message.starts_with("intervention") && l.message.contains("as scripted")));
    places_are_those_of_the_world(&topics, &log);

    let masks: Vec<CompressedImage> = read(&topics["/camera/truth"]);
    assert!(masks.iter().all(|image| image.format == "png" && image.data.starts_with(b"\x89PNG")));
    let layout = fs::read_to_string(out("first.layout.json")).unwrap();
    for topic in topics.keys().filter(|topic| !["/tf", "/ego/pose"].contains(&topic.as_str())) {
        assert!(layout.contains(&format!("\"{topic}")), "the layout does not show {topic}");
    }
}

/// Poses, transforms and boxes are where the simulation has car, camera and actors.
fn places_are_those_of_the_world(topics: &Topics, log: &Log) {
    let mut replayer = Replayer::new(log, log.manifest.network().unwrap()).unwrap();
    let near = |a: DVec3, b: DVec3| assert!(a.distance(b) < 1e-3, "{a} and {b}");
    for (time, pose) in times(&topics["/ego/pose"]).iter().zip(read::<PoseInFrame>(&topics["/ego/pose"])) {
        replayer.seek((time * 60).div_ceil(1_000_000_000)).unwrap();
        let place = pose.pose.unwrap().position.unwrap();
        near(DVec3::new(place.x, place.y, place.z), replayer.world().scene().ego.position.as_dvec3());
    }
    let updates: Vec<SceneUpdate> = read(&topics["/actors"]);
    let transforms: Vec<FrameTransforms> = read(&topics["/tf"]);
    for ((time, update), FrameTransforms { transforms }) in times(&topics["/tf"]).iter().zip(updates).zip(transforms) {
        replayer.seek((time * 60).div_ceil(1_000_000_000)).unwrap();
        let scene = replayer.world().scene();
        assert_eq!((update.entities.len(), transforms.len()), (scene.actors.len() + 1, scene.actors.len() + 2));
        let ((at, rotation), (from_ego, optical)) = (place(&transforms[0]), place(&transforms[1]));
        let (eye, view) = Camera::driver(64, 32).pose(&scene.ego);
        near(at + rotation * from_ego, eye.as_dvec3());
        near(rotation * optical * DVec3::Z, (view * glam::Vec3::X).as_dvec3());
        near(rotation * optical * DVec3::Y, (view * glam::Vec3::NEG_Z).as_dvec3());
        for (actor, transform) in scene.actors.iter().zip(&transforms[2..]) {
            near(place(transform).0, actor.position.as_dvec3());
        }
    }
}

fn place(transform: &FrameTransform) -> (DVec3, DQuat) {
    let (t, r) = (transform.translation.as_ref().unwrap(), transform.rotation.as_ref().unwrap());
    (DVec3::new(t.x, t.y, t.z), DQuat::from_xyzw(r.x, r.y, r.z, r.w))
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn windows_are_those_of_the_run_and_several_files_go_into_a_folder() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, case) = files(dir.path());
    let (recording, case) = (recording.to_str().unwrap(), case.to_str().unwrap());
    let folder = dir.path().join("new/folder");
    let common = ["--size", "16x8", "--out", folder.to_str().unwrap()];
    let (code, sentence) = export(&[&[recording, case, "--last", "3s"], common.as_slice()].concat());
    assert_eq!(code, 0, "{sentence}");
    let written = |name: &str| fs::metadata(folder.join(name)).unwrap().modified().unwrap();
    let before = written("a.mcap");
    fs::remove_file(folder.join("a.case.mcap")).unwrap();
    let (code, sentence) = export(&[&[recording, case, "--last", "3s"], common.as_slice()].concat());
    assert_eq!((code, written("a.mcap")), (0, before), "what is there is kept: {sentence}");
    let whole = fs::read(folder.join("a.mcap")).unwrap();
    fs::write(folder.join("a.mcap"), &whole[..whole.len() - 1]).unwrap();
    let (code, sentence) = export(&[&[recording, case, "--last", "3s"], common.as_slice()].concat());
    assert!(code == 0 && fs::read(folder.join("a.mcap")).unwrap() == whole, "one without an end is not: {sentence}");
    let frames = |name: &str| times(&topics(&folder.join(name))["/camera/rgb"]);
    assert_eq!(frames("a.mcap").len(), 30);
    assert_eq!((frames("a.mcap"), frames("a.mcap").last()), (frames("a.case.mcap"), Some(&nanoseconds(TAKEOVER))));
    let (code, sentence) = export(&[&[recording, "--from", "2s", "--to", "3.5s"], common.as_slice()].concat());
    assert_eq!(code, 0, "{sentence}");
    let poses = times(&topics(&folder.join("a.mcap"))["/ego/pose"]);
    assert_eq!((poses.len(), poses[0], poses[90]), (91, nanoseconds(120), nanoseconds(210)));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn what_cannot_be_exported_is_refused_in_one_sentence_and_nothing_is_left() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, case) = files(dir.path());
    let (recording, case) = (recording.to_str().unwrap(), case.to_str().unwrap());
    let path = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    let (out, folder) = (path("out.mcap"), path("out"));
    let before = fs::read_dir(dir.path()).unwrap().count();
    let bytes = (fs::read(recording).unwrap(), fs::read(case).unwrap());
    let same = dir.path().to_str().unwrap();
    for (arguments, expected, words) in [
        (vec![recording, case, "--out", &out], 2, "out.mcap: is one file; expected a folder"),
        (vec!["missing.mcap", "--out", &out], 1, "missing.mcap"),
        (vec!["missing.mcap", "--out", &folder], 1, "missing.mcap"),
        (vec![recording, "--from", "500s", "--out", &folder], 1, "nothing of that window"),
        (vec![recording, "--from", "3s", "--to", "2s", "--out", &out], 1, "nothing of that window"),
        (vec![recording, "--out", same], 1, "a.mcap: exists already and is no export"),
        (vec![recording, "--out", case], 1, "a.case.mcap: exists already and is no export"),
        (vec![recording, "--out", "/nowhere/to/be/found.mcap"], 1, "/nowhere/to/be does not exist"),
        (vec![recording, "--checkpoint", "gone.onnx", "--out", &out], 1, "gone.onnx"),
    ] {
        let (code, sentence) = export(&arguments);
        assert!(code == expected && sentence.contains(words), "{arguments:?}: {code}, {sentence:?}");
        assert!(!sentence.contains('\n') && sentence.len() < 400, "{sentence:?}");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), before, "{arguments:?}: something was left");
    }
    assert_eq!((fs::read(recording).unwrap(), fs::read(case).unwrap()), bytes);
}

/// The pictures of an animated PNG, 3 bytes a pixel.
fn animated(file: &Path) -> (u32, u32, Vec<Vec<u8>>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(fs::read(file).unwrap())).read_info().unwrap();
    let (width, height) = (reader.info().width, reader.info().height);
    let frames = reader.info().animation_control().expect("it is animated").num_frames;
    let mut next = || {
        let mut bytes = vec![0; width as usize * height as usize * 3];
        reader.next_frame(&mut bytes).unwrap();
        bytes
    };
    (width, height, (0..frames).map(|_| next()).collect())
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn moving_pictures_are_those_of_the_driver_with_the_masks_beside_them() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = files(dir.path());
    let (case, out) = (case.to_str().unwrap(), dir.path().join("a.png"));
    let arguments = [case, "--checkpoint", "truth", "--size", "64x32", "--last", "1s", "--out", out.to_str().unwrap()];
    assert_eq!(export(&arguments), (0, String::new()));
    let (width, height, pictures) = animated(&out);
    assert_eq!((width, height, pictures.len()), (128, 32, 10));
    // Beside what `rerender` draws of the same ticks.
    let drawn = dir.path().join("drawn");
    let again = ["--checkpoint", "truth", "--size", "64x32", "--last", "1s"];
    let (code, said) = tests::command::aeye(&format!("rerender {}", again.join(" ")), &[Path::new(case)], &drawn);
    assert_eq!(code, 0, "{said}");
    let mut files: Vec<_> = fs::read_dir(drawn.join("a.case/rgb")).unwrap().map(|f| f.unwrap().path()).collect();
    files.sort();
    assert_eq!(files.len(), 10);
    for (file, picture) in files.iter().zip(&pictures) {
        let (_, rgb) = base::png::read(file, 3).unwrap();
        let left: Vec<u8> = picture.chunks(3 * 128).flat_map(|row| &row[..3 * 64]).copied().collect();
        assert!(left == rgb, "{}", file.display());
        let tick = file.file_name().unwrap();
        let (_, ids) = base::png::read(&drawn.join("a.case/labels").join(tick), 1).unwrap();
        let right: Vec<u8> = picture.chunks(3 * 128).flat_map(|row| &row[3 * 64..]).copied().collect();
        assert!(right == render::tags::colours(&ids), "{}", file.display());
    }
    // The same again is kept, other options make it anew, and what is none is not touched.
    let (before, written) = (fs::read(&out).unwrap(), |out: &Path| fs::metadata(out).unwrap().modified().unwrap());
    let at = written(&out);
    assert_eq!(export(&arguments).0, 0);
    assert_eq!((written(&out), fs::read(&out).unwrap() == before), (at, true));
    let from_above = [case, "--camera", "top", "--size", "64x32", "--last", "1s", "--out", out.to_str().unwrap()];
    assert_eq!(export(&from_above).0, 0);
    assert_eq!(animated(&out).0, 64);
    fs::write(&out, "mine").unwrap();
    assert!(export(&from_above).1.contains("exists already and is no export"));
    assert_eq!(fs::read(&out).unwrap(), b"mine");
}

#[test]
fn moving_pictures_say_what_they_cannot_be() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = files(dir.path());
    let case = case.to_str().unwrap();
    let says = |arguments: &[&str], expected: &str| {
        let (code, said) = export(&[&[case], arguments].concat());
        assert!(code != 0 && said.contains(expected), "{arguments:?}: {code}, {said}");
    };
    let gif = dir.path().join("a.gif");
    let gif = gif.to_str().unwrap();
    says(&["--camera", "top", "--out", "a.mcap"], "expected --format apng, gif or mp4");
    says(&["--camera", "top", "--checkpoint", "truth", "--out", gif], "networks see the driver's view");
    says(&["--format", "apng", "--out", gif], "expected a folder, or a file *.png");
    assert!(!Path::new(gif).exists());
}

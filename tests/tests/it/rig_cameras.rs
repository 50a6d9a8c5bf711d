//! Several cameras: datasets, exports, windows and pages are seen through those that are named, and say so.

use std::fs;
use std::path::{Path, PathBuf};

use base::progress::Interrupt;
use drivers::checkpoint::CheckpointChoice;
use foxglove::messages::{CameraCalibration, CompressedImage, FrameTransforms};
use lab::eval::evaluate;
use lab::report;
use prost::Message;
use render::Camera;
use replay::Recording;
use serde_json::Value;
use tests::command::aeye;
use tests::files::contents;
use tests::recordings::recorded;

const LEFT: &str = "y_m = 0.5\nyaw_rad = 1.57\npitch_rad = -0.1\nwidth = 48\nsensor = \"k1=-0.1\"";

/// A file of cameras, the first of which is the drivers'.
fn rig(folder: &Path, others: &[(&str, &str)]) -> PathBuf {
    let x_m = Camera::driver(8, 8).position.x;
    let mut text = format!("[[cameras]]\nname = \"front\"\nx_m = {x_m}\nz_m = 1.5\n");
    for (name, more) in others {
        text += &format!("[[cameras]]\nname = \"{name}\"\nx_m = 1.0\nz_m = 1.6\n{more}\n");
    }
    let path = folder.join("rig.toml");
    fs::write(&path, text).unwrap();
    path
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn lines(folder: &Path) -> Vec<Value> {
    let text = fs::read_to_string(folder.join("frames.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn every_camera_takes_every_frame_of_a_natural_dataset() {
    let dir = tempfile::tempdir().unwrap();
    let [several, one, again] = ["several", "one", "again"].map(|name| dir.path().join(name));
    let make = "dataset natural --scenes 1 --val-scenes 0 --test-scenes 0 --frames 2 --size 64x32 --quality plain \
                --maps rural --seed 5";
    let with = |rig: &Path| format!("{make} --cameras {}", rig.display());
    let rig_of_two = rig(dir.path(), &[("rear_left", LEFT)]);
    assert_eq!(aeye(&with(&rig_of_two), &[], &several), (0, String::new()));
    assert_eq!(aeye(make, &[], &one), (0, String::new()));
    let told: Vec<_> = lines(&several).iter().map(|l| (l["frame"].clone(), l["camera"].clone())).collect();
    let cameras = ["front 64x32", "rear_left 48x32 plain k1=-0.1"];
    assert_eq!(told, [0, 1].map(|frame| cameras.map(|camera| (frame.into(), camera.into()))).concat());
    assert_eq!(lines(&several)[1]["camera_name"], "rear_left");
    let manifest = json(&several.join("dataset.json"));
    assert_eq!((&manifest["train_frames"], &manifest["recipe"]["cameras"][1]["width"]), (&4.into(), &48.into()));
    let picture = |folder: &Path, city: &str| {
        fs::read(folder.join(format!("leftImg8bit/train/{city}/{city}_000000_000001_leftImg8bit.png"))).unwrap()
    };
    assert!(picture(&several, "rural-front") == picture(&one, "rural"), "the drivers' camera under a name");
    assert!(picture(&several, "rural-rear-left") != picture(&one, "rural"));
    assert!(!fs::read_to_string(one.join("frames.jsonl")).unwrap().contains("camera_name"));

    assert_eq!(aeye("dataset rebuild", &[&several], &again), (0, String::new()));
    assert!(contents(&again) == contents(&several));
    let (code, said) = aeye(make, &[], &several);
    assert!(code == 1 && said.contains("of another recipe"), "{said}");
    let none = dir.path().join("none");
    let (code, said) = aeye(&with(&rig(dir.path(), &[("a_b", ""), ("a-b", "")])), &[], &none);
    assert!(code == 2 && said.contains("two cameras are named \"a-b\"") && !none.exists(), "{said}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn every_camera_takes_every_frame_of_a_case() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let rig = rig(dir.path(), &[("left", LEFT)]);
    let [several, one, again] = ["several", "one", "again"].map(|name| dir.path().join(name));
    let command = "dataset cases --size 64x32 --quality plain";
    assert_eq!(aeye(&format!("{command} --cameras {}", rig.display()), &[&case], &several), (0, String::new()));
    assert_eq!(aeye(command, &[&case], &one), (0, String::new()));
    let told = lines(&several);
    assert_eq!((told.len(), &told[0]["camera_name"], &told[1]["camera_name"]), (60, &"front".into(), &"left".into()));
    let digests = |lines: &[Value]| lines.iter().map(|line| line["rgb_digest"].clone()).collect::<Vec<_>>();
    let of_front: Vec<Value> = told.iter().step_by(2).cloned().collect();
    assert_eq!(digests(&of_front), digests(&lines(&one)));
    assert_eq!(aeye("dataset rebuild", &[&several, &case], &again), (0, String::new()));
    assert!(contents(&again) == contents(&several));
    // Distances would be those of the drivers' camera.
    let [far, near] = [&several, &one].map(|folder| {
        let evaluation = evaluate(&CheckpointChoice::Truth, folder, "train", None, &Interrupt::default()).unwrap();
        evaluation.road_users.pedestrians.by_distance_m.iter().map(|range| range.recall.count).sum::<u64>()
    });
    assert!(far == 0 && near > 0, "{far} {near}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn parts_of_a_mix_have_the_same_cameras() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let rig = rig(dir.path(), &[("left", LEFT)]);
    let at = |name: &str| dir.path().join(name);
    let size = "--size 64x32 --quality plain";
    let natural = format!("dataset natural --scenes 1 --val-scenes 0 --test-scenes 0 --frames 2 {size} --maps rural");
    let cameras = format!("--cameras {}", rig.display());
    assert_eq!(aeye(&format!("{natural} --seed 5 {cameras}"), &[], &at("natural")), (0, String::new()));
    assert_eq!(aeye(&format!("{natural} --seed 6 {cameras}"), &[], &at("pool")), (0, String::new()));
    assert_eq!(aeye(&format!("dataset cases {size} {cameras}"), &[&case], &at("cases")), (0, String::new()));
    assert_eq!(aeye(&format!("dataset cases {size}"), &[&case], &at("driver")), (0, String::new()));
    let mix = |cases: &str, out: &str| {
        let [natural, pool, cases] = ["natural", "pool", cases].map(|name| at(name).display().to_string());
        let parts = format!("--natural {natural} --pool {pool} --corner-cases {cases}");
        aeye(&format!("dataset mix {parts} --replace 3"), &[], &at(out))
    };
    assert_eq!(mix("cases", "mix"), (0, String::new()));
    let mixed = lines(&at("mix/corner-case"));
    let of_cases: Vec<_> = mixed.iter().filter(|line| line["part"] == "cases").collect();
    assert_eq!((mixed.len(), of_cases.len()), (4, 3));
    for line in mixed {
        assert!(at("mix/corner-case").join(line["image"].as_str().unwrap()).is_file(), "{line}");
    }
    let (code, said) = mix("driver", "none");
    let words = "holds pictures of other cameras than";
    assert!(code == 1 && said.contains(words) && !at("none").exists(), "{said}");
}

/// Messages of a topic.
fn messages<M: Message + Default>(bytes: &[u8], topic: &str) -> Vec<M> {
    let all = mcap::MessageStream::new(bytes).unwrap().map(Result::unwrap);
    all.filter(|message| message.channel.topic == topic).map(|message| M::decode(&*message.data).unwrap()).collect()
}

/// The pictures of a camera as `rerender` draws them, in order.
fn drawn(folder: &Path) -> Vec<Vec<u8>> {
    contents(folder).into_values().collect()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn exports_hold_what_every_camera_saw() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let at = |name: &str| dir.path().join(name);
    let options =
        format!("--size 64x32 --quality plain --last 0.5s --cameras {}", rig(dir.path(), &[("left", LEFT)]).display());
    let export = |more: &str, out: &str| aeye(&format!("export {options} {more}"), &[&case], &at(out));
    let rerender = format!("rerender --checkpoint truth {options}");
    assert_eq!(aeye(&rerender, &[&case], &at("drawn")), (0, String::new()));
    let rgb = drawn(&at("drawn/a.case/cameras/left/rgb"));
    assert_eq!(rgb.len(), 5);

    assert_eq!(export("--format mcap", "seen.mcap"), (0, String::new()));
    let bytes = fs::read(at("seen.mcap")).unwrap();
    let images: Vec<CompressedImage> = messages(&bytes, "/cameras/left/rgb");
    assert!(images.iter().map(|image| image.data.to_vec()).eq(rgb.clone()));
    assert_eq!(images[0].frame_id, "cameras/left");
    let calibrations: Vec<CameraCalibration> = messages(&bytes, "/cameras/left/calibration");
    assert_eq!((calibrations.len(), calibrations[0].width, calibrations[0].d[0] as f32), (5, 48, -0.1));
    for FrameTransforms { transforms } in messages(&bytes, "/tf") {
        let [driver, front, left] = &transforms[1..4] else { panic!("three cameras") };
        assert_eq!([driver, front, left].map(|t| &*t.child_frame_id), ["camera", "cameras/front", "cameras/left"]);
        assert!(driver.translation == front.translation && driver.rotation == front.rotation);
        assert_eq!(left.translation.as_ref().map(|t| (t.x, t.y)), Some((1.0, 0.5)));
    }
    let of = |topic: &str| messages::<CompressedImage>(&bytes, topic);
    assert!(of("/cameras/front/rgb").iter().zip(of("/camera/rgb")).all(|(front, driver)| front.data == driver.data));
    assert!(fs::read_to_string(at("seen.layout.json")).unwrap().contains("\"/cameras/left/calibration\""));

    assert_eq!(export("--format ros2", "bag"), (0, String::new()));
    let bytes = fs::read(at("bag/bag_0.mcap")).unwrap();
    let all: Vec<_> = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap).collect();
    let of = |topic: &str| all.iter().filter(|message| message.channel.topic == topic).collect::<Vec<_>>();
    for topic in ["camera_info", "image_raw/compressed", "truth/compressed"] {
        assert_eq!(of(&format!("/cameras/left/{topic}")).len(), 5, "{topic}");
    }
    let holds = |bytes: &[u8], text: &[u8]| bytes.windows(text.len()).any(|window| window == text);
    assert!(of("/cameras/left/image_raw/compressed").iter().zip(&rgb).all(|(message, png)| holds(&message.data, png)));
    let [mounting] = of("/tf_static")[..] else { panic!("one message") };
    assert!(holds(&mounting.data, b"camera_optical_frame") && holds(&mounting.data, b"cameras/left_optical_frame"));

    assert_eq!(export("--format coco", "coco"), (0, String::new()));
    assert!(drawn(&at("coco/cameras/left/images")) == rgb);
    let table = |name: &str| json(&at("coco").join(name));
    let (driver, front, left) =
        (table("panoptic.json"), table("cameras/front/panoptic.json"), table("cameras/left/panoptic.json"));
    assert!(driver["annotations"] == front["annotations"] && left["annotations"] != front["annotations"]);
    assert_eq!((&left["images"][0]["width"], &left["info"]["aeye"]["camera"]), (&48.into(), &"left".into()));

    assert_eq!(export("--sensor k1=-0.05", "a.json"), (0, String::new()));
    let labels = json(&at("a.json"))["openlabel"].clone();
    let systems = &labels["coordinate_systems"];
    assert_eq!(systems["ego"]["children"], serde_json::json!(["camera", "cameras/front", "cameras/left"]));
    assert!((systems["cameras/left"]["pose_wrt_parent"]["translation"][1].as_f64().unwrap() - 0.5).abs() < 1e-6);
    let k1 = |name: &str| {
        let pinhole = &labels["streams"][name]["stream_properties"]["intrinsics_pinhole"];
        pinhole["distortion_coeffs"][0].as_f64().unwrap() as f32
    };
    assert_eq!(["camera", "cameras/front", "cameras/left"].map(k1), [-0.05, -0.05, -0.1]);

    // What is there of other cameras is not kept.
    rig(dir.path(), &[("right", "")]);
    assert_eq!(export("--format mcap", "seen.mcap"), (0, String::new()));
    assert!(messages::<CompressedImage>(&fs::read(at("seen.mcap")).unwrap(), "/cameras/left/rgb").is_empty());
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn windows_of_cameras_that_are_no_more_go() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let (out, file) = (dir.path().join("out"), rig(dir.path(), &[("left", LEFT), ("right", "yaw_rad = -1.57")]));
    let alone = "rerender --checkpoint truth --size 64x32 --quality plain --last 0.2s";
    let command = format!("{alone} --cameras {}", file.display());
    let draw = |command: &str| assert_eq!(aeye(command, &[&case], &out), (0, String::new()));
    draw(&command);
    let home = out.join("a.case/cameras");
    let written = |name: &str| {
        let pictures = contents(&home.join(name)).into_keys();
        pictures.map(|path| fs::metadata(home.join(name).join(path)).unwrap().modified().unwrap()).collect::<Vec<_>>()
    };
    let before = written("front");
    assert!(before.len() == 4 && home.join("right/rgb").is_dir());
    rig(dir.path(), &[("left", "")]);
    draw(&command);
    assert!(!home.join("right").exists() && !out.join(".rerender/a.case/cameras/right.json").exists());
    assert_eq!(written("front"), before, "what is the same is kept");
    let whole = contents(&out);
    draw(alone);
    assert!(contents(&out) == whole, "without cameras nothing is said of them");
    fs::remove_dir_all(&out).unwrap();
    draw(&command);
    assert!(contents(&out) == whole, "as if there had been no others");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn files_of_cameras_that_cannot_be_are_refused_in_one_sentence() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let file = dir.path().join("rig.toml");
    let camera = |name: &str, more: &str| format!("[[cameras]]\nname = \"{name}\"\nx_m = 1\nz_m = 1\n{more}\n");
    let commands = ["export", "export --format coco", "dataset cases", "rerender --checkpoint truth"];
    for (text, words) in [
        (camera("../../climbs", ""), "cannot be a file's"),
        (camera("a", "") + &camera("a", ""), "two cameras are named \"a\""),
        (camera("a", "") + &camera("A", ""), "two cameras are named \"A\""),
        (camera("a", "yaw_rad = nan"), "camera a: yaw_rad is NaN"),
        (camera("a", "sensor = \"k1=-0.9\""), "camera a: a lens of k1=-0.9 folds the picture"),
        (camera("a", "quality = \"fine\"\nwidth = 6000"), "camera a: fine pictures of 6000x"),
        ("cameras = []".into(), "0 cameras; expected 1 to 32"),
        (String::new(), "missing field `cameras`"),
        ("\u{0}".into(), "rig.toml"),
    ] {
        fs::write(&file, text).unwrap();
        let there = contents(dir.path());
        for command in commands {
            let command = format!("{command} --cameras {}", file.display());
            let (code, said) = aeye(&command, &[&case], &dir.path().join("out"));
            assert!(code == 2 && said.contains(words) && !said.contains('\n'), "{command}: {code}, {said:?}");
            assert!(contents(dir.path()) == there, "{command}: something was left");
        }
    }
    fs::write(&file, camera("a", "")).unwrap();
    for (format, code) in [("gif", 2), ("osi", 2), ("openscenario", 2)] {
        let command = format!("export --format {format} --cameras {}", file.display());
        let said = aeye(&command, &[&case], &dir.path().join("out"));
        let words =
            format!("{format} holds no pictures of several cameras; --cameras is for mcap, coco, openlabel, ros2");
        assert_eq!(said, (code, words));
    }
    fs::write(&file, camera("a b", "") + &camera("a_b", "")).unwrap();
    let (code, said) =
        aeye(&format!("export --format ros2 --cameras {}", file.display()), &[&case], &dir.path().join("out"));
    assert!(code == 2 && said.contains("would both have topics of \"a_b\""), "{said}");
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_report_is_drawn_as_the_drive_was() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let page = |case: &Path| report::render(&[case.to_owned()], &[], Some((64, 32)), None).unwrap().html;
    let mut log = Recording::open(&case).unwrap().into_log();
    let mut with = |camera: &str| {
        log.manifest.provenance.insert("camera".to_owned(), camera.to_owned());
        fs::write(&case, log.encode().unwrap()).unwrap();
        page(&case)
    };
    let [plain, noisy] = ["driver 64x32 plain", "driver 64x32 plain noise=9"].map(&mut with);
    let pictures = |html: &str| -> Vec<String> {
        let parts = html.split("data:image/png;base64,").skip(1);
        parts.map(|part| part.split('"').next().unwrap_or_default().to_owned()).collect()
    };
    let (plain, noisy) = (pictures(&plain), pictures(&noisy));
    assert_eq!((plain.len(), noisy.len()), (60, 60));
    let same = plain.iter().zip(&noisy).filter(|(a, b)| a == b).count();
    assert_eq!(same, 30, "the ground truth alone is the same");
}

//! A bag of ROS 2 holds what the world holds, at its time, and is made again byte for byte.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use glam::DVec3;
use kernel::time::Tick;
use replay::{Recording, Replayer, nanoseconds};
use tests::command::aeye;
use tests::files::contents;
use tests::recordings::{TAKEOVER, recorded};

const OPTIONS: &str = "export --format ros2 --size 64x32 --last 1s --checkpoint truth";

/// Messages by topic: their times and bytes.
type Topics = BTreeMap<String, Vec<(u64, Vec<u8>)>>;

fn topics(bag: &Path) -> Topics {
    let bytes = fs::read(bag.join("bag_0.mcap")).unwrap();
    assert!(bytes[8..].windows(4).take(64).any(|word| word == b"ros2"), "the profile");
    assert!(mcap::Summary::read(&bytes).unwrap().is_some(), "no index");
    let mut topics = Topics::new();
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        let schema = message.channel.schema.as_ref().expect("a schema");
        assert_eq!((schema.encoding.as_str(), message.channel.message_encoding.as_str()), ("ros2msg", "cdr"));
        assert!(schema.name.contains("/msg/") && !schema.data.is_empty(), "{}", schema.name);
        assert!(message.channel.metadata["offered_qos_profiles"].contains("durability: "));
        assert_eq!(message.data[..4], [0, 1, 0, 0], "{}", schema.name);
        topics.entry(message.channel.topic.clone()).or_default().push((message.log_time, message.data[4..].to_vec()));
    }
    topics
}

fn times(messages: &[(u64, Vec<u8>)]) -> Vec<u64> {
    messages.iter().map(|(time, _)| *time).collect()
}

/// Three numbers of a message from a byte on.
fn vector(message: &[u8], from: usize) -> DVec3 {
    let number = |at: usize| f64::from_le_bytes(message[at..at + 8].try_into().unwrap());
    DVec3::new(number(from), number(from + 8), number(from + 16))
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_bag_holds_every_tick_picture_and_event_at_its_time() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let bag = dir.path().join("bag");
    assert_eq!(aeye(OPTIONS, &[&case], &bag), (0, String::new()));
    let (topics, log) = (topics(&bag), Recording::open(&case).unwrap().into_log());
    let nanos = |ticks: &mut dyn Iterator<Item = Tick>| ticks.map(nanoseconds).collect::<Vec<_>>();
    let window = TAKEOVER - 59..=TAKEOVER;
    for topic in ["/clock", "/tf", "/odom"] {
        assert_eq!(times(&topics[topic]), nanos(&mut window.clone()), "{topic}");
    }
    let pictures = nanos(&mut window.clone().filter(|tick| (TAKEOVER - tick).is_multiple_of(6)));
    let masks = ["/camera/truth/compressed", "/camera/predicted/truth/compressed"];
    for topic in ["/actors", "/camera/camera_info", "/camera/image_raw/compressed"].iter().chain(&masks) {
        assert_eq!(times(&topics[*topic]), pictures, "{topic}");
    }
    assert!(topics[masks[0]] == topics[masks[1]], "the truth is what is predicted");
    for topic in ["/tf_static", "/camera/label_info"] {
        assert_eq!(times(&topics[topic]), [nanoseconds(*window.start())], "{topic}");
    }
    let happened = log.events.iter().map(|(tick, _)| *tick).filter(|tick| window.contains(tick));
    assert_eq!(times(&topics["/events"]), nanos(&mut happened.into_iter()));
    let said = |text: &str| topics["/events"].iter().any(|(_, m)| m.windows(text.len()).any(|w| w == text.as_bytes()));
    assert!(said("intervention at") && said("a <test>"));

    let mut replayer = Replayer::new(&log, log.manifest.network().unwrap()).unwrap();
    for (tick, (_, odometry)) in window.zip(&topics["/odom"]) {
        replayer.seek(tick).unwrap();
        let ego = replayer.world().scene().ego;
        // Behind a stamp and the frames `map` and `base_link`; then a rotation, 36 covariances, and the velocities.
        let (place, linear_mps) = (vector(odometry, 32), vector(odometry, 32 + 24 + 32 + 288));
        assert_eq!((place, linear_mps.x), (ego.position.as_dvec3(), f64::from(ego.speed_mps)), "tick {tick}");
        assert!(linear_mps.y.abs() < 0.5 && linear_mps.z.abs() < 0.5, "tick {tick}: {linear_mps}");
    }
    let metadata = fs::read_to_string(bag.join("metadata.yaml")).unwrap();
    let messages: usize = topics.values().map(Vec::len).sum();
    let duration_ns = nanoseconds(TAKEOVER) - nanoseconds(TAKEOVER - 59);
    for line in [
        format!("\n  message_count: {messages}\n"),
        format!("\n  duration:\n    nanoseconds: {duration_ns}\n"),
        "\n        name: /odom\n        type: nav_msgs/msg/Odometry\n".to_owned(),
    ] {
        assert!(metadata.contains(&line), "{line:?} in {metadata}");
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn it_is_made_again_or_kept_and_takes_nobodys_place() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, case) = recorded(dir.path());
    let at = |name: &str| dir.path().join(name);
    for name in ["first", "second"] {
        assert_eq!(aeye(OPTIONS, &[&case], &at(name)), (0, String::new()));
    }
    assert!(contents(&at("first")) == contents(&at("second")));
    let written = || fs::metadata(at("first/metadata.yaml")).unwrap().modified().unwrap();
    let before = written();
    assert_eq!((aeye(OPTIONS, &[&case], &at("first")).0, written()), (0, before));
    assert_eq!(aeye(OPTIONS, &[&recording, &case], &at("both")), (0, String::new()));
    assert!(at("both/a/metadata.yaml").is_file() && at("both/a.case/metadata.yaml").is_file());
    fs::create_dir(at("mine")).unwrap();
    fs::write(at("mine/metadata.yaml"), "mine").unwrap();
    let there = contents(dir.path());
    for (options, out, words) in [
        (OPTIONS, "mine", "mine: exists already; expected a new or an empty folder"),
        ("export --format ros2 --last 2s", "first", "first: exists already; expected a new or an empty folder"),
        (OPTIONS, "new.mcap", "new.mcap: ros2 writes a folder"),
        ("export --format ros2 --camera chase", "new", "--camera is for moving pictures"),
        ("export --format ros2 --from 3s --to 2s", "new", "nothing of that window"),
    ] {
        let (code, said) = aeye(options, &[&case], &at(out));
        assert!(code != 0 && said.contains(words) && !said.contains('\n'), "{options} {out}: {code}, {said:?}");
        assert!(contents(dir.path()) == there, "{options} {out}: something was left or changed");
    }
}

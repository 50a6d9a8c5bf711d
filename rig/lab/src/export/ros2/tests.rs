//! What is encoded is what the definitions say.

use base::maps::Map;
use foxglove::messages::Log as Line;
use kernel::World;
use kernel::scene::SceneSnapshot;
use render::Camera;

use super::definitions::{self, fields, made_of};
use super::messages::{Clock, Message, Time};
use super::motion::Twist;
use super::token::token;
use super::{check_names, tell};
use crate::cameras::Named;

/// Reads a message by its definition alone.
struct Walk<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Walk<'_> {
    fn number(&mut self, bytes: usize) -> u64 {
        self.at = self.at.next_multiple_of(bytes);
        let number = self.bytes[self.at..self.at + bytes].iter().rev().fold(0, |n, byte| n << 8 | u64::from(*byte));
        self.at += bytes;
        number
    }

    fn text(&mut self) -> String {
        let length = self.number(4) as usize;
        let text = &self.bytes[self.at..self.at + length];
        assert_eq!(text.last(), Some(&0), "a text ends with a zero");
        self.at += length;
        String::from_utf8(text[..length - 1].to_vec()).expect("UTF-8")
    }

    /// Every number and text of a message of a type, in words.
    fn message(&mut self, name: &str, told: &mut Vec<String>) {
        let known: Vec<_> = fields(name).collect();
        assert!(!known.is_empty(), "{name} has no definition");
        for (of_field, field) in known {
            let (part, count) = match of_field.trim_end_matches(']').split_once('[') {
                None => (of_field, 1),
                Some((part, "")) => (part, self.number(4)),
                Some((part, count)) => (part, count.parse().expect("a number")),
            };
            for _ in 0..count {
                let said = match part {
                    "bool" | "uint8" => self.number(1).to_string(),
                    "uint16" => self.number(2).to_string(),
                    "int32" | "uint32" => self.number(4).to_string(),
                    "float32" => f32::from_bits(self.number(4) as u32).to_string(),
                    "float64" => f64::from_bits(self.number(8)).to_string(),
                    "string" => self.text(),
                    _ => {
                        self.message(&made_of(name, part).expect("a part with a definition"), told);
                        continue;
                    }
                };
                told.push(format!("{field} {said}"));
            }
        }
    }
}

/// Reads a message to its end.
fn read<M: Message>(message: &M) -> Vec<String> {
    let bytes = message.encode().expect("encoded");
    assert_eq!(bytes[..4], [0, 1, 0, 0]);
    let (mut walk, mut told) = (Walk { bytes: &bytes[4..], at: 0 }, Vec::new());
    walk.message(&M::TYPE.replace("/msg/", "/"), &mut told);
    assert_eq!(walk.at, bytes.len() - 4, "{} is longer or shorter than its definition", M::TYPE);
    told
}

fn city() -> SceneSnapshot {
    let map = Map::find("city").expect("bundled");
    World::new(&map.scenario(1), &map.network).expect("a world").scene()
}

#[test]
fn every_message_has_the_fields_of_its_definition() {
    let (scene, camera) = (city(), Camera::driver(64, 32));
    let (twist, line) = (Twist::default(), Line { level: 4, message: "collision".into(), ..Line::default() });
    assert_eq!(read(&Clock { clock: Time::of(1_500_000_007) }), ["sec 1", "nanosec 500000007"]);
    assert_eq!(read(&tell::ego(&scene.ego, 7))[1..4], ["nanosec 7", "frame_id map", "child_frame_id base_link"]);
    assert_eq!(read(&tell::mounting([(tell::OPTICAL_FRAME, &camera)], 0))[3], "child_frame_id camera_optical_frame");
    let odometry = read(&tell::odometry(&scene.ego, &twist, 0));
    assert_eq!(
        (odometry.len(), odometry[4].as_str()),
        (4 + 7 + 36 + 6 + 36, &*format!("x {}", f64::from(scene.ego.position.x)))
    );
    let info = read(&tell::camera_info(&camera, tell::OPTICAL_FRAME, 0));
    assert_eq!(
        (info[3..6].join(", "), info[11].as_str()),
        ("height 32, width 64, distortion_model plumb_bob".into(), "k 32")
    );
    assert_eq!(read(&tell::picture(vec![1, 2, 255], "a", 0))[4..], ["data 1", "data 2", "data 255"]);
    assert_eq!(read(&tell::mask(vec![], "a", 0))[3], "format mono8; png compressed mono8");
    assert_eq!(read(&tell::labels(0))[11..13], ["class_id 4", "class_name Pedestrian"]);
    let markers = read(&tell::markers(&scene));
    let of = |what: &str| markers.iter().filter(|told| *told == what).count();
    assert_eq!((of("action 3"), of("type 1"), of("ns ego")), (1, 1 + scene.actors.len(), 1));
    let happening = read(&tell::happening(line, 0));
    assert_eq!(happening[2..5], ["level 40", "name ", "msg collision"]);
}

#[test]
fn a_definition_comes_with_all_that_it_is_made_of() {
    let text = definitions::whole("nav_msgs/msg/Odometry");
    assert!(text.contains("\ngeometry_msgs/PoseWithCovariance pose\n"), "{text}");
    for part in ["std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/Vector3", "geometry_msgs/Quaternion"] {
        assert_eq!(text.matches(&format!("\nMSG: {part}\n")).count(), 1, "{part} in {text}");
    }
}

#[test]
fn a_checkpoint_is_a_part_of_a_topic() {
    assert_eq!(["early", "v1.2-b", "3rd"].map(token), ["early", "v1_2_b", "n3rd"]);
}

#[test]
fn cameras_of_one_topic_are_refused() {
    let named = |name: &str| Named { name: name.into(), camera: Camera::driver(64, 32) };
    assert!(check_names(&["left", "left_2", "camera"].map(named)).is_ok());
    let said = check_names(&["a-b", "c", "a_b"].map(named)).expect_err("one topic").to_string();
    assert_eq!(said, "cameras \"a-b\" and \"a_b\" would both have topics of \"a_b\"; expected other names");
}

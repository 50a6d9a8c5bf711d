//! Clients of every kind, friendly or not.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::time::Duration;

use base::image::Image;
use base::maps::Map;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use foxglove::messages::{CompressedImage, FrameTransforms, Log, SceneUpdate};
use foxglove::prost_types::{FileDescriptorProto, FileDescriptorSet};
use prost::Message as _;
use serde_json::{Value, json};
use tungstenite::client::ClientRequestBuilder;
use tungstenite::{Message, WebSocket, client};

use super::channels::Channel;
use super::*;
use crate::feed::View;

/// What the tests read of `/telemetry`.
#[derive(Clone, PartialEq, prost::Message)]
struct Telemetry {
    #[prost(uint64, tag = "1")]
    tick: u64,
    #[prost(double, tag = "2")]
    speed_mps: f64,
    #[prost(double, tag = "4")]
    odometer_m: f64,
    #[prost(string, tag = "5")]
    phase: String,
    #[prost(string, tag = "6")]
    steering_by: String,
    #[prost(double, tag = "8")]
    steer: f64,
}

/// All of `/rig`.
#[derive(Clone, PartialEq, prost::Message)]
struct Rig {
    #[prost(uint32, tag = "1")]
    run: u32,
    #[prost(uint64, tag = "2")]
    tick: u64,
    #[prost(double, tag = "3")]
    late_ms: f64,
    #[prost(double, tag = "4")]
    slowed_ms: f64,
}

/// No wait of these tests is longer.
const PATIENCE: Duration = Duration::from_secs(60);

struct Client(WebSocket<TcpStream>);

impl Client {
    fn connect(at: SocketAddr) -> Self {
        let stream = TcpStream::connect(at).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let request = ClientRequestBuilder::new(format!("ws://{at}").parse().unwrap());
        let (socket, response) = client(request.with_sub_protocol("foxglove.websocket.v1"), stream).unwrap();
        assert_eq!(response.headers()["Sec-WebSocket-Protocol"], "foxglove.websocket.v1");
        Self(socket)
    }

    /// Connects, and lets the server say what it has.
    fn greeted(at: SocketAddr) -> Self {
        let mut client = Self::connect(at);
        assert_eq!([client.words(), client.words()].map(|w| w["op"].clone()), ["serverInfo", "advertise"]);
        client
    }

    fn words(&mut self) -> Value {
        serde_json::from_str(self.0.read().unwrap().to_text().unwrap()).unwrap()
    }

    fn subscribe(&mut self, channels: &[Channel]) {
        let wishes = channels.iter().map(|c| json!({ "id": 10 + c.id(), "channelId": c.id() }));
        let words = json!({ "op": "subscribe", "subscriptions": wishes.collect::<Vec<_>>() });
        self.0.send(Message::text(words.to_string())).unwrap();
    }

    /// The next message of a channel: its channel, time and payload.
    fn message(&mut self) -> (Channel, u64, Vec<u8>) {
        loop {
            let Message::Binary(bytes) = self.0.read().unwrap() else { continue };
            assert_eq!(bytes[0], 1, "message data");
            let subscription = u32::from_le_bytes(bytes[1..5].try_into().unwrap());
            let time_ns = u64::from_le_bytes(bytes[5..13].try_into().unwrap());
            let channel = Channel::ALL.into_iter().find(|c| 10 + c.id() == subscription).unwrap();
            return (channel, time_ns, bytes[13..].to_vec());
        }
    }
}

fn here(at: &str) -> Endpoint {
    Endpoint { at: address(at).unwrap(), origins: vec!["http://rig.lab:8080".into()] }
}

/// A drive that is shown tick by tick.
struct Drive {
    world: World,
    publisher: Publisher,
}

impl Drive {
    fn start() -> Self {
        let map = Map::find("rural").unwrap();
        let world = World::new(&map.scenario(1), &map.network).unwrap();
        Self { world, publisher: Publisher::bind(here("0")).unwrap() }
    }

    fn at(&self) -> SocketAddr {
        self.publisher._server.address()
    }

    fn tick(&mut self) {
        self.world.step(&Default::default());
        self.publisher.show(&self.world);
    }

    fn show_views(&self) {
        let image = Arc::new(Image { width: 2, height: 1, rgb: vec![1, 2, 3, 4, 5, 6] });
        for slot in [&self.publisher.feed.safety, &self.publisher.feed.semantic] {
            let image = image.clone();
            slot.put(View { run: 1, tick: 0, image, mask: None, captured_us: 0, ready_us: 0 });
        }
    }
}

/// The files of a channel's schema.
fn files_of(offer: &Value) -> Vec<FileDescriptorProto> {
    assert_eq!((&offer["encoding"], &offer["schemaEncoding"]), (&json!("protobuf"), &json!("protobuf")));
    let schema = STANDARD.decode(offer["schema"].as_str().unwrap()).unwrap();
    FileDescriptorSet::decode(schema.as_slice()).unwrap().file
}

/// Numbers and names of the fields of the message that a channel's schema names.
fn fields_of(offer: &Value) -> Vec<(i32, String)> {
    let files = files_of(offer);
    let (package, name) = offer["schemaName"].as_str().unwrap().split_once('.').unwrap();
    let mut messages = files.iter().filter(|file| file.package() == package).flat_map(|file| &file.message_type);
    let message = messages.find(|message| message.name() == name).expect("the schema describes its message");
    message.field.iter().map(|field| (field.number(), field.name().to_owned())).collect()
}

/// Whether a message is of its channel's type and tells something.
fn tells(channel: Channel, payload: &[u8]) -> bool {
    match channel {
        Channel::Transforms => {
            let frames = FrameTransforms::decode(payload).unwrap().transforms;
            let names: Vec<_> =
                frames.iter().map(|f| (f.parent_frame_id.as_str(), f.child_frame_id.as_str())).collect();
            names.starts_with(&[("map", "ego"), ("ego", "camera")]) && names[2..].iter().all(|(of, _)| *of == "map")
        }
        Channel::Actors => {
            let SceneUpdate { deletions, entities } = SceneUpdate::decode(payload).unwrap();
            deletions.len() == 1 && entities[0].id == "ego" && entities.iter().all(|entity| entity.cubes.len() == 1)
        }
        Channel::Telemetry => {
            let told = Telemetry::decode(payload).unwrap();
            let known = told.speed_mps.is_finite() && told.odometer_m.is_finite();
            known && !told.phase.is_empty() && told.steering_by == "semantic" && told.steer.is_nan()
        }
        Channel::Rig => {
            let told = Rig::decode(payload).unwrap();
            told.run == 1 && told.tick > 0 && (told.late_ms, told.slowed_ms) == (0.0, 0.0)
        }
        Channel::Events => Log::decode(payload).unwrap().message.contains(" s  "),
        Channel::SafetyCamera | Channel::SemanticCamera => {
            let picture = CompressedImage::decode(payload).unwrap();
            picture.format == "png" && picture.data.starts_with(b"\x89PNG\r\n\x1a\n")
        }
    }
}

#[test]
fn every_channel_is_offered_and_gives_messages_whose_time_grows() {
    let mut drive = Drive::start();
    let mut client = Client::connect(drive.at());
    assert_eq!(client.words()["op"], "serverInfo");
    let offered = client.words();
    let channels = offered["channels"].as_array().unwrap();
    assert_eq!((offered["op"].as_str(), channels.len()), (Some("advertise"), Channel::ALL.len()));
    assert!(channels.iter().all(|channel| !fields_of(channel).is_empty()));
    client.subscribe(&Channel::ALL);
    drive.show_views();
    let (mut last_ns, mut ticks, mut seen) = (0, Vec::new(), Vec::new());
    while ticks.len() < 5 || seen.len() < Channel::ALL.len() {
        (0..40).for_each(|_| drive.tick());
        let (channel, time_ns, payload) = client.message();
        assert!(time_ns >= last_ns && time_ns > 1_600_000_000_000_000_000, "{time_ns} after {last_ns}");
        last_ns = time_ns;
        assert!(tells(channel, &payload), "{channel:?}");
        if channel == Channel::Telemetry {
            ticks.push(Telemetry::decode(payload.as_slice()).unwrap().tick);
        }
        if !seen.contains(&channel) {
            seen.push(channel);
        }
    }
    assert!(ticks.is_sorted_by(|a, b| a < b), "{ticks:?}");
}

#[test]
fn channels_have_the_names_of_files_and_schemas_name_what_is_sent() {
    let offers: Value = serde_json::from_str(&protocol::advertise()).unwrap();
    let offers = offers["channels"].as_array().unwrap();
    let named: Vec<_> = offers.iter().map(|o| [&o["topic"], &o["schemaName"]].map(|w| w.as_str().unwrap())).collect();
    let expected = [
        ["/tf", "foxglove.FrameTransforms"],
        ["/actors", "foxglove.SceneUpdate"],
        ["/telemetry", "telemetry.Telemetry"],
        ["/rig", "rig.Rig"],
        ["/events", "foxglove.Log"],
        ["/camera/safety", "foxglove.CompressedImage"],
        ["/camera/semantic", "foxglove.CompressedImage"],
    ];
    assert_eq!(named, expected);
    let of = |channel: Channel| fields_of(&offers[channel as usize]);
    let told = [(1, "tick"), (2, "speed_mps"), (4, "odometer_m"), (5, "phase"), (6, "steering_by"), (8, "steer")];
    assert!(told.iter().all(|(tag, name)| of(Channel::Telemetry).contains(&(*tag, (*name).into()))));
    assert_eq!(of(Channel::Telemetry).len(), 17);
    let rig = [(1, "run"), (2, "tick"), (3, "late_ms"), (4, "slowed_ms")].map(|(tag, name)| (tag, name.to_owned()));
    assert_eq!(of(Channel::Rig), rig);
}

#[test]
fn what_was_unsubscribed_or_said_wrongly_sends_nothing() {
    let mut drive = Drive::start();
    drive.tick();
    let mut client = Client::greeted(drive.at());
    client.subscribe(&[Channel::Telemetry]);
    assert_eq!(client.message().0, Channel::Telemetry);
    client.0.send(Message::text("{]")).unwrap();
    assert_eq!(client.words()["op"], "status");
    let words = json!({ "op": "unsubscribe", "subscriptionIds": [10 + Channel::Telemetry.id()] });
    client.0.send(Message::text(words.to_string())).unwrap();
    client.subscribe(&[Channel::Transforms]);
    loop {
        drive.tick();
        let (channel, ..) = client.message();
        if channel == Channel::Transforms {
            break;
        }
    }
    drive.tick();
    assert_eq!(client.message().0, Channel::Transforms);
}

#[test]
fn hostile_clients_are_dropped_and_do_no_harm() {
    let mut drive = Drive::start();
    let mut friend = Client::greeted(drive.at());
    friend.subscribe(&[Channel::Telemetry]);

    let mut noise = TcpStream::connect(drive.at()).unwrap();
    noise.set_read_timeout(Some(PATIENCE)).unwrap();
    noise.write_all(&[0xA5; 4096]).unwrap();
    // The server may end the connection before or after it has read all.
    assert!(noise.read(&mut [0; 512]).is_ok_and(|n| n < 512) || noise.write_all(&[0]).is_err());

    let mut giant = Client::greeted(drive.at());
    let _ = giant.0.send(Message::text("x".repeat(1 << 20)));
    assert!(std::iter::repeat_with(|| giant.0.read()).take(100).any(|read| read.is_err()));

    let mut flood = Client::greeted(drive.at());
    let said = std::iter::repeat_with(|| flood.0.send(Message::text("{\"op\":\"x\"}"))).take(2_000_000);
    assert!(said.into_iter().any(|said| said.is_err()), "the flood was never stopped");

    let stranger = TcpStream::connect(drive.at()).unwrap();
    assert!(client(format!("ws://{}", drive.at()), stranger).is_err(), "it speaks no subprotocol of Foxglove");

    let _silent: Vec<TcpStream> = (0..20).map(|_| TcpStream::connect(drive.at()).unwrap()).collect();
    for _ in 0..3 {
        drive.tick();
        assert_eq!(friend.message().0, Channel::Telemetry);
    }
}

#[test]
fn a_port_that_is_taken_is_said_in_one_sentence() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let at = taken.local_addr().unwrap();
    let error = Publisher::bind(here(&at.to_string())).err().expect("taken");
    let said = base::failure::sentence(&error);
    assert!(said.starts_with(&format!("--foxglove {at}: expected an address")) && said.contains("in use"), "{said}");
}

/// Status and reason with which a page, and whoever asks for another host, is answered.
fn answer(at: SocketAddr, header: &str) -> (String, String) {
    let mut stream = TcpStream::connect(at).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let request = format!(
        "GET / HTTP/1.1\r\n{header}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
         Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n"
    );
    stream.write_all(request.as_bytes()).unwrap();
    let (mut answer, mut some) = (String::new(), [0; 512]);
    let ends = ["look on", "asked for", "more than one", "serverInfo"];
    while !ends.iter().any(|end| answer.contains(end)) {
        let n = stream.read(&mut some).unwrap();
        assert!(n > 0, "{answer}");
        answer.push_str(&String::from_utf8_lossy(&some[..n]));
    }
    (answer[9..12].into(), answer)
}

#[test]
fn pages_of_strangers_are_refused_with_a_reason() {
    let drive = Drive::start();
    let host = format!("Host: {}", drive.at());
    let with = |origin: &str| answer(drive.at(), &format!("{host}\r\nOrigin: {origin}"));
    let (status, said) = with("https://evil.example");
    assert!(status == "403" && said.contains("--foxglove-origin https://evil.example"), "{said}");
    for origin in ["http://rig.lab:8080", "http://localhost:8080", "https://app.foxglove.dev"] {
        assert_eq!(with(origin).0, "101", "{origin}");
    }
    assert_eq!(with("http://localhost\r\nOrigin: https://evil.example").0, "403");
    assert_eq!(answer(drive.at(), "Host: evil.example").0, "403");
}

/// Sends a byte now and then until the connection is ended from the other side.
fn dribble(mut stream: TcpStream, bytes: Vec<u8>) {
    stream.set_nonblocking(true).unwrap();
    for byte in bytes.into_iter().cycle() {
        let gone = matches!(stream.read(&mut [0; 512]), Ok(0)) || stream.write_all(&[byte]).is_err();
        if gone {
            return;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
}

#[test]
fn who_dribbles_locks_nobody_out() {
    let mut drive = Drive::start();
    let at = drive.at();
    // Half of them never finish to shake hands, the others never finish to say what they want.
    let header = b"GET / HTTP/1.1\r\nX: ";
    let mut dribblers: Vec<_> = (0..8).map(|_| (TcpStream::connect(at).unwrap(), header.to_vec())).collect();
    for _ in 0..8 {
        let idle = Client::greeted(at).0.get_ref().try_clone().unwrap();
        dribblers.push((idle, vec![0x81, 0xFE, 0x10, 0]));
    }
    let dribblers = dribblers.into_iter().map(|(stream, bytes)| std::thread::spawn(|| dribble(stream, bytes)));
    let dribblers: Vec<_> = dribblers.collect();
    let mut ninth = Client::greeted(at);
    ninth.subscribe(&[Channel::Telemetry]);
    for _ in 0..3 {
        drive.tick();
        assert_eq!(ninth.message().0, Channel::Telemetry);
    }
    drop(drive);
    assert!(dribblers.into_iter().all(|dribbler| dribbler.join().is_ok()));
}

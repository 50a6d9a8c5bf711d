//! Clients of every kind, friendly or not.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::time::Duration;

use base::image::Image;
use base::maps::Map;
use serde_json::{Value, json};
use tungstenite::client::ClientRequestBuilder;
use tungstenite::{Message, WebSocket, client};

use super::topics::Topic;
use super::*;
use crate::feed::View;

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

    fn subscribe(&mut self, topics: &[Topic]) {
        let wishes = topics.iter().map(|t| json!({ "id": 10 + t.channel(), "channelId": t.channel() }));
        let words = json!({ "op": "subscribe", "subscriptions": wishes.collect::<Vec<_>>() });
        self.0.send(Message::text(words.to_string())).unwrap();
    }

    /// The next message of a channel: its topic, time and payload.
    fn message(&mut self) -> (Topic, u64, Value) {
        loop {
            let Message::Binary(bytes) = self.0.read().unwrap() else { continue };
            assert_eq!(bytes[0], 1, "message data");
            let subscription = u32::from_le_bytes(bytes[1..5].try_into().unwrap());
            let time_ns = u64::from_le_bytes(bytes[5..13].try_into().unwrap());
            let topic = Topic::ALL.into_iter().find(|t| 10 + t.channel() == subscription).unwrap();
            return (topic, time_ns, serde_json::from_slice(&bytes[13..]).unwrap());
        }
    }
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
        Self { world, publisher: Publisher::bind(address("0").unwrap()).unwrap() }
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

#[test]
fn every_channel_is_offered_and_gives_messages_whose_time_grows() {
    let mut drive = Drive::start();
    let mut client = Client::connect(drive.at());
    assert_eq!(client.words()["op"], "serverInfo");
    let offered = client.words();
    let channels = offered["channels"].as_array().unwrap();
    assert_eq!((offered["op"].as_str(), channels.len()), (Some("advertise"), Topic::ALL.len()));
    for channel in channels {
        let schema: Value = serde_json::from_str(channel["schema"].as_str().unwrap()).unwrap();
        assert_eq!((&channel["encoding"], &schema["type"]), (&json!("json"), &json!("object")));
    }
    client.subscribe(&Topic::ALL);
    drive.show_views();
    let (mut last_ns, mut ticks, mut topics) = (0, Vec::new(), Vec::new());
    while ticks.len() < 5 || topics.len() < Topic::ALL.len() {
        (0..40).for_each(|_| drive.tick());
        let (topic, time_ns, payload) = client.message();
        assert!(time_ns >= last_ns && time_ns > 1_600_000_000_000_000_000, "{time_ns} after {last_ns}");
        last_ns = time_ns;
        match topic {
            Topic::Telemetry => ticks.push(payload["tick"].as_u64().unwrap()),
            Topic::Events => assert!(payload["message"].as_str().unwrap().contains(" s  ")),
            Topic::SafetyCamera => assert!(payload["data"].as_str().unwrap().starts_with("iVBORw0KGgo")),
            _ => {}
        }
        if !topics.contains(&topic) {
            topics.push(topic);
        }
    }
    assert!(ticks.is_sorted_by(|a, b| a < b), "{ticks:?}");
}

#[test]
fn what_was_unsubscribed_or_said_wrongly_sends_nothing() {
    let mut drive = Drive::start();
    drive.tick();
    let mut client = Client::greeted(drive.at());
    client.subscribe(&[Topic::Telemetry]);
    assert_eq!(client.message().0, Topic::Telemetry);
    client.0.send(Message::text("{]")).unwrap();
    assert_eq!(client.words()["op"], "status");
    client.0.send(Message::text(r#"{"op":"unsubscribe","subscriptionIds":[13]}"#)).unwrap();
    client.subscribe(&[Topic::Transform]);
    loop {
        drive.tick();
        let (topic, ..) = client.message();
        if topic == Topic::Transform {
            break;
        }
    }
    drive.tick();
    assert_eq!(client.message().0, Topic::Transform);
}

#[test]
fn hostile_clients_are_dropped_and_do_no_harm() {
    let mut drive = Drive::start();
    let mut friend = Client::greeted(drive.at());
    friend.subscribe(&[Topic::Telemetry]);

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
        assert_eq!(friend.message().0, Topic::Telemetry);
    }
}

#[test]
fn a_port_that_is_taken_is_said_in_one_sentence() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let at = taken.local_addr().unwrap();
    let error = Publisher::bind(at).err().expect("taken");
    let said = base::failure::sentence(&error);
    assert!(said.starts_with(&format!("--foxglove {at}: expected an address")) && said.contains("in use"), "{said}");
}

#[test]
fn addresses_are_of_this_machine_unless_said_otherwise() {
    assert_eq!(address("8765"), Ok("127.0.0.1:8765".parse().unwrap()));
    assert_eq!(address("[::1]:80"), Ok("[::1]:80".parse().unwrap()));
    assert!(address("all:80").is_err() && address("70000").is_err() && address("").is_err());
}

//! A remote control centre looks on while the program drives.

use std::io::{BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpStream};
use std::process::{Command, Stdio};
use std::time::Duration;

use prost::Message as _;
use serde_json::{Value, json};
use tungstenite::client::ClientRequestBuilder;
use tungstenite::{Message, client};

const ADDRESS: &str = "Foxglove: ws://";
/// Nothing takes this long; without it a test that waits in vain would never end.
const PATIENCE: Duration = Duration::from_secs(240);

/// What the test reads of `/telemetry`.
#[derive(Clone, PartialEq, prost::Message)]
struct Telemetry {
    #[prost(uint64, tag = "1")]
    tick: u64,
    #[prost(double, optional, tag = "2")]
    speed_mps: Option<f64>,
    #[prost(string, optional, tag = "5")]
    phase: Option<String>,
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_drive_is_seen_from_afar_while_strangers_do_no_harm() {
    let dir = tempfile::tempdir().expect("a folder");
    let mut drive = Command::new(env!("CARGO_BIN_EXE_aeye"))
        .current_dir(dir.path())
        .args("drive --headless --map rural --checkpoint truth --max-time 60s --foxglove 0 --record a.mcap".split(' '))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("aeye starts");
    let mut said = BufReader::new(drive.stderr.take().expect("piped")).lines().map_while(Result::ok);
    let address = said.find_map(|line| line.strip_prefix(ADDRESS)?.parse().ok()).expect("an address");
    // What it says has to be read on, or it would wait for us.
    let listener = std::thread::spawn(move || said.count());

    let noise = [TcpStream::connect(address).expect("reachable"), TcpStream::connect(address).expect("reachable")];
    (&noise[0]).write_all(&[0xA5; 2048]).expect("taken");
    let stuck = (0..8).map(|_| TcpStream::connect(address).expect("reachable"));
    let stuck: Vec<_> =
        stuck.inspect(|mut stream| stream.write_all(b"GET / HTTP/1.1\r\nX: ").expect("taken")).collect();
    let page = ClientRequestBuilder::new(format!("ws://{address}").parse().expect("an address"));
    let page = page.with_sub_protocol("foxglove.sdk.v1").with_header("Origin", "https://elsewhere.example");
    assert!(client(page, TcpStream::connect(address).expect("reachable")).is_err(), "a page of a stranger");
    let ticks = look_on(address);
    assert!(ticks.is_sorted_by(|a, b| a < b), "{ticks:?}");
    assert!(drive.wait().expect("it ends").success());
    assert!(listener.join().is_ok());
    drop(stuck);
    let verified = Command::new(env!("CARGO_BIN_EXE_aeye")).arg("verify").arg(dir.path().join("a.mcap")).status();
    assert!(verified.expect("aeye runs").success());
}

/// Ticks of the messages that a client gets, whose times must grow.
fn look_on(address: SocketAddr) -> Vec<u64> {
    let stream = TcpStream::connect(address).expect("reachable");
    stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
    let request = ClientRequestBuilder::new(format!("ws://{address}").parse().expect("an address"));
    let (mut socket, _) = client(request.with_sub_protocol("foxglove.sdk.v1"), stream).expect("a handshake");
    let channel = loop {
        let words: Value = serde_json::from_str(socket.read().expect("words").to_text().expect("text")).expect("JSON");
        let mut channels = words["channels"].as_array().into_iter().flatten();
        if let Some(channel) = channels.find(|c| c["topic"] == "/telemetry") {
            assert_eq!([&channel["encoding"], &channel["schemaName"]], ["protobuf", "telemetry.Telemetry"]);
            break channel["id"].as_u64().expect("a number");
        }
    };
    let words = json!({ "op": "subscribe", "subscriptions": [{ "id": 1, "channelId": channel }] });
    socket.send(Message::text(words.to_string())).expect("sent");
    let (mut ticks, mut last_ns) = (Vec::new(), 0);
    while ticks.len() < 5 {
        let message = socket.read().expect("a message");
        let Message::Binary(bytes) = message else { continue };
        let time_ns = u64::from_le_bytes(bytes[5..13].try_into().expect("8 bytes"));
        assert!(bytes[..5] == [1, 1, 0, 0, 0] && time_ns > last_ns, "{time_ns} after {last_ns}");
        last_ns = time_ns;
        let telemetry = Telemetry::decode(&bytes[13..]).expect("telemetry");
        assert!(telemetry.speed_mps.is_some_and(f64::is_finite) && telemetry.phase.is_some(), "{telemetry:?}");
        ticks.push(telemetry.tick);
    }
    ticks
}

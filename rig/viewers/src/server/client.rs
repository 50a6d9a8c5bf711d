//! One client: what it subscribes to, and the newest of that, again and again. The only file that
//! names tungstenite.

use std::io::ErrorKind;
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use base::clock::SessionClock;
use serde_json::Value;
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::{HeaderValue, StatusCode};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket, accept_hdr_with_config};

use super::images::Images;
use super::protocol::{self, Subscriptions};
use super::topics::{self, Topic};
use crate::feed::{Feed, Look, View};
use crate::telemetry::Telemetry;

const SUBPROTOCOL: &str = "Sec-WebSocket-Protocol";
/// Longest silence of a client that is still shaking hands, and longest wait for one that does not read.
const PATIENCE: Duration = Duration::from_secs(2);
/// Everything but pictures is sent at most so often, and pictures at most so often, microseconds.
const PERIOD_US: u64 = 50_000;
const PICTURE_PERIOD_US: u64 = 200_000;
/// A client that says more than this in a period floods us.
const MOST_WORDS: u32 = 100;
/// Longest message of a client, bytes; a subscription has about 100.
const LONGEST_BYTES: usize = 16 << 10;

/// What clients are told of.
pub struct Source {
    /// The newest of everything.
    pub feed: Arc<Feed>,
    /// The session's time.
    pub clock: SessionClock,
    /// Pictures that are encoded: the safety driver's and the semantic driver's.
    pub images: Images,
    /// Whether the server ends.
    pub is_over: Arc<AtomicBool>,
}

impl Source {
    /// Whether the server ends.
    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }
}

/// What a client has already, so that nothing is sent twice.
#[derive(Default)]
struct Sent {
    at_us: u64,
    pictures_at_us: u64,
    look: Option<Arc<Look>>,
    telemetry: Option<Arc<Telemetry>>,
    events: u64,
    views: [Option<Arc<View>>; 2],
}

/// Serves a client until it goes, misbehaves, or the server ends. Whatever goes wrong concerns the
/// client alone.
pub fn serve(stream: TcpStream, source: &Source) {
    let _ = talk(stream, source);
}

fn talk(stream: TcpStream, source: &Source) -> Result<(), Box<Error>> {
    stream.set_nodelay(true).map_err(boxed)?;
    stream.set_read_timeout(Some(PATIENCE)).map_err(boxed)?;
    stream.set_write_timeout(Some(PATIENCE)).map_err(boxed)?;
    let config = WebSocketConfig::default()
        .read_buffer_size(LONGEST_BYTES)
        .max_message_size(Some(LONGEST_BYTES))
        .max_frame_size(Some(LONGEST_BYTES));
    let Ok(mut socket) = accept_hdr_with_config(stream, choose, Some(config)) else { return Ok(()) };
    socket.get_ref().set_read_timeout(Some(Duration::from_micros(PERIOD_US))).map_err(boxed)?;
    say(&mut socket, protocol::server_info(&source.clock.unix_ns(0).to_string()))?;
    say(&mut socket, protocol::advertise())?;

    let (mut subscriptions, mut sent, mut words) = (Subscriptions::default(), Sent::default(), 0);
    while !source.is_over() {
        match socket.read() {
            Ok(Message::Text(text)) => {
                words += 1;
                if let Err(wrong) = subscriptions.hear(&text) {
                    say(&mut socket, protocol::warning(&wrong))?;
                }
            }
            Ok(Message::Close(_)) => return Ok(()),
            Ok(_) => words += 1,
            Err(Error::Io(error)) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Err(error) => return Err(Box::new(error)),
        }
        let now_us = source.clock.now_us();
        if now_us >= sent.at_us + PERIOD_US {
            (sent.at_us, words) = (now_us, 0);
            for (subscription, payload) in news(source, &subscriptions, &mut sent, now_us) {
                let message = protocol::message(subscription, source.clock.unix_ns(now_us), &payload.to_string());
                socket.send(Message::binary(message)).map_err(Box::new)?;
            }
        }
        if words > MOST_WORDS {
            return Ok(());
        }
    }
    Ok(())
}

fn boxed(error: std::io::Error) -> Box<Error> {
    Box::new(Error::Io(error))
}

fn say(socket: &mut WebSocket<TcpStream>, words: String) -> Result<(), Box<Error>> {
    socket.send(Message::text(words)).map_err(Box::new)
}

/// Chooses the subprotocol, or refuses.
#[expect(clippy::result_large_err, reason = "the signature is tungstenite's")]
fn choose(request: &Request, mut response: Response) -> Result<Response, ErrorResponse> {
    let offered = request.headers().get_all(SUBPROTOCOL).into_iter().filter_map(|value| value.to_str().ok());
    match offered.filter_map(protocol::subprotocol).next() {
        Some(chosen) => {
            response.headers_mut().insert(SUBPROTOCOL, HeaderValue::from_static(chosen));
            Ok(response)
        }
        None => {
            let mut refusal = ErrorResponse::new(Some("expected a subprotocol of Foxglove\n".into()));
            *refusal.status_mut() = StatusCode::BAD_REQUEST;
            Err(refusal)
        }
    }
}

/// What is new in the feed and subscribed.
fn news(source: &Source, subscriptions: &Subscriptions, sent: &mut Sent, now_us: u64) -> Vec<(u32, Value)> {
    let Source { feed, clock, images, .. } = source;
    let mut news = Vec::new();
    let mut add = |topic, payload: &dyn Fn() -> Value| {
        news.extend(subscriptions.of(topic).map(|subscription| (subscription, payload())));
    };
    let wants = |topics: &[Topic]| topics.iter().any(|topic| subscriptions.of(*topic).is_some());
    let look = feed.scene.get().filter(|_| wants(&[Topic::Transform, Topic::Scene]));
    if let Some(look) = newer(look, &mut sent.look) {
        let time_ns = clock.unix_ns(look.captured_us);
        add(Topic::Transform, &|| topics::transform(&look.scene, time_ns));
        add(Topic::Scene, &|| topics::scene(&look.scene, time_ns));
    }
    let time_ns = clock.unix_ns(now_us);
    let telemetry = feed.telemetry.get().filter(|_| wants(&[Topic::Telemetry, Topic::Events]));
    if let Some(telemetry) = newer(telemetry, &mut sent.telemetry) {
        add(Topic::Telemetry, &|| topics::telemetry(&telemetry, time_ns));
        if wants(&[Topic::Events]) {
            telemetry.events.since(sent.events).for_each(|text| add(Topic::Events, &|| topics::event(text, time_ns)));
            sent.events = telemetry.events.end();
        }
    }
    if now_us >= sent.pictures_at_us + PICTURE_PERIOD_US {
        sent.pictures_at_us = now_us;
        let cameras = [(Topic::SafetyCamera, &feed.safety), (Topic::SemanticCamera, &feed.semantic)];
        for (i, (topic, view)) in cameras.into_iter().enumerate() {
            let view = newer(view.get().filter(|_| wants(&[topic])), &mut sent.views[i]);
            if let Some((view, png)) = view.and_then(|view| images[i].png(&view).map(|png| (view, png))) {
                add(topic, &|| topics::image(&png, clock.unix_ns(view.captured_us)));
            }
        }
    }
    news
}

/// The value, unless it was sent already.
fn newer<T>(value: Option<Arc<T>>, sent: &mut Option<Arc<T>>) -> Option<Arc<T>> {
    let value = value.filter(|value| sent.as_ref().is_none_or(|sent| !Arc::ptr_eq(sent, value)))?;
    *sent = Some(value.clone());
    Some(value)
}

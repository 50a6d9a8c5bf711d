//! One client: what it subscribes to, and the newest of that, again and again.

use std::io::ErrorKind;
use std::net::TcpStream;
use std::sync::Arc;
use std::time::Duration;

use base::say::say;
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::header::{HOST, HeaderName, ORIGIN};
use tungstenite::http::{HeaderValue, StatusCode};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket, accept_hdr_with_config};

use super::news::{Sent, Source, news};
use super::places::{Arrival, Guest};
use super::protocol::{self, Subscriptions};
use super::timed::Timed;

const SUBPROTOCOL: &str = "Sec-WebSocket-Protocol";
/// A handshake that lasts longer is ended, and so is a client that takes longer to take what is sent at a time.
const PATIENCE: Duration = Duration::from_secs(2);
/// News are sent at most so often, microseconds.
const PERIOD_US: u64 = 50_000;
/// A client that says more than this in a period floods us.
const MOST_WORDS: u32 = 100;
/// Longest message of a client, bytes; a subscription has about 100.
const LONGEST_BYTES: usize = 16 << 10;

/// Serves a client until it goes, misbehaves, has to make room, or the server ends. Whatever goes wrong
/// concerns the client alone.
pub fn serve(stream: TcpStream, arrival: Arrival, source: &Source) {
    if let Some((socket, guest)) = shake_hands(stream, source) {
        drop(arrival);
        let _ = talk(socket, &guest, source);
    }
}

fn shake_hands(stream: TcpStream, source: &Source) -> Option<(WebSocket<Timed>, Arc<Guest>)> {
    stream.set_nodelay(true).ok()?;
    let config = WebSocketConfig::default()
        .read_buffer_size(LONGEST_BYTES)
        .max_message_size(Some(LONGEST_BYTES))
        .max_frame_size(Some(LONGEST_BYTES));
    let mut guest = None;
    #[expect(clippy::result_large_err, reason = "the signature is tungstenite's")]
    let answer = |request: &Request, response: Response| {
        let response = choose(request, response, source)?;
        guest = Some(source.places.seat().ok_or_else(|| refusal(StatusCode::SERVICE_UNAVAILABLE, "too many look on"))?);
        Ok(response)
    };
    let socket = accept_hdr_with_config(Timed::new(stream, PATIENCE), answer, Some(config)).ok()?;
    Some((socket, guest?))
}

fn talk(mut socket: WebSocket<Timed>, guest: &Guest, source: &Source) -> Result<(), Box<Error>> {
    tell(&mut socket, protocol::server_info(&source.clock.unix_ns(0).to_string()))?;
    tell(&mut socket, protocol::advertise())?;

    let (mut subscriptions, mut sent) = (Subscriptions::default(), Sent::default());
    let (mut sent_us, mut words) = (0, 0);
    while !source.is_over() && !guest.is_sent_away() && words <= MOST_WORDS {
        socket.get_mut().allow(Duration::from_micros(PERIOD_US));
        match socket.read() {
            Ok(Message::Text(text)) => {
                words += 1;
                let heard = subscriptions.hear(&text);
                guest.set_looks_on(subscriptions.any());
                if let Err(wrong) = heard {
                    tell(&mut socket, protocol::warning(&wrong))?;
                }
            }
            Ok(Message::Close(_)) => return Ok(()),
            Ok(_) => words += 1,
            Err(Error::Io(error)) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
            Err(error) => return Err(Box::new(error)),
        }
        let now_us = source.clock.now_us();
        if now_us >= sent_us + PERIOD_US {
            (sent_us, words) = (now_us, 0);
            socket.get_mut().allow(PATIENCE);
            for (subscription, payload) in news(source, &subscriptions, &mut sent, now_us) {
                let message = protocol::message(subscription, source.clock.unix_ns(now_us), &payload);
                socket.send(Message::binary(message)).map_err(Box::new)?;
            }
        }
    }
    Ok(())
}

fn tell(socket: &mut WebSocket<Timed>, words: String) -> Result<(), Box<Error>> {
    socket.get_mut().allow(PATIENCE);
    socket.send(Message::text(words)).map_err(Box::new)
}

/// Chooses the subprotocol, or refuses.
#[expect(clippy::result_large_err, reason = "the signature is tungstenite's")]
fn choose(request: &Request, mut response: Response, source: &Source) -> Result<Response, ErrorResponse> {
    if let Some(reason) = unwelcome(request, source) {
        source.refused.call_once(|| say(format_args!("Foxglove: {reason}")));
        return Err(refusal(StatusCode::FORBIDDEN, &reason));
    }
    let offered = request.headers().get_all(SUBPROTOCOL).into_iter().filter_map(|value| value.to_str().ok());
    let chosen = offered.filter_map(protocol::subprotocol).next();
    let chosen = chosen.ok_or_else(|| refusal(StatusCode::BAD_REQUEST, "expected a subprotocol of Foxglove"))?;
    response.headers_mut().insert(SUBPROTOCOL, HeaderValue::from_static(chosen));
    Ok(response)
}

/// Why whoever asks may not look on. Browsers send each of the headers at most once.
fn unwelcome(request: &Request, source: &Source) -> Option<String> {
    let all = |name: HeaderName| request.headers().get_all(name).into_iter().map(HeaderValue::as_bytes);
    if all(HOST).count().max(all(ORIGIN).count()) > 1 {
        return Some("it names more than one host or origin".into());
    }
    source.endpoint.refusal(all(HOST).next(), all(ORIGIN).next())
}

fn refusal(status: StatusCode, reason: &str) -> ErrorResponse {
    let mut refusal = ErrorResponse::new(Some(format!("{reason}\n")));
    *refusal.status_mut() = status;
    refusal
}

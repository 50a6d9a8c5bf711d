//! One client: what it subscribes to, and the newest of that, again and again. The only file that
//! names tungstenite.

use std::io::ErrorKind;
use std::net::TcpStream;
use std::time::Duration;

use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::{HeaderValue, StatusCode};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{Error, Message, WebSocket, accept_hdr_with_config};

use super::news::{Sent, Source, news};
use super::protocol::{self, Subscriptions};

const SUBPROTOCOL: &str = "Sec-WebSocket-Protocol";
/// Longest silence of a client that is still shaking hands, and longest wait for one that does not read.
const PATIENCE: Duration = Duration::from_secs(2);
/// News are sent at most so often, microseconds.
const PERIOD_US: u64 = 50_000;
/// A client that says more than this in a period floods us.
const MOST_WORDS: u32 = 100;
/// Longest message of a client, bytes; a subscription has about 100.
const LONGEST_BYTES: usize = 16 << 10;

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

    let (mut subscriptions, mut sent) = (Subscriptions::default(), Sent::default());
    let (mut sent_us, mut words) = (0, 0);
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
        if now_us >= sent_us + PERIOD_US {
            (sent_us, words) = (now_us, 0);
            for (subscription, payload) in news(source, &subscriptions, &mut sent, now_us) {
                let message = protocol::message(subscription, source.clock.unix_ns(now_us), &payload);
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

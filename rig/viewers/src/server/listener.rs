//! Takes clients.

use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use anyhow::Context;
use base::clock::SessionClock;
use base::say::say;

use super::access::Endpoint;
use super::client;
use super::news::Source;
use crate::feed::Feed;

/// Longest wait for a connection to ourselves.
const WAKE_UP: Duration = Duration::from_millis(200);

/// A server that runs until it is dropped.
pub struct Server {
    address: SocketAddr,
    is_over: Arc<AtomicBool>,
}

impl Server {
    /// Serves what is in a feed at an address, and says where; port 0 takes one that is free.
    pub fn bind(endpoint: Endpoint, feed: Arc<Feed>, clock: SessionClock) -> anyhow::Result<Self> {
        let at = endpoint.at;
        let named = || format!("--foxglove {at}: expected an address of this machine and a port that is free");
        let listener = TcpListener::bind(at).with_context(named)?;
        let address = listener.local_addr().with_context(named)?;
        let is_over = Arc::new(AtomicBool::new(false));
        let source = Arc::new(Source::new(endpoint, feed, clock, is_over.clone()));
        std::thread::spawn(move || accept(&listener, &source));
        say(format_args!("Foxglove: ws://{address}"));
        Ok(Self { address, is_over })
    }

    /// Where it is.
    #[cfg(test)]
    pub fn address(&self) -> SocketAddr {
        self.address
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        // Wakes the thread that accepts; if it cannot be reached it ends with the program.
        let _ = TcpStream::connect_timeout(&self.address, WAKE_UP);
    }
}

fn accept(listener: &TcpListener, source: &Arc<Source>) {
    for stream in listener.incoming() {
        if source.is_over() {
            return;
        }
        // A client that has gone away again is no matter.
        let Ok(stream) = stream else { continue };
        match source.places.arrive() {
            Some(arrival) => {
                let source = source.clone();
                std::thread::spawn(move || client::serve(stream, arrival, &source));
            }
            None => {
                let _ = stream.shutdown(Shutdown::Both);
            }
        }
    }
}

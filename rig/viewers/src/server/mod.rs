//! A drive for remote control centres: poses, figures, events and both drivers' pictures over
//! Foxglove's WebSocket protocol. Clients only read.
//!
//! Each client has a thread of its own that looks at the feed from time to time, so that a slow or
//! hostile one delays nobody but itself.

mod channels;
mod client;
mod images;
mod listener;
mod news;
mod protocol;
#[cfg(test)]
mod tests;

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::Arc;

use base::clock::SessionClock;
use base::words;
use kernel::World;

use crate::events::Events;
use crate::feed::{Feed, Look};
use crate::figures::TickFigures;
pub use listener::Server;

/// `PORT` of this machine alone, or `ADDRESS:PORT`.
pub fn address(text: &str) -> Result<SocketAddr, String> {
    let loopback = |port| SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), port);
    let port = text.parse::<u16>().ok().map(loopback);
    port.or_else(|| text.parse().ok())
        .ok_or_else(|| "expected PORT, as in 8765, or ADDRESS:PORT, as in 0.0.0.0:8765 or [::1]:8765".into())
}

/// Publishes a drive without windows.
pub struct Publisher {
    feed: Arc<Feed>,
    clock: SessionClock,
    events: Events,
    _server: Server,
}

impl Publisher {
    /// Serves at an address.
    pub fn bind(at: SocketAddr) -> anyhow::Result<Self> {
        let (feed, clock) = (Arc::new(Feed::default()), SessionClock::starting_now());
        let server = Server::bind(at, feed.clone(), clock)?;
        Ok(Self { feed, clock, events: Events::default(), _server: server })
    }

    /// Shows the world at its last tick.
    pub fn show(&mut self, world: &World) {
        world.last_events().iter().for_each(|event| self.events.push(words::event_at(world.tick(), event)));
        self.feed.scene.put(Look { run: 1, scene: world.scene(), captured_us: self.clock.now_us() });
        self.feed.figures.put(TickFigures { events: self.events.clone(), ..TickFigures::of_world(world, 1) });
    }
}

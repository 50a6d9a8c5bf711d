//! A drive for remote control centres: poses, figures, events and both drivers' pictures over
//! Foxglove's WebSocket protocol. Clients only read.
//!
//! Each client has a thread of its own that looks at the feed from time to time, so that a slow or
//! hostile one delays nobody but itself; pages of strangers are refused.

mod access;
mod channels;
mod client;
mod images;
mod listener;
mod news;
mod places;
mod protocol;
#[cfg(test)]
mod tests;
mod timed;

use std::sync::Arc;

use base::clock::SessionClock;
use base::words;
use kernel::World;

use crate::events::Events;
use crate::feed::{Feed, Look};
use crate::figures::TickFigures;
pub use access::{Endpoint, address, origin};
pub use listener::Server;

/// Publishes a drive without windows.
pub struct Publisher {
    feed: Arc<Feed>,
    clock: SessionClock,
    events: Events,
    _server: Server,
}

impl Publisher {
    /// Serves at an endpoint.
    pub fn bind(endpoint: Endpoint) -> anyhow::Result<Self> {
        let (feed, clock) = (Arc::new(Feed::default()), SessionClock::starting_now());
        let server = Server::bind(endpoint, feed.clone(), clock)?;
        Ok(Self { feed, clock, events: Events::default(), _server: server })
    }

    /// Shows the world at its last tick.
    pub fn show(&mut self, world: &World) {
        world.last_events().iter().for_each(|event| self.events.push(words::event_at(world.tick(), event)));
        let (network, captured_us) = (world.network().clone(), self.clock.now_us());
        self.feed.scene.put(Look { run: 1, network, eye: 0, scene: world.scene(), captured_us });
        self.feed.figures.put(TickFigures { events: self.events.clone(), ..TickFigures::of_world(world, 1) });
    }
}

//! What is new in the feed for a client, as messages of the channels that it subscribed to.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Once};

use base::clock::SessionClock;
use foxglove::Encode;
use render::Camera;

use super::access::Endpoint;
use super::channels::Channel;
use super::images::Images;
use super::places::Places;
use super::protocol::Subscriptions;
use crate::feed::{Feed, Look, View};
use crate::figures::TickFigures;
use crate::messages::actors::actors;
use crate::messages::camera::CAMERA;
use crate::messages::poses::transforms;
use crate::messages::report;
use crate::messages::rig::Rig;
use crate::messages::telemetry::Telemetry;

/// Pictures are sent at most so often, microseconds.
const PICTURE_PERIOD_US: u64 = 200_000;

/// What clients are told of, and who may be one.
pub struct Source {
    /// Where they come to, and which.
    pub endpoint: Endpoint,
    /// How many there are.
    pub places: Places,
    /// Told of the first that was refused, so that a page that stays empty has a reason.
    pub refused: Once,
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
    /// A source for a server's clients.
    pub fn new(endpoint: Endpoint, feed: Arc<Feed>, clock: SessionClock, is_over: Arc<AtomicBool>) -> Self {
        let (places, refused, images) = (Places::default(), Once::new(), Images::default());
        Self { endpoint, places, refused, feed, clock, images, is_over }
    }

    /// Whether the server ends.
    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }
}

/// What a client has already, so that nothing is sent twice.
#[derive(Default)]
pub struct Sent {
    pictures_at_us: u64,
    look: Option<Arc<Look>>,
    figures: Option<Arc<TickFigures>>,
    events: u64,
    views: [Option<Arc<View>>; 2],
}

/// Messages for a client, each with the number of its subscription.
struct News<'a> {
    subscriptions: &'a Subscriptions,
    messages: Vec<(u32, Vec<u8>)>,
}

impl News<'_> {
    fn wants(&self, channels: &[Channel]) -> bool {
        channels.iter().any(|channel| self.subscriptions.of(*channel).is_some())
    }

    /// Adds a message, which is made only where it is subscribed.
    fn add<M: Encode>(&mut self, channel: Channel, message: impl FnOnce() -> M) {
        let Some(subscription) = self.subscriptions.of(channel) else { return };
        let mut bytes = Vec::new();
        // A vector has room for every message.
        if message().encode(&mut bytes).is_ok() {
            self.messages.push((subscription, bytes));
        }
    }
}

/// What is new in the feed and subscribed, as bytes with the number of their subscription.
pub fn news(source: &Source, subscriptions: &Subscriptions, sent: &mut Sent, now_us: u64) -> Vec<(u32, Vec<u8>)> {
    let mut news = News { subscriptions, messages: Vec::new() };
    scene(source, sent, &mut news);
    figures(source, sent, source.clock.unix_ns(now_us), &mut news);
    if now_us >= sent.pictures_at_us + PICTURE_PERIOD_US {
        sent.pictures_at_us = now_us;
        pictures(source, sent, &mut news);
    }
    news.messages
}

fn scene(Source { feed, clock, .. }: &Source, sent: &mut Sent, news: &mut News<'_>) {
    let look = feed.scene.get().filter(|_| news.wants(&[Channel::Transforms, Channel::Actors]));
    let Some(look) = newer(look, &mut sent.look) else { return };
    let time_ns = clock.unix_ns(look.captured_us);
    // Where the camera is does not depend on the size of its pictures.
    news.add(Channel::Transforms, || transforms(&look.scene, [(CAMERA, &Camera::driver(1, 1))], time_ns));
    news.add(Channel::Actors, || actors(&look.scene, time_ns));
}

fn figures(Source { feed, .. }: &Source, sent: &mut Sent, time_ns: u64, news: &mut News<'_>) {
    let wanted = [Channel::Telemetry, Channel::Rig, Channel::Events];
    let figures = feed.figures.get().filter(|_| news.wants(&wanted));
    let Some(figures) = newer(figures, &mut sent.figures) else { return };
    news.add(Channel::Telemetry, || Telemetry::of(&figures));
    news.add(Channel::Rig, || Rig::of(&figures));
    if news.wants(&[Channel::Events]) {
        figures.events.since(sent.events).for_each(|text| news.add(Channel::Events, || report::told(text, time_ns)));
        sent.events = figures.events.end();
    }
}

fn pictures(Source { feed, clock, images, .. }: &Source, sent: &mut Sent, news: &mut News<'_>) {
    let cameras = [(Channel::SafetyCamera, &feed.safety), (Channel::SemanticCamera, &feed.semantic)];
    for (i, (channel, view)) in cameras.into_iter().enumerate() {
        let view = newer(view.get().filter(|_| news.wants(&[channel])), &mut sent.views[i]);
        if let Some(message) = view.and_then(|view| images[i].message(&view, clock)) {
            news.add(channel, || message);
        }
    }
}

/// The value, unless it was sent already.
fn newer<T>(value: Option<Arc<T>>, sent: &mut Option<Arc<T>>) -> Option<Arc<T>> {
    let value = value.filter(|value| sent.as_ref().is_none_or(|sent| !Arc::ptr_eq(sent, value)))?;
    *sent = Some(value.clone());
    Some(value)
}

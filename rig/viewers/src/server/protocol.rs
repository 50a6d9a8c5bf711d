//! The words of Foxglove's WebSocket protocol, without any socket.
//!
//! Source: `docs/spec.md` of github.com/foxglove/ws-protocol; of what servers may offer, only channels.

use serde::Deserialize;
use serde_json::json;

use super::channels::Channel;

/// Subprotocols that are spoken: the one of Foxglove's SDK and its predecessor; what is used here is the
/// same in both.
const SUBPROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/// First byte of a message of a channel.
const MESSAGE_DATA: u8 = 1;

/// The subprotocol to speak, of those that a client offers in a header.
pub fn subprotocol(offered: &str) -> Option<&'static str> {
    SUBPROTOCOLS.into_iter().find(|known| offered.split(',').any(|one| one.trim() == *known))
}

/// The first words to a client.
pub fn server_info(session: &str) -> String {
    json!({ "op": "serverInfo", "name": "A-Eye", "capabilities": [], "sessionId": session }).to_string()
}

/// Names every channel.
pub fn advertise() -> String {
    let channels: Vec<_> = Channel::ALL.into_iter().filter_map(Channel::offer).collect();
    json!({ "op": "advertise", "channels": channels }).to_string()
}

/// Tells a client what was wrong with its words.
pub fn warning(words: &str) -> String {
    json!({ "op": "status", "level": 1, "message": words }).to_string()
}

/// A message of a subscription, received at a time, nanoseconds since 1970.
pub fn message(subscription: u32, time_ns: u64, payload: &[u8]) -> Vec<u8> {
    [&[MESSAGE_DATA][..], &subscription.to_le_bytes(), &time_ns.to_le_bytes(), payload].concat()
}

/// What a client asks for; other operations are ignored.
#[derive(Deserialize)]
#[serde(tag = "op", rename_all = "camelCase")]
enum Request {
    Subscribe {
        subscriptions: Vec<Wish>,
    },
    #[serde(rename_all = "camelCase")]
    Unsubscribe {
        subscription_ids: Vec<u32>,
    },
    #[serde(other)]
    Other,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Wish {
    id: u32,
    channel_id: u32,
}

/// A client's subscriptions: its own numbers for channels, one a channel.
#[derive(Debug, Default)]
pub struct Subscriptions(Vec<(u32, Channel)>);

impl Subscriptions {
    /// Obeys a client; gives what was wrong with its words.
    pub fn hear(&mut self, text: &str) -> Result<(), String> {
        match serde_json::from_str(text).map_err(|e| format!("not understood: {e}"))? {
            Request::Subscribe { subscriptions } => subscriptions.iter().try_for_each(|wish| self.subscribe(wish)),
            Request::Unsubscribe { subscription_ids } => {
                self.0.retain(|(id, _)| !subscription_ids.contains(id));
                Ok(())
            }
            Request::Other => Ok(()),
        }
    }

    fn subscribe(&mut self, wish: &Wish) -> Result<(), String> {
        let channel = Channel::ALL.into_iter().find(|channel| channel.id() == wish.channel_id);
        let channel = channel.ok_or_else(|| format!("there is no channel {}", wish.channel_id))?;
        if self.0.iter().any(|(id, had)| *id == wish.id || *had == channel) {
            return Err(format!("subscription {} of {} is there already", wish.id, channel.topic()));
        }
        self.0.push((wish.id, channel));
        Ok(())
    }

    /// Whether there is one.
    pub fn any(&self) -> bool {
        !self.0.is_empty()
    }

    /// The number under which a channel is subscribed.
    pub fn of(&self, channel: Channel) -> Option<u32> {
        self.0.iter().find(|(_, had)| *had == channel).map(|(id, _)| *id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_newer_subprotocol_is_preferred_and_others_are_refused() {
        assert_eq!(subprotocol("foxglove.websocket.v1, foxglove.sdk.v1"), Some("foxglove.sdk.v1"));
        assert_eq!(subprotocol("chat,foxglove.websocket.v1"), Some("foxglove.websocket.v1"));
        assert_eq!(subprotocol("foxglove.websocket.v2"), None);
    }

    #[test]
    fn a_channel_is_subscribed_once_and_given_back() {
        let mut subscriptions = Subscriptions::default();
        let subscribe = r#"{"op":"subscribe","subscriptions":[{"id":7,"channelId":1},{"id":8,"channelId":2}]}"#;
        assert_eq!(subscriptions.hear(subscribe), Ok(()));
        assert_eq!(Channel::ALL.map(|channel| subscriptions.of(channel))[..3], [Some(7), Some(8), None]);
        assert!(subscriptions.hear(subscribe).is_err_and(|e| e.contains("already")));
        assert_eq!(subscriptions.hear(r#"{"op":"unsubscribe","subscriptionIds":[7,99]}"#), Ok(()));
        assert_eq!(subscriptions.of(Channel::ALL[0]), None);
        let unknown = r#"{"op":"subscribe","subscriptions":[{"id":9,"channelId":4000}]}"#;
        assert_eq!(subscriptions.hear(unknown), Err("there is no channel 4000".into()));
        assert_eq!(subscriptions.hear(r#"{"op":"getParameters","parameterNames":[]}"#), Ok(()));
    }

    #[test]
    fn messages_have_the_layout_of_the_specification() {
        assert_eq!(message(0x0102_0304, 5, b"{}"), [1, 4, 3, 2, 1, 5, 0, 0, 0, 0, 0, 0, 0, b'{', b'}']);
    }

    proptest! {
        #[test]
        fn no_words_of_a_client_do_harm(words in prop::collection::vec(".{0,80}", 1..20)) {
            let mut subscriptions = Subscriptions::default();
            for text in words {
                prop_assert!(subscriptions.hear(&text).is_err() || text.contains("op"));
            }
            prop_assert!(subscriptions.0.is_empty());
        }
    }
}

//! What is published: a channel for each topic, whose messages have one type.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use foxglove::messages::{CompressedImage, FrameTransforms, Log, SceneUpdate};
use foxglove::{Encode, Schema};
use serde::Serialize;

use crate::messages::rig::Rig;
use crate::messages::telemetry::Telemetry;
use crate::messages::topics::{ACTORS, EVENTS, RIG, SAFETY, SEMANTIC, TELEMETRY, TRANSFORMS};

/// A channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Where the ego car, its camera and every actor are.
    Transforms,
    /// Every road user as a box.
    Actors,
    /// Speed, controls, who is in control.
    Telemetry,
    /// How the rig keeps up.
    Rig,
    /// What happened.
    Events,
    /// What the safety driver sees.
    SafetyCamera,
    /// What the semantic driver sees.
    SemanticCamera,
}

/// A channel as clients are told of it.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Offer {
    id: u32,
    topic: &'static str,
    encoding: &'static str,
    schema_name: String,
    /// A `FileDescriptorSet` in base 64.
    schema: String,
    schema_encoding: String,
}

impl Channel {
    /// Every channel.
    pub const ALL: [Self; 7] = [
        Self::Transforms,
        Self::Actors,
        Self::Telemetry,
        Self::Rig,
        Self::Events,
        Self::SafetyCamera,
        Self::SemanticCamera,
    ];

    /// Its number.
    pub fn id(self) -> u32 {
        self as u32 + 1
    }

    /// Name of its topic.
    pub fn topic(self) -> &'static str {
        match self {
            Self::Transforms => TRANSFORMS,
            Self::Actors => ACTORS,
            Self::Telemetry => TELEMETRY,
            Self::Rig => RIG,
            Self::Events => EVENTS,
            Self::SafetyCamera => SAFETY,
            Self::SemanticCamera => SEMANTIC,
        }
    }

    /// Layout of its messages; every type of ours has one.
    fn schema(self) -> Option<Schema> {
        match self {
            Self::Transforms => FrameTransforms::get_schema(),
            Self::Actors => SceneUpdate::get_schema(),
            Self::Telemetry => Telemetry::get_schema(),
            Self::Rig => Rig::get_schema(),
            Self::Events => Log::get_schema(),
            Self::SafetyCamera | Self::SemanticCamera => CompressedImage::get_schema(),
        }
    }

    /// What clients are told of it.
    pub fn offer(self) -> Option<Offer> {
        let Schema { name, encoding, data } = self.schema()?;
        let (id, topic, schema) = (self.id(), self.topic(), STANDARD.encode(data));
        Some(Offer { id, topic, encoding: "protobuf", schema_name: name, schema, schema_encoding: encoding })
    }
}

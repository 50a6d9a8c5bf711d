//! `osi_trafficlight.proto` and `osi_trafficsign.proto`.

use prost::{Enumeration, Message};

use super::common::{BaseStationary, Identifier};

/// One lamp of a traffic light.
#[derive(Clone, PartialEq, Message)]
pub struct TrafficLight {
    #[prost(message, required, tag = "1")]
    pub id: Identifier,
    #[prost(message, required, tag = "2")]
    pub base: BaseStationary,
    #[prost(message, required, tag = "3")]
    pub classification: TrafficLightClassification,
}

/// What a lamp shows, and to whom.
#[derive(Clone, PartialEq, Message)]
pub struct TrafficLightClassification {
    #[prost(enumeration = "Color", required, tag = "1")]
    pub color: i32,
    #[prost(enumeration = "Icon", required, tag = "2")]
    pub icon: i32,
    #[prost(enumeration = "Mode", required, tag = "3")]
    pub mode: i32,
    /// The lanes that it holds.
    #[prost(message, repeated, tag = "5")]
    pub assigned_lane_id: Vec<Identifier>,
}

/// A traffic sign.
#[derive(Clone, PartialEq, Message)]
pub struct TrafficSign {
    #[prost(message, required, tag = "1")]
    pub id: Identifier,
    #[prost(message, required, tag = "2")]
    pub main_sign: MainSign,
}

/// Its board.
#[derive(Clone, PartialEq, Message)]
pub struct MainSign {
    #[prost(message, required, tag = "1")]
    pub base: BaseStationary,
    #[prost(message, required, tag = "2")]
    pub classification: MainSignClassification,
}

/// What is on a board.
#[derive(Clone, PartialEq, Message)]
pub struct MainSignClassification {
    #[prost(enumeration = "Variability", required, tag = "1")]
    pub variability: i32,
    #[prost(enumeration = "SignType", required, tag = "2")]
    pub r#type: i32,
    #[prost(message, optional, tag = "3")]
    pub value: Option<SignValue>,
}

/// The number on a board.
#[derive(Clone, PartialEq, Message)]
pub struct SignValue {
    #[prost(double, required, tag = "1")]
    pub value: f64,
    #[prost(enumeration = "Unit", required, tag = "2")]
    pub value_unit: i32,
    #[prost(string, required, tag = "3")]
    pub text: String,
}

/// Colour of a lamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Color {
    Unknown = 0,
    Red = 2,
    Yellow = 3,
    Green = 4,
}

/// Shape of a lamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Icon {
    Unknown = 0,
    None = 2,
}

/// Whether a lamp is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Mode {
    Unknown = 0,
    Off = 2,
    Constant = 3,
}

/// Whether a sign changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Variability {
    Unknown = 0,
    Fixed = 2,
}

/// What a sign says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum SignType {
    Unknown = 0,
    Other = 1,
    GiveWay = 16,
    Stop = 17,
    SpeedLimitBegin = 52,
    BusStop = 137,
}

/// What a number on a sign counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Unit {
    Unknown = 0,
    KilometerPerHour = 3,
    MilePerHour = 4,
}

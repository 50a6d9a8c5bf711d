//! `osi_groundtruth.proto`.

use prost::Message;

use super::common::{Identifier, InterfaceVersion, Timestamp};
use super::environment::EnvironmentalConditions;
use super::lanes::{Lane, LaneBoundary};
use super::objects::{MovingObject, StationaryObject};
use super::signals::{TrafficLight, TrafficSign};

/// The world at one time.
#[derive(Clone, PartialEq, Message)]
pub struct GroundTruth {
    #[prost(message, required, tag = "1")]
    pub version: InterfaceVersion,
    #[prost(message, required, tag = "2")]
    pub timestamp: Timestamp,
    /// The ego car.
    #[prost(message, required, tag = "3")]
    pub host_vehicle_id: Identifier,
    #[prost(message, repeated, tag = "4")]
    pub stationary_object: Vec<StationaryObject>,
    #[prost(message, repeated, tag = "5")]
    pub moving_object: Vec<MovingObject>,
    #[prost(message, repeated, tag = "6")]
    pub traffic_sign: Vec<TrafficSign>,
    #[prost(message, repeated, tag = "7")]
    pub traffic_light: Vec<TrafficLight>,
    #[prost(message, repeated, tag = "9")]
    pub lane_boundary: Vec<LaneBoundary>,
    #[prost(message, repeated, tag = "10")]
    pub lane: Vec<Lane>,
    #[prost(message, required, tag = "12")]
    pub environmental_conditions: EnvironmentalConditions,
    /// Where the coordinates are on the Earth, as PROJ writes it.
    #[prost(string, optional, tag = "14")]
    pub proj_string: Option<String>,
    /// Name of the map's OpenDRIVE file.
    #[prost(string, required, tag = "15")]
    pub map_reference: String,
}

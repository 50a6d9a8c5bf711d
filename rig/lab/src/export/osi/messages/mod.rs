//! What is written of ASAM OSI 3.8: its messages with the fields that have a value here, by their numbers in the standard.
//!
//! A field is `required` where every message has it. On the wire that is the standard's `optional` with a value.

mod common;
mod environment;
mod ground_truth;
mod lanes;
mod objects;
mod signals;

pub use common::{
    BaseMoving, BaseStationary, Dimension3d, Identifier, InterfaceVersion, Orientation3d, Timestamp, Vector3d,
};
pub use environment::{CloudLayer, EnvironmentalConditions, Fog, Precipitation, Sun};
pub use ground_truth::GroundTruth;
pub use lanes::{
    BoundaryKind, BoundaryPoint, Lane, LaneBoundary, LaneBoundaryClassification, LaneClassification, LanePairing,
    LaneSubtype, LaneType,
};
pub use objects::{
    BrakeLight, Indicator, Light, LightState, MovingObject, MovingType, Role, StationaryClassification,
    StationaryObject, StationaryType, VehicleAttributes, VehicleClassification, VehicleType,
};
pub use signals::{
    Color, Icon, MainSign, MainSignClassification, Mode, SignType, SignValue, TrafficLight, TrafficLightClassification,
    TrafficSign, Unit, Variability,
};

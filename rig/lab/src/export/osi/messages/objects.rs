//! `osi_object.proto`.

use prost::{Enumeration, Message};

use super::common::{BaseMoving, BaseStationary, Identifier, Vector3d};

/// What stands there.
#[derive(Clone, PartialEq, Message)]
pub struct StationaryObject {
    #[prost(message, required, tag = "1")]
    pub id: Identifier,
    #[prost(message, required, tag = "2")]
    pub base: BaseStationary,
    #[prost(message, required, tag = "3")]
    pub classification: StationaryClassification,
    /// What it is in the words of this program.
    #[prost(string, required, tag = "4")]
    pub model_reference: String,
}

/// What it is.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct StationaryClassification {
    #[prost(enumeration = "StationaryType", required, tag = "1")]
    pub r#type: i32,
}

/// A road user.
#[derive(Clone, PartialEq, Message)]
pub struct MovingObject {
    #[prost(message, required, tag = "1")]
    pub id: Identifier,
    #[prost(message, required, tag = "2")]
    pub base: BaseMoving,
    #[prost(enumeration = "MovingType", required, tag = "3")]
    pub r#type: i32,
    /// Of vehicles alone.
    #[prost(message, optional, tag = "5")]
    pub vehicle_attributes: Option<VehicleAttributes>,
    /// Of vehicles alone.
    #[prost(message, optional, tag = "6")]
    pub vehicle_classification: Option<VehicleClassification>,
    /// What it is in the words of this program.
    #[prost(string, required, tag = "7")]
    pub model_reference: String,
}

/// Measures of a vehicle, as far as it has any.
#[derive(Clone, PartialEq, Message)]
pub struct VehicleAttributes {
    /// Radius of a wheel, metres.
    #[prost(double, optional, tag = "2")]
    pub radius_wheel: Option<f64>,
    #[prost(uint32, optional, tag = "3")]
    pub number_wheels: Option<u32>,
    /// From the middle of the box to the middle of the rear axle, in the vehicle's axes, metres.
    #[prost(message, optional, tag = "4")]
    pub bbcenter_to_rear: Option<Vector3d>,
    /// The same of the front axle.
    #[prost(message, optional, tag = "5")]
    pub bbcenter_to_front: Option<Vector3d>,
    /// Room between ground and body, metres.
    #[prost(double, optional, tag = "6")]
    pub ground_clearance: Option<f64>,
}

/// Which vehicle it is, and its lamps.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct VehicleClassification {
    #[prost(enumeration = "VehicleType", required, tag = "1")]
    pub r#type: i32,
    #[prost(message, required, tag = "2")]
    pub light_state: LightState,
    #[prost(bool, required, tag = "3")]
    pub has_trailer: bool,
    #[prost(enumeration = "Role", required, tag = "5")]
    pub role: i32,
}

/// The lamps of a vehicle.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct LightState {
    #[prost(enumeration = "Indicator", required, tag = "1")]
    pub indicator_state: i32,
    #[prost(enumeration = "Light", required, tag = "4")]
    pub head_light: i32,
    #[prost(enumeration = "BrakeLight", required, tag = "7")]
    pub brake_light_state: i32,
}

/// What a road user is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum MovingType {
    Unknown = 0,
    Other = 1,
    Vehicle = 2,
    Pedestrian = 3,
}

/// What a vehicle is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum VehicleType {
    Unknown = 0,
    MediumCar = 4,
    DeliveryVan = 6,
    HeavyTruck = 7,
    Motorbike = 10,
    Bicycle = 11,
    Bus = 12,
    Tram = 13,
    Wheelchair = 15,
}

/// What a vehicle is there for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Role {
    Unknown = 0,
    Other = 1,
    Civil = 2,
    PublicTransport = 6,
}

/// What an indicator shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Indicator {
    Unknown = 0,
    Off = 2,
    Left = 3,
    Right = 4,
    Warning = 5,
}

/// Whether a lamp is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum Light {
    Unknown = 0,
    Off = 2,
    On = 3,
}

/// Whether the brake lights are on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum BrakeLight {
    Unknown = 0,
    Off = 2,
    Normal = 3,
}

/// What stands there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum StationaryType {
    Unknown = 0,
    Other = 1,
    Bridge = 2,
    Building = 3,
    Pole = 4,
    Tree = 7,
    Barrier = 8,
    Vegetation = 9,
    Wall = 11,
    OverheadStructure = 14,
    EmittingStructure = 18,
}

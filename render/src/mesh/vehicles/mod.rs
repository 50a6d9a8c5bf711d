//! Vehicles and those in or on them.

pub mod bus;
mod cabin;
pub mod car;
mod car_shape;
mod car_trim;
pub mod emergency;
mod fittings;
#[cfg(test)]
mod fleet_tests;
mod heavy;
pub(crate) mod lacquer;
mod loft;
pub mod lorry;
pub mod motorcycle;
mod occupant;
pub mod tram;
pub mod two_wheeler;
pub mod van;
mod wheel;
pub mod wheeled;

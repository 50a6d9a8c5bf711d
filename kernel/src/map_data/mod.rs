//! A map as plain data, baked once from OpenDRIVE.
//!
//! Coordinates are rounded to 2^-10 m, so that differing libm results vanish; the digest over all
//! of it is part of every recording. Nothing that is derived from it is kept here.

mod bus_stop;
mod circles;
mod data;
mod digest;
mod ids;
mod junction;
mod lane;
mod place;
mod scenery;
mod walkway;

pub use bus_stop::BusStop;
pub(crate) use circles::{Circle, circles};
pub use data::MapData;
pub use ids::{LaneId, LightGroupId, WalkEdgeId};
pub use junction::{Junction, LightGroup, LightHead};
pub(crate) use lane::URBAN_MPS;
pub use lane::{Conflict, Lane, LaneKind, LanePoint, Projection, StopKind, StopLine, Turn};
pub use place::Place;
pub(crate) use scenery::rising;
pub use scenery::{
    FurnitureKind, Prop, PropKind, SIGN_BUS_STOP, SIGN_LIMIT, SIGN_STOP, SIGN_YIELD, Surface, SurfaceKind,
};
pub use walkway::{Crosswalk, WalkEdge, WalkNode};

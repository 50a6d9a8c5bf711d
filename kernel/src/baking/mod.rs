//! OpenDRIVE text to [`MapData`](crate::map_data::MapData): `steps` says in which order.

mod bus_stops;
mod catalogue;
mod crosswalks;
mod dressing;
mod error;
mod junctions;
mod lanes;
mod lights;
mod limits;
mod mesh;
mod pace;
mod priority;
mod programme;
mod props;
mod rounding;
mod shapes;
mod signs;
mod source;
mod speeds;
mod steps;
mod stops;
mod surfaces;
mod terrain;
mod walkways;

pub use error::BakeError;
pub use steps::bake;

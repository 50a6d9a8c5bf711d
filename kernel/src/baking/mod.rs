//! OpenDRIVE text to [`MapData`](crate::map_data::MapData): `steps` says in which order.

mod crosswalks;
mod dressing;
mod error;
mod junctions;
mod lanes;
mod lights;
mod limits;
mod mesh;
mod priority;
mod props;
mod rounding;
mod shapes;
mod signs;
mod source;
mod steps;
mod stops;
mod surfaces;
mod terrain;
mod walkways;

pub use error::BakeError;
pub use steps::bake;

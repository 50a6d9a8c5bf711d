//! OpenDRIVE text to [`MapData`](crate::map_data::MapData): `steps` says in which order.

mod bus_stops;
mod catalogue;
mod crosswalks;
mod dressing;
mod error;
mod flat;
mod gaps;
mod junctions;
mod lanes;
mod lights;
mod limits;
mod marks;
mod materials;
mod mesh;
mod notes;
mod pace;
mod paint;
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
mod structures;
mod surfaces;
mod survey;
mod terrain;
mod told;
mod walkways;
mod warnings;

pub use error::BakeError;
pub use marks::Mark;
pub use notes::{Passed, PassedOver};
#[cfg(test)]
pub(crate) use paint::lines_without_gaps;
pub(crate) use steps::lights_by_id;
pub use steps::{Baked, bake, bake_with_notes};
pub(crate) use survey::Survey;
pub use told::{Control, Told};

//! What is in a map and what was not understood of its file, in figures and as a picture.

mod draw;
mod figures;
mod look;
mod measure;
mod reach;
mod text;

pub use draw::{Drawing, Options, draw};
pub use figures::{Inspected, Junctions, Lanes, Limit, NotUnderstood, Parking, Props, Reach, Relief, Walkways};
pub use look::inspect;

//! The offline lab: pictures, datasets, checkpoints and reports made from recordings.

pub mod demo;
pub mod eval;
pub mod natural;
pub mod rerender;
pub mod train;

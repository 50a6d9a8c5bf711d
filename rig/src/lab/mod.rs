//! The offline lab: pictures, datasets, checkpoints and reports made from recordings.

pub mod cityscapes;
pub mod compare;
pub mod dataset;
pub mod demo;
pub mod eval;
pub mod experiment;
pub mod export;
pub mod figures;
pub mod footage;
pub mod library;
pub mod looks;
pub mod pipeline;
pub mod plot;
pub mod png;
pub mod redrive;
pub mod report;
pub mod rerender;
pub mod spread;
pub mod store;
pub mod train;

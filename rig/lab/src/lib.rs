//! The offline lab: simulated campaigns, and pictures, datasets, checkpoints, comparisons and reports made
//! from recordings. Options come as plain structs, results say themselves as JSON and as text.

pub mod cameras;
pub mod campaign;
pub mod cases;
pub mod cityscapes;
pub mod compare;
pub mod dataset;
pub mod demo;
pub mod eval;
pub mod experiment;
pub mod export;
pub mod figures;
pub mod gallery;
pub mod inspect;
pub mod looks;
pub mod machine;
pub mod map;
pub mod pipeline;
pub mod plot;
pub mod redrive;
pub mod report;
pub mod rerender;
pub mod share;
pub mod shots;
pub mod still;
pub mod store;
pub mod train;
pub mod trust;
pub mod verify;

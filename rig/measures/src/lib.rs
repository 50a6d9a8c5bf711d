//! Figures that follow from a log and its map alone, so that they mean the same for people and bots, live
//! and headless: what drivers do, how critical it was, how often corner cases happen.

pub mod criticality;
pub mod footage;
pub mod human;
pub mod run_figures;
pub mod run_outcome;
pub mod statistics;
pub mod stats;

pub use criticality::Criticality;
pub use human::{Measures, Tally};
pub use run_figures::RunFigures;

//! What a run starts from. Parsed, hence valid.

mod default;
mod fields;
mod hazards;
mod reader;
mod start;
mod text;
mod weather;

pub use crate::car::CarSetup;
pub use crate::traffic::{HazardLevel, HazardRates, TrafficCounts};
pub use fields::{EgoStart, MOST_OF_A_KIND, Rules, Scenario, ScenarioError};
pub use start::{StartError, driving_lanes};

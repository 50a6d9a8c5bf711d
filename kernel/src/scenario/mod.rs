//! What a run starts from. Parsed, hence valid.

mod default;
mod fields;
mod text;

pub use crate::traffic::TrafficCounts;
pub use fields::{EgoStart, MOST_OF_A_KIND, Rules, Scenario, ScenarioError};

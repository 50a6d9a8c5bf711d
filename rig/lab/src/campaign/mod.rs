//! Simulated drives in parallel. Run `i` follows from the campaign's seed and `i` alone, so that the
//! results do not depend on how many worlds run at the same time, or on interruptions.

mod aside;
mod drive;
mod figures;
mod plan;
mod run_line;
mod runner;
#[cfg(test)]
mod tests;
mod until;
mod workers;

pub use drive::{Options, drive, plan};
pub use figures::{CampaignFigures, figures};
pub use plan::Plan;
pub use run_line::RunLine;
pub use until::Until;
pub use workers::drive_all;

//! Simulated drives in parallel. Run `i` follows from the campaign's seed and `i` alone, so that the
//! results do not depend on how many worlds run at the same time, or on interruptions.

mod aside;
mod collect;
mod drive;
mod figures;
mod gather;
mod kept;
mod options;
mod places;
mod plan;
mod run_line;
mod runner;
mod shard;
mod shards;
mod single;
mod sum;
mod task;
#[cfg(test)]
mod tests;
mod until;
mod workers;

pub use collect::{Collection, collect};
pub use drive::{ShardFigures, drive, drive_shard};
pub use figures::{CampaignFigures, figures};
pub use options::{Options, plan};
pub use places::Places;
pub use plan::Plan;
pub use run_line::RunLine;
pub use single::{drive_run, missing_runs};
pub use sum::TooFew;
pub use task::Task;
pub use until::{Goal, Until};
pub use workers::drive_all;

//! Arguments of what reads recordings and corner cases, one by one.

use std::path::PathBuf;

use clap::Args;
use lab::redrive::Need;

use super::library::verdict;
use super::values::{file, jobs};

/// Arguments of `verify`.
#[derive(Args, Clone, Debug)]
pub struct VerifyArgs {
    /// Recordings or cases, or folders with such files anywhere below.
    #[arg(required = true, value_parser = file(), value_name = "FILE|DIR")]
    pub files: Vec<PathBuf>,
    /// Also go back this many ticks again and again and compare, 1 to 600 of them, 60 a second (rollback self-check).
    #[arg(long, value_name = "TICKS", value_parser = clap::value_parser!(u16).range(1..=600))]
    pub rewind: Option<u16>,
    /// Compare with this recording tick by tick, and name the field that differs first.
    #[arg(long, value_name = "FILE")]
    pub against: Option<PathBuf>,
    /// Files checked at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
}

/// Arguments of `inspect`.
#[derive(Args, Clone, Debug)]
pub struct InspectArgs {
    /// Recordings or cases, or folders with such files anywhere below.
    #[arg(required = true, value_parser = file(), value_name = "FILE|DIR")]
    pub files: Vec<PathBuf>,
    /// Tell which checkpoint drove blind drives.
    #[arg(long)]
    pub reveal: bool,
    /// Files read at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
}

/// Arguments of `questionnaire`.
#[derive(Args, Clone, Debug)]
pub struct QuestionnaireArgs {
    /// Recordings; no folders, since answers are of who sat there.
    #[arg(required = true, value_parser = file(), value_name = "RECORDING")]
    pub files: Vec<PathBuf>,
    /// The drivers' answers.
    #[arg(long, value_name = "FILE.toml")]
    pub answers: PathBuf,
}

/// Arguments of `statistics`.
#[derive(Args, Clone, Debug)]
pub struct StatisticsArgs {
    /// Recordings, in the order in which they were driven, or folders with recordings anywhere below. Corner
    /// cases and forks in folders, and drives to get used to the rig, do not count.
    #[arg(required = true, value_parser = file(), value_name = "FILE|DIR")]
    pub files: Vec<PathBuf>,
    /// The checkpoint that rates are compared with (default: that of the first recording).
    #[arg(long, value_name = "NAME")]
    pub reference: Option<String>,
    /// Tell the checkpoints of blind drives; without this they are all one.
    #[arg(long)]
    pub reveal: bool,
    /// Recordings read at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Count only takeovers on which a campaign came to one of these verdicts, which stands beside the recording; others
    /// end their drive without a corner case.
    #[arg(long, value_delimiter = ',', value_parser = verdict(), value_name = "VERDICT,...")]
    pub verdict: Vec<Need>,
}

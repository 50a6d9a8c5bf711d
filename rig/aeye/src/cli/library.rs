//! Arguments of the library of cases.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use drivers::checkpoint::CheckpointChoice;
use lab::cases::conditions::WeatherChoice;
use lab::cases::query::{Caused, Overlooked, Sort, dashed};
use lab::cases::review::{ReviewState, Reviewed, Tag};
use lab::redrive::Need;
use replay::Label;

use super::values::{ModelsArgs, file, jobs};

/// Arguments of `cases`.
#[derive(Args, Clone, Debug)]
#[command(override_usage = "aeye cases <DIR|FILE>... [QUERY] [OPTIONS]")]
pub struct LibraryArgs {
    /// Folders with corner cases anywhere below, of which an index is kept. With files among them, only these cases are
    /// meant.
    #[arg(required = true, value_parser = file(), value_name = "DIR|FILE")]
    pub places: Vec<PathBuf>,
    /// File of the index (default: `cases.sqlite` in the folder); of several folders it must be given.
    #[arg(long, value_name = "FILE")]
    pub index: Option<PathBuf>,
    /// Answer from the index as it is, without a look at the folders.
    #[arg(long)]
    pub no_scan: bool,
    /// Which cases.
    #[command(flatten)]
    pub query: QueryArgs,
    /// Say how many there are, and not which.
    #[arg(long)]
    pub count: bool,
    /// Print nothing but the files, a line each, as other commands take them: `aeye compare @FILE`, or `@-` for stdin.
    #[arg(long, conflicts_with = "count")]
    pub paths: bool,
    /// With `--paths`, end each by a NUL instead of a line's end.
    #[arg(long, requires = "paths")]
    pub null: bool,
    /// Simulate and draw the cases that were not measured before: time to collision, who was overlooked by the drive's
    /// checkpoint and how many pixels of them. What is done stays when it is interrupted.
    #[arg(long)]
    pub measure: bool,
    /// Where the checkpoints of the drives may be found, if they do not come with the program.
    #[arg(long = "recorded-checkpoint", value_delimiter = ',', value_name = "FILE.onnx,...")]
    pub recorded: Vec<CheckpointChoice>,
    /// Whose models the drives showed.
    #[command(flatten)]
    pub models: ModelsArgs,
    /// Say of these cases what came of looking at them: accepted, rejected or unclear.
    #[arg(long, value_name = "STATE")]
    pub set_review: Option<ReviewState>,
    /// Give these cases tags.
    #[arg(long, value_delimiter = ',', value_name = "TAG,...")]
    pub add_tag: Vec<Tag>,
    /// Take tags from these cases.
    #[arg(long, value_delimiter = ',', value_name = "TAG,...")]
    pub remove_tag: Vec<Tag>,
    /// Tell the checkpoints of blind drives.
    #[arg(long)]
    pub reveal: bool,
    /// Files read at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
}

/// Which cases are asked for.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Query (everything holds that is given, of a list one is enough)")]
pub struct QueryArgs {
    /// With these labels: walker, vehicle, rules or boredom.
    #[arg(long, value_delimiter = ',', value_name = "LABEL,...")]
    pub label: Vec<Label>,
    /// With these verdicts on the takeover: necessary, near-miss, early, needless or in-vain.
    #[arg(long, value_delimiter = ',', value_parser = verdict(), value_name = "VERDICT,...")]
    pub verdict: Vec<Need>,
    /// On these maps.
    #[arg(long, value_delimiter = ',', value_name = "NAME,...")]
    pub map: Vec<String>,
    /// In this weather: rain, wet, dry, fog, night, day, or a name as in HardRainNoon.
    #[arg(long, value_delimiter = ',', value_name = "WEATHER,...")]
    pub weather: Vec<WeatherChoice>,
    /// With this level of hazards: none, natural, raised, or own.
    #[arg(long, value_delimiter = ',', value_parser = ["none", "natural", "raised", "own"], value_name = "LEVEL,...")]
    pub hazards: Vec<String>,
    /// Driven through these checkpoints: their names, or 8 or more digits that their digests begin with.
    #[arg(long, value_delimiter = ',', value_name = "NAME|DIGEST,...")]
    pub checkpoint: Vec<String>,
    /// Caused by perception: yes, no or unknown.
    #[arg(long, value_delimiter = ',', value_name = "yes|no|unknown,...")]
    pub perception_caused: Vec<Caused>,
    /// Where somebody of a kind was overlooked, by so many pixels: any, walker, vehicle, or a kind as in `child:200`.
    #[arg(long, value_delimiter = ',', value_name = "KIND[:PIXELS],...")]
    pub overlooked: Vec<Overlooked>,
    /// With a measured time to collision below this, seconds.
    #[arg(long, value_parser = seconds, value_name = "SECONDS")]
    pub ttc_below: Option<f64>,
    /// The same without the takeover, as a campaign has found out.
    #[arg(long, value_parser = seconds, value_name = "SECONDS")]
    pub fork_ttc_below: Option<f64>,
    /// Reviewed: yes, no, accepted, rejected or unclear.
    #[arg(long, value_delimiter = ',', value_name = "yes|no|STATE,...")]
    pub reviewed: Vec<Reviewed>,
    /// With these tags.
    #[arg(long, value_delimiter = ',', value_name = "TAG,...")]
    pub tag: Vec<Tag>,
    /// Whose situation is nearly that of this case.
    #[arg(long, value_name = "FILE")]
    pub near: Option<PathBuf>,
    /// One of each group of cases whose situation is nearly the same.
    #[arg(long)]
    pub unique: bool,
    /// By what they are sorted.
    #[arg(long, default_value = "file", value_parser = sort(), value_name = "KEY")]
    pub sort: Sort,
    /// The greatest first.
    #[arg(long)]
    pub descending: bool,
    /// At most so many.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub limit: Option<u32>,
}

pub(super) fn verdict() -> impl TypedValueParser<Value = Need> {
    let named = |name: String| Need::WITHOUT_INTERVENTION.into_iter().find(|need| dashed(need.name()) == name);
    PossibleValuesParser::new(["necessary", "near-miss", "early", "needless", "in-vain"])
        .try_map(move |name| named(name).ok_or("no such verdict"))
}

fn sort() -> impl TypedValueParser<Value = Sort> {
    PossibleValuesParser::new(Sort::ALL.map(Sort::name)).try_map(|name| name.parse::<Sort>())
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.parse::<f64>().ok().filter(|seconds| *seconds > 0.0 && seconds.is_finite());
    seconds.ok_or_else(|| "expected seconds, more than 0, as in 1.5".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_verdict_on_a_takeover_can_be_asked_for() {
        let parser = verdict();
        for need in Need::WITHOUT_INTERVENTION {
            let name = std::ffi::OsString::from(dashed(need.name()));
            let parsed = parser.parse_ref(&clap::Command::new("cases"), None, &name);
            assert_eq!(parsed.expect("one of the possible values"), need);
        }
    }
}

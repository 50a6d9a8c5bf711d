//! The command line of `aeye`.

mod campaign;
mod lab;
mod learning;
mod library;
mod live;
mod maps;
mod recordings;
mod shell;
mod values;

use clap::{Parser, Subcommand};

pub use campaign::{CampaignArgs, DemoArgs, ExperimentArgs};
pub use lab::{CompareArgs, ExportArgs, GalleryArgs, RedriveArgs, RenderArgs, ReportArgs, RerenderArgs};
pub use learning::{CasesArgs, DatasetCommand, EvalArgs, MixArgs, NaturalArgs, RebuildArgs, TrainArgs};
pub use library::{LibraryArgs, QueryArgs};
pub use live::{
    DoctorArgs, DriveArgs, PictureArgs, ViewArgs, WheelCalibrateArgs, WheelCommand, WheelImportArgs, WheelListArgs,
};
pub use maps::{MapCommand, MapDrawArgs, MapInspectArgs};
pub use recordings::{InspectArgs, QuestionnaireArgs, StatisticsArgs, VerifyArgs};
pub use shell::{CompletionsArgs, ManArgs};
pub use values::ImagingArgs;

/// Drive by the eyes of a network, record every tick, and learn from every takeover.
///
/// Data goes to stdout, progress and errors to stderr. Exit codes: 0 ok, 1 error (unreadable,
/// damaged), 2 usage, 3 a check failed, 75 may go well if it is tried again.
#[derive(Debug, Parser)]
#[command(name = "aeye", version)]
pub struct Cli {
    /// Print JSON on stdout instead of text.
    #[arg(long, global = true)]
    pub json: bool,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// Every command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Drive in windows, or one run without, and record it.
    Drive(Box<DriveArgs>),
    /// Simulated drives, headless, until so many runs, kilometres or corner cases.
    Campaign(CampaignArgs),
    /// Simulate recordings again and compare every tick.
    Verify(VerifyArgs),
    /// Say what is in recordings or cases.
    Inspect(InspectArgs),
    /// How often corner cases happened: kilometres, rates with intervals, ratios.
    Statistics(StatisticsArgs),
    /// Look at a recording or case in a window, tick by tick.
    View(ViewArgs),
    /// Attach answers that were given after a drive.
    Questionnaire(QuestionnaireArgs),
    /// One picture of a moment of a recording, or of a run that is simulated so far.
    Render(RenderArgs),
    /// Pictures of every map at noon, dusk, in rain, fog and at night, with a page that shows them.
    Gallery(GalleryArgs),
    /// Render the window of recordings or cases through checkpoints.
    Rerender(RerenderArgs),
    /// Which corner cases another checkpoint fixes and breaks.
    Compare(CompareArgs),
    /// Drive corner cases on from before the intervention: was it necessary?
    Redrive(RedriveArgs),
    /// Write recordings or cases for others: Foxglove, Lichtblick and Rerun, moving pictures, OpenSCENARIO XML, OSI, COCO, OpenLABEL, ROS 2.
    Export(ExportArgs),
    /// Find corner cases by what is known of them, and say what came of looking at them.
    Cases(Box<LibraryArgs>),
    /// Make datasets.
    #[command(subcommand)]
    Dataset(DatasetCommand),
    /// Train Fast-SCNN from a dataset folder.
    Train(TrainArgs),
    /// Measure a checkpoint on a dataset folder.
    Eval(EvalArgs),
    /// One self-contained page about corner cases.
    Report(ReportArgs),
    /// The paper from end to end: do corner cases make networks better?
    Experiment(ExperimentArgs),
    /// Drive until three corner cases, verify, render them again, and write a report.
    Demo(DemoArgs),
    /// Say what is in maps and what was not understood of their files, or draw one.
    #[command(subcommand)]
    Map(MapCommand),
    /// List and calibrate wheels and gamepads.
    #[command(subcommand)]
    #[cfg_attr(not(feature = "live"), command(hide = true))]
    Wheel(WheelCommand),
    /// Say what this machine has and how fast it is.
    Doctor(DoctorArgs),
    /// Completions of the command line for a shell.
    Completions(CompletionsArgs),
    /// Man pages.
    Man(ManArgs),
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn a_campaign_needs_an_end_and_shards_a_number_of_runs() {
        let parse = |tail: &[&str]| {
            let head = ["aeye", "campaign", "--checkpoint", "truth", "--out", "d"];
            Cli::try_parse_from(head.iter().chain(tail)).is_ok()
        };
        assert!(parse(&["--runs", "4"]) && parse(&["--km", "1.5"]));
        assert!(!parse(&[]) && !parse(&["--km", "4", "--cases", "1"]) && parse(&["--runs", "4", "--cases", "1"]));
        assert!(parse(&["--runs", "4", "--shard", "2/3"]) && parse(&["--runs", "4", "--km", "1", "--shard", "2/3"]));
        assert!(parse(&["--scenario", "cut_out", "--vary", "4", "--shard", "2/3"]));
        assert!(!parse(&["--scenario", "cut_out", "--vary", "4", "--runs", "4"]) && !parse(&["--vary", "4"]));
        assert!(!parse(&["--km", "1", "--shard", "2/3"]) && !parse(&["--runs", "4", "--shard", "4/3"]));
        let collect = |tail: &[&str]| {
            let head = ["aeye", "campaign", "--collect", "a", "b", "--out", "d"];
            Cli::try_parse_from(head.iter().chain(tail)).is_ok()
        };
        assert!(collect(&[]) && collect(&["--jobs", "2"]));
        assert!(Cli::try_parse_from(["aeye", "campaign", "--collect", "--out", "d"]).is_err());
        assert!([["--runs", "4"], ["--seed", "1"], ["--shard", "1/2"]].iter().all(|tail| !collect(tail)));
    }
}

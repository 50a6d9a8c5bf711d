//! What needs windows, wheels or gamepads: all that this program has of the crate `live`.

mod trial;
mod wheel;

use std::path::Path;
use std::sync::Arc;

use base::maps::Map;
use drivers::checkpoint::CheckpointChoice;
use drivers::film::Film;
use kernel::Scenario;
pub use live::drive::LiveFigures;
use live::drive::{Options, Tell, Wanted};
use live::speakers;
use live::units::hardware::Hardware;
use measures::RunFigures;
use study::Protocol;

use crate::cli::DriveArgs;
pub use trial::trial;
pub use wheel::{none_found, run as wheels};

/// Live runs, until the operators have had enough.
pub fn drive(
    args: &DriveArgs,
    scenario: Scenario,
    map: Map,
    tell: impl Fn(&Path, &RunFigures) -> anyhow::Result<()> + Send + Sync + 'static,
) -> anyhow::Result<()> {
    let (scenario, checkpoint, study) = (Box::new(scenario), args.checkpoint.clone(), (&args.study).into());
    live::drive::drive(options(args, Wanted::Scenario { map, scenario, checkpoint, study }, Arc::new(tell)))
}

/// The trials of a protocol, as far as they are not driven yet.
pub fn drive_planned(
    args: &DriveArgs,
    protocol: Protocol,
    tell: impl Fn(&Path, &RunFigures) -> anyhow::Result<()> + Send + Sync + 'static,
) -> anyhow::Result<()> {
    live::drive::drive(options(args, Wanted::Trials(protocol), Arc::new(tell)))
}

fn options(args: &DriveArgs, wanted: Wanted, tell: Tell) -> Options {
    Options {
        wanted,
        seats: [args.semantic.clone(), args.safety.clone()].map(Option::unwrap_or_default),
        calibration: args.calibration.clone(),
        force: args.force,
        sound: speakers::Options {
            safety: sound(args.sound.as_deref(), "default"),
            semantic: sound(args.semantic_sound.as_deref(), "off"),
            semantic_hears_car: args.semantic_hears_car,
        },
        foxglove: args.foxglove(),
        pictures: (&args.pictures).into(),
        record: args.record().to_owned(),
        tell,
    }
}

/// A device as it is asked for, or else this.
fn sound(asked: Option<&str>, otherwise: &str) -> speakers::Choice {
    speakers::Choice::from(asked.unwrap_or(otherwise))
}

/// Shows a recording or case until its window is closed.
pub fn watch(film: &Film, choices: &[CheckpointChoice]) -> anyhow::Result<()> {
    live::view::watch(film, choices)
}

/// Names of the wheels and gamepads that are plugged in.
pub fn devices() -> anyhow::Result<Vec<String>> {
    Ok(Hardware::open()?.devices().into_iter().map(|d| format!("{} at {}", d.name, d.path)).collect())
}

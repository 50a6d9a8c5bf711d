//! What is in recordings and cases, file by file, and what several have in common.

mod contents;
mod text;

use std::path::{Path, PathBuf};

use base::failure::Failure;
use base::library::{self, Found, Kind};
use base::spread::{in_order, jobs};
use measures::{Measures, Tally};
use replay::Recording;

pub use contents::{Contents, EventLine, NoteLine, Overall, Takeover, Window};

/// What is looked at.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Recordings or cases, or folders with such files anywhere below.
    pub files: Vec<PathBuf>,
    /// Tell which checkpoint drove blind drives.
    pub reveal: bool,
    /// Files read at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
}

/// What is left to say when each file has been shown.
pub struct Inspected {
    /// Files that could be read.
    pub read: usize,
    /// What they have in common, and what could not be read; none of a single file.
    pub overall: Option<Overall>,
    /// Those whose replay is not the run that was recorded.
    pub diverged: Vec<PathBuf>,
    /// Those that could not be read, and why.
    pub failed: Vec<Failure>,
}

/// Looks at every file, and shows what is in each, in their order.
pub fn inspect(options: &Options, mut show: impl FnMut(&Contents) -> anyhow::Result<()>) -> anyhow::Result<Inspected> {
    let Found { files, mut failed } = library::find(&options.files, Kind::All);
    let (mut seen, mut diverged) = (Vec::new(), Vec::new());
    in_order(
        jobs(options.jobs),
        files.len(),
        |index| look(&files[index].path, options.reveal),
        |index, looked| {
            let path = &files[index].path;
            match looked {
                Ok((recording, contents, has_diverged)) => {
                    diverged.extend(has_diverged.then(|| path.clone()));
                    show(&contents)?;
                    seen.push((recording, contents.measures));
                }
                Err(error) => failed.push(Failure::new(path, &error)),
            }
            Ok(())
        },
    )?;
    let tally = || Tally::of(seen.iter().map(|(recording, measures)| (recording, measures.as_ref())));
    let several = seen.len() + failed.len() > 1;
    let overall =
        several.then(|| Overall { kind: "overall", files: seen.len(), tally: tally(), failed: failed.clone() });
    Ok(Inspected { read: seen.len(), overall, diverged, failed })
}

/// A file, what is printed for it, and whether its replay is not the run that was recorded.
fn look(file: &Path, reveal: bool) -> anyhow::Result<(Recording, Contents, bool)> {
    let recording = Recording::open(file)?;
    let (network, measured) = match recording.network() {
        Ok(network) => (Some(network.clone()), Measures::of(recording.log(), &network)),
        Err(error) => (None, Err(error)),
    };
    let diverged = matches!(measured, Err(replay::Error::Diverged(_)));
    let contents = Contents::read(file, &recording, (network.as_ref(), measured), reveal)?;
    Ok((recording, contents, diverged))
}

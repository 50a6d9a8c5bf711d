//! A file of Foxglove's protobuf messages. Their times are simulated time, so that the same export gives the same bytes.

use std::path::{Path, PathBuf};

use anyhow::bail;
use base::output::PendingFile;
use base::progress::Interrupt;
use measures::footage::Window;
use replay::{Exported, Recording, exported};

use super::about::{about, origin};
use super::film::{self, Camera, Counts};
use super::options::{Export, Options};
use super::sink::Sink;
use crate::looks::Size;

/// Writes the file, unless it is there.
pub fn export(
    (args, size): (&Options, Size),
    (file, recording): (&Path, &Recording),
    out: PathBuf,
    camera: &mut Camera<'_>,
    interrupt: &Interrupt,
) -> anyhow::Result<Export> {
    let there = exported(&out);
    if there.is_none() && out.exists() {
        bail!("{}: exists already and is no export; expected another place", out.display());
    }
    let (log, network) = (recording.log(), recording.network()?);
    let window = Window::of(log, &args.asked())?;
    let mut about = about(recording, &window, (args, size), (&*camera.eyes, camera.others));
    about.extend(origin(&network));
    let counts = Counts::of(log, &window);
    let (from, to) = window.ticks.clone().into_inner();
    let kept = there == Some(Exported { about: about.clone(), is_whole: true });
    let export = Export { file: file.to_owned(), out, from, to, kept, counts };
    if kept {
        return Ok(export);
    }
    let mut sink = Sink::new(PendingFile::new(&export.out)?, about)?;
    film::shoot((log, &network), &window, camera, &mut sink, || {
        if interrupt.is_raised() {
            bail!("interrupted; nothing of its export is kept");
        }
        Ok(())
    })?;
    sink.finish()?.finish()?;
    Ok(export)
}

//! A file of Foxglove's protobuf messages. Their times are simulated time, so that the same export gives the same bytes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::bail;
use base::output::PendingFile;
use base::progress::Interrupt;
use drivers::vision::Eye;
use kernel::RoadNetwork;
use measures::footage::{Asked, Window};
use replay::{Exported, Recording, exported};

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
    let window = Window::of(log, &Asked { last: args.last, from: args.from, to: args.to, fps: args.fps })?;
    let mut about = about(recording, &window, (args, size), camera.eyes);
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

/// What the export was made from.
fn about(
    recording: &Recording,
    window: &Window,
    (args, size): (&Options, Size),
    eyes: &[Eye],
) -> BTreeMap<String, String> {
    let eyes: Vec<String> = eyes.iter().map(|eye| format!("{} {}", eye.name(), eye.digest())).collect();
    let entries = [
        ("source", blake3::Hash::from_bytes(recording.digest()).to_hex().to_string()),
        ("ticks", format!("{} to {}", window.ticks.start(), window.ticks.end())),
        ("fps", args.fps.to_string()),
        ("size", format!("{}x{}", size.0, size.1)),
        ("checkpoints", eyes.join(", ")),
        ("adapter", drivers::vision::adapter()),
        ("program", env!("CARGO_PKG_VERSION").to_owned()),
    ];
    entries.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// What to add to coordinates to have those of the map's file, where they differ: metres to the east and to the north.
fn origin(network: &RoadNetwork) -> Option<(String, String)> {
    let [east_m, north_m] = network.origin_m;
    ([east_m, north_m] != [0.0; 2]).then(|| ("origin_m".to_owned(), format!("{east_m} {north_m}")))
}

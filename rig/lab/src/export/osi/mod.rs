//! A window of a recording as a trace of the ASAM Open Simulation Interface (OSI): an MCAP file of `osi3.GroundTruth`.
//!
//! Times are simulated time and nothing is a clock's, so that the same export gives the same bytes.

mod environment;
mod ids;
mod kinds;
mod lanes;
mod lights;
mod messages;
mod moving;
mod place;
mod projection;
mod schema;
mod things;
mod world;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::bail;
use base::output::PendingFile;
use base::progress::Interrupt;
use kernel::RoadNetwork;
use kernel::map::bundled_text;
use kernel::time::Tick;
use measures::footage::{self, Window};
use prost::Message;
use replay::{Exported, Exporter, Log, Recording, exported};

use self::moving::WARM_UP_SCENES;
use self::world::Worlds;
use super::film::Counts;
use super::options::{Export, Options};

/// Writes the trace, unless it is there.
pub fn export(args: &Options, file: &Path, out: PathBuf, interrupt: &Interrupt) -> anyhow::Result<Export> {
    let there = exported(&out);
    if there.is_none() && out.exists() {
        bail!("{}: exists already and is no export; expected another place", out.display());
    }
    let recording = Recording::open(file)?;
    let (log, network) = (recording.log(), recording.network()?);
    let window = Window::of(log, &args.asked())?;
    let ticks: Vec<Tick> = window.pictures().collect();
    let (Some(&from), Some(&to)) = (ticks.first(), ticks.last()) else {
        bail!("no message falls into the window; expected a longer one, or a higher --fps");
    };
    let about = about(&recording, &window, args);
    let kept = there == Some(Exported { about: about.clone(), is_whole: true });
    let counts = Counts { frames: 0, poses: ticks.len(), events: 0 };
    let export = Export { file: file.to_owned(), out, from, to, kept, counts };
    if kept {
        return Ok(export);
    }
    let (map, proj) = map_of(log, &network);
    let mut exporter = Exporter::new(PendingFile::new(&export.out)?, about)?;
    exporter.metadata(schema::RECORD, schema::trace(&network.name))?;
    let channel = exporter.channel_with(schema::TOPIC, &schema::schema(), &schema::channel())?;
    let mut worlds = Worlds::on(&network, map, proj);
    footage::each_scene(log, &network, &with_warm_up(log, &window, ticks), |_, scene| {
        if interrupt.is_raised() {
            bail!("interrupted; nothing of its export is kept");
        }
        if scene.tick < from {
            worlds.warm_up(&scene);
            return Ok(());
        }
        Ok(exporter.put(channel, scene.tick, &worlds.message(&scene).encode_to_vec())?)
    })?;
    exporter.finish()?.finish()?;
    Ok(export)
}

/// These ticks after some before them, as far as they can be simulated: by those everybody's acceleration is known.
fn with_warm_up(log: &Log, window: &Window, ticks: Vec<Tick>) -> Vec<Tick> {
    let first = ticks.first().copied().filter(|_| log.manifest.kernel == kernel::identity());
    let before = |first: Tick| {
        let back = (1..=WARM_UP_SCENES).rev().filter_map(move |scenes| first.checked_sub(scenes * window.stride));
        back.filter(|tick| *tick >= log.first_tick())
    };
    first.into_iter().flat_map(before).chain(ticks).collect()
}

/// What the export was made from.
fn about(recording: &Recording, window: &Window, args: &Options) -> BTreeMap<String, String> {
    let entries = [
        ("format", args.format.name().to_owned()),
        ("source", blake3::Hash::from_bytes(recording.digest()).to_hex().to_string()),
        ("ticks", format!("{} to {}", window.ticks.start(), window.ticks.end())),
        ("fps", args.fps.to_string()),
        ("program", env!("CARGO_PKG_VERSION").to_owned()),
    ];
    entries.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// The name of the map's file, as it is beside a recording where it does not come with the program, and its projection.
fn map_of(log: &Log, network: &RoadNetwork) -> (String, Option<String>) {
    match (&log.manifest.foreign_map, bundled_text(&network.name)) {
        (Some(foreign), _) => (foreign.file_name(), foreign.text.as_deref().and_then(projection::of)),
        (None, text) => (format!("{}.xodr", network.name), text.and_then(projection::of)),
    }
}

//! How a run's recording begins: its name, what it says about itself, and the thread that writes it.

use std::path::{Path, PathBuf};
use std::sync::mpsc::Sender;

use anyhow::anyhow;
use base::words;
use kernel::World;
use replay::Manifest;

use super::agenda::Bill;
use super::plan::Plan;
use crate::drive::board::Message;
use crate::drive::disk::{self, BackgroundFile};
use crate::drive::seating::Seating;
use crate::speakers::Sound;

/// What the recording of a run says about itself: the world's scenario, who sits where, and the checkpoint.
pub fn manifest(plan: &Plan, seating: &Seating, sound: &Sound, bill: &Bill, world: &World) -> Manifest {
    let swapped = || study::swapped(&plan.provenance);
    let mut provenance = if seating.is_swapped() { swapped() } else { plan.provenance.clone() };
    provenance.insert("live".into(), "true".into());
    provenance.extend(plan.cast.provenance(bill.eye).clone());
    provenance.extend(plan.agenda.protocol().map(|protocol| protocol.provenance(bill.trial)).unwrap_or_default());
    provenance.extend(seating.provenance());
    provenance.extend(seating.tempers(world.scenario().seed));
    let hears: Vec<&str> = sound.heard_by().into_iter().map(|seat| words::SEATS[seat as usize]).collect();
    provenance.insert("sound".into(), if hears.is_empty() { "off".into() } else { hears.join(",") });
    Manifest::new(world.scenario(), &bill.map.network, bill.map.foreign.clone(), provenance)
}

/// A new file for the recording of a run, written in the background; failures are said to the simulation.
pub fn create(record: &Path, number: u32, outbox: Sender<Message>) -> anyhow::Result<(PathBuf, BackgroundFile)> {
    let (path, file) = disk::create(record, number)?;
    let name = path.display().to_string();
    // When nobody listens any more the session is over, and meets the error itself.
    let file = BackgroundFile::new(file, move |error| {
        drop(outbox.send(Message::Failed(anyhow!("{name}: {error}"))));
    });
    Ok((path, file))
}

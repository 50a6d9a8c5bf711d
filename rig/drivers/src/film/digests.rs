//! Makes every mask of a log again and compares its digest with the one that was logged.

use std::collections::BTreeMap;
use std::fmt;

use anyhow::{Context, anyhow, bail};
use base::json::Typed;
use base::progress;
use base::say::printable;
use base::words::count;
use kernel::time::Tick;
use render::{AdapterChoice, Renderer};
use replay::MaskShown;
use serde::Serialize;

use super::Film;
use super::reel::Reel;
use crate::checkpoint::CheckpointChoice;
use crate::vision::{self, Eye, digest_of};

/// What the comparison came to.
#[derive(Debug, Serialize)]
pub struct Digests {
    /// The file.
    file: String,
    /// Name of the checkpoint.
    checkpoint: String,
    /// Its digest, hexadecimal.
    checkpoint_digest: String,
    /// Size of the pictures, as in `256x128`.
    camera: String,
    /// What draws them now: adapter and driver.
    adapter: String,
    /// What drew them when they were shown; empty when the recording does not say.
    recorded_adapter: String,
    /// What computes them now.
    inference: &'static str,
    /// What computed the masks of the drive.
    recorded_inference: &'static str,
    /// Masks in the log.
    masks: usize,
    /// Frames that were drawn and looked at again for them.
    frames: usize,
    /// Masks with the logged digest.
    equal: usize,
    /// Masks with another one.
    different: usize,
    /// Masks of frames from before the file's first tick.
    before_start: usize,
    /// The first mask with another digest than the logged one.
    first_difference: Option<Difference>,
}

/// What `aeye view --digests` prints.
impl Typed for Digests {
    const TYPE: &'static str = "aeye.view.digests";
}

/// A mask that is not the logged one.
#[derive(Debug, Serialize)]
struct Difference {
    /// When the mask came to the screen.
    tick_shown: Tick,
    /// Tick that it is a picture of.
    tick_of_frame: Tick,
    /// The digest in the log, hexadecimal.
    logged: String,
    /// The digest of the mask made again.
    rebuilt: String,
}

/// A digest as people see it.
pub fn hex(digest: u64) -> String {
    format!("{digest:016x}")
}

/// Makes every mask of a film again.
pub fn compare(film: &Film, choices: &[CheckpointChoice]) -> anyhow::Result<Digests> {
    remake(film, choices).with_context(|| film.path.display().to_string())
}

fn remake(film: &Film, choices: &[CheckpointChoice]) -> anyhow::Result<Digests> {
    let masks = &film.log().masks;
    if masks.is_empty() {
        bail!("holds no masks that were shown to a semantic driver");
    }
    if let Some(mask) = masks.iter().find(|mask| mask.camera != 0) {
        bail!("the mask of tick {} is of camera {}; expected 0, the driver's", mask.tick_shown, mask.camera);
    }
    let mut eye = film.eye.find_as_it_was(choices)?.ok_or_else(|| anyhow!(film.eye.not_found("--checkpoint")))?;
    let rebuilt = rebuild(film, &mut eye)?;
    let logged = |mask: &&MaskShown| rebuilt.get(&mask.tick_of_frame).is_some_and(|digest| *digest == mask.digest);
    let found = |mask: &&MaskShown| rebuilt.contains_key(&mask.tick_of_frame);
    let equal = masks.iter().filter(logged).count();
    let different = masks.iter().filter(found).count() - equal;
    let first = masks.iter().filter(found).find(|mask| !logged(mask));
    if rebuilt.is_empty() {
        bail!("all of its masks are of frames from before its first tick");
    }
    let (width, height) = film.eye.size();
    Ok(Digests {
        file: film.path.display().to_string(),
        checkpoint: eye.name().to_owned(),
        checkpoint_digest: eye.digest(),
        camera: format!("{width}x{height}"),
        adapter: vision::adapter(),
        recorded_adapter: film.eye.adapter.clone(),
        inference: eye.compute().name(),
        recorded_inference: film.eye.compute.name(),
        masks: masks.len(),
        frames: rebuilt.len(),
        equal,
        different,
        before_start: masks.len() - equal - different,
        first_difference: first.map(|mask| Difference {
            tick_shown: mask.tick_shown,
            tick_of_frame: mask.tick_of_frame,
            logged: hex(mask.digest),
            rebuilt: hex(rebuilt[&mask.tick_of_frame]),
        }),
    })
}

/// The digest of the mask of each frame that was shown, by tick; each is made once.
fn rebuild(film: &Film, eye: &mut Eye) -> anyhow::Result<BTreeMap<Tick, u64>> {
    let frames = film.log().masks.iter().map(|mask| mask.tick_of_frame).filter(|tick| film.holds(*tick));
    let mut digests: BTreeMap<Tick, u64> = frames.map(|tick| (tick, 0)).collect();
    let mut reel = Reel::new(film.log(), &film.network)?;
    let mut renderer = Renderer::new(&film.network, &AdapterChoice::default())?;
    let bar = progress::bar("masks", digests.len() as u64);
    for (tick, digest) in &mut digests {
        let frame = eye.draw(&mut renderer, &reel.at(*tick)?.scene, &film.eye.camera)?;
        *digest = digest_of(&eye.see(frame)?.ids);
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(digests)
}

impl Digests {
    /// Whether every mask that could be made again is the logged one.
    pub fn are_equal(&self) -> bool {
        self.different == 0
    }
}

impl fmt::Display for Digests {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&text(self))
    }
}

fn text(digests: &Digests) -> String {
    let Digests { file, checkpoint, masks, frames, equal, different, before_start, .. } = digests;
    let (file, masks, frames) = (printable(file), count(*masks, "mask"), count(*frames, "frame"));
    let mut text = format!("{file}: {masks} of {frames} through {checkpoint}: {equal} equal, {different} different");
    if *before_start > 0 {
        text += &format!(", {before_start} of frames from before the file's first tick");
    }
    if let Some(Difference { tick_shown, tick_of_frame, logged, rebuilt }) = &digests.first_difference {
        text += &format!(
            "\nfirst difference at tick {tick_shown}: the mask of frame {tick_of_frame} was logged as {logged}, but is {rebuilt}"
        );
    }
    if digests.different > 0 && digests.adapter != digests.recorded_adapter {
        let drew =
            if digests.recorded_adapter.is_empty() { "an adapter it does not name" } else { &digests.recorded_adapter };
        text += &format!(
            "\nequal masks are promised on one adapter: it was drawn by {drew}, and now by {}",
            digests.adapter
        );
    }
    if digests.inference != digests.recorded_inference {
        text += &format!("\ncomputed by {}, and now by {}", digests.recorded_inference, digests.inference);
    }
    text
}

//! A window of a recording as moving pictures, with the masks of checkpoints beside the driver's view: an animated PNG, or by
//! `ffmpeg`, where that is, a GIF or an MP4. A comment in each tells what it was made from.

mod encoder;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, bail};
use base::output;
use base::progress::Interrupt;
use drivers::vision::Eye;
use render::{Frame, tags};

use self::encoder::Encoder;
use super::film::Counts;
use super::options::{Export, Options};
use crate::looks::{Size, look};
use crate::shots::{Shots, Stage, Workshop};

/// What draws, and what looks at that.
pub struct Screen<'a> {
    /// Draws.
    pub workshop: &'a Arc<Workshop>,
    /// Of each picture, pixels.
    pub size: Size,
    /// Their masks stand on the right of the picture, one after the other.
    pub eyes: &'a mut [Eye],
}

/// Writes the file, unless it is there.
pub fn export(
    args: &Options,
    file: &Path,
    out: PathBuf,
    screen: Screen<'_>,
    interrupt: &Interrupt,
) -> anyhow::Result<Export> {
    let stage = Arc::new(Stage::open(file, screen.workshop)?);
    let shots = Shots::of_window(&stage, &args.asked(), args.camera.camera(screen.size).at(args.imaging))?;
    let (Some(&from), Some(&to)) = (shots.ticks().first(), shots.ticks().last()) else {
        bail!("no picture falls into the window; expected a longer one, or more pictures a second");
    };
    let counts = Counts { frames: shots.ticks().len(), ..Counts::default() };
    let source = source(&stage, &shots, args, &screen);
    let kept = match fs::read(&out) {
        Ok(bytes) if encoder::tells(&bytes, &source) => true,
        Ok(bytes) if encoder::is_export(&bytes) => false,
        Ok(_) => bail!("{}: exists already and is no export; expected another place", out.display()),
        Err(_) => false,
    };
    if !kept {
        let (width, height) = screen.size;
        let panels = 1 + screen.eyes.len() as u32;
        let mut encoder = Encoder::new(args.format, (width * panels, height), args.fps, counts.frames as u32)?;
        for index in 0..counts.frames {
            if interrupt.is_raised() {
                bail!("interrupted; nothing of its export is kept");
            }
            encoder.push(&beside_each_other(&shots.draw(index)?.frame, screen.eyes)?)?;
        }
        output::write_file(&out, &encoder.finish(&source)?)?;
    }
    Ok(Export { file: file.to_owned(), out, from, to, kept, counts })
}

/// A digest of all that the pictures follow from.
fn source(stage: &Stage, shots: &Shots, args: &Options, screen: &Screen<'_>) -> String {
    let eyes: Vec<String> = screen.eyes.iter().map(Eye::digest).collect();
    let recording = blake3::Hash::from_bytes(stage.recording().digest()).to_hex();
    let (camera, adapter, version) = (args.camera.name(), drivers::vision::adapter(), env!("CARGO_PKG_VERSION"));
    let pictures = (screen.size, args.imaging.to_string(), camera);
    let all = (recording.as_str(), shots.ticks(), args.fps, pictures, eyes, adapter, version);
    blake3::hash(format!("{all:?}").as_bytes()).to_hex().to_string()
}

/// The picture and its masks in their tags' colours, from left to right, 3 bytes a pixel.
fn beside_each_other(frame: &Frame, eyes: &mut [Eye]) -> anyhow::Result<Vec<u8>> {
    let masks = look(eyes, frame)?;
    let coloured: Vec<Vec<u8>> = masks.iter().map(|mask| tags::colours(&mask.ids)).collect();
    let row = 3 * frame.width as usize;
    let mut picture = Vec::with_capacity(frame.rgb.len() * (1 + coloured.len()));
    for y in 0..frame.height as usize {
        for panel in std::iter::once(&frame.rgb).chain(&coloured) {
            picture.extend_from_slice(panel.get(y * row..(y + 1) * row).context("a mask of another size")?);
        }
    }
    Ok(picture)
}

//! What the semantic driver sees in a simulated drive: in lockstep with the ticks, with a declared
//! latency, so that the same run gives the same masks on a fast and on a slow machine.

use std::io;
use std::path::Path;

use anyhow::Context;
use base::failure::Usage;
use kernel::World;
use kernel::time::{CLIP_STRIDE_TICKS, Tick};
use perception::{BUNDLED, Checkpoint, Compute, Mask, RgbView, Segmenter};
use render::{Camera, Frame, RenderOptions, Renderer};
use replay::{MaskShown, Provenance};

use crate::MaskView;
use crate::checkpoint::CheckpointChoice;

/// Ticks from one frame to the next: 10 frames a second.
pub const FRAME_TICKS: Tick = CLIP_STRIDE_TICKS;
/// Ticks from a frame to its mask on the screen: 100 ms for rendering, inference and display. How old the mask is at a
/// tick says [`MaskShown::age_at`].
pub const LATENCY_TICKS: Tick = 6;
/// Size of the pictures for checkpoints that take any, pixels.
pub const DEFAULT_SIZE: (u32, u32) = (256, 128);

/// What turns a frame into a mask.
#[derive(Clone)]
pub enum Eye {
    /// The renderer's class ids.
    Truth,
    /// A network.
    Network {
        /// Its file.
        checkpoint: Box<Checkpoint>,
        /// Itself, ready for its size.
        segmenter: Box<Segmenter>,
    },
}

impl Eye {
    /// Opens a checkpoint at the size it takes.
    pub fn open(choice: &CheckpointChoice) -> anyhow::Result<Self> {
        Self::open_on(Compute::Cpu, choice, None)
    }

    /// Opens a checkpoint for pictures of one size, which are resampled if it takes another.
    pub fn open_at(choice: &CheckpointChoice, size: (u32, u32)) -> anyhow::Result<Self> {
        Self::open_on(Compute::Cpu, choice, Some(size))
    }

    /// Opens a checkpoint on a device, for pictures of one size or of the size it takes.
    pub fn open_on(compute: Compute, choice: &CheckpointChoice, size: Option<(u32, u32)>) -> anyhow::Result<Self> {
        let checkpoint = Box::new(match choice {
            CheckpointChoice::Truth => return Ok(Self::Truth),
            CheckpointChoice::Bundled(name) => perception::bundled(name).context("a bundled checkpoint")??,
            CheckpointChoice::File(path) => load(path)?,
        });
        let own = || checkpoint.input_size().unwrap_or((DEFAULT_SIZE.0 as usize, DEFAULT_SIZE.1 as usize));
        let (width, height) = size.map_or_else(own, |(width, height)| (width as usize, height as usize));
        let segmenter = Box::new(Segmenter::on(compute, &checkpoint, width, height)?);
        Ok(Self::Network { checkpoint, segmenter })
    }

    /// `truth`, or the checkpoint's name: that of its file without the ending.
    pub fn name(&self) -> &str {
        match self {
            Self::Truth => "truth",
            Self::Network { checkpoint, .. } => checkpoint.name(),
        }
    }

    /// `truth`, or the digest of the checkpoint in hexadecimal digits.
    pub fn digest(&self) -> String {
        match self {
            Self::Truth => "truth".into(),
            Self::Network { checkpoint, .. } => checkpoint.digest().to_hex().to_string(),
        }
    }

    /// What computes it.
    pub fn compute(&self) -> Compute {
        match self {
            Self::Truth => Compute::default(),
            Self::Network { segmenter, .. } => segmenter.compute(),
        }
    }

    /// Width and height of the pictures it looks at, pixels.
    pub fn size(&self) -> (u32, u32) {
        match self {
            Self::Truth => DEFAULT_SIZE,
            Self::Network { segmenter, .. } => (segmenter.size().0 as u32, segmenter.size().1 as u32),
        }
    }

    /// The mask of a frame, as tag ids.
    pub fn see(&mut self, frame: Frame) -> anyhow::Result<Mask> {
        let (width, height) = (frame.width as usize, frame.height as usize);
        match self {
            Self::Truth => Ok(Mask::new(width, height, frame.class_ids)?),
            Self::Network { segmenter, .. } => Ok(segmenter.run(RgbView::new(width, height, &frame.rgb)?)?),
        }
    }

    /// As [`Eye::see`], and how sure it is of every pixel, (0, 1]; `None` where it gives classes only.
    pub fn see_with_confidence(&mut self, frame: &Frame) -> anyhow::Result<(Mask, Option<Vec<f32>>)> {
        let (width, height) = (frame.width as usize, frame.height as usize);
        match self {
            Self::Truth => Ok((Mask::new(width, height, frame.class_ids.clone())?, None)),
            Self::Network { segmenter, .. } => {
                Ok(segmenter.run_with_confidence(RgbView::new(width, height, &frame.rgb)?)?)
            }
        }
    }
}

fn load(path: &Path) -> anyhow::Result<Checkpoint> {
    if path.exists() {
        return Ok(Checkpoint::load(path)?);
    }
    let known = BUNDLED.join(", ");
    let sentence = format!("{}: no such checkpoint; expected one of {known}, truth, or an ONNX file", path.display());
    if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("onnx")) {
        return Err(io::Error::new(io::ErrorKind::NotFound, sentence).into());
    }
    Err(Usage(sentence).into())
}

/// What recordings say about how their masks came about: through which checkpoint, computed by what,
/// from pictures of which size, drawn by which adapter with which driver.
pub fn provenance(eye: &Eye, (width, height): (u32, u32)) -> Provenance {
    let entries = [
        ("checkpoint", eye.name().to_owned()),
        ("checkpoint_digest", eye.digest()),
        ("camera", format!("driver {width}x{height}")),
        ("adapter", adapter()),
    ];
    // Nothing is said of the CPU, which is the rule.
    let elsewhere = Some(eye.compute()).filter(|compute| *compute != Compute::Cpu);
    let inference = elsewhere.map(|compute| ("inference", compute.name().to_owned()));
    entries.into_iter().chain(inference).map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Name and driver of the adapter that draws for drivers; empty where there is none.
pub fn adapter() -> String {
    find_adapter().unwrap_or_default()
}

/// As [`adapter`]; the error says what to install where there is none.
pub fn find_adapter() -> anyhow::Result<String> {
    let found = RenderOptions::default().adapter.find()?;
    Ok(format!("{}, {}", found.name, found.driver))
}

/// First 8 bytes of the blake3 digest of a mask's tag ids, as recordings hold it.
pub fn digest_of(ids: &[u8]) -> u64 {
    blake3::hash(ids).as_bytes().iter().take(8).rev().fold(0, |value, byte| value << 8 | u64::from(*byte))
}

/// A mask on its way to the screen, or on it.
struct Picture {
    shown: MaskShown,
    mask: Mask,
}

/// The driver's camera, the eye behind it, and the screen.
pub struct Vision {
    renderer: Renderer,
    eye: Eye,
    camera: Camera,
    on_screen: Option<Picture>,
    coming: Option<Picture>,
}

const _: () = assert!(LATENCY_TICKS <= FRAME_TICKS, "only one mask may be on its way");

impl Vision {
    /// Looks at the renderer's map through an eye.
    pub fn new(renderer: Renderer, eye: Eye) -> Self {
        let (width, height) = eye.size();
        Self { renderer, eye, camera: Camera::driver(width, height), on_screen: None, coming: None }
    }

    /// What looks.
    pub fn eye(&self) -> &Eye {
        &self.eye
    }

    /// The same renderer with another eye and a dark screen.
    pub fn with_eye(self, eye: Eye) -> Self {
        Self::new(self.renderer, eye)
    }

    /// Hands the renderer back.
    pub fn into_renderer(self) -> Renderer {
        self.renderer
    }

    /// The mask on the screen at the world's tick. The first one of a drive comes without delay, so
    /// that the screen is never dark.
    pub fn look(&mut self, world: &World) -> anyhow::Result<(MaskView<'_>, MaskShown)> {
        let tick = world.tick();
        if self.coming.as_ref().is_some_and(|c| c.shown.tick_shown <= tick) {
            self.on_screen = self.coming.take();
        }
        if self.on_screen.is_none() {
            self.on_screen = Some(self.picture(world, tick)?);
        } else if tick.is_multiple_of(FRAME_TICKS) {
            let coming = self.picture(world, tick + LATENCY_TICKS)?;
            self.coming = Some(coming);
        }
        let picture = self.on_screen.as_ref().context("a mask on the screen")?;
        let mask = MaskView { width: picture.mask.width, height: picture.mask.height, ids: &picture.mask.ids };
        Ok((mask, picture.shown))
    }

    fn picture(&mut self, world: &World, tick_shown: Tick) -> anyhow::Result<Picture> {
        let frame = self.renderer.draw(&world.scene(), &self.camera)?;
        let tick_of_frame = frame.tick;
        let mask = self.eye.see(frame)?;
        let digest = digest_of(&mask.ids);
        // The controls of the next tick are the first that are given with this mask in view.
        let shown = MaskShown { tick_shown, tick_of_frame, camera: 0, digest, times: None };
        Ok(Picture { shown, mask })
    }
}

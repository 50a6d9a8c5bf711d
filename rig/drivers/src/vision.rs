//! What the semantic driver sees in a simulated drive: in lockstep with the ticks, with a declared
//! latency, so that the same run gives the same masks on a fast and on a slow machine.

use std::path::Path;
use std::{io, mem};

use anyhow::Context;
use base::failure::Usage;
use kernel::time::{CLIP_STRIDE_TICKS, Tick};
use kernel::{SceneSnapshot, World};
use perception::{BUNDLED, Certainty, Checkpoint, Compute, Mask, RgbView, Segmenter};
use render::{AdapterChoice, Camera, Frame, Imaging, ModelsId, RenderError, Renderer};
use replay::{MaskShown, Provenance};

use crate::MaskView;
use crate::checkpoint::CheckpointChoice;
use crate::external::External;

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
    /// The same with models of a user's own.
    TruthOf(ModelsId),
    /// A network.
    Network {
        /// Its file.
        checkpoint: Box<Checkpoint>,
        /// Itself, ready for its size.
        segmenter: Box<Segmenter>,
        /// How the pictures are made that it looks at.
        imaging: Imaging,
    },
    /// A function of whoever uses these libraries.
    External(External),
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
            CheckpointChoice::External(external) => {
                return Ok(Self::External(external.at(size.unwrap_or(external.size()))));
            }
        });
        let own = || checkpoint.input_size().unwrap_or((DEFAULT_SIZE.0 as usize, DEFAULT_SIZE.1 as usize));
        let (width, height) = size.map_or_else(own, |(width, height)| (width as usize, height as usize));
        let segmenter = Box::new(Segmenter::on(compute, &checkpoint, width, height)?);
        Ok(Self::Network { checkpoint, segmenter, imaging: Imaging::default() })
    }

    /// The same for pictures that are made otherwise; truth is the same in all of them, and sees through no lens.
    pub fn at(self, imaging: impl Into<Imaging>) -> Self {
        let imaging = imaging.into();
        match self {
            Self::Truth | Self::TruthOf(_) => imaging.models.map_or(Self::Truth, Self::TruthOf),
            Self::Network { checkpoint, segmenter, .. } => Self::Network { checkpoint, segmenter, imaging },
            Self::External(external) => Self::External(external.of_imaging(imaging)),
        }
    }

    /// `truth`, or the checkpoint's name: that of its file without the ending, or what its user calls it.
    pub fn name(&self) -> &str {
        match self {
            Self::Truth | Self::TruthOf(_) => "truth",
            Self::Network { checkpoint, .. } => checkpoint.name(),
            Self::External(external) => external.name(),
        }
    }

    /// `truth`, or the digest of the checkpoint in hexadecimal digits; `external NAME@VERSION` of what no file holds.
    pub fn digest(&self) -> String {
        match self {
            Self::Truth | Self::TruthOf(_) => "truth".into(),
            Self::Network { checkpoint, .. } => checkpoint.digest().to_hex().to_string(),
            Self::External(external) => external.identity(),
        }
    }

    /// What computes it.
    pub fn compute(&self) -> Compute {
        match self {
            Self::Truth | Self::TruthOf(_) | Self::External(_) => Compute::default(),
            Self::Network { segmenter, .. } => segmenter.compute(),
        }
    }

    /// Width and height of the pictures it looks at, pixels.
    pub fn size(&self) -> (u32, u32) {
        match self {
            Self::Truth | Self::TruthOf(_) => DEFAULT_SIZE,
            Self::Network { segmenter, .. } => (segmenter.size().0 as u32, segmenter.size().1 as u32),
            Self::External(external) => external.size(),
        }
    }

    /// How the pictures are made that it looks at.
    pub fn imaging(&self) -> Imaging {
        match self {
            Self::Truth => Imaging::unsaid(),
            Self::TruthOf(models) => Imaging { models: Some(*models), ..Imaging::unsaid() },
            Self::Network { imaging, .. } => *imaging,
            Self::External(external) => external.imaging(),
        }
    }

    /// The driver's camera, which takes those pictures.
    pub fn camera(&self) -> Camera {
        let (width, height) = self.size();
        Camera::driver(width, height).at(self.imaging())
    }

    /// Whether it looks at colours.
    pub fn needs_colours(&self) -> bool {
        !self.is_truth()
    }

    /// Whether it sees what is there.
    pub fn is_truth(&self) -> bool {
        matches!(self, Self::Truth | Self::TruthOf(_))
    }

    /// What it needs of a picture.
    pub fn draw(&self, renderer: &mut Renderer, scene: &SceneSnapshot, camera: &Camera) -> Result<Frame, RenderError> {
        if self.needs_colours() { renderer.draw(scene, camera) } else { renderer.draw_classes(scene, camera) }
    }

    /// The mask of a frame, as tag ids.
    pub fn see(&mut self, mut frame: Frame) -> anyhow::Result<Mask> {
        self.take_in(&mut frame)
    }

    /// As [`Eye::see`] of a frame whose colours are needed afterwards; its class ids may be gone.
    fn take_in(&mut self, frame: &mut Frame) -> anyhow::Result<Mask> {
        let (width, height) = (frame.width as usize, frame.height as usize);
        match self {
            Self::Truth | Self::TruthOf(_) => Ok(Mask::new(width, height, mem::take(&mut frame.class_ids))?),
            Self::Network { segmenter, .. } => Ok(segmenter.run(RgbView::new(width, height, &frame.rgb)?)?),
            Self::External(external) => external.see(RgbView::new(width, height, &frame.rgb)?),
        }
    }

    /// As [`Eye::see`], and how sure it is of every pixel; `None` where it gives classes only.
    pub fn see_with_certainty(&mut self, frame: &Frame) -> anyhow::Result<(Mask, Option<Certainty>)> {
        let (width, height) = (frame.width as usize, frame.height as usize);
        match self {
            Self::Truth | Self::TruthOf(_) => Ok((Mask::new(width, height, frame.class_ids.clone())?, None)),
            Self::Network { segmenter, .. } => {
                Ok(segmenter.run_with_certainty(RgbView::new(width, height, &frame.rgb)?)?)
            }
            Self::External(external) => Ok((external.see(RgbView::new(width, height, &frame.rgb)?)?, None)),
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

/// What recordings say about their eye alone.
const OF_EYE: [&str; 4] = ["checkpoint", "checkpoint_digest", EXTERNAL, "inference"];
/// The version of what looked where no file holds it.
pub(crate) const EXTERNAL: &str = "external";

/// What recordings say about how their masks came about: through which checkpoint, computed by what,
/// from pictures of which size and kind, drawn by which adapter with which driver.
pub fn provenance(eye: &Eye, camera: &Camera) -> Provenance {
    let which = match eye {
        Eye::External(external) => (EXTERNAL, external.version().to_owned()),
        _ => ("checkpoint_digest", eye.digest()),
    };
    let entries =
        [("checkpoint", eye.name().to_owned()), which, ("camera", camera_text(camera)), ("adapter", adapter())];
    // Nothing is said of the CPU, which is the rule.
    let elsewhere = Some(eye.compute()).filter(|compute| *compute != Compute::Cpu);
    let inference = elsewhere.map(|compute| ("inference", compute.name().to_owned()));
    entries.into_iter().chain(inference).map(|(name, value)| (name.to_owned(), value)).collect()
}

/// A driver's camera in words, as in `driver 256x128 standard` or `driver 256x128 plain noise=4`. Nothing is said of pictures that
/// are plain, of an ideal sensor, and of the renderer's own models.
pub fn camera_text(camera: &Camera) -> String {
    named_camera_text("driver", camera)
}

/// The same of a camera with another name.
pub fn named_camera_text(name: &str, camera: &Camera) -> String {
    let Camera { width, height, .. } = camera;
    let (size, imaging) = (format!("{name} {width}x{height}"), camera.imaging());
    if imaging == Imaging::unsaid() { size } else { format!("{size} {imaging}") }
}

/// Says in a recording's provenance that from now on this eye looks, and no longer the one that did.
pub fn replace_eye(provenance: &mut Provenance, eye: &Eye) {
    provenance.retain(|name, _| !OF_EYE.contains(&name.as_str()));
    provenance.extend(self::provenance(eye, &eye.camera()));
}

/// Name and driver of the adapter that draws for drivers; empty where there is none.
pub fn adapter() -> String {
    find_adapter().unwrap_or_default()
}

/// As [`adapter`]; the error says what to install where there is none.
pub fn find_adapter() -> anyhow::Result<String> {
    let found = AdapterChoice::default().find()?;
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

/// The driver's camera and the eye behind it. It remembers nothing of a drive, so that drives on one map can take turns.
pub struct Optics {
    renderer: Renderer,
    eye: Eye,
    camera: Camera,
    /// Colours are drawn though the eye needs none.
    with_colours: bool,
}

impl Optics {
    /// Looks at the renderer's map through an eye.
    pub fn new(renderer: Renderer, eye: Eye) -> Self {
        Self { renderer, camera: eye.camera(), eye, with_colours: false }
    }

    /// The same for somebody who looks at the colours of the eye's pictures, too.
    pub fn with_colours(self) -> Self {
        Self { with_colours: true, ..self }
    }

    /// What looks.
    pub fn eye(&self) -> &Eye {
        &self.eye
    }

    /// What another camera sees.
    pub fn draw(&mut self, world: &World, camera: &Camera) -> anyhow::Result<Frame> {
        Ok(self.renderer.draw(&world.scene(), camera)?)
    }

    /// The mask that comes to the screen at a tick, and the colours that it is of, where they were drawn.
    fn picture(&mut self, world: &World, tick_shown: Tick) -> anyhow::Result<(Picture, Vec<u8>)> {
        let scene = world.scene();
        let mut frame = if self.with_colours {
            self.renderer.draw(&scene, &self.camera)?
        } else {
            self.eye.draw(&mut self.renderer, &scene, &self.camera)?
        };
        let mask = self.eye.take_in(&mut frame)?;
        let digest = digest_of(&mask.ids);
        // The controls of the next tick are the first that are given with this mask in view.
        let shown = MaskShown { tick_shown, tick_of_frame: frame.tick, camera: 0, digest, times: None };
        Ok((Picture { shown, mask }, frame.rgb))
    }
}

const _: () = assert!(LATENCY_TICKS <= FRAME_TICKS, "only one mask may be on its way");

/// The semantic driver's screen during one drive.
#[derive(Default)]
pub struct Screen {
    on_screen: Option<Picture>,
    coming: Option<Picture>,
    looked_at: Option<Tick>,
    drawn: Option<(Tick, Vec<u8>)>,
}

impl Screen {
    /// The mask on the screen at the world's tick, to be asked for at every tick of a drive. The first one of a drive
    /// comes without delay, so that the screen is never dark.
    pub fn look(&mut self, optics: &mut Optics, world: &World) -> anyhow::Result<(MaskView<'_>, MaskShown)> {
        if self.looked_at != Some(world.tick()) {
            self.follow(optics, world)?;
            self.looked_at = Some(world.tick());
        }
        let picture = self.on_screen.as_ref().context("a mask on the screen")?;
        let mask = MaskView { width: picture.mask.width, height: picture.mask.height, ids: &picture.mask.ids };
        Ok((mask, picture.shown))
    }

    /// The colours of the frame of a tick, 3 bytes a pixel, if that is the one that was drawn last for a mask, and with them.
    pub fn colours_of(&self, tick: Tick) -> Option<&[u8]> {
        self.drawn.as_ref().filter(|(drawn, rgb)| *drawn == tick && !rgb.is_empty()).map(|(_, rgb)| rgb.as_slice())
    }

    fn follow(&mut self, optics: &mut Optics, world: &World) -> anyhow::Result<()> {
        let tick = world.tick();
        if self.coming.as_ref().is_some_and(|c| c.shown.tick_shown <= tick) {
            self.on_screen = self.coming.take();
        }
        let is_dark = self.on_screen.is_none();
        if is_dark || tick.is_multiple_of(FRAME_TICKS) {
            let latency = if is_dark { 0 } else { LATENCY_TICKS };
            let (picture, rgb) = optics.picture(world, tick + latency)?;
            self.drawn = Some((tick, rgb));
            *(if is_dark { &mut self.on_screen } else { &mut self.coming }) = Some(picture);
        }
        Ok(())
    }
}

/// What the semantic driver of one drive looks at, and with what.
pub struct Vision {
    optics: Optics,
    screen: Screen,
}

impl Vision {
    /// Looks at the renderer's map through an eye.
    pub fn new(renderer: Renderer, eye: Eye) -> Self {
        Self { optics: Optics::new(renderer, eye), screen: Screen::default() }
    }

    /// What looks.
    pub fn eye(&self) -> &Eye {
        &self.optics.eye
    }

    /// The same renderer with another eye and a dark screen.
    pub fn with_eye(self, eye: Eye) -> Self {
        Self::new(self.optics.renderer, eye)
    }

    /// Hands the renderer back.
    pub fn into_renderer(self) -> Renderer {
        self.optics.renderer
    }

    /// As [`Screen::look`].
    pub fn look(&mut self, world: &World) -> anyhow::Result<(MaskView<'_>, MaskShown)> {
        self.screen.look(&mut self.optics, world)
    }
}

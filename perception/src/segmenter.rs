//! Runs a checkpoint on pictures of one size.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;

use crate::classes::UNLABELED_TAG;
use crate::compute::agree;
use crate::decode::{Decoder, Grid};
use crate::ends;
use crate::metadata::{Layout, ScoreKind};
use crate::onnx::{self, Element, Engine, Output, Pixels, pb};
use crate::scale::Scale;
use crate::{Certainty, Checkpoint, Compute, Mask, PerceptionError, RgbView};

/// A network made ready for pictures of one size. On the CPU single-threaded and deterministic; a
/// clone shares the weights.
#[derive(Clone)]
pub struct Segmenter {
    path: PathBuf,
    compute: Compute,
    width: usize,
    height: usize,
    /// From the picture's size to the network's, unless they are the same.
    scale: Option<Scale>,
    layout: Layout,
    element: Element,
    /// Input value of each byte for red, green and blue.
    table: Arc<[[f32; 256]; 3]>,
    /// Which of red, green and blue each channel is.
    channels: [usize; 3],
    engine: Engine,
    /// Whether the output is a class map, be it one of floats.
    is_map: bool,
    /// From scores finer than the picture to its pixels.
    coarsen: Option<(Scale, Grid)>,
    decoder: Decoder,
    score_kind: ScoreKind,
    tags: Vec<u8>,
    floats: Vec<f32>,
    bytes: Vec<u8>,
}

impl Segmenter {
    /// Makes the network ready on the CPU for pictures of `width` x `height` pixels. Where the network
    /// takes one size only, pictures are resampled to it; the mask always has the picture's size.
    pub fn new(checkpoint: &Checkpoint, width: usize, height: usize) -> Result<Self, PerceptionError> {
        Self::ready(Compute::Cpu, checkpoint, width, height)
    }

    /// As [`Segmenter::new`], computed by something else. It looks at a picture first, and is refused if
    /// it does not see there what the CPU sees.
    pub fn on(compute: Compute, checkpoint: &Checkpoint, width: usize, height: usize) -> Result<Self, PerceptionError> {
        let cpu = Self::new(checkpoint, width, height)?;
        if compute == Compute::Cpu {
            return Ok(cpu);
        }
        let tried = catch_unwind(AssertUnwindSafe(|| {
            let segmenter = Self::ready(compute, checkpoint, width, height)?;
            segmenter.compare(cpu)?;
            Ok(segmenter)
        }));
        let refuse = |reason| PerceptionError::Compute { name: compute.name(), reason };
        tried.unwrap_or_else(|_| Err(refuse("its libraries failed".into())))
    }

    /// Whether it makes of a picture what another one makes of it.
    fn compare(&self, mut other: Self) -> Result<(), PerceptionError> {
        let mut own = self.clone();
        let noise = |i: usize| (i as u32).wrapping_mul(0x9e37_79b9).to_be_bytes()[0] / 2 + (i / self.width % 128) as u8;
        let rgb: Vec<u8> = (0..3 * self.width * self.height).map(noise).collect();
        let image = RgbView::new(self.width, self.height, &rgb)?;
        let refuse = |reason| PerceptionError::Compute { name: self.compute.name(), reason };
        let (expected, found) = (other.output(image)?, own.output(image)?);
        agree(&other.decoder.in_planes(expected), &own.decoder.in_planes(found)).map_err(refuse)
    }

    fn ready(compute: Compute, checkpoint: &Checkpoint, width: usize, height: usize) -> Result<Self, PerceptionError> {
        if width == 0 || height == 0 {
            return Err(PerceptionError::ImageSize { bytes: 0, width, height, channels: 3 });
        }
        let input = checkpoint.input;
        let network = (input.width.unwrap_or(width), input.height.unwrap_or(height));
        let shape = match input.layout {
            Layout::Nchw => [1, 3, network.1, network.0],
            Layout::Nhwc => [1, network.1, network.0, 3],
        };
        let path = checkpoint.path().to_path_buf();
        let lacks = |reason| PerceptionError::Compute { name: compute.name(), reason };
        let runtime = onnx::runtime(compute.name()).map_err(lacks)?;
        let make = |model: &pb::ModelProto| {
            let engine = Engine::new(runtime.clone(), model, input.element, shape)?;
            let form = form(&engine, checkpoint.classes().count(), checkpoint.scores)?;
            Ok::<_, String>((engine, form))
        };
        // Most networks for several pictures take one as well.
        let (engine, (grid, is_map)) = match make(&checkpoint.model) {
            Err(_) if input.pictures > 1 => make(&ends::repeated(&checkpoint.model, input.pictures)),
            made => made,
        }
        // The CPU was asked before anything else.
        .map_err(|reason| match compute {
            Compute::Cpu => PerceptionError::NotSegmentation { path: path.clone(), reason },
            _ => lacks(reason),
        })?;
        let coarse = if is_map { grid } else { grid.within(width, height) };
        let decoder = Decoder::new(coarse, width, height, checkpoint.enlarge);
        Ok(Self {
            path,
            compute,
            width,
            height,
            scale: Scale::between((width, height), network),
            layout: if engine.takes_last { Layout::Nhwc } else { input.layout },
            element: input.element,
            table: Arc::new(checkpoint.metadata().normalisation.map_or([[0.0; 256]; 3], |n| n.table())),
            channels: checkpoint.metadata().channels.order(),
            is_map,
            coarsen: Scale::between((grid.width, grid.height), (coarse.width, coarse.height))
                .map(|scale| (scale, grid)),
            engine,
            decoder,
            score_kind: checkpoint.score_kind,
            tags: checkpoint.classes().tags().to_vec(),
            floats: Vec::new(),
            bytes: Vec::new(),
        })
    }

    /// What computes it.
    pub fn compute(&self) -> Compute {
        self.compute
    }

    /// Width and height in pixels of the pictures it takes.
    pub fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    /// The class of every pixel.
    pub fn run(&mut self, image: RgbView<'_>) -> Result<Mask, PerceptionError> {
        let output = self.output(image)?;
        self.mask(&output)
    }

    /// The class of every pixel, and how sure the network is of it. `None` for a network that gives classes only.
    pub fn run_with_certainty(&mut self, image: RgbView<'_>) -> Result<(Mask, Option<Certainty>), PerceptionError> {
        let output = self.output(image)?;
        let certainty = match &output {
            Output::Scores(scores) => Some(self.decoder.certainty(scores, self.score_kind)),
            Output::Ids(_) => None,
        };
        Ok((self.mask(&output)?, certainty))
    }

    /// What the network gives for a picture.
    fn output(&mut self, image: RgbView<'_>) -> Result<Output, PerceptionError> {
        if (image.width(), image.height()) != (self.width, self.height) {
            let (width, height) = (self.width, self.height);
            return Err(PerceptionError::ImageSize { bytes: image.bytes().len(), width, height, channels: 3 });
        }
        let resampled = self.scale.as_ref().map(|scale| scale.picture(image.bytes()));
        self.fill(resampled.as_deref().unwrap_or(image.bytes()));
        let pixels = match self.element {
            Element::Float => Pixels::Float(&self.floats),
            Element::Byte => Pixels::Byte(&self.bytes),
        };
        let fail = |reason| PerceptionError::Inference { path: self.path.clone(), reason };
        match self.engine.run(pixels).map_err(fail)? {
            Output::Scores(ids) if self.is_map => whole(&ids).map(Output::Ids).map_err(fail),
            Output::Scores(scores) if let Some((scale, grid)) = &self.coarsen => {
                Ok(Output::Scores(scale.scores(&scores, *grid)))
            }
            output => Ok(output),
        }
    }

    fn mask(&self, output: &Output) -> Result<Mask, PerceptionError> {
        let tags = match output {
            Output::Scores(scores) => {
                self.decoder.classes(scores).into_iter().map(|class| self.tags[usize::from(class)]).collect()
            }
            Output::Ids(ids) => self.decoder.nearest(ids).into_iter().map(|id| self.tag_of_id(id)).collect(),
        };
        Mask::new(self.width, self.height, tags)
    }

    /// Values that name no class, such as an "ignore" of 255, are unlabelled.
    fn tag_of_id(&self, id: i64) -> u8 {
        usize::try_from(id).ok().and_then(|id| self.tags.get(id)).copied().unwrap_or(UNLABELED_TAG)
    }

    /// Writes the picture in the network's own form.
    fn fill(&mut self, rgb: &[u8]) {
        match self.element {
            Element::Float => {
                let value = |colour: usize, byte| self.table[colour][usize::from(byte)];
                fill(&mut self.floats, rgb, self.layout, self.channels, value);
            }
            Element::Byte => fill(&mut self.bytes, rgb, self.layout, self.channels, |_, byte| byte),
        }
    }
}

fn fill<T: Copy + Default>(
    out: &mut Vec<T>,
    rgb: &[u8],
    layout: Layout,
    channels: [usize; 3],
    value: impl Fn(usize, u8) -> T,
) {
    out.resize(rgb.len(), T::default());
    let pixels = rgb.as_chunks::<3>().0;
    match layout {
        Layout::Nhwc => {
            for (out, pixel) in out.as_chunks_mut::<3>().0.iter_mut().zip(pixels) {
                *out = channels.map(|colour| value(colour, pixel[colour]));
            }
        }
        Layout::Nchw => {
            for (colour, plane) in channels.into_iter().zip(out.chunks_exact_mut(pixels.len())) {
                for (out, pixel) in plane.iter_mut().zip(pixels) {
                    *out = value(colour, pixel[colour]);
                }
            }
        }
    }
}

/// The ids of a class map of floats.
fn whole(ids: &[f32]) -> Result<Vec<i64>, String> {
    match ids.iter().find(|id| id.fract() != 0.0) {
        Some(odd) => Err(format!("its class map holds {odd}, which is no whole number")),
        None => Ok(ids.iter().map(|id| *id as i64).collect()),
    }
}

/// How the network's output is to be read, and whether it is a class map.
fn form(engine: &Engine, classes: usize, likely: Layout) -> Result<(Grid, bool), String> {
    let shape = &engine.output_shape;
    let text = || shape.iter().map(usize::to_string).collect::<Vec<_>>().join("x");
    if shape.contains(&0) {
        return Err(format!("its output has the shape {}, which holds nothing", text()));
    }
    let scores = |width, height, interleaved| Ok((Grid { channels: classes, width, height, interleaved }, false));
    let planes = |channels, width| channels == classes && (likely == Layout::Nchw || width != classes);
    match (engine.gives_ids, shape.as_slice()) {
        (false, &[1, h, w, c]) if engine.is_moved && c == classes => scores(w, h, true),
        (false, &[1, c, h, w] | &[c, h, w]) if planes(c, w) => scores(w, h, false),
        (false, &[1, h, w, c]) if c == classes => scores(w, h, true),
        (false, &[h, w, c]) if c == classes && h > 1 => scores(w, h, true),
        (_, &[1, h, w] | &[1, 1, h, w] | &[1, h, w, 1]) => {
            Ok((Grid { channels: 1, width: w, height: h, interleaved: false }, true))
        }
        (_, &[h, w]) if h > 1 && w > 1 => Ok((Grid { channels: 1, width: w, height: h, interleaved: false }, true)),
        _ => Err(format!(
            "its output has the shape {}, expected scores of {classes} classes (1xCxHxW or 1xHxWxC) or a class map",
            text()
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::onnx::pb::tensor_proto::DataType;
    use crate::toy::{self, Tail, Toy};

    const SIZE: (usize, usize) = (48, 32);

    fn mask(toy: &Toy, (width, height): (usize, usize)) -> Mask {
        let dir = tempfile::tempdir().unwrap();
        let checkpoint = Checkpoint::load(toy.write(dir.path())).unwrap();
        let mut segmenter = Segmenter::new(&checkpoint, width, height).unwrap();
        let rgb = toy::picture(width, height);
        let image = RgbView::new(width, height, &rgb).unwrap();
        let mask = segmenter.run(image).unwrap();
        assert_eq!(segmenter.clone().run(image).unwrap(), mask, "a clone gives the same");
        mask
    }

    fn expected(toy: &Toy) -> Vec<[f32; 3]> {
        let table = toy::metadata().normalisation.unwrap().table();
        let value = |c: usize, byte: u8| match toy.element {
            DataType::Uint8 => f32::from(byte),
            _ => table[c][usize::from(byte)],
        };
        toy::scores(&toy::picture(SIZE.0, SIZE.1), SIZE.0, SIZE.1, toy.stride, value)
    }

    #[test]
    fn every_kind_of_network_gives_the_mask_of_its_definition() {
        for layout in [Layout::Nchw, Layout::Nhwc] {
            for element in [DataType::Float, DataType::Uint8] {
                for tail in [Tail::None, Tail::Upsample, Tail::Argmax] {
                    for size in [None, Some((SIZE.1 as i64, SIZE.0 as i64))] {
                        let toy = Toy { layout, element, tail, size, ..Toy::default() };
                        toy::assert_highest(&mask(&toy, SIZE), &expected(&toy));
                    }
                }
            }
        }
    }

    #[test]
    fn scores_at_full_resolution_need_no_upsampling() {
        let toy = Toy { stride: 1, ..Toy::default() };
        toy::assert_highest(&mask(&toy, SIZE), &expected(&toy));
    }

    #[test]
    fn a_coarse_class_map_is_enlarged_to_the_nearest() {
        let toy = Toy { tail: Tail::CoarseArgmax, ..Toy::default() };
        let mask = mask(&toy, SIZE);
        for (i, id) in mask.ids.iter().enumerate() {
            let (x, y) = (i % SIZE.0 / 4 * 4, i / SIZE.0 / 4 * 4);
            assert_eq!(*id, mask.ids[y * SIZE.0 + x]);
        }
    }

    #[test]
    fn pictures_of_another_size_are_resampled() {
        let toy = Toy { size: Some((32, 48)), ..Toy::default() };
        let mask = mask(&toy, (96, 64));
        assert_eq!((mask.width, mask.height, mask.ids.len()), (96, 64, 96 * 64));
        assert!(mask.ids.iter().any(|id| *id != mask.ids[0]));
    }

    #[test]
    fn certainty_comes_with_the_same_mask_and_only_from_scores() {
        let tails = [(Tail::None, true), (Tail::Upsample, true), (Tail::Argmax, true), (Tail::CoarseArgmax, false)];
        for (tail, has_scores) in tails {
            let dir = tempfile::tempdir().unwrap();
            let checkpoint = Checkpoint::load(Toy { tail, ..Toy::default() }.write(dir.path())).unwrap();
            let mut segmenter = Segmenter::new(&checkpoint, SIZE.0, SIZE.1).unwrap();
            let rgb = toy::picture(SIZE.0, SIZE.1);
            let image = RgbView::new(SIZE.0, SIZE.1, &rgb).unwrap();
            let (mask, certainty) = segmenter.run_with_certainty(image).unwrap();
            assert_eq!(mask, segmenter.run(image).unwrap());
            assert_eq!(certainty.map(|c| c.confidence.len()), has_scores.then_some(SIZE.0 * SIZE.1));
        }
    }

    #[test]
    fn a_network_that_sees_something_else_is_refused() {
        let [early, full] = ["early", "full"].map(|name| {
            let checkpoint = crate::bundled(name).unwrap().unwrap();
            Segmenter::new(&checkpoint, 256, 128).unwrap()
        });
        assert!(early.compare(early.clone()).is_ok());
        assert!(early.compare(full).is_err());
    }

    #[test]
    fn the_wrong_size_of_picture_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let checkpoint = Checkpoint::load(Toy::default().write(dir.path())).unwrap();
        let mut segmenter = Segmenter::new(&checkpoint, 48, 32).unwrap();
        let rgb = toy::picture(32, 48);
        assert!(segmenter.run(RgbView::new(32, 48, &rgb).unwrap()).is_err());
    }
}

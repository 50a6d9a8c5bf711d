//! A network's file as it is, run by onnxruntime as its users run it.

use std::path::Path;

use anyhow::{anyhow, bail, ensure};
use ort::inputs;
use ort::session::Session;
use ort::session::builder::GraphOptimizationLevel;
use ort::value::TensorRef;
use perception::{Checkpoint, Normalisation};

use crate::{pictures, timed};

/// A session on one thread, and what its input is.
pub struct Theirs {
    session: Session,
    /// Of a network that takes planes of floats; others take bytes, channels last.
    normalisation: Option<Normalisation>,
    width: usize,
    height: usize,
}

/// Scores as planes, as pixels, or the index of every pixel's class; with their dimensions.
enum Given {
    Scores(Vec<usize>, Vec<f32>),
    Ids(Vec<i64>),
}

fn failed<T>(error: ort::Error<T>) -> anyhow::Error {
    anyhow!("{}", error.message())
}

impl Theirs {
    /// Opens a network for pictures of one size.
    pub fn open(path: &Path, checkpoint: &Checkpoint, (width, height): (usize, usize)) -> anyhow::Result<Self> {
        let environment = perception::onnxruntime().map_err(|reason| anyhow!(reason))?;
        let builder = Session::builder(&environment).map_err(failed)?;
        let builder = builder.with_optimization_level(GraphOptimizationLevel::All).map_err(failed)?;
        let builder = builder.with_intra_threads(1).map_err(failed)?;
        let mut builder = builder.with_inter_threads(1).map_err(failed)?;
        let session = builder.commit_from_file(path).map_err(failed)?;
        Ok(Self { session, normalisation: checkpoint.metadata().normalisation, width, height })
    }

    /// The tag of every pixel of a picture, and how long onnxruntime took, milliseconds.
    pub fn tags(&mut self, rgb: &[u8], tags: &[u8], out: &mut Vec<u8>) -> anyhow::Result<f64> {
        let (given, ms) = match self.normalisation {
            Some(Normalisation { mean, std }) => {
                let value = |c: usize, byte: u8| (f32::from(byte) / 255.0 - mean[c]) / std[c];
                let plane = |c| rgb.iter().skip(c).step_by(3).map(move |&byte| value(c, byte));
                let planes: Vec<f32> = (0..3).flat_map(plane).collect();
                self.run(TensorRef::from_array_view(([1, 3, self.height, self.width], &planes[..])).map_err(failed)?)
            }
            None => self.run(TensorRef::from_array_view(([1, self.height, self.width, 3], rgb)).map_err(failed)?),
        }?;
        *out = self.classes(given)?.into_iter().map(|class| tags[class]).collect();
        ensure!(out.len() == self.width * self.height, "a class map of {} pixels", out.len());
        Ok(ms)
    }

    fn run<'a>(&mut self, image: impl Into<ort::session::SessionInputValue<'a>>) -> anyhow::Result<(Given, f64)> {
        let (outputs, ms) = timed(|| self.session.run(inputs![image]).map_err(failed))?;
        let value = &outputs[0];
        if let Ok((_, ids)) = value.try_extract_tensor::<i64>() {
            return Ok((Given::Ids(ids.to_vec()), ms));
        }
        let (shape, scores) = value.try_extract_tensor::<f32>().map_err(failed)?;
        Ok((Given::Scores(shape.iter().map(|size| *size as usize).collect(), scores.to_vec()), ms))
    }

    /// The index of every pixel's class, the first one of the highest scores.
    fn classes(&self, given: Given) -> anyhow::Result<Vec<usize>> {
        let (shape, scores) = match given {
            Given::Ids(ids) => return Ok(ids.into_iter().map(|id| id as usize).collect()),
            Given::Scores(shape, scores) => (shape, scores),
        };
        let &[1, channels, rows, cols] = &shape[..] else { bail!("an output of {shape:?}") };
        if self.normalisation.is_none() {
            return Ok(scores.chunks_exact(cols).map(|pixel| highest(pixel.iter().copied())).collect());
        }
        let size = (self.width, self.height);
        let planes: Vec<Vec<f32>> =
            scores.chunks_exact(rows * cols).map(|plane| pictures::upsampled(plane, (cols, rows), size)).collect();
        ensure!(planes.len() == channels, "{} planes", planes.len());
        Ok((0..size.0 * size.1).map(|pixel| highest(planes.iter().map(|plane| plane[pixel]))).collect())
    }
}

fn highest(scores: impl Iterator<Item = f32>) -> usize {
    let best = |(at, best): (usize, f32), (i, score)| if score > best { (i, score) } else { (at, best) };
    scores.enumerate().fold((0, f32::NEG_INFINITY), best).0
}

//! A network made ready for one input shape, and run.

use std::sync::Arc;

use super::guard::guarded;

/// What the network takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Element {
    Float,
    Byte,
}

/// One picture in the network's own form.
pub(crate) enum Pixels<'a> {
    Float(&'a [f32]),
    Byte(&'a [u8]),
}

/// What the network gives.
#[derive(Debug)]
pub(crate) enum Output {
    Scores(Vec<f32>),
    Ids(Vec<i64>),
}

/// A network in the hands of what runs it.
pub(super) trait Plan: Send + Sync {
    /// The first output and its shape.
    fn run(&self, pixels: Pixels<'_>) -> Result<(Vec<usize>, Output), String>;
}

/// A network made ready for one input shape on one device; clones share the weights.
#[derive(Clone)]
pub(crate) struct Engine {
    pub(super) plan: Arc<dyn Plan>,
    /// Whether it takes the picture with the channels last, in whatever order the file has it.
    pub takes_last: bool,
    /// Shape of the first output.
    pub output_shape: Vec<usize>,
    /// Whether the file's order of the output's dimensions was batch, channels, rows and columns, and the channels are last
    /// here.
    pub is_moved: bool,
    /// Whether the first output holds class ids instead of scores.
    pub gives_ids: bool,
}

impl Engine {
    /// Runs the network on one picture.
    pub fn run(&self, pixels: Pixels<'_>) -> Result<Output, String> {
        guarded(|| {
            let (shape, output) = self.plan.run(pixels)?;
            if shape != self.output_shape || matches!(output, Output::Ids(_)) != self.gives_ids {
                return Err("its output has another form than it said".into());
            }
            let Output::Scores(scores) = &output else { return Ok(output) };
            match scores.iter().filter(|score| !score.is_finite()).count() {
                0 => Ok(output),
                odd => Err(format!("{odd} of its {} scores are no finite numbers", scores.len())),
            }
        })
    }
}

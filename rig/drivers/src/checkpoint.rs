//! The checkpoint that somebody asks for.

use std::convert::Infallible;
use std::path::PathBuf;
use std::str::FromStr;

use perception::BUNDLED;

/// What the semantic driver looks at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CheckpointChoice {
    /// `truth`: the renderer's class ids instead of a prediction.
    Truth,
    /// One that comes with the program, by name.
    Bundled(&'static str),
    /// An ONNX file.
    File(PathBuf),
}

impl FromStr for CheckpointChoice {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        let bundled = BUNDLED.into_iter().find(|name| *name == text);
        Ok(match bundled {
            _ if text == "truth" => Self::Truth,
            Some(name) => Self::Bundled(name),
            None => Self::File(PathBuf::from(text)),
        })
    }
}

//! The checkpoint that somebody asks for.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::PathBuf;
use std::str::FromStr;

use base::failure::Usage;
use perception::{BUNDLED, TRUTH};

use crate::external::External;

/// What the semantic driver looks at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CheckpointChoice {
    /// `truth`: the renderer's class ids instead of a prediction.
    Truth,
    /// One that comes with the program, by name.
    Bundled(&'static str),
    /// An ONNX file.
    File(PathBuf),
    /// A function of whoever uses these libraries.
    External(External),
}

impl CheckpointChoice {
    /// What it is called in results: its own name, of a file that without the ending.
    pub fn name(&self) -> Cow<'_, str> {
        match self {
            Self::Truth => TRUTH.into(),
            Self::Bundled(name) => (*name).into(),
            Self::File(path) => path.file_stem().unwrap_or_default().to_string_lossy(),
            Self::External(external) => external.name().into(),
        }
    }
}

impl FromStr for CheckpointChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.is_empty() {
            return Err(format!("nothing is named; expected one of {}, truth, or an ONNX file", BUNDLED.join(", ")));
        }
        let bundled = BUNDLED.into_iter().find(|name| *name == text);
        Ok(match bundled {
            _ if text == TRUTH => Self::Truth,
            Some(name) => Self::Bundled(name),
            None => Self::File(PathBuf::from(text)),
        })
    }
}

/// Refuses checkpoints that results could not tell apart.
pub fn check_names(choices: &[CheckpointChoice]) -> Result<(), Usage> {
    let mut known = HashMap::new();
    for choice in choices {
        let name = choice.name();
        match known.insert(name.clone(), choice) {
            Some(twin) if twin == choice => {
                return Err(Usage(format!("checkpoint {name} is given twice; expected each once")));
            }
            Some(_) => {
                return Err(Usage(format!("two checkpoints have the name {name}; expected names that differ")));
            }
            None => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checkpoints_that_results_could_not_tell_apart_are_refused() {
        let check = |names: &[&str]| {
            let choices: Vec<CheckpointChoice> = names.iter().map(|name| name.parse().expect("a choice")).collect();
            check_names(&choices).map_err(|Usage(said)| said)
        };
        assert_eq!(check(&["early", "full", "truth", "a/mine.onnx"]), Ok(()));
        assert_eq!(check(&["early", "early"]).unwrap_err(), "checkpoint early is given twice; expected each once");
        let said = "two checkpoints have the name early; expected names that differ";
        assert_eq!(check(&["early", "runs/early.onnx"]).unwrap_err(), said);
        assert!(check(&["a/net.onnx", "b/net.onnx"]).is_err());
        assert!("".parse::<CheckpointChoice>().unwrap_err().contains("expected one of early, full, truth"));
    }
}

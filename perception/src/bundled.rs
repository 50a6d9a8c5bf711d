//! The checkpoints that come with A-Eye, part of the program so that they are at hand everywhere.

use crate::{Checkpoint, PerceptionError};

/// Names of the bundled checkpoints: `early` was stopped on purpose and makes corner cases, `full`
/// was trained to the end. Their cards are in `perception/checkpoints`.
pub const BUNDLED: [&str; 2] = ["early", "full"];

/// What ground truth is called among checkpoints.
pub const TRUTH: &str = "truth";

const FILES: [&[u8]; BUNDLED.len()] =
    [include_bytes!("../checkpoints/early.onnx"), include_bytes!("../checkpoints/full.onnx")];

/// A bundled checkpoint by name, equal to the one that is read from its file.
pub fn bundled(name: &str) -> Option<Result<Checkpoint, PerceptionError>> {
    let k = BUNDLED.iter().position(|known| *known == name)?;
    Some(Checkpoint::from_bytes(name, FILES[k]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_bundled_checkpoint_is_the_one_in_its_file() {
        for name in BUNDLED {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("checkpoints/{name}.onnx"));
            let (own, read) = (bundled(name).unwrap().unwrap(), Checkpoint::load(path).unwrap());
            assert_eq!((own.name(), own.digest()), (read.name(), read.digest()));
            assert_eq!((own.metadata(), own.input_size()), (read.metadata(), read.input_size()));
        }
        assert!(bundled("none").is_none());
    }
}

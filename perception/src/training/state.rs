//! A training that is not finished, as a file: one line of JSON, the numbers in little-endian order,
//! and their digest.

use std::fs;
use std::io::Write;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::adam::Adam;
use super::weights::Weights;
use super::{EpochReport, TrainOptions};
use crate::PerceptionError;

const FORMAT: u32 = 1;

/// Where a training stands between two epochs.
pub(super) struct State {
    pub(super) weights: Weights,
    pub(super) adam: Adam,
    pub(super) history: Vec<EpochReport>,
}

#[derive(Serialize, Deserialize)]
struct Header {
    format: u32,
    options: TrainOptions,
    dataset: String,
    steps: u64,
    history: Vec<EpochReport>,
}

impl State {
    pub(super) fn new(seed: u64) -> Self {
        let weights = Weights::new(seed);
        Self { adam: Adam::new(&weights), weights, history: Vec::new() }
    }

    /// Every number, in a fixed order.
    fn numbers(&mut self) -> impl Iterator<Item = &mut f32> {
        let moments = self.weights.moments.iter_mut().flat_map(|m| [&mut m.mean, &mut m.variance]);
        let parameters = self.weights.parameters.iter_mut().map(|p| &mut p.values);
        parameters.chain(moments).chain(&mut self.adam.means).chain(&mut self.adam.squares).flatten()
    }

    /// Writes the file in one step.
    pub(super) fn save(
        &mut self,
        path: &Path,
        options: &TrainOptions,
        dataset: blake3::Hash,
    ) -> Result<(), PerceptionError> {
        let header = Header {
            format: FORMAT,
            options: options.clone(),
            dataset: dataset.to_hex().to_string(),
            steps: self.adam.steps,
            history: self.history.clone(),
        };
        let io = |source| PerceptionError::Io { path: path.to_owned(), source };
        let mut bytes = serde_json::to_vec(&header).map_err(|e| io(e.into()))?;
        bytes.push(b'\n');
        bytes.extend(self.numbers().flat_map(|v| v.to_le_bytes()));
        let digest = blake3::hash(&bytes);
        bytes.extend(digest.as_bytes());
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut file = tempfile::NamedTempFile::new_in(folder).map_err(io)?;
        file.write_all(&bytes).map_err(io)?;
        file.persist(path).map_err(|e| io(e.error))?;
        Ok(())
    }

    /// Reads the file if there is one; it must belong to these options and this dataset.
    pub(super) fn load(
        path: &Path,
        options: &TrainOptions,
        dataset: blake3::Hash,
    ) -> Result<Option<Self>, PerceptionError> {
        let refuse = |reason: &str| PerceptionError::Unfinished { path: path.to_owned(), reason: reason.into() };
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(PerceptionError::Io { path: path.to_owned(), source }),
        };
        let (content, digest) = bytes.split_last_chunk::<32>().ok_or_else(|| refuse("it is too short"))?;
        if blake3::hash(content) != *digest {
            return Err(refuse("its digest does not match its content"));
        }
        let end = content.iter().position(|b| *b == b'\n').ok_or_else(|| refuse("it has no header"))?;
        let header: Header = serde_json::from_slice(&content[..end]).map_err(|e| refuse(&e.to_string()))?;
        if header.format != FORMAT {
            return Err(refuse(&format!("it has format {}, expected {FORMAT}", header.format)));
        }
        if header.options != *options {
            return Err(refuse(&format!("it was begun with {:?}, asked for are {options:?}", header.options)));
        }
        if header.dataset != dataset.to_hex().as_str() {
            return Err(refuse(&format!("it was begun on dataset {}, given is {dataset}", header.dataset)));
        }
        let mut state = Self { history: header.history, ..Self::new(options.seed) };
        state.adam.steps = header.steps;
        let (numbers, rest) = content[end + 1..].as_chunks::<4>();
        if numbers.len() != state.numbers().count() || !rest.is_empty() {
            return Err(refuse("it holds another network"));
        }
        for (number, bytes) in state.numbers().zip(numbers) {
            *number = f32::from_le_bytes(*bytes);
        }
        Ok(Some(state))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_saved_comes_back_and_damage_or_other_options_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("c.onnx.part");
        let (options, dataset) = (TrainOptions::default(), blake3::hash(b"dataset"));
        assert!(State::load(&path, &options, dataset).unwrap().is_none());
        let mut state = State::new(3);
        state.adam.steps = 7;
        state.adam.squares[4][2] = 0.5;
        state.weights.moments[1].variance[3] = 2.0;
        state.history.push(EpochReport { epoch: 1, loss: 0.25, miou: None, iou: vec![Some(0.5)] });
        state.save(&path, &options, dataset).unwrap();
        let read = State::load(&path, &options, dataset).unwrap().unwrap();
        assert_eq!((&read.weights, &read.adam, &read.history), (&state.weights, &state.adam, &state.history));

        let said = |options: &TrainOptions, dataset| State::load(&path, options, dataset).err().unwrap().to_string();
        assert!(said(&TrainOptions { seed: 9, ..options.clone() }, dataset).contains("begun with"));
        assert!(said(&options, blake3::hash(b"other")).contains("begun on dataset"));
        let mut bytes = fs::read(&path).unwrap();
        bytes[5000] ^= 1;
        fs::write(&path, &bytes).unwrap();
        assert!(said(&options, dataset).contains("digest"));
        fs::write(&path, &bytes[..9]).unwrap();
        assert!(said(&options, dataset).contains("short"));
    }
}

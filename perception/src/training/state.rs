//! A training that is not finished, as a file: one line of JSON, the numbers in little-endian order,
//! and their digest.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::adam::Adam;
use super::options::TrainOptions;
use super::progress::EpochReport;
use super::weights::Weights;
use crate::PerceptionError;

const FORMAT: u32 = 2;

/// Where a training stands between two epochs.
pub(super) struct State {
    pub(super) weights: Weights,
    pub(super) adam: Adam,
    pub(super) history: Vec<EpochReport>,
    /// The network of the best epoch so far, where that one is to be kept.
    pub(super) best: Option<Weights>,
}

#[derive(Serialize, Deserialize)]
struct Header {
    format: u32,
    options: TrainOptions,
    dataset: String,
    steps: u64,
    history: Vec<Epoch>,
}

/// What is at the begin of a header of any format.
#[derive(Deserialize)]
struct Format {
    format: u32,
}

/// An [`EpochReport`] whose numbers are bits: reading a JSON number may change its last one.
#[derive(Serialize, Deserialize)]
struct Epoch {
    epoch: u32,
    loss: u64,
    miou: Option<u64>,
    iou: Vec<Option<u64>>,
}

impl From<&EpochReport> for Epoch {
    fn from(EpochReport { epoch, loss, miou, iou }: &EpochReport) -> Self {
        let iou = iou.iter().map(|v| v.map(f64::to_bits)).collect();
        Self { epoch: *epoch, loss: loss.to_bits(), miou: miou.map(f64::to_bits), iou }
    }
}

impl From<Epoch> for EpochReport {
    fn from(Epoch { epoch, loss, miou, iou }: Epoch) -> Self {
        let iou = iou.into_iter().map(|v| v.map(f64::from_bits)).collect();
        Self { epoch, loss: f64::from_bits(loss), miou: miou.map(f64::from_bits), iou }
    }
}

impl State {
    pub(super) fn new(seed: u64) -> Self {
        let weights = Weights::new(seed);
        Self { adam: Adam::new(&weights), weights, history: Vec::new(), best: None }
    }

    /// Notes what an epoch came to, and its network where it is the best so far and to be kept.
    pub(super) fn record(&mut self, report: EpochReport, options: &TrainOptions) {
        let epoch = report.epoch;
        self.history.push(report);
        if options.patience.is_some() && self.best_epoch() == epoch {
            self.best = Some(self.weights.clone());
        }
    }

    /// The first epoch with the highest validation mIoU, counted from 1; 0 before the first one.
    pub(super) fn best_epoch(&self) -> u32 {
        let miou = |report: &EpochReport| report.miou.unwrap_or(f64::NEG_INFINITY);
        let better = |best, report| if miou(report) > miou(best) { report } else { best };
        self.history.iter().reduce(better).map_or(0, |report| report.epoch)
    }

    /// Every number, in a fixed order.
    fn numbers(&mut self) -> impl Iterator<Item = &mut f32> {
        let adam = self.adam.means.iter_mut().chain(&mut self.adam.squares);
        let best = self.best.iter_mut().flat_map(Weights::vectors);
        self.weights.vectors().chain(adam).chain(best).flatten()
    }

    /// Writes the file in one step: under a hidden name beside it, which is the same each time, so that what a
    /// killed process left there goes.
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
            history: self.history.iter().map(Epoch::from).collect(),
        };
        let io = |source| PerceptionError::Io { path: path.to_owned(), source };
        let mut bytes = serde_json::to_vec(&header).map_err(|e| io(e.into()))?;
        bytes.push(b'\n');
        bytes.extend(self.numbers().flat_map(|v| v.to_le_bytes()));
        let digest = blake3::hash(&bytes);
        bytes.extend(digest.as_bytes());
        let hidden = hidden(path);
        let written = fs::write(&hidden, &bytes).and_then(|()| fs::rename(&hidden, path));
        written.map_err(|error| {
            let _ = fs::remove_file(&hidden);
            io(error)
        })
    }

    /// Reads the file if there is one; it must belong to these options and this dataset.
    pub(super) fn load(
        path: &Path,
        options: &TrainOptions,
        dataset: blake3::Hash,
    ) -> Result<Option<Self>, PerceptionError> {
        let refuse = |reason: &str| PerceptionError::Unfinished { path: path.to_owned(), reason: reason.into() };
        let bytes = match intake::read(path, intake::most::NETWORK) {
            Ok(bytes) => bytes,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(PerceptionError::Io { path: path.to_owned(), source }),
        };
        let (content, digest) = bytes.split_last_chunk::<32>().ok_or_else(|| refuse("it is too short"))?;
        if blake3::hash(content) != *digest {
            return Err(refuse("its digest does not match its content"));
        }
        let end = content.iter().position(|b| *b == b'\n').ok_or_else(|| refuse("it has no header"))?;
        let Format { format } = serde_json::from_slice(&content[..end]).map_err(|e| refuse(&e.to_string()))?;
        if format != FORMAT {
            return Err(refuse(&format!("it has format {format}, expected {FORMAT}")));
        }
        let header: Header = serde_json::from_slice(&content[..end]).map_err(|e| refuse(&e.to_string()))?;
        if header.options != *options {
            return Err(refuse(&format!("it was begun with {:?}, asked for are {options:?}", header.options)));
        }
        if header.dataset != dataset.to_hex().as_str() {
            let begun = header.dataset;
            return Err(refuse(&format!(
                "its dataset has changed: it was begun on BLAKE3 {begun}, now it is {dataset}"
            )));
        }
        let mut state =
            Self { history: header.history.into_iter().map(EpochReport::from).collect(), ..Self::new(options.seed) };
        state.adam.steps = header.steps;
        state.best = options.patience.filter(|_| !state.history.is_empty()).map(|_| state.weights.clone());
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

fn hidden(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".aeye-{name}"))
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
        state.history.push(EpochReport { epoch: 1, loss: 2.845400542020798, miou: None, iou: vec![Some(0.1), None] });
        fs::write(hidden(&path), "half").unwrap();
        state.save(&path, &options, dataset).unwrap();
        assert!(!hidden(&path).exists());
        let read = State::load(&path, &options, dataset).unwrap().unwrap();
        assert_eq!((&read.weights, &read.adam, &read.history), (&state.weights, &state.adam, &state.history));

        let said = |options: &TrainOptions, dataset| State::load(&path, options, dataset).err().unwrap().to_string();
        assert!(said(&TrainOptions { seed: 9, ..options.clone() }, dataset).contains("begun with"));
        assert!(said(&options, blake3::hash(b"other")).contains("its dataset has changed"));
        let mut bytes = fs::read(&path).unwrap();
        bytes[5000] ^= 1;
        fs::write(&path, &bytes).unwrap();
        assert!(said(&options, dataset).contains("digest"));
        fs::write(&path, &bytes[..9]).unwrap();
        assert!(said(&options, dataset).contains("short"));
    }
}

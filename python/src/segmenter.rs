//! Networks.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use drivers::checkpoint::CheckpointChoice;
use drivers::vision::Eye;
use numpy::{IntoPyArray, PyArray2, PyArrayMethods, PyReadonlyArray3, PyUntypedArrayMethods};
use perception::classes::tag_name;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use render::Frame;

use crate::errors::{input, raise};
use crate::given::Given;
use crate::values::described;

/// A segmentation network: `early` or `full`, which come with the package, or an ONNX file that takes one image.
///
/// Raises FileError where there is no such file, InputError where it is no such network.
#[pyclass(frozen, module = "aeye")]
pub struct Segmenter {
    choice: CheckpointChoice,
    name: String,
    digest: String,
    tags: Vec<u8>,
    eye: Mutex<Eye>,
}

#[pymethods]
impl Segmenter {
    #[new]
    fn new(py: Python<'_>, checkpoint: Given<PathBuf>) -> PyResult<Self> {
        let choice: CheckpointChoice = checkpoint.named("checkpoint")?.to_string_lossy().parse().map_err(input)?;
        let eye = py.detach(|| Eye::open(&choice)).map_err(|error| raise(&error))?;
        let Eye::Network { checkpoint, .. } = &eye else {
            return Err(input("truth is no network; expected early, full or an ONNX file".into()));
        };
        let mut tags = checkpoint.classes().tags().to_vec();
        tags.sort_unstable();
        tags.dedup();
        Ok(Self { name: eye.name().to_owned(), digest: eye.digest(), tags, choice, eye: Mutex::new(eye) })
    }

    /// `early`, `full`, or the file's name without its ending.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// BLAKE3 of the file, hexadecimal.
    #[getter]
    fn digest(&self) -> &str {
        &self.digest
    }

    /// The classes that it tells apart: what they are called by the number that masks have.
    #[getter]
    fn classes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let classes = PyDict::new(py);
        for tag in &self.tags {
            classes.set_item(tag, tag_name(*tag))?;
        }
        Ok(classes)
    }

    /// The class of every pixel, uint8 of shape (height, width), of a picture: uint8 of shape (height, width, 3), red,
    /// green, blue. Pictures of a size that the network does not take are resampled for it.
    ///
    /// Raises InputError for any other array, EngineError where the network fails.
    fn predict<'py>(&self, py: Python<'py>, rgb: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<u8>>> {
        let frame = picture(rgb)?;
        let mask = py.detach(|| self.see(frame)).map_err(|error| raise(&error))?;
        mask.ids.into_pyarray(py).reshape([mask.height, mask.width])
    }

    fn __repr__(&self) -> String {
        format!("Segmenter({})", self.name)
    }
}

impl Segmenter {
    fn see(&self, frame: Frame) -> anyhow::Result<perception::Mask> {
        let mut eye = self.eye.lock().unwrap_or_else(PoisonError::into_inner);
        let size = (frame.width, frame.height);
        if eye.size() != size {
            *eye = Eye::open_at(&self.choice, size)?;
        }
        eye.see(frame)
    }
}

/// A picture that somebody hands over.
fn picture(array: &Bound<'_, PyAny>) -> PyResult<Frame> {
    let refuse = || input(format!("expected an array of uint8 of shape (height, width, 3), got {}", described(array)));
    let array = array.extract::<PyReadonlyArray3<'_, u8>>().map_err(|_| refuse())?;
    let [height, width, channels] = *array.shape() else { return Err(refuse()) };
    let (Ok(width), Ok(height), 3) = (u32::try_from(width), u32::try_from(height), channels) else {
        return Err(refuse());
    };
    // One that is a part of another array, or turned, does not lie in memory row by row.
    let pixels = array.as_array();
    let rgb = pixels.as_slice().map_or_else(|| pixels.iter().copied().collect(), <[u8]>::to_vec);
    Ok(Frame { width, height, rgb, ..Frame::default() })
}

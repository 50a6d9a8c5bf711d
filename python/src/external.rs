//! Functions of Python in the place of checkpoints.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{anyhow, bail};
use base::failure::Usage;
use drivers::checkpoint::CheckpointChoice;
use drivers::external::{self, Sight};
use numpy::{IntoPyArray, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use perception::{Mask, RgbView};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::errors::input;
use crate::given::{Argument, Given, OneOrMore, Pair};
use crate::values::{DEFAULT_PAIR, described, picture_size};

/// A function in the place of a checkpoint, for `campaign`, `compare`, `redrive`, `evaluate` and `aeye.gym`: a network of
/// PyTorch, JAX or TensorRT drives without an ONNX file.
///
/// `function` takes a picture, uint8 of shape (height, width, 3): red, green, blue, and gives the class of every pixel,
/// uint8 of shape (height, width): keys of `aeye.CLASSES`. Threads call it, several at once where there are `jobs`; what it raises
/// ends the call and is raised there. In a drive pictures have the `size`, (width, height) in pixels.
///
/// Recordings and results say `name` and `version`, which no file stands behind: a function that changes needs
/// another version, or results of the old one are taken for its own.
///
/// Raises InputError for a name that no file can have or that is a checkpoint's of this package, and for a size that cannot be.
#[pyclass(frozen, module = "aeye")]
pub struct External {
    function: Py<PyAny>,
    name: String,
    version: String,
    size: (u32, u32),
}

#[pymethods]
impl External {
    #[new]
    #[pyo3(
        signature = (function, *, name, version, size = DEFAULT_PAIR),
        text_signature = "(function, *, name, version, size=(256, 128))"
    )]
    fn new(
        function: Bound<'_, PyAny>,
        name: Given<String>,
        version: Given<String>,
        size: Given<Pair>,
    ) -> PyResult<Self> {
        if !function.is_callable() {
            return Err(input(format!("function={}; expected something to call", function.get_type().name()?)));
        }
        let (name, version) = (name.named("name")?, version.named("version")?);
        let external = Self { function: function.unbind(), name, version, size: picture_size(size, "size")? };
        external.choice(&Raised::default())?;
        Ok(external)
    }

    /// The function.
    #[getter]
    fn function(&self) -> &Py<PyAny> {
        &self.function
    }

    /// What it is called in results.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// Which one of that name it is.
    #[getter]
    fn version(&self) -> &str {
        &self.version
    }

    /// Width and height of the pictures that it looks at in a drive, pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        self.size
    }

    fn __repr__(&self) -> String {
        let Self { name, version, size: (width, height), .. } = self;
        format!("External({name}, version {version}, {width}x{height})")
    }

    /// What it is made of, to travel to other processes with its function.
    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((&Py<PyAny>,), Bound<'py, PyDict>)> {
        let named = [("name", &self.name), ("version", &self.version)].into_py_dict(py)?;
        named.set_item("size", self.size)?;
        Ok(((&self.function,), named))
    }
}

impl External {
    /// Itself as a checkpoint of one call of this package, which raises what the function raises.
    pub fn choice(&self, raised: &Raised) -> PyResult<CheckpointChoice> {
        let function = Python::attach(|py| self.function.clone_ref(py));
        let sight = Arc::new(Called { function, name: self.name.clone(), raised: raised.clone() });
        let external = external::External::new(&self.name, &self.version, self.size, sight);
        Ok(CheckpointChoice::External(external.map_err(|Usage(sentence)| input(sentence))?))
    }
}

/// The exception that ended a call of this package.
#[derive(Clone, Default)]
pub struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    /// That exception, or else what the call came to.
    pub fn or<T>(&self, result: PyResult<T>) -> PyResult<T> {
        let raised = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        raised.map_or(result, Err)
    }

    fn is_there(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    fn keep(&self, error: PyErr) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
    }
}

/// A function, and where its exception goes: errors of the crates below are sentences.
struct Called {
    function: Py<PyAny>,
    name: String,
    raised: Raised,
}

impl Sight for Called {
    fn see(&self, picture: RgbView<'_>) -> anyhow::Result<Mask> {
        // One exception is enough, though other threads have not heard of it yet.
        if self.raised.is_there() {
            bail!("{}: has raised an exception", self.name);
        }
        let (shape, rgb) = ([picture.height(), picture.width(), 3], picture.bytes().to_vec());
        Python::attach(|py| {
            let call = || self.function.bind(py).call1((rgb.into_pyarray(py).reshape(shape)?,));
            let given = call().map_err(|error| {
                let sentence = anyhow!("{}: {error}", self.name);
                self.raised.keep(error);
                sentence
            })?;
            self.mask(&given)
        })
    }
}

impl Called {
    fn mask(&self, given: &Bound<'_, PyAny>) -> anyhow::Result<Mask> {
        let Ok(array) = given.extract::<PyReadonlyArray2<'_, u8>>() else {
            let (name, found) = (&self.name, described(given));
            let sentence = format!("{name}: gave {found}; expected an array of uint8 of shape (height, width)");
            return Err(Usage(sentence).into());
        };
        let [height, width] = *array.shape() else { bail!("{}: gave no picture", self.name) };
        Ok(Mask::new(width, height, array.as_array().iter().copied().collect())?)
    }
}

/// A checkpoint: `early`, `full`, `truth`, an ONNX file, or a function.
pub enum Checkpoint<'py> {
    External(PyRef<'py, External>),
    /// A name or a file.
    Named(PathBuf),
}

impl<'py> Argument<'py> for Checkpoint<'py> {
    fn expected() -> String {
        "a name, a file or an aeye.External".to_owned()
    }

    fn of(value: &Bound<'py, PyAny>) -> Result<Self, Bound<'py, PyAny>> {
        match value.extract() {
            Ok(external) => Ok(Self::External(external)),
            Err(_) => PathBuf::of(value).map(Self::Named),
        }
    }
}

/// What the crates below take for checkpoints, if there are any.
pub fn choices(given: Option<OneOrMore<Checkpoint<'_>>>, raised: &Raised) -> PyResult<Vec<CheckpointChoice>> {
    given.map_or_else(Vec::new, OneOrMore::list).iter().map(|checkpoint| checkpoint.choice(raised)).collect()
}

impl Checkpoint<'_> {
    /// What the crates below take, for one call of this package.
    pub fn choice(&self, raised: &Raised) -> PyResult<CheckpointChoice> {
        match self {
            Self::External(external) => external.choice(raised),
            Self::Named(path) => path.to_string_lossy().parse().map_err(input),
        }
    }
}

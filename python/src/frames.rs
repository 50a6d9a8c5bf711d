//! Pictures of a window.

use lab::shots::Shots;
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;

use crate::errors::raise;
use crate::forked::{self, Owned};
use crate::frame::Frame;

/// The frames of a window, as a sequence: each is drawn when it is asked for, and none is kept.
#[pyclass(frozen, sequence, module = "aeye")]
pub struct Frames {
    shots: Owned<Shots>,
}

impl From<Shots> for Frames {
    fn from(shots: Shots) -> Self {
        Self { shots: Owned::new(shots) }
    }
}

impl Frames {
    /// Draws one of them while Python's other threads go on.
    pub fn draw(&self, py: Python<'_>, index: usize) -> PyResult<Frame> {
        forked::check()?;
        let shot = py.detach(|| self.shots.draw(index)).map_err(|error| raise(&error))?;
        Frame::of(py, shot)
    }
}

#[pymethods]
impl Frames {
    /// Their ticks, uint64 of shape (n,), ascending.
    #[getter]
    fn ticks<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u64>> {
        self.shots.ticks().to_vec().into_pyarray(py)
    }

    fn __len__(&self) -> usize {
        self.shots.ticks().len()
    }

    fn __getitem__(&self, py: Python<'_>, index: isize) -> PyResult<Frame> {
        let length = self.__len__();
        let from_start = if index < 0 { index.checked_add_unsigned(length) } else { Some(index) };
        let found = from_start.and_then(|index| usize::try_from(index).ok()).filter(|index| *index < length);
        let index = found.ok_or_else(|| PyIndexError::new_err(format!("frame {index} of {length}")))?;
        self.draw(py, index)
    }

    fn __iter__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let builtins = slf.py().import("builtins")?;
        let numbers = builtins.call_method1("range", (slf.len()?,))?;
        builtins.call_method1("map", (slf.getattr("__getitem__")?, numbers))
    }

    fn __repr__(&self) -> String {
        format!("Frames(of {} ticks)", self.__len__())
    }
}

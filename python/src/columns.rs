//! Tables as dictionaries of arrays, one for each column.

use numpy::{Element, IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// A table that is being filled.
pub struct Columns<'py>(Bound<'py, PyDict>);

impl<'py> Columns<'py> {
    /// One without columns.
    pub fn new(py: Python<'py>) -> Self {
        Self(PyDict::new(py))
    }

    /// A column of numbers.
    pub fn add<T: Element>(self, name: &str, values: impl Iterator<Item = T>) -> PyResult<Self> {
        self.0.set_item(name, values.collect::<Vec<_>>().into_pyarray(self.0.py()))?;
        Ok(self)
    }

    /// A column of `N` numbers a row.
    pub fn add_wide<T: Element, const N: usize>(
        self,
        name: &str,
        rows: impl ExactSizeIterator<Item = [T; N]>,
    ) -> PyResult<Self> {
        let shape = [rows.len(), N];
        self.0.set_item(name, rows.flatten().collect::<Vec<_>>().into_pyarray(self.0.py()).reshape(shape)?)?;
        Ok(self)
    }

    /// A column of names.
    pub fn add_names(self, name: &str, values: impl ExactSizeIterator<Item = String>) -> PyResult<Self> {
        let py = self.0.py();
        let numpy = py.import("numpy")?;
        let kind = PyDict::new(py);
        kind.set_item("dtype", numpy.getattr("str_")?)?;
        self.0.set_item(name, numpy.call_method("array", (PyList::new(py, values)?,), Some(&kind))?)?;
        Ok(self)
    }

    /// The table.
    pub fn finish(self) -> Bound<'py, PyDict> {
        self.0
    }
}

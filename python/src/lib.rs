//! The native half of the Python package `aeye`: recordings and cases as arrays, their pictures, networks and metrics.
//! Everything is done by the crates that the command `aeye` stands on; here it takes Python's form.

mod camera;
mod campaigns;
mod columns;
mod compare;
mod errors;
mod experiments;
mod external;
mod forked;
mod forks;
mod frame;
mod frames;
mod given;
mod gym;
mod library;
mod log;
mod metrics;
mod recording;
mod segmenter;
mod values;
mod work;

use pyo3::pymodule;

/// The native half of the package `aeye`, which is what to import.
#[pymodule]
mod _aeye {
    use perception::classes::{TAGS, tag_name};
    use pyo3::prelude::*;
    use pyo3::types::PyDict;

    #[pymodule_export]
    use crate::camera::Camera;
    #[pymodule_export]
    use crate::campaigns::{campaign, collect};
    #[pymodule_export]
    use crate::compare::compare;
    #[pymodule_export]
    use crate::experiments::{experiment, pieces};
    #[pymodule_export]
    use crate::external::External;
    #[pymodule_export]
    use crate::forks::redrive;
    #[pymodule_export]
    use crate::frame::Frame;
    #[pymodule_export]
    use crate::frames::Frames;
    #[pymodule_export]
    use crate::gym::{Episodes, Setting};
    #[pymodule_export]
    use crate::library::cases;
    #[pymodule_export]
    use crate::metrics::evaluate;
    #[pymodule_export]
    use crate::recording::{Recording, open};
    #[pymodule_export]
    use crate::segmenter::Segmenter;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let classes = PyDict::new(module.py());
        for tag in 0..TAGS as u8 {
            classes.set_item(tag, tag_name(tag))?;
        }
        module.add("CLASSES", classes)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}

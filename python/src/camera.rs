//! The camera of a picture.

use glam::Mat3;
use kernel::scene::EgoScene;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use render::camera::OPTICAL;

/// The camera of a frame, a pinhole behind a lens, in the axes that OpenCV uses: x to the right, y down, z along the view.
#[pyclass(frozen, module = "aeye")]
pub struct Camera {
    /// Pixels a row.
    #[pyo3(get)]
    width: u32,
    /// Rows.
    #[pyo3(get)]
    height: u32,
    intrinsics: [f64; 9],
    distortion: [f64; 5],
    pose: [f64; 16],
}

impl Camera {
    /// That of a picture of which the ego car is there.
    pub fn of(camera: &render::Camera, ego: &EgoScene) -> Self {
        let (eye, rotation) = camera.pose(ego);
        let [x, y, z] = Mat3::from_quat(rotation * OPTICAL).to_cols_array_2d();
        let row = |i: usize, shift: f32| [x[i], y[i], z[i], shift].map(f64::from);
        let rows = [row(0, eye.x), row(1, eye.y), row(2, eye.z), [0.0, 0.0, 0.0, 1.0]];
        let mut pose = [0.0; 16];
        pose.as_chunks_mut::<4>().0.copy_from_slice(&rows);
        Self {
            width: camera.width,
            height: camera.height,
            intrinsics: camera.intrinsics(),
            distortion: camera.distortion(),
            pose,
        }
    }
}

#[pymethods]
impl Camera {
    /// The matrix K, float64 of shape (3, 3), pixels. The middle of the first pixel is at (0.5, 0.5).
    #[getter]
    fn intrinsics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.intrinsics.to_vec().into_pyarray(py).reshape([3, 3])
    }

    /// What its lens does, float64 of shape (5,): k1, k2, p1, p2 and k3 of OpenCV, 0 of an ideal one.
    #[getter]
    fn distortion<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.distortion.to_vec().into_pyarray(py)
    }

    /// From camera to world, float64 of shape (4, 4), metres: x east, y north, z up.
    #[getter]
    fn world_from_camera<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.pose.to_vec().into_pyarray(py).reshape([4, 4])
    }

    fn __repr__(&self) -> String {
        format!("Camera(width={}, height={})", self.width, self.height)
    }
}

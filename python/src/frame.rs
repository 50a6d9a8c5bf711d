//! A picture with its ground truth.

use kernel::SceneSnapshot;
use kernel::time::{TICK_HZ, Tick};
use lab::shots::Shot;
use numpy::{Element, IntoPyArray, PyArray2, PyArray3, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use render::instance_of_actor;

use crate::camera::Camera;
use crate::columns::Columns;

/// A picture of a tick, its ground truth, and what there is in the scene. The arrays are the renderer's own memory.
#[pyclass(frozen, module = "aeye")]
pub struct Frame {
    /// The tick, 60 a second.
    #[pyo3(get)]
    tick: Tick,
    /// Colour, uint8 of shape (height, width, 3): red, green, blue (sRGB).
    #[pyo3(get)]
    rgb: Py<PyArray3<u8>>,
    /// Class of each pixel, uint8 of shape (height, width): keys of `aeye.CLASSES`.
    #[pyo3(get)]
    class_ids: Py<PyArray2<u8>>,
    /// Instance of each pixel, uint16 of shape (height, width): 0 for none, up to 32767 an actor's number, from 32768 on
    /// a parked car's, 65535 the ego car.
    #[pyo3(get)]
    instance_ids: Py<PyArray2<u16>>,
    /// Distance along the view, float32 of shape (height, width), metres; infinite for the sky.
    #[pyo3(get)]
    depth_m: Py<PyArray2<f32>>,
    /// Where it was taken from, and how.
    #[pyo3(get)]
    camera: Py<Camera>,
    scene: SceneSnapshot,
}

impl Frame {
    /// Takes a picture over.
    pub fn of(py: Python<'_>, shot: Shot) -> PyResult<Self> {
        let Shot { frame, scene, camera } = shot;
        let size = [frame.height as usize, frame.width as usize];
        Ok(Self {
            tick: frame.tick,
            rgb: frame.rgb.into_pyarray(py).reshape([size[0], size[1], 3])?.unbind(),
            class_ids: plane(py, frame.class_ids, size)?,
            instance_ids: plane(py, frame.instance_ids, size)?,
            depth_m: plane(py, frame.depth_m, size)?,
            camera: Py::new(py, Camera::of(&camera, &scene.ego))?,
            scene,
        })
    }
}

/// An array that takes the memory over.
fn plane<T: Element>(py: Python<'_>, values: Vec<T>, size: [usize; 2]) -> PyResult<Py<PyArray2<T>>> {
    Ok(values.into_pyarray(py).reshape(size)?.unbind())
}

#[pymethods]
impl Frame {
    /// Simulated time since the start of the run, seconds.
    #[getter]
    fn time_s(&self) -> f64 {
        self.tick as f64 / f64::from(TICK_HZ)
    }

    /// The ego car: `position_m` (float32 of shape (3,), below the middle of its rear axle), `rotation_xyzw` (float32
    /// of shape (4,), a quaternion from its axes, x ahead, y left, z up, to the world's), `speed_mps`, and
    /// `wheel_angle_rad` (positive to the right).
    #[getter]
    fn ego<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let ego = &self.scene.ego;
        let state = PyDict::new(py);
        state.set_item("position_m", ego.position.to_array().to_vec().into_pyarray(py))?;
        state.set_item("rotation_xyzw", ego.rotation.to_array().to_vec().into_pyarray(py))?;
        state.set_item("speed_mps", ego.speed_mps)?;
        state.set_item("wheel_angle_rad", ego.wheel_angle_rad)?;
        Ok(state)
    }

    /// The other road users, a row each: `id` (uint32), `instance_id` (uint16, as in `instance_ids`), `kind` (names),
    /// `position_m` (float32 of shape (n, 3), the middle of the footprint), `rotation_xyzw` (float32 of shape (n, 4)),
    /// `size_m` (float32 of shape (n, 3): length, width, height), `speed_mps` (float32). Parked cars are among them only
    /// where they were hit; their open doors (`Door`) are, with the instance of the car.
    #[getter]
    fn actors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let rows = self.scene.actors.iter();
        let columns = Columns::new(py)
            .add("id", rows.clone().map(|actor| actor.id))?
            .add("instance_id", rows.clone().map(|actor| instance_of_actor(actor.id)))?
            .add_names("kind", rows.clone().map(|actor| format!("{:?}", actor.kind)))?
            .add_wide("position_m", rows.clone().map(|actor| actor.position.to_array()))?
            .add_wide("rotation_xyzw", rows.clone().map(|actor| actor.rotation.to_array()))?
            .add_wide("size_m", rows.clone().map(|actor| actor.kind.size_m().to_array()))?
            .add("speed_mps", rows.map(|actor| actor.speed_mps))?;
        Ok(columns.finish())
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let shape = self.rgb.bind(py).shape();
        format!("Frame(tick={}, size={}x{})", self.tick, shape[1], shape[0])
    }
}

//! What a log holds as tables.

use kernel::Controls;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use replay::Log;

use crate::columns::Columns;

/// Names of what a bit of [`Controls::flags`] stands for.
const FLAGS: [(&str, u8); 8] = [
    ("hand_brake", Controls::HAND_BRAKE),
    ("reverse", Controls::REVERSE),
    ("seen", Controls::SEEN),
    ("indicate_left", Controls::INDICATE_LEFT),
    ("indicate_right", Controls::INDICATE_RIGHT),
    ("horn", Controls::HORN),
    ("lights", Controls::LIGHTS),
    ("wipers", Controls::WIPERS),
];

/// Both drivers' controls.
pub fn controls<'py>(py: Python<'py>, log: &Log) -> PyResult<Bound<'py, PyDict>> {
    let seats = PyDict::new(py);
    seats.set_item("semantic", of_seat(py, log.inputs.iter().map(|input| input.semantic))?)?;
    seats.set_item("safety", of_seat(py, log.inputs.iter().map(|input| input.safety))?)?;
    Ok(seats)
}

fn of_seat<'py>(py: Python<'py>, rows: impl Iterator<Item = Controls> + Clone) -> PyResult<Bound<'py, PyDict>> {
    let mut columns = Columns::new(py)
        .add("steering", rows.clone().map(|c| c.steer_fraction()))?
        .add("throttle", rows.clone().map(|c| c.throttle_fraction()))?
        .add("brake", rows.clone().map(|c| c.brake_fraction()))?;
    for (name, flag) in FLAGS {
        columns = columns.add(name, rows.clone().map(|c| c.has(flag)))?;
    }
    Ok(columns.finish())
}

/// What happened in the world.
pub fn events<'py>(py: Python<'py>, log: &Log) -> PyResult<Bound<'py, PyDict>> {
    let rows = log.events.iter();
    let columns = Columns::new(py)
        .add("tick", rows.clone().map(|(tick, _)| *tick))?
        .add_names("kind", rows.clone().map(|(_, event)| format!("{:?}", event.kind)))?
        .add("actor", rows.clone().map(|(_, event)| event.actor))?
        .add("speed_mps", rows.map(|(_, event)| event.speed_mps))?;
    Ok(columns.finish())
}

/// The masks that were shown to the semantic driver.
pub fn masks<'py>(py: Python<'py>, log: &Log) -> PyResult<Bound<'py, PyDict>> {
    let rows = log.masks.iter();
    let columns = Columns::new(py)
        .add("tick_shown", rows.clone().map(|mask| mask.tick_shown))?
        .add("tick_of_frame", rows.clone().map(|mask| mask.tick_of_frame))?
        .add("digest", rows.map(|mask| mask.digest))?;
    Ok(columns.finish())
}

/// What was said about the intervention; `None` where nobody said anything.
pub fn labels<'py>(py: Python<'py>, log: &Log) -> PyResult<Option<Bound<'py, PyDict>>> {
    let Some(said) = &log.annotation else { return Ok(None) };
    let labels = PyDict::new(py);
    labels.set_item("label", said.label.name())?;
    labels.set_item("comment", &said.comment)?;
    labels.set_item("perception_caused", said.perception_caused)?;
    Ok(Some(labels))
}

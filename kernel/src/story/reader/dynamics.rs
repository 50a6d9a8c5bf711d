//! How something changes, and how long that takes.

use crate::story::error::StoryError;
use crate::story::script::{Dynamics, Shape, Takes};

use super::document::Element;
use crate::time::{TICK_HZ, Tick};

/// The courses of changes.
pub const SHAPES: &[(&str, Shape)] =
    &[("linear", Shape::Linear), ("cubic", Shape::Cubic), ("sinusoidal", Shape::Sinusoidal), ("step", Shape::Step)];

/// How something changes.
pub fn dynamics(element: Element<'_>) -> Result<Dynamics, StoryError> {
    type Of = fn(f32) -> Takes;
    const DIMENSIONS: &[(&str, Of)] = &[("time", Takes::Time), ("distance", Takes::Distance), ("rate", Takes::Rate)];
    let shape = element.word("dynamicsShape", SHAPES)?;
    if shape == Shape::Step && element.given("value")?.is_none() {
        element.given("dynamicsDimension")?;
        return Ok(Dynamics { shape, takes: Takes::Time(0.0) });
    }
    let takes = element.word("dynamicsDimension", DIMENSIONS)?;
    // Some files write the sign of a rate, though the target says which it has.
    let is_rate = matches!(takes(0.0), Takes::Rate(_));
    let value = if is_rate { element.float("value")?.abs() } else { element.amount("value")? };
    Ok(Dynamics { shape, takes: takes(value) })
}

/// Seconds as ticks.
pub fn ticks(seconds: f32) -> Tick {
    // At most what a run can last.
    (seconds.min(1e6) * TICK_HZ as f32 + 0.5) as Tick
}

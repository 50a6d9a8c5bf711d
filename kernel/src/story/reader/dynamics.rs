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
    let shape = element.word("dynamicsShape", SHAPES)?;
    let value = element.amount("value")?;
    let takes = [("time", Takes::Time(value)), ("distance", Takes::Distance(value)), ("rate", Takes::Rate(value))];
    Ok(Dynamics { shape, takes: element.word("dynamicsDimension", &takes)? })
}

/// Seconds as ticks.
pub fn ticks(seconds: f32) -> Tick {
    // At most what a run can last.
    (seconds.min(1e6) * TICK_HZ as f32 + 0.5) as Tick
}

//! Places, in the words of the text.

use crate::story::error::StoryError;
use crate::story::script::{Facing, Position};

use super::document::Element;
use super::names::Names;

/// The place in an element `<Position>`.
pub fn read(position: Element<'_>, names: &Names<'_>) -> Result<Position, StoryError> {
    let place = position.choice()?;
    match place.tag() {
        "WorldPosition" => Ok(Position::World {
            at_m: [place.number("x")?, place.number("y")?],
            z_m: place.number_given("z")?,
            heading_rad: place.number_given("h")?.map(|heading_rad| heading_rad as f32),
            at: place.begins(),
        }),
        "LanePosition" => Ok(Position::Lane {
            road: place.text("roadId")?,
            lane: place.whole("laneId")?,
            s_m: place.number("s")?,
            offset_m: place.metres("offset")?.into(),
            facing: facing(place)?,
            at: place.begins(),
        }),
        "RoadPosition" => Ok(Position::Road {
            road: place.text("roadId")?,
            s_m: place.number("s")?,
            t_m: place.need_metres("t")?.into(),
            facing: facing(place)?,
            at: place.begins(),
        }),
        "RelativeWorldPosition" | "RelativeObjectPosition" => Ok(Position::Beside {
            role: names.role(place, "entityRef")?,
            by_m: [place.need_metres("dx")?, place.need_metres("dy")?],
            own_axes: place.tag() == "RelativeObjectPosition",
            facing: facing(place)?,
        }),
        "RelativeRoadPosition" => Ok(Position::BesideRoad {
            role: names.role(place, "entityRef")?,
            by_m: [place.need_metres("ds")?, place.need_metres("dt")?],
            facing: facing(place)?,
        }),
        "RelativeLanePosition" => Ok(Position::BesideLane {
            role: names.role(place, "entityRef")?,
            lanes: place.whole("dLane")?,
            ahead_m: place.need_metres(if place.given("ds")?.is_some() { "ds" } else { "dsLane" })?,
            offset_m: place.metres("offset")?,
            facing: facing(place)?,
        }),
        _ => Err(place.unsupported()),
    }
}

/// Whether a place says how who is there faces, other than as traffic, the road or the role does.
pub fn says_heading(place: &Position) -> bool {
    match place {
        Position::World { heading_rad, .. } => heading_rad.is_some(),
        Position::Known(_) => false,
        Position::Lane { facing, .. }
        | Position::Road { facing, .. }
        | Position::Beside { facing, .. }
        | Position::BesideRoad { facing, .. }
        | Position::BesideLane { facing, .. } => *facing != Facing::Relative(0.0),
    }
}

/// What `<Orientation>` says; who says nothing faces as traffic, the road or the role does.
fn facing(place: Element<'_>) -> Result<Facing, StoryError> {
    let Some(orientation) = place.child("Orientation") else { return Ok(Facing::Relative(0.0)) };
    let heading_rad = orientation.or_zero("h")? as f32;
    let is_relative = orientation.word_given("type", &[("relative", true), ("absolute", false)])?;
    // The standard's default is absolute.
    Ok(if is_relative.unwrap_or(false) { Facing::Relative(heading_rad) } else { Facing::Absolute(heading_rad) })
}

//! Places, in the words of the text.

use crate::story::error::StoryError;
use crate::story::script::{Facing, Position};

use super::document::Element;
use super::names::Names;
use super::vary;

/// The place in an element `<Position>`.
pub fn read(position: Element<'_>, names: &Names<'_>) -> Result<Position, StoryError> {
    let place = position.choice()?;
    let facing = |place: Element<'_>| facing(place, names);
    let (left, left_f32) = (names.left, names.left as f32);
    match place.tag() {
        "WorldPosition" => Ok(Position::World {
            at_m: [place.number("x")?, left * place.number("y")?],
            z_m: place.number_given("z")?,
            heading_rad: place.number_given("h")?.map(|heading_rad| (left * heading_rad) as f32),
            at: place.begins(),
        }),
        // The reference line.
        "LanePosition" if place.whole("laneId")? == 0 => Ok(Position::Road {
            road: place.text("roadId")?,
            s_m: place.number("s")?,
            t_m: left * f64::from(place.metres("offset")?),
            facing: facing(place)?,
            at: place.begins(),
        }),
        "LanePosition" => Ok(Position::Lane {
            road: place.text("roadId")?,
            lane: place.whole("laneId")?,
            s_m: place.number("s")?,
            offset_m: left * f64::from(place.metres("offset")?),
            facing: facing(place)?,
            at: place.begins(),
        }),
        "RoadPosition" => Ok(Position::Road {
            road: place.text("roadId")?,
            s_m: place.number("s")?,
            t_m: left * f64::from(place.need_metres("t")?),
            facing: facing(place)?,
            at: place.begins(),
        }),
        "RelativeWorldPosition" | "RelativeObjectPosition" => Ok(Position::Beside {
            role: names.role(place, "entityRef")?,
            by_m: [place.need_metres("dx")?, left_f32 * place.need_metres("dy")?],
            own_axes: place.tag() == "RelativeObjectPosition",
            facing: facing(place)?,
        }),
        "RelativeRoadPosition" => Ok(Position::BesideRoad {
            role: names.role(place, "entityRef")?,
            by_m: [place.need_metres("ds")?, left_f32 * place.need_metres("dt")?],
            facing: facing(place)?,
        }),
        "RelativeLanePosition" => Ok(Position::BesideLane {
            role: names.role(place, "entityRef")?,
            lanes: place.whole("dLane")?,
            ahead_m: place.need_metres(if place.given("ds")?.is_some() { "ds" } else { "dsLane" })?,
            offset_m: left_f32 * place.metres("offset")?,
            facing: facing(place)?,
        }),
        "RoutePosition" => on_route(place, names),
        _ => Err(place.unsupported()),
    }
}

/// Most places of a route.
const WAYPOINTS: usize = 100;

/// The places that a route leads through.
pub fn waypoints(route: Element<'_>, names: &Names<'_>) -> Result<Vec<Position>, StoryError> {
    is_open(route)?;
    vary::pass_parameters(route)?;
    let mut places = Vec::new();
    for waypoint in route.all("Waypoint") {
        if places.len() == WAYPOINTS {
            return Err(waypoint.wrong(format!("expected at most {WAYPOINTS} waypoints")));
        }
        waypoint.spend(5)?;
        places.push(read(waypoint.need("Position")?, names)?);
    }
    if places.is_empty() {
        return Err(route.wrong("<Route> has no <Waypoint>"));
    }
    Ok(places)
}

/// Refuses what comes back to its beginning.
pub fn is_open(way: Element<'_>) -> Result<(), StoryError> {
    match way.switch("closed")? {
        Some(true) => Err(way.wrong(format!("closed=\"true\" of <{}> is not supported", way.tag()))),
        _ => Ok(()),
    }
}

fn on_route(place: Element<'_>, names: &Names<'_>) -> Result<Position, StoryError> {
    let facing = facing(place, names)?;
    let via = waypoints(place.need("RouteRef")?.need("Route")?, names)?;
    let within = place.need("InRoutePosition")?.choice()?;
    let (lane, offset_m) = match within.tag() {
        "FromLaneCoordinates" => (within.whole("laneId")?, within.metres("laneOffset")?),
        "FromRoadCoordinates" => (0, within.need_metres("t")?),
        _ => return Err(within.unsupported()),
    };
    within.amount("pathS")?;
    let (s_m, offset_m) = (within.metres("pathS")?, names.left as f32 * offset_m);
    Ok(Position::Route { via, s_m, lane, offset_m, facing, at: place.begins() })
}

/// Whether a place says how who is there faces, other than as traffic, the road or the role does.
pub fn says_heading(place: &Position) -> bool {
    match place {
        Position::World { heading_rad, .. } => heading_rad.is_some(),
        Position::Known(_) => false,
        Position::Lane { facing, .. }
        | Position::Road { facing, .. }
        | Position::Route { facing, .. }
        | Position::Beside { facing, .. }
        | Position::BesideRoad { facing, .. }
        | Position::BesideLane { facing, .. } => *facing != Facing::Relative(0.0),
    }
}

/// What `<Orientation>` says; who says nothing faces as traffic, the road or the role does.
fn facing(place: Element<'_>, names: &Names<'_>) -> Result<Facing, StoryError> {
    let Some(orientation) = place.child("Orientation") else { return Ok(Facing::Relative(0.0)) };
    let heading_rad = (names.left * orientation.or_zero("h")?) as f32;
    let is_relative = orientation.word_given("type", &[("relative", true), ("absolute", false)])?;
    // The standard's default is absolute.
    Ok(if is_relative.unwrap_or(false) { Facing::Relative(heading_rad) } else { Facing::Absolute(heading_rad) })
}

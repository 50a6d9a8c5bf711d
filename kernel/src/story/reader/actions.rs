//! What somebody does.

use crate::story::error::StoryError;
use crate::story::script::{Action, Dynamics, LaneTarget, Path, Position, RoleId, Shape, SpeedTarget, Takes};

use super::document::Element;
use super::names::Names;
use super::positions;

/// Most corners of a line, and most places of a route.
const CORNERS: usize = 100_000;
const WAYPOINTS: usize = 100;

/// The actions in an element of a choice; none where they change nothing here.
pub fn private(action: Element<'_>, names: &Names<'_>) -> Result<Option<Action>, StoryError> {
    let kind = action.choice()?;
    let found = match kind.tag() {
        "LongitudinalAction" => {
            let speed = kind.choice()?;
            match speed.tag() {
                "SpeedAction" => self::speed(speed, names)?,
                _ => return Err(speed.unsupported()),
            }
        }
        "LateralAction" => {
            let across = kind.choice()?;
            match across.tag() {
                "LaneChangeAction" => lane_change(across, names)?,
                "LaneOffsetAction" => lane_offset(across, names)?,
                _ => return Err(across.unsupported()),
            }
        }
        "RoutingAction" => {
            let way = kind.choice()?;
            match way.tag() {
                "AssignRouteAction" => route(way, names)?,
                "AcquirePositionAction" => Action::Acquire(positions::read(way.need("Position")?, names)?),
                "FollowTrajectoryAction" => Action::Follow(path(way, names)?),
                _ => return Err(way.unsupported()),
            }
        }
        "TeleportAction" => Action::Teleport(positions::read(kind.need("Position")?, names)?),
        "ControllerAction" | "ActivateControllerAction" | "VisibilityAction" | "AppearanceAction" => return Ok(None),
        _ => return Err(kind.unsupported()),
    };
    Ok(Some(found))
}

/// A global action, with the role that it is about.
pub fn global(action: Element<'_>, names: &Names<'_>) -> Result<(RoleId, Action), StoryError> {
    let kind = action.choice()?;
    if kind.tag() != "EntityAction" {
        return Err(kind.unsupported());
    }
    let role = names.role(kind, "entityRef")?;
    let what = kind.choice()?;
    match what.tag() {
        "DeleteEntityAction" => Ok((role, Action::Leave)),
        _ => Err(what.unsupported()),
    }
}

fn dynamics(element: Element<'_>) -> Result<Dynamics, StoryError> {
    let shapes =
        [("linear", Shape::Linear), ("cubic", Shape::Cubic), ("sinusoidal", Shape::Sinusoidal), ("step", Shape::Step)];
    let shape = element.word("dynamicsShape", &shapes)?;
    let value = element.amount("value")?;
    let takes = [("time", Takes::Time(value)), ("distance", Takes::Distance(value)), ("rate", Takes::Rate(value))];
    Ok(Dynamics { shape, takes: element.word("dynamicsDimension", &takes)? })
}

fn speed(action: Element<'_>, names: &Names<'_>) -> Result<Action, StoryError> {
    let dynamics = dynamics(action.need("SpeedActionDynamics")?)?;
    let target = action.need("SpeedActionTarget")?.choice()?;
    let target = match target.tag() {
        "AbsoluteTargetSpeed" => SpeedTarget::Absolute(target.float("value")?),
        "RelativeTargetSpeed" => {
            let (role, value) = (names.role(target, "entityRef")?, target.float("value")?);
            let goes_on = target.switch("continuous")?.unwrap_or(false);
            let kinds = [
                ("delta", SpeedTarget::Faster(role, value, goes_on)),
                ("factor", SpeedTarget::Times(role, value, goes_on)),
            ];
            target.word("speedTargetValueType", &kinds)?
        }
        _ => return Err(target.unsupported()),
    };
    Ok(Action::Speed(dynamics, target))
}

fn lane_change(action: Element<'_>, names: &Names<'_>) -> Result<Action, StoryError> {
    let offset_m = action.or_zero("targetLaneOffset")? as f32;
    let dynamics = dynamics(action.need("LaneChangeActionDynamics")?)?;
    let target = action.need("LaneChangeTarget")?.choice()?;
    let target = match target.tag() {
        "AbsoluteTargetLane" => LaneTarget::Absolute(target.whole("value")?),
        "RelativeTargetLane" => LaneTarget::Relative(names.role(target, "entityRef")?, target.whole("value")?),
        _ => return Err(target.unsupported()),
    };
    Ok(Action::LaneChange(dynamics, target, offset_m))
}

fn lane_offset(action: Element<'_>, names: &Names<'_>) -> Result<Action, StoryError> {
    action.switch("continuous")?;
    let dynamics_of = action.need("LaneOffsetActionDynamics")?;
    let shapes =
        [("linear", Shape::Linear), ("cubic", Shape::Cubic), ("sinusoidal", Shape::Sinusoidal), ("step", Shape::Step)];
    let shape = dynamics_of.word("dynamicsShape", &shapes)?;
    let most_mps2 = dynamics_of.number_given("maxLateralAcc")?;
    let target = action.need("LaneOffsetTarget")?.choice()?;
    let (offset_m, role) = match target.tag() {
        "AbsoluteTargetLaneOffset" => (target.float("value")?, None),
        "RelativeTargetLaneOffset" => (target.float("value")?, Some(names.role(target, "entityRef")?)),
        _ => return Err(target.unsupported()),
    };
    // So fast that its greatest acceleration is the one of the file, or of a calm driver; `Takes::Time` cannot say it before
    // the way is known.
    let takes = Takes::Rate(most_mps2.unwrap_or(0.5).max(1e-3) as f32);
    Ok(Action::LaneOffset(Dynamics { shape, takes }, offset_m, role))
}

fn route(action: Element<'_>, names: &Names<'_>) -> Result<Action, StoryError> {
    let route = action.need("Route")?;
    route.pass_parameters();
    let mut places = Vec::new();
    for waypoint in route.all("Waypoint") {
        if places.len() == WAYPOINTS {
            return Err(waypoint.wrong(format!("expected at most {WAYPOINTS} waypoints")));
        }
        places.push(positions::read(waypoint.need("Position")?, names)?);
    }
    if places.is_empty() {
        return Err(route.wrong("<Route> has no <Waypoint>"));
    }
    Ok(Action::Route(places))
}

fn path(action: Element<'_>, names: &Names<'_>) -> Result<Path, StoryError> {
    if let Some(mode) = action.child("TrajectoryFollowingMode") {
        mode.given("followingMode")?;
    }
    let within = action.child("TrajectoryRef").unwrap_or(action);
    let trajectory = within.need("Trajectory")?;
    trajectory.pass_parameters();
    let line = trajectory.need("Shape")?.choice()?;
    if line.tag() != "Polyline" {
        return Err(line.unsupported());
    }
    let timing = action.child("TimeReference").and_then(|reference| reference.child("Timing"));
    if let Some(reference) = action.child("TimeReference") {
        reference.child("None");
    }
    let (mut absolute, mut scale, mut offset_s) = (false, 1.0, 0.0);
    if let Some(timing) = timing {
        absolute = timing.word("domainAbsoluteRelative", &[("absolute", true), ("relative", false)])?;
        (scale, offset_s) = (timing.float("scale")?, timing.float("offset")?);
        if scale <= 0.0 {
            return Err(timing.wrong(format!("scale of <Timing> is {scale}, expected a number above 0")));
        }
    }
    let mut corners: Vec<(_, Option<f32>)> = Vec::new();
    let mut headings = false;
    for vertex in line.all("Vertex") {
        if corners.len() == CORNERS {
            return Err(vertex.wrong(format!("expected at most {CORNERS} vertices")));
        }
        let time_s = vertex.number_given("time")?.map(|time_s| time_s as f32 * scale + offset_s);
        let before = corners.last().and_then(|(_, time_s)| *time_s);
        if let (Some(before), Some(time_s)) = (before, time_s)
            && time_s < before
        {
            return Err(vertex.wrong("time of <Vertex> is before that of the one before"));
        }
        let position = positions::read(vertex.need("Position")?, names)?;
        headings |= matches!(position, Position::World { heading_rad: Some(_), .. });
        corners.push((position, time_s));
    }
    if corners.len() < 2 {
        return Err(line.wrong("expected two or more <Vertex>"));
    }
    let timed = timing.is_some();
    if timed && corners.iter().any(|(_, time_s)| time_s.is_none()) {
        return Err(line.wrong("expected a time of every <Vertex>, as <Timing> asks for"));
    }
    let from_m = action.number_given("initialDistanceOffset")?.unwrap_or(0.0) as f32;
    Ok(Path { corners, absolute, timed, from_m, headings })
}

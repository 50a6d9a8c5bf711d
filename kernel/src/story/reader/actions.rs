//! What somebody does.

use crate::story::error::StoryError;
use crate::story::script::{Abreast, Action, Doer, Door, Dynamics, LaneTarget, Path, Takes};

use super::document::Element;
use super::dynamics::{SHAPES, dynamics, ticks};
use super::names::Names;
use super::{environment, positions, signals, speeds, vary};

/// Most corners of a line.
const CORNERS: usize = 100_000;
/// As hard as who moves within a lane or to another's side accelerates across it where the file does not say, m/s².
const CALM_MPS2: f32 = 0.5;

/// The actions in an element of a choice; none where they change nothing here.
pub fn private(action: Element<'_>, names: &Names<'_>) -> Result<Option<Action>, StoryError> {
    let kind = action.choice()?;
    let found = match kind.tag() {
        "LongitudinalAction" => {
            let speed = kind.choice()?;
            match speed.tag() {
                "SpeedAction" => speeds::change(speed, names)?,
                "SpeedProfileAction" => speeds::profile(speed)?,
                "LongitudinalDistanceAction" => speeds::gap(speed, names)?,
                _ => return Err(speed.unsupported()),
            }
        }
        "LateralAction" => {
            let across = kind.choice()?;
            match across.tag() {
                "LaneChangeAction" => lane_change(across, names)?,
                "LaneOffsetAction" => lane_offset(across, names)?,
                "LateralDistanceAction" => abreast(across, names)?,
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
        "SynchronizeAction" => speeds::meeting(kind, names)?,
        "TeleportAction" => Action::Teleport(positions::read(kind.need("Position")?, names)?),
        "ControllerAction" | "ActivateControllerAction" => return Ok(activates(kind)?.then_some(Action::HandOver)),
        "AppearanceAction" => return appearance(kind),
        "VisibilityAction" => return Ok(None),
        _ => return Err(kind.unsupported()),
    };
    Ok(Some(found))
}

/// A door that is opened or shut; lights and gestures change nothing here.
fn appearance(action: Element<'_>) -> Result<Option<Action>, StoryError> {
    const DOORS: &[(&str, bool)] = &[("doorFrontLeft", true), ("doorFrontRight", false)];
    let Some(animation) = action.child("AnimationAction") else { return Ok(None) };
    let component = animation.child("AnimationType").and_then(|kind| kind.child("ComponentAnimation"));
    let Some(component) = component.and_then(|component| component.child("VehicleComponent")) else { return Ok(None) };
    let named = component.text("vehicleComponentType")?;
    let Some((_, is_left)) = DOORS.iter().find(|(door, _)| *door == named) else {
        return Err(component.wrong("expected doorFrontLeft or doorFrontRight: nothing else is supported"));
    };
    let open = animation.need("AnimationState")?.amount("state")?.min(1.0);
    let takes_s =
        if animation.given("animationDuration")?.is_some() { animation.amount("animationDuration")? } else { 1.0 };
    let takes_ticks = ticks(takes_s.min(1e3)).max(1) as u32;
    action.is_used();
    Ok(Some(Action::Door(Door { is_left: *is_left, open, takes_ticks })))
}

/// Whether somebody's controller takes over.
fn activates(action: Element<'_>) -> Result<bool, StoryError> {
    let activation = if action.tag() == "ActivateControllerAction" {
        Some(action)
    } else {
        action.child("ActivateControllerAction")
    };
    let Some(activation) = activation else { return Ok(false) };
    let is_on = |domain: &str| Ok::<_, StoryError>(activation.switch(domain)?.unwrap_or(false));
    let is_on = is_on("longitudinal")? || is_on("lateral")?;
    if is_on {
        action.is_used();
    }
    Ok(is_on)
}

/// A global action, and by whom it is done.
pub fn global(action: Element<'_>, names: &Names<'_>) -> Result<(Doer, Action), StoryError> {
    let kind = action.choice()?;
    match kind.tag() {
        "EntityAction" => {
            let role = names.role(kind, "entityRef")?;
            let what = kind.choice()?;
            match what.tag() {
                "DeleteEntityAction" => Ok((Doer::Role(role), Action::Leave)),
                "AddEntityAction" => {
                    Ok((Doer::Role(role), Action::Enter(positions::read(what.need("Position")?, names)?)))
                }
                _ => Err(what.unsupported()),
            }
        }
        "InfrastructureAction" => Ok((Doer::World, signals::action(kind.need("TrafficSignalAction")?, names)?)),
        "EnvironmentAction" => Ok((Doer::World, Action::Environment(environment::read(kind)?))),
        _ => Err(kind.unsupported()),
    }
}

fn lane_change(action: Element<'_>, names: &Names<'_>) -> Result<Action, StoryError> {
    let offset_m = action.metres("targetLaneOffset")?;
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
    let shape = dynamics_of.word("dynamicsShape", SHAPES)?;
    let most_mps2 = speeds::limit(dynamics_of, "maxLateralAcc", CALM_MPS2)?;
    let target = action.need("LaneOffsetTarget")?.choice()?;
    let (offset_m, role) = match target.tag() {
        "AbsoluteTargetLaneOffset" => (target.need_metres("value")?, None),
        "RelativeTargetLaneOffset" => (target.need_metres("value")?, Some(names.role(target, "entityRef")?)),
        _ => return Err(target.unsupported()),
    };
    // So fast that its greatest acceleration is the one of the file, or of a calm driver; `Takes::Time` cannot say it before
    // the way is known.
    let takes = Takes::Rate(most_mps2);
    Ok(Action::LaneOffset(Dynamics { shape, takes }, offset_m, role))
}

fn abreast(action: Element<'_>, names: &Names<'_>) -> Result<Action, StoryError> {
    action.switch("continuous")?;
    action.given("coordinateSystem")?;
    let sides = [("any", None), ("leftToReferencedEntity", Some(true)), ("rightToReferencedEntity", Some(false))];
    let constraints = action.child("DynamicConstraints");
    let most_mps2 = constraints.map_or(Ok(CALM_MPS2), |given| speeds::limit(given, "maxAcceleration", CALM_MPS2))?;
    let wanted_m = if action.given("distance")?.is_some() { Some(action.metres("distance")?.abs()) } else { None };
    Ok(Action::Abreast(Abreast {
        role: names.role(action, "entityRef")?,
        // On which side it is its sign does not say: `displacement` does.
        wanted_m,
        free: action.switch("freespace")?.unwrap_or(false),
        is_left: action.word_given("displacement", &sides)?.flatten(),
        most_mps2,
    }))
}

fn route(action: Element<'_>, names: &Names<'_>) -> Result<Action, StoryError> {
    positions::waypoints(action.need("Route")?, names).map(Action::Route)
}

fn path(action: Element<'_>, names: &Names<'_>) -> Result<Path, StoryError> {
    if let Some(mode) = action.child("TrajectoryFollowingMode") {
        mode.given("followingMode")?;
    }
    let within = action.child("TrajectoryRef").unwrap_or(action);
    let trajectory = within.need("Trajectory")?;
    positions::is_open(trajectory)?;
    vary::pass_parameters(trajectory)?;
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
        headings |= positions::says_heading(&position);
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
    if timed && from_m != 0.0 {
        return Err(action.wrong("initialDistanceOffset with <Timing> is not supported"));
    }
    Ok(Path { corners, absolute, timed, from_m, headings })
}

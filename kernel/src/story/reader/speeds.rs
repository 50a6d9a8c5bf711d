//! How fast somebody goes.

use crate::story::error::StoryError;
use crate::story::script::{
    Action, Along, Gap, GapSide, GapWidth, Limits, Measure, Meeting, Position, SpeedProfile, SpeedTarget,
};

use super::document::Element;
use super::dynamics::dynamics;
use super::names::Names;
use super::positions;

/// Most speeds of a profile.
const ENTRIES: usize = 10_000;
/// As hard and as fast as may be, where a file does not say: as a sporty car, m/s² and m/s.
const USUAL: Limits = Limits { acceleration_mps2: 5.0, deceleration_mps2: 9.0, most_mps: 100.0 };

/// A change of speed.
pub fn change(action: Element<'_>, names: &Names<'_>) -> Result<Action, StoryError> {
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
            target.word_given("speedTargetValueType", &kinds)?.unwrap_or(kinds[0].1)
        }
        _ => return Err(target.unsupported()),
    };
    Ok(Action::Speed(dynamics, target))
}

/// Speeds, one after the other.
pub fn profile(action: Element<'_>) -> Result<Action, StoryError> {
    action.given("followingMode")?;
    if action.given("entityRef")?.is_some() {
        return Err(action.wrong("entityRef of <SpeedProfileAction> is not supported"));
    }
    let mut entries = Vec::new();
    for entry in action.all("SpeedProfileEntry") {
        if entries.len() == ENTRIES {
            return Err(entry.wrong(format!("expected at most {ENTRIES} entries")));
        }
        let takes_s = if entry.given("time")?.is_some() { Some(entry.amount("time")?) } else { None };
        entries.push((entry.float("speed")?, takes_s));
    }
    if entries.is_empty() {
        return Err(action.wrong("<SpeedProfileAction> has no <SpeedProfileEntry>"));
    }
    Ok(Action::SpeedProfile(SpeedProfile { entries, limits: limits(action)? }))
}

/// What `<DynamicConstraints>` says; rates of change of acceleration are not kept.
fn limits(action: Element<'_>) -> Result<Limits, StoryError> {
    let Some(constraints) = action.child("DynamicConstraints") else { return Ok(USUAL) };
    Ok(Limits {
        acceleration_mps2: limit(constraints, "maxAcceleration", USUAL.acceleration_mps2)?,
        deceleration_mps2: limit(constraints, "maxDeceleration", USUAL.deceleration_mps2)?,
        most_mps: limit(constraints, "maxSpeed", USUAL.most_mps)?,
    })
}

/// A limit by its name, or the usual one.
pub fn limit(of: Element<'_>, name: &str, usual: f32) -> Result<f32, StoryError> {
    let given = of.number_given(name)?.map(|value| value as f32);
    match given {
        Some(value) if value <= 0.0 => {
            Err(of.wrong(format!("{name} of <{}> is {value}, expected a number above 0", of.tag())))
        }
        given => Ok(given.map_or(usual, |value| value.min(1e3))),
    }
}

/// A gap that is kept.
pub fn gap(action: Element<'_>, names: &Names<'_>) -> Result<Action, StoryError> {
    let has = |name: &str| Ok::<_, StoryError>(action.given(name)?.is_some());
    let wanted = match (has("distance")?, has("timeGap")?) {
        // Some programs write a sign: on which side it is, it stays.
        (true, false) => GapWidth::Way(action.float("distance")?.abs()),
        (false, true) => GapWidth::Time(action.amount("timeGap")?),
        _ => return Err(action.wrong("expected distance or timeGap of <LongitudinalDistanceAction>")),
    };
    let sides = [
        ("any", GapSide::Any),
        ("trailingReferencedEntity", GapSide::Behind),
        ("leadingReferencedEntity", GapSide::Ahead),
    ];
    // What `coordinateSystem` may say is all the same on one lane.
    action.given("coordinateSystem")?;
    Ok(Action::Gap(Gap {
        role: names.role(action, "entityRef")?,
        wanted,
        measure: Measure { free: action.switch("freespace")?.unwrap_or(false), along: Along::Forward },
        side: action.word_given("displacement", &sides)?.unwrap_or(GapSide::Any),
        goes_on: action.switch("continuous")?.unwrap_or(false),
        limits: limits(action)?,
    }))
}

/// Two who arrive at the same time.
pub fn meeting(action: Element<'_>, names: &Names<'_>) -> Result<Action, StoryError> {
    let with = names.role(action, "masterEntityRef")?;
    let arrival = |place: &'static str, tolerance: &str| -> Result<(Position, f32), StoryError> {
        let near_m = if action.given(tolerance)?.is_some() { action.amount(tolerance)? } else { 0.0 };
        Ok((positions::read(action.need(place)?, names)?, near_m))
    };
    let theirs = arrival("TargetPositionMaster", "targetToleranceMaster")?;
    let own = arrival("TargetPosition", "targetTolerance")?;
    let last = match action.child("FinalSpeed") {
        None => None,
        Some(last) => {
            let speed = last.choice()?;
            // Before it arrives it would go on steadily: it does so at its place only.
            for steady in ["TargetDistanceSteadyState", "TargetTimeSteadyState"] {
                speed.child(steady);
            }
            Some(match speed.tag() {
                "AbsoluteSpeed" => SpeedTarget::Absolute(speed.float("value")?),
                "RelativeSpeedToMaster" => {
                    let value = speed.float("value")?;
                    let kinds = [
                        ("delta", SpeedTarget::Faster(with, value, true)),
                        ("factor", SpeedTarget::Times(with, value, true)),
                    ];
                    speed.word("speedTargetValueType", &kinds)?
                }
                _ => return Err(speed.unsupported()),
            })
        }
    };
    Ok(Action::Meet(Box::new(Meeting { with, theirs, own, last })))
}

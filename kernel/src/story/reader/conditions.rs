//! What begins and ends the elements of a story.

use crate::story::error::StoryError;
use crate::story::script::{Along, Condition, Edge, ElementKind, ElementState, Measure, OfRole, Rule, Trigger, When};

use super::document::Element;
use super::dynamics::ticks;
use super::names::Names;
use super::{positions, signals};

/// Most conditions of a trigger.
const CONDITIONS: usize = 100;

const RULES: &[(&str, Rule)] = &[
    ("greaterThan", Rule::Greater),
    ("greaterOrEqual", Rule::GreaterOrEqual),
    ("lessThan", Rule::Less),
    ("lessOrEqual", Rule::LessOrEqual),
    ("equalTo", Rule::Equal),
    ("notEqualTo", Rule::NotEqual),
];
const EDGES: &[(&str, Edge)] =
    &[("none", Edge::None), ("rising", Edge::Rising), ("falling", Edge::Falling), ("risingOrFalling", Edge::Either)];
const KINDS: &[(&str, ElementKind)] = &[
    (ElementKind::Act.name(), ElementKind::Act),
    (ElementKind::Group.name(), ElementKind::Group),
    (ElementKind::Manoeuvre.name(), ElementKind::Manoeuvre),
    (ElementKind::Event.name(), ElementKind::Event),
    (ElementKind::Action.name(), ElementKind::Action),
];
const STATES: &[(&str, ElementState)] = &[
    ("standbyState", ElementState::Standby),
    ("runningState", ElementState::Running),
    ("completeState", ElementState::Complete),
    ("startTransition", ElementState::Started),
    ("endTransition", ElementState::Ended),
    ("stopTransition", ElementState::Stopped),
    ("skipTransition", ElementState::Skipped),
];

/// The conditions in an element, if it is there.
pub fn trigger(element: Option<Element<'_>>, names: &Names<'_>) -> Result<Trigger, StoryError> {
    let mut trigger = Trigger::default();
    let mut count = 0;
    for group in element.into_iter().flat_map(|element| element.all("ConditionGroup")) {
        let mut conditions = Vec::new();
        for condition in group.all("Condition") {
            count += 1;
            if count > CONDITIONS {
                return Err(condition.wrong(format!("expected at most {CONDITIONS} conditions of a trigger")));
            }
            conditions.push(self::condition(condition, names)?);
        }
        if conditions.is_empty() {
            return Err(group.wrong("<ConditionGroup> has no <Condition>"));
        }
        trigger.groups.push(conditions);
    }
    Ok(trigger)
}

fn condition(element: Element<'_>, names: &Names<'_>) -> Result<Condition, StoryError> {
    element.spend(1)?;
    let delay_s = if element.given("delay")?.is_some() { element.amount("delay")? } else { 0.0 };
    let edge = element.word_given("conditionEdge", EDGES)?.unwrap_or(Edge::None);
    let what = element.choice()?;
    let when = match what.tag() {
        "ByValueCondition" => by_value(what.choice()?, names)?,
        "ByEntityCondition" => by_entity(what, names)?,
        _ => return Err(what.unsupported()),
    };
    Ok(Condition { delay_ticks: ticks(delay_s), edge, when })
}

fn by_value(value: Element<'_>, names: &Names<'_>) -> Result<When, StoryError> {
    match value.tag() {
        "SimulationTimeCondition" => Ok(When::Time(value.word("rule", RULES)?, value.float("value")?)),
        "StoryboardElementStateCondition" => Ok(When::Element {
            kind: value.word("storyboardElementType", KINDS)?,
            path: value.text("storyboardElementRef")?,
            state: value.word("state", STATES)?,
            at: value.begins(),
        }),
        "ParameterCondition" => parameter(value).map(When::Always),
        "TrafficSignalCondition" => signals::shows(value),
        "TrafficSignalControllerCondition" => signals::is_in(value, names),
        _ => Err(value.unsupported()),
    }
}

/// Whether a parameter is as a condition says: none changes. ScenarioRunner's files name none, for what it judges drives by.
fn parameter(condition: Element<'_>) -> Result<bool, StoryError> {
    let (rule, than) = (condition.word("rule", RULES)?, condition.text("value")?);
    let Some(value) = condition.parameter("parameterRef")? else { return Ok(false) };
    let numbers = value.parse::<f32>().ok().zip(than.parse::<f32>().ok());
    Ok(match (numbers, rule) {
        (Some((value, than)), _) => rule.holds(value, than, 0.0),
        (None, Rule::Equal) => value == than,
        (None, Rule::NotEqual) => value != than,
        (None, _) => false,
    })
}

fn by_entity(element: Element<'_>, names: &Names<'_>) -> Result<When, StoryError> {
    let triggering = element.need("TriggeringEntities")?;
    let all = triggering.word("triggeringEntitiesRule", &[("any", false), ("all", true)])?;
    let roles = triggering.all("EntityRef").map(|entity| names.role(entity, "entityRef"));
    let roles = roles.collect::<Result<Vec<_>, _>>()?;
    if roles.is_empty() {
        return Err(triggering.wrong("<TriggeringEntities> has no <EntityRef>"));
    }
    let what = of_role(element.need("EntityCondition")?.choice()?, names)?;
    Ok(When::Role { all, roles, what })
}

fn of_role(it: Element<'_>, names: &Names<'_>) -> Result<OfRole, StoryError> {
    let rule = || it.word("rule", RULES);
    if it.given("direction")?.is_some() {
        return Err(it.wrong(format!("direction of <{}> is not supported", it.tag())));
    }
    match it.tag() {
        "SpeedCondition" => Ok(OfRole::Speed(rule()?, it.float("value")?)),
        "RelativeSpeedCondition" => {
            Ok(OfRole::RelativeSpeed(rule()?, it.float("value")?, names.role(it, "entityRef")?))
        }
        "AccelerationCondition" => Ok(OfRole::Acceleration(rule()?, it.float("value")?)),
        "StandStillCondition" => Ok(OfRole::Stands(ticks(it.amount("duration")?))),
        "EndOfRoadCondition" => Ok(OfRole::EndOfRoad(ticks(it.amount("duration")?))),
        "OffroadCondition" => Ok(OfRole::OffRoad(ticks(it.amount("duration")?))),
        "TraveledDistanceCondition" => Ok(OfRole::Travelled(it.amount("value")?)),
        "ReachPositionCondition" => {
            let tolerance_m = it.amount("tolerance")?;
            Ok(OfRole::Reaches(positions::read(it.need("Position")?, names)?, tolerance_m))
        }
        "DistanceCondition" => {
            let place = positions::read(it.need("Position")?, names)?;
            Ok(OfRole::Distance(rule()?, it.float("value")?, measure(it)?, place))
        }
        "RelativeDistanceCondition" => {
            Ok(OfRole::RelativeDistance(rule()?, it.float("value")?, measure(it)?, names.role(it, "entityRef")?))
        }
        "TimeHeadwayCondition" => {
            Ok(OfRole::Headway(rule()?, it.float("value")?, measure(it)?, names.role(it, "entityRef")?))
        }
        "TimeToCollisionCondition" => {
            let target = it.need("TimeToCollisionConditionTarget")?.choice()?;
            match target.tag() {
                "EntityRef" => {
                    let role = names.role(target, "entityRef")?;
                    Ok(OfRole::TimeToCollision(rule()?, it.float("value")?, measure(it)?, role))
                }
                _ => Err(target.unsupported()),
            }
        }
        "CollisionCondition" => match it.child("EntityRef") {
            Some(entity) => Ok(OfRole::Collides(Some(names.role(entity, "entityRef")?))),
            None => Ok(OfRole::Collides(None)),
        },
        _ => Err(it.unsupported()),
    }
}

/// How a distance is measured: by `relativeDistanceType` and `coordinateSystem`, and by what 1.0 has for them.
fn measure(it: Element<'_>) -> Result<Measure, StoryError> {
    let free = it.switch("freespace")?.unwrap_or(false);
    let kinds = [
        ("longitudinal", Along::Forward),
        ("lateral", Along::Sideways),
        ("cartesianDistance", Along::Straight),
        ("euclidianDistance", Along::Straight),
    ];
    let kind = it.word_given("relativeDistanceType", &kinds)?;
    let by_road = it.switch("alongRoute")?.unwrap_or(false);
    let systems = [("entity", false), ("lane", true), ("road", true), ("trajectory", true), ("world", false)];
    let by_road = it.word_given("coordinateSystem", &systems)?.unwrap_or(by_road);
    let is_time = matches!(it.tag(), "TimeHeadwayCondition" | "TimeToCollisionCondition");
    let usual = if by_road || is_time { Along::Forward } else { Along::Straight };
    Ok(Measure { free, along: kind.unwrap_or(usual) })
}

//! Traffic lights and their programmes.

use crate::signals::LightPhase;
use crate::story::error::StoryError;
use crate::story::script::{Action, Light, Programme, When};

use super::document::Element;
use super::dynamics::ticks;
use super::names::Names;

/// Most programmes of a text, and most phases of one.
const PROGRAMMES: usize = 200;
const PHASES: usize = 100;
/// Shortest phase, seconds: one of no time would never end.
const SHORTEST_S: f32 = 0.1;

/// A light in an element that says which signal shows what.
fn light(element: Element<'_>, signal: &str) -> Result<Light, StoryError> {
    let text = element.text("state")?;
    let phase = phase(&text).ok_or_else(|| {
        let expected = "expected red, yellow or green, or its three lamps as on;off;off";
        element.wrong(format!("state of <{}> is {text:?}, {expected}", element.tag()))
    })?;
    Ok(Light { signal: element.text(signal)?, phase, at: element.begins(), groups: Vec::new() })
}

/// What a light shows, by its colour or by its lamps from above.
fn phase(text: &str) -> Option<LightPhase> {
    let lamps: Vec<bool> = text.split(';').map(|lamp| matches!(lamp.trim(), "on" | "true" | "1")).collect();
    match (text.trim().to_lowercase().as_str(), lamps.as_slice()) {
        ("red", _) | (_, [true, false, false]) => Some(LightPhase::Red),
        // Red and yellow say that green is to come: who stands goes on standing.
        (_, [true, true, false]) => Some(LightPhase::Red),
        ("yellow" | "amber", _) | (_, [false, true, false]) => Some(LightPhase::Yellow),
        ("green" | "go", _) | (_, [false, false, true]) => Some(LightPhase::Green),
        _ => None,
    }
}

/// The programmes in `<TrafficSignals>`.
pub fn programmes(signals: Option<Element<'_>>) -> Result<Vec<Programme>, StoryError> {
    let mut found: Vec<(Programme, Option<String>)> = Vec::new();
    for controller in signals.into_iter().flat_map(|signals| signals.all("TrafficSignalController")) {
        if found.len() == PROGRAMMES {
            return Err(controller.wrong(format!("expected at most {PROGRAMMES} controllers")));
        }
        let delay_s = if controller.given("delay")?.is_some() { controller.amount("delay")? } else { 0.0 };
        let mut phases = Vec::new();
        for phase in controller.all("Phase") {
            if phases.len() == PHASES {
                return Err(phase.wrong(format!("expected at most {PHASES} phases")));
            }
            let lights = phase.all("TrafficSignalState").map(|shown| light(shown, "trafficSignalId"));
            let lights = lights.collect::<Result<Vec<_>, _>>()?;
            phases.push((phase.text("name")?, ticks(phase.amount("duration")?.max(SHORTEST_S)), lights));
        }
        if phases.is_empty() {
            return Err(controller.wrong("<TrafficSignalController> has no <Phase>"));
        }
        let programme = Programme { name: controller.text("name")?, delay_ticks: ticks(delay_s), phases };
        found.push((programme, controller.given("reference")?));
    }
    // A delay counts from the programme that it refers to; one that is told of later, from the beginning.
    for number in 0..found.len() {
        let Some(reference) = found[number].1.clone() else { continue };
        let before = found[..number].iter().find(|(other, _)| other.name == reference);
        let later_ticks = before.map_or(0, |(other, _)| other.delay_ticks);
        found[number].0.delay_ticks = found[number].0.delay_ticks.saturating_add(later_ticks);
    }
    Ok(found.into_iter().map(|(programme, _)| programme).collect())
}

/// What is done to a light, or to a programme.
pub fn action(element: Element<'_>, names: &Names<'_>) -> Result<Action, StoryError> {
    let kind = element.choice()?;
    match kind.tag() {
        "TrafficSignalStateAction" => Ok(Action::Light(light(kind, "name")?)),
        "TrafficSignalControllerAction" => {
            let (number, phase) = names.phase(kind, "trafficSignalControllerRef", "phase")?;
            Ok(Action::Programme(number, phase))
        }
        _ => Err(kind.unsupported()),
    }
}

/// What a light shows, as a condition.
pub fn shows(condition: Element<'_>) -> Result<When, StoryError> {
    Ok(When::Light(light(condition, "name")?))
}

/// The phase of a programme, as a condition.
pub fn is_in(condition: Element<'_>, names: &Names<'_>) -> Result<When, StoryError> {
    let (number, phase) = names.phase(condition, "trafficSignalControllerRef", "phase")?;
    Ok(When::Programme(number, phase))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_are_named_by_colours_and_by_lamps() {
        for (text, expected) in [
            ("green", Some(LightPhase::Green)),
            ("Red", Some(LightPhase::Red)),
            ("amber", Some(LightPhase::Yellow)),
            ("on;off;off", Some(LightPhase::Red)),
            ("on;on;off", Some(LightPhase::Red)),
            ("off; off; on", Some(LightPhase::Green)),
            ("off;off;off", None),
            ("blue", None),
            ("", None),
        ] {
            assert_eq!(phase(text), expected, "{text}");
        }
    }
}

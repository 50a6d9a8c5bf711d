//! Weather that a story changes.

use crate::weather::Weather;

use super::plan::Plan;
use super::script::Action;
use super::state::StoryState;

/// A weather as a story has changed it so far: what was told last counts.
pub fn changed(plan: &Plan, state: &StoryState, mut weather: Weather) -> Weather {
    let begun = plan.weather.iter().map(|deed| (state.deeds[*deed].mark, *deed));
    let mut begun: Vec<_> = begun.filter(|(mark, _)| mark.began > 0).collect();
    begun.sort_by_key(|(mark, deed)| (mark.began, *deed));
    for (_, deed) in begun {
        if let Action::Environment(environment) = &*plan.deeds[deed].action {
            environment.change(&mut weather);
        }
    }
    weather
}

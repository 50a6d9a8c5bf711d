//! Traffic lights that a story holds.

use crate::map::RoadNetwork;
use crate::signals::HeldLight;
use crate::time::Tick;

use super::script::{Action, Light, Programme, Script, When};
use super::state::{Cycle, StoryState};

/// Finds the lights of a script on a map.
pub fn find(script: &mut Script, network: &RoadNetwork) -> Result<(), (usize, String)> {
    let Script { lights, programmes, acts, stop, .. } = script;
    let mut all: Vec<&mut Light> = lights.iter_mut().collect();
    all.extend(programmes.iter_mut().flat_map(|programme| &mut programme.phases).flat_map(|(.., lights)| lights));
    let mut triggers = vec![stop];
    for act in acts {
        triggers.extend([&mut act.start, &mut act.stop]);
        for event in act.groups.iter_mut().flat_map(|group| &mut group.events) {
            triggers.push(&mut event.start);
            let held = event.actions.iter_mut().filter_map(|(_, _, action)| match action {
                Action::Light(light) => Some(light),
                _ => None,
            });
            all.extend(held);
        }
    }
    let conditions = triggers.into_iter().flat_map(|trigger| trigger.groups.iter_mut().flatten());
    all.extend(conditions.filter_map(|condition| match &mut condition.when {
        When::Light(light) => Some(light),
        _ => None,
    }));
    all.into_iter().try_for_each(|light| {
        light.groups = network.lights_of(&light.signal).collect();
        match light.groups.is_empty() {
            true => Err((light.at, format!("there is no traffic light {} on the map", light.signal))),
            false => Ok(()),
        }
    })
}

/// What is held, and where the programmes are, before the first tick.
pub fn begin(script: &Script) -> (Vec<HeldLight>, Vec<Cycle>) {
    let mut held = Vec::new();
    let cycles = script.programmes.iter().map(|programme| {
        let last = programme.phases.len() - 1;
        let (phase, until) = match programme.delay_ticks {
            0 => (0, programme.phases[0].1),
            delay_ticks => (last, delay_ticks),
        };
        programme.phases[phase].2.iter().for_each(|light| hold(&mut held, light));
        Cycle { phase: phase as u16, until }
    });
    let cycles = cycles.collect();
    script.lights.iter().for_each(|light| hold(&mut held, light));
    (held, cycles)
}

fn hold(held: &mut Vec<HeldLight>, light: &Light) {
    for group in &light.groups {
        let shown = HeldLight { group: *group, phase: light.phase };
        match held.binary_search_by_key(group, |light| light.group) {
            Ok(at) => held[at] = shown,
            Err(at) => held.insert(at, shown),
        }
    }
}

/// The programmes go on by a tick.
pub fn go_on(state: &mut StoryState, programmes: &[Programme], tick: Tick) {
    for (number, programme) in programmes.iter().enumerate() {
        let cycle = state.cycles[number];
        if tick >= cycle.until {
            enter(state, number, programme, (usize::from(cycle.phase) + 1) % programme.phases.len(), tick);
        }
    }
}

fn enter(state: &mut StoryState, number: usize, programme: &Programme, phase: usize, tick: Tick) {
    let (_, ticks, lights) = &programme.phases[phase];
    state.cycles[number] = Cycle { phase: phase as u16, until: tick.saturating_add(*ticks) };
    lights.iter().for_each(|light| hold(&mut state.lights, light));
}

/// What is done to lights.
pub fn change(state: &mut StoryState, action: &Action, programmes: &[Programme], tick: Tick) {
    match action {
        Action::Light(light) => hold(&mut state.lights, light),
        Action::Programme(number, phase) => {
            enter(state, *number, &programmes[*number], *phase, tick);
        }
        _ => {}
    }
}

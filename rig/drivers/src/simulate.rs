//! One simulated run from start to end: driven, recorded, and its cause found.

use std::io::Write;

use base::maps::Map;
use kernel::arbiter::{Outcome, Phase};
use kernel::time::{CLIP_TICKS, TICK_HZ, Tick, seconds};
use kernel::{Keyframe, Scenario, Seat, World};
use replay::{Annotation, Label, Manifest};

use crate::crew::Crew;
use crate::safety::QUEUE_TICKS;
use crate::session::{Session, SessionState};
use crate::temper::Temper;
use crate::vision::{self, Eye, FRAME_TICKS, LATENCY_TICKS, Vision};

/// A fork that bots drive starts at least this long before the intervention, so that nothing is decided yet.
pub fn fork_before_ticks(label: Label) -> Tick {
    if label == Label::Boredom { QUEUE_TICKS + CLIP_TICKS } else { CLIP_TICKS }
}
/// A fork goes on for this long after the intervention; one that comes so far without harm did not need it. The one
/// time for every such question: `perception_caused` of a recording, what would have happened without the
/// intervention, and `aeye redrive`, unless it is told otherwise. Predictions of criticality look as far ahead.
pub const FORK_AFTER_TICKS: Tick = seconds(10);

/// What a manifest calls a simulated driver.
pub const BOT: &str = "bot";

/// The manifest of a simulated run: bots in both seats, what the semantic one sees, and when.
pub fn manifest(scenario: &Scenario, map: &Map, eye: &Eye) -> Manifest {
    manifest_with([BOT; 2], scenario, map, eye)
}

/// As [`manifest`], with who sits in the seats, the semantic driver first.
pub fn manifest_with(who: [&str; 2], scenario: &Scenario, map: &Map, eye: &Eye) -> Manifest {
    let bots = [Seat::Semantic, Seat::Safety].into_iter().zip(who).filter(|(_, who)| *who == BOT);
    let entries = [
        ("semantic", who[0].to_owned()),
        ("safety", who[1].to_owned()),
        ("frame_ticks", FRAME_TICKS.to_string()),
        ("latency_ticks", LATENCY_TICKS.to_string()),
    ];
    let mut provenance = vision::provenance(eye, &eye.camera());
    provenance.extend(entries.map(|(name, value)| (name.to_owned(), value)));
    provenance.extend(Temper::entries(bots.map(|(seat, _)| seat), scenario.seed));
    Manifest::new(scenario, &map.network, map.foreign.clone(), provenance)
}

/// Drives a run until it ends, `keep_on` says no, or something fails, and records it. Gives the
/// stream back, and the vision for the next run on the same map.
pub fn drive<W: Write>(
    scenario: &Scenario,
    map: &Map,
    vision: Vision,
    out: W,
    keep_on: impl FnMut(&World) -> bool,
) -> anyhow::Result<(W, Vision)> {
    let manifest = manifest(scenario, map, vision.eye());
    drive_as(&manifest, map, vision, out, keep_on)
}

/// As [`drive`], with what the recording is to say about itself.
pub fn drive_as<W: Write>(
    manifest: &Manifest,
    map: &Map,
    vision: Vision,
    out: W,
    mut keep_on: impl FnMut(&World) -> bool,
) -> anyhow::Result<(W, Vision)> {
    let world = World::new(&manifest.scenario, &map.network)?;
    let mut keyframes = vec![world.initial_keyframe()];
    let mut session = Session::new(world, manifest, out)?;
    let mut crew = Crew::drawn(vision, manifest.scenario.seed);
    let mut ended = false;
    while !ended && keep_on(session.world()) {
        let (input, shown) = crew.act(session.world())?;
        session.mask_shown(shown)?;
        let (state, output) = session.tick(&input)?;
        keyframes.extend(output.keyframe);
        ended = state != SessionState::Driving;
    }
    let (annotation, vision) = explain(session.world(), crew, &keyframes)?;
    if let Some(annotation) = annotation {
        session.annotate(annotation);
    }
    Ok((session.finish()?, vision))
}

/// Label, comment and share of the perception in what ended a run, if something did.
fn explain(world: &World, crew: Crew, keyframes: &[Keyframe]) -> anyhow::Result<(Option<Annotation>, Vision)> {
    let arbiter = world.arbiter();
    let at = match arbiter.outcome {
        Some(Outcome::Intervened) => arbiter.intervention.map(|i| i.tick),
        Some(Outcome::Missed) => arbiter.ended_at,
        Some(Outcome::Censored) | None => None,
    };
    let cause = crew.cause(world);
    let vision = crew.into_vision();
    let (Some(at), Some((label, comment))) = (at, cause) else { return Ok((None, vision)) };
    let eye = vision.eye().clone();
    let (needed, vision) = needed_with_truth(world, keyframes, (at, fork_before_ticks(label)), vision)?;
    let perception_caused = Some(!eye.is_truth() && !needed);
    Ok((Some(Annotation { label, comment, perception_caused }), vision.with_eye(eye)))
}

/// Drives again from the last keyframe before the intervention with true masks: does the run need
/// one as well?
fn needed_with_truth(
    world: &World,
    keyframes: &[Keyframe],
    (at, before): (Tick, Tick),
    vision: Vision,
) -> anyhow::Result<(bool, Vision)> {
    if vision.eye().is_truth() {
        return Ok((true, vision));
    }
    let early = |k: &&Keyframe| k.tick + before <= at;
    let Some(start) = keyframes.iter().rev().find(early) else { return Ok((true, vision)) };
    let end = at + FORK_AFTER_TICKS;
    let mut fork = World::fork(&lasting(world.scenario().clone(), end), world.network(), start)?;
    let truth = Eye::Truth.at(vision.eye().imaging());
    let mut crew = Crew::drawn(vision.with_eye(truth), world.scenario().seed);
    while fork.tick() < end && matches!(fork.arbiter().phase, Phase::Arming | Phase::Driving) {
        let (input, _) = crew.act(&fork)?;
        fork.step(&input);
    }
    let needed = match fork.arbiter().outcome {
        Some(Outcome::Censored) => false,
        outcome => outcome.is_some() || fork.arbiter().intervention.is_some(),
    };
    Ok((needed, crew.into_vision()))
}

/// A scenario whose limit of time does not end a fork before that tick.
pub fn lasting(mut scenario: Scenario, until: Tick) -> Scenario {
    let limit_s = &mut scenario.rules.max_seconds;
    *limit_s = (*limit_s).max((until / Tick::from(TICK_HZ)) as u32 + 1);
    scenario
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fork_lasts_its_time_although_the_run_would_end() {
        let mut scenario = Scenario::default_for("city", 1);
        scenario.rules.max_seconds = 20;
        let takeover = seconds(19);
        let limit_s = lasting(scenario.clone(), takeover + FORK_AFTER_TICKS).rules.max_seconds;
        assert_eq!((limit_s, lasting(scenario, seconds(5)).rules.max_seconds), (30, 20));
    }
}

//! Checks of whole logs.

use std::sync::Arc;

use kernel::state::{State, first_difference};
use kernel::time::Tick;
use kernel::{RoadNetwork, TickOutput, World};

use crate::{CaseInfo, Divergence, Error, Log, Replayer, RunSummary, case};

/// What a check found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Ticks simulated and compared.
    pub ticks: Tick,
    /// Keyframes compared or resumed from.
    pub keyframes: usize,
    /// The first difference, if there is one.
    pub divergence: Option<Divergence>,
}

/// Simulates every tick from the start and compares all that is derived: the hash each tick (which covers scenario,
/// map and inputs), the parts each second, the bytes of each keyframe, events, intervention and summary, and the
/// scenes of a case, which must be those of its window. Masks, notes, annotation and provenance do not follow from
/// the run: reading the file has found that its seals vouch for them.
pub fn verify(log: &Log, network: &Arc<RoadNetwork>) -> Result<Report, Error> {
    log.manifest.check(network)?;
    let start = compare_start(log, network)?.or_else(|| compare_window(log));
    let mut report = Report { keyframes: 1, divergence: start, ..Report::default() };
    if report.divergence.is_some() {
        return Ok(report);
    }
    let mut replayer = Replayer::new(log, network.clone())?;
    while report.divergence.is_none() {
        report.divergence = compare_scene(&replayer);
        let Some(output) = replayer.advance() else { break };
        report.ticks += 1;
        report.keyframes += usize::from(output.keyframe.is_some());
        if let Some(found) = replayer.compare(&output)? {
            report.divergence = Some(explain(&mut replayer, &output, found)?);
        }
    }
    if report.divergence.is_none() {
        report.divergence = compare_summary(log, replayer.world());
    }
    Ok(report)
}

/// The state of tick 0 follows from scenario and map.
fn compare_start(log: &Log, network: &Arc<RoadNetwork>) -> Result<Option<Divergence>, Error> {
    let Some(recorded) = log.keyframes.first().filter(|k| k.tick == 0) else { return Ok(None) };
    let computed = World::new(&log.manifest.scenario, network)?.initial_keyframe();
    Ok(recorded.difference(&computed)?.map(|field| Divergence::of_field(0, field, 0)))
}

/// A case has the scenes of its window, and a recording has none.
fn compare_window(log: &Log) -> Option<Divergence> {
    let recorded: Vec<Tick> = log.scenes.iter().map(|scene| scene.tick).collect();
    let Some(CaseInfo { from, to, .. }) = log.manifest.case else {
        return difference("scenes", log.first_tick(), &recorded, &Vec::new());
    };
    if !(log.first_tick() <= from && from <= to && to <= log.last_tick()) {
        let (window, ticks) = (format!("{from} to {to}"), format!("{} to {}", log.first_tick(), log.last_tick()));
        return Some(Divergence::at(from, "output", "window", &window, &format!("a log of ticks {ticks}")));
    }
    difference("scenes", from, &recorded, &case::scene_ticks(from..=to).collect())
}

fn compare_scene(replayer: &Replayer<'_>) -> Option<Divergence> {
    let tick = replayer.world().tick();
    let recorded = replayer.log().scenes.iter().find(|s| s.tick == tick)?;
    difference("scene", tick, recorded, &replayer.world().scene())
}

fn compare_summary(log: &Log, world: &World) -> Option<Divergence> {
    let (recorded, tick) = (log.summary.as_ref()?, world.tick());
    let computed = RunSummary {
        ticks: tick,
        odometer_mm: world.odometer_mm(),
        intervention: world.arbiter().intervention,
        outcome: world.arbiter().outcome,
    };
    let numbers = |s: &RunSummary| vec![s.ticks, s.odometer_mm];
    difference("summary", tick, &numbers(recorded), &numbers(&computed))
        .or_else(|| difference("summary.intervention", tick, &recorded.intervention, &computed.intervention))
        .or_else(|| difference("summary.outcome", tick, &recorded.outcome, &computed.outcome))
}

fn difference<T: State>(what: &str, tick: Tick, recorded: &T, computed: &T) -> Option<Divergence> {
    let (field, expected, got) = first_difference(recorded, computed)?;
    Some(Divergence::at(tick, "output", &format!("{what}.{field}"), &expected, &got))
}

/// Goes on with a run whose hash differs, to say more: a run that is right again in the next tick
/// differed in its input only; the next mark knows the part; the next keyframe actor, field and values.
fn explain(replayer: &mut Replayer<'_>, output: &TickOutput, found: Divergence) -> Result<Divergence, Error> {
    let mut found = found;
    if replayer.log().hash(output.tick) == Some(output.hash.0 as u32) {
        return Ok(found);
    }
    let mut output = output.clone();
    loop {
        if let Some(field) = replayer.compare_keyframe(&output)?.filter(|f| f.field != "keyframe") {
            return Ok(Divergence { tick: found.tick, ..field });
        }
        if let Some(mark) = replayer.compare_mark(&output).filter(|_| found.part == "state") {
            found.part = mark.part;
        }
        let Some(next) = replayer.advance() else { return Ok(found) };
        if replayer.log().hash(next.tick) == Some(next.hash.0 as u32) {
            found.part = "input".into();
            return Ok(found);
        }
        output = next;
    }
}

/// Resumes from every keyframe and compares every tick up to the next one.
pub fn resumes(log: &Log, network: &Arc<RoadNetwork>) -> Result<Report, Error> {
    let mut replayer = Replayer::new(log, network.clone())?;
    let mut report = Report::default();
    let ends = log.keyframes.iter().skip(1).map(|k| k.tick).chain([log.last_tick()]);
    for (keyframe, end) in log.keyframes.iter().zip(ends) {
        replayer.resume(keyframe)?;
        report.keyframes += 1;
        while replayer.world().tick() < end {
            let Some(output) = replayer.advance() else { break };
            report.ticks += 1;
            if let Some(found) = replayer.compare(&output)? {
                report.divergence = Some(explain(&mut replayer, &output, found)?);
                return Ok(report);
            }
        }
    }
    Ok(report)
}

/// Every `n` ticks: saves the world, advances `n` ticks, goes back to what was saved, advances again
/// and compares (rollback self-check, as the sync test of GGRS). The run goes on from the world that
/// was saved, so that what a copy loses adds up.
pub fn rewind(log: &Log, network: &Arc<RoadNetwork>, n: Tick) -> Result<Report, Error> {
    let mut replayer = Replayer::new(log, network.clone())?;
    let mut report = Report::default();
    loop {
        let mut ahead = replayer.world().clone();
        for _ in 0..n.max(1) {
            let Some(input) = log.input(ahead.tick() + 1) else { return Ok(report) };
            let first = ahead.step(input);
            let Some(again) = replayer.advance() else { return Ok(report) };
            report.ticks += 1;
            report.keyframes += usize::from(again.keyframe.is_some());
            report.divergence = match ahead.difference(replayer.world()) {
                Some(field) => Some(Divergence::of_field(first.tick, field, first.tick)),
                None => replayer.compare(&again)?,
            };
            if report.divergence.is_some() {
                return Ok(report);
            }
        }
    }
}

/// Simulates two logs side by side and names the first tick and field in which they differ;
/// `expected` is the value in `other`. What they hold as recorded is compared too.
pub fn against(
    log: &Log,
    network: &Arc<RoadNetwork>,
    other: &Log,
    other_network: &Arc<RoadNetwork>,
) -> Result<Report, Error> {
    let (mut left, mut right) = (Replayer::new(other, other_network.clone())?, Replayer::new(log, network.clone())?);
    let start = log.first_tick().max(other.first_tick());
    for replayer in [&mut left, &mut right] {
        while replayer.world().tick() < start && replayer.advance().is_some() {}
    }
    let mut report = Report::default();
    loop {
        report.divergence = compare_worlds(&left, &right);
        if report.divergence.is_some() {
            return Ok(report);
        }
        let outputs = (left.advance(), right.advance());
        if let (None, None) = outputs {
            return Ok(report);
        }
        if outputs.0.is_none() || outputs.1.is_none() {
            report.divergence = compare_lengths(other, log);
            return Ok(report);
        }
        report.ticks += 1;
    }
}

fn compare_worlds(left: &Replayer<'_>, right: &Replayer<'_>) -> Option<Divergence> {
    let tick = left.world().tick();
    if left.world().hash() != right.world().hash() {
        let field = left.world().difference(right.world());
        return Some(field.map_or_else(
            || Divergence::of_hash(tick, format!("{:?}", left.world().hash()), format!("{:?}", right.world().hash())),
            |field| Divergence::of_field(tick, field, tick),
        ));
    }
    match (left.log().hash(tick), right.log().hash(tick)) {
        (Some(a), Some(b)) if a != b => Some(Divergence::of_hash(tick, format!("{a:08x}"), format!("{b:08x}"))),
        _ => None,
    }
}

/// A case ends before its recording without differing from it.
fn compare_lengths(other: &Log, log: &Log) -> Option<Divergence> {
    let (expected, got) = (other.last_tick(), log.last_tick());
    let cut = other.manifest.case.is_some() || log.manifest.case.is_some();
    (!cut).then(|| {
        let tick = expected.min(got) + 1;
        Divergence::at(tick, "input", "last tick", &expected.to_string(), &got.to_string())
    })
}

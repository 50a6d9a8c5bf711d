//! Threads that drive: one world, renderer and segmenter each.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;
use std::sync::Mutex;

use anyhow::{Context, bail};
use indicatif::ProgressBar;
use render::{RenderOptions, Renderer};
use replay::{Case, Recording};

use super::{Plan, RunLine, STALLED_RUNS};
use crate::lab::redrive::Counterfactual;
use crate::output;
use crate::progress::{self, Interrupt};
use crate::simulate::{self, manifest};
use crate::vision::{Eye, Vision};

/// What the threads share.
struct Board<'a> {
    plan: &'a Plan,
    eye: &'a Eye,
    interrupt: &'a Interrupt,
    bar: ProgressBar,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    next: u32,
    done: BTreeMap<u32, RunLine>,
    /// Runs that were not there before.
    driven: BTreeSet<u32>,
    failure: Option<anyhow::Error>,
}

impl State {
    /// The runs from the first on without a gap.
    fn prefix(&self) -> Vec<RunLine> {
        (0..).map_while(|i| self.done.get(&i).cloned()).collect()
    }
}

/// Drives the runs of one checkpoint until there are enough, and gives those that count, in order.
pub fn drive_all(plan: &Plan, eye: &Eye, jobs: usize, interrupt: &Interrupt) -> anyhow::Result<Vec<RunLine>> {
    let bar = progress::bar(eye.name(), plan.until.progress(&[]).1);
    let board = Board { plan, eye, interrupt, bar, state: Mutex::default() };
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| board.work());
        }
    });
    board.bar.finish_and_clear();
    let state = board.state.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    if let Some(failure) = state.failure {
        return Err(failure);
    }
    let mut runs = state.prefix();
    if !plan.until.is_met(&runs) {
        bail!("interrupted after {} runs; the same command goes on from there", runs.len());
    }
    let enough = (1..=runs.len()).find(|n| plan.until.is_met(&runs[..*n])).unwrap_or(runs.len());
    // Only what was driven just now: a longer campaign may have left more.
    for run in state.driven.range(enough as u32..).copied() {
        discard(&plan.recording_path(eye.name(), run))?;
        discard(&plan.case_path(eye.name(), run))?;
        discard(&plan.counterfactual_path(eye.name(), run))?;
    }
    runs.truncate(enough);
    Ok(runs)
}

/// Deletes what a thread drove while another finished the campaign.
fn discard(path: &Path) -> anyhow::Result<()> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(e).with_context(|| path.display().to_string()),
        _ => Ok(()),
    }
}

impl Board<'_> {
    fn state(&self) -> std::sync::MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Takes one run after the other until there are enough.
    fn work(&self) {
        let mut renderers = HashMap::new();
        while let Some(run) = self.take() {
            match self.run(run, &mut renderers) {
                Ok(Some(line)) => self.put(run, line),
                Ok(None) => return,
                Err(error) => {
                    self.state().failure.get_or_insert(error);
                    return;
                }
            }
        }
    }

    fn take(&self) -> Option<u32> {
        let mut state = self.state();
        if state.failure.is_some() || self.interrupt.is_raised() || self.plan.until.is_met(&state.prefix()) {
            return None;
        }
        if self.plan.until.is_out_of_reach(&state.prefix()) {
            state.failure = Some(anyhow::anyhow!(
                "{}: {STALLED_RUNS} runs in a row brought the campaign no further; expected a checkpoint that drives, and \
                 traffic that makes such corner cases",
                self.eye.name()
            ));
            return None;
        }
        // Driven already but not in turn: only runs can be counted before they are driven.
        if matches!(self.plan.until, super::Until::Runs(n) if state.next >= n) {
            return None;
        }
        state.next += 1;
        Some(state.next - 1)
    }

    fn put(&self, run: u32, line: RunLine) {
        let mut state = self.state();
        state.done.insert(run, line);
        self.bar.set_position(self.plan.until.progress(&state.prefix()).0);
    }

    /// Drives a run, unless its files are there already; `None` when interrupted.
    fn run(&self, run: u32, renderers: &mut HashMap<usize, Renderer>) -> anyhow::Result<Option<RunLine>> {
        let path = self.plan.recording_path(self.eye.name(), run);
        if !path.exists() {
            if !self.drive(run, &path, renderers)? {
                return Ok(None);
            }
            self.state().driven.insert(run);
        }
        let recording = Recording::open(&path)?;
        self.check(run, &path, &recording)?;
        let has_case = self.cut(run, &recording)?;
        let mut line = RunLine::new(self.plan, self.eye.name(), run, &recording, has_case);
        line.without_intervention = self.counterfactual(run, &recording, renderers)?;
        Ok(Some(line))
    }

    /// What would have happened without the intervention, if there was one; driven once.
    fn counterfactual(
        &self,
        run: u32,
        recording: &Recording,
        renderers: &mut HashMap<usize, Renderer>,
    ) -> anyhow::Result<Option<Counterfactual>> {
        if recording.log().intervention.is_none() {
            return Ok(None);
        }
        let path = self.plan.counterfactual_path(self.eye.name(), run);
        if let Some(known) = Counterfactual::read(&path, recording)? {
            return Ok(Some(known));
        }
        let vision = self.vision(run, renderers)?;
        let network = &self.plan.maps[self.plan.map_index(run)].network;
        let (found, vision) = Counterfactual::of(recording, network, vision)?;
        renderers.insert(self.plan.map_index(run), vision.into_renderer());
        found.write(&path)?;
        // As it would be read again: numbers lose their last digits in JSON.
        Counterfactual::read(&path, recording)
    }

    /// The bot's eye on the map of a run.
    fn vision(&self, run: u32, renderers: &mut HashMap<usize, Renderer>) -> anyhow::Result<Vision> {
        let index = self.plan.map_index(run);
        let renderer = match renderers.remove(&index) {
            Some(renderer) => renderer,
            None => Renderer::new(&self.plan.maps[index].network, &RenderOptions::default())?,
        };
        Ok(Vision::new(renderer, self.eye.clone()))
    }

    /// False when interrupted.
    fn drive(&self, run: u32, path: &Path, renderers: &mut HashMap<usize, Renderer>) -> anyhow::Result<bool> {
        let index = self.plan.map_index(run);
        let map = &self.plan.maps[index];
        let vision = self.vision(run, renderers)?;
        let scenario = self.plan.scenario_of(run);
        let keep_on = |_: &kernel::World| !self.interrupt.is_raised();
        let (bytes, vision) = simulate::drive(&scenario, map, vision, Vec::new(), keep_on)?;
        renderers.insert(index, vision.into_renderer());
        if self.interrupt.is_raised() {
            return Ok(false);
        }
        output::write_file(path, &bytes)?;
        Ok(true)
    }

    /// A recording that is there already must be the one that would be driven.
    fn check(&self, run: u32, path: &Path, recording: &Recording) -> anyhow::Result<()> {
        let map = &self.plan.maps[self.plan.map_index(run)];
        let expected = manifest(&self.plan.scenario_of(run), map, self.eye);
        if recording.log().manifest != expected || !recording.finished() {
            bail!("{}: belongs to another campaign; expected an empty folder or this campaign's", path.display());
        }
        Ok(())
    }

    /// Cuts the corner case out of a recording, if there is one.
    fn cut(&self, run: u32, recording: &Recording) -> anyhow::Result<bool> {
        let Some(window) = Case::window(recording.log()) else { return Ok(false) };
        let path = self.plan.case_path(self.eye.name(), run);
        let is_cut = |case: &Case| case.info().source == recording.digest() && case.info().to == *window.end();
        if !Case::open(&path).is_ok_and(|case| is_cut(&case)) {
            let case = Case::cut(recording, &recording.network()?, window)?;
            output::write_file(&path, &case.encode()?)?;
        }
        Ok(true)
    }
}

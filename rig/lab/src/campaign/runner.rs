//! One run of a campaign: driven, cut, and driven on without its intervention, unless that is there already.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use anyhow::bail;
use base::maps;
use base::progress::Interrupt;
use drivers::simulate::{self, manifest};
use drivers::vision::{Eye, Vision};
use kernel::World;
use render::{RenderOptions, Renderer};
use replay::{Case, Recording};

use super::aside::Aside;
use super::plan::Plan;
use super::run_line::RunLine;
use crate::redrive::Counterfactual;

/// A run, and its files, which are in their places or wait for them.
pub struct Driven {
    line: RunLine,
    files: Vec<PathBuf>,
}

impl Driven {
    /// Gives the files their places.
    pub fn keep(self, aside: &Aside) -> anyhow::Result<RunLine> {
        self.files.iter().try_for_each(|path| aside.release(path))?;
        Ok(self.line)
    }
}

/// Drives runs, one after the other.
pub struct Runner<'a> {
    plan: &'a Plan,
    eye: &'a Eye,
    aside: &'a Aside,
    interrupt: &'a Interrupt,
    /// By the map's index.
    renderers: HashMap<usize, Renderer>,
}

impl<'a> Runner<'a> {
    /// One for a campaign.
    pub fn new(plan: &'a Plan, eye: &'a Eye, aside: &'a Aside, interrupt: &'a Interrupt) -> Self {
        Self { plan, eye, aside, interrupt, renderers: HashMap::new() }
    }

    /// Drives a run, unless it is there already; `None` when interrupted.
    pub fn drive(&mut self, run: u32) -> anyhow::Result<Option<Driven>> {
        let path = self.plan.recording_path(self.eye.name(), run);
        let recording = match self.known(run, &path)? {
            Some(known) => known,
            None => {
                let Some(recorded) = self.record(run, &path)? else { return Ok(None) };
                recorded
            }
        };
        let case = self.cut(run, &recording)?;
        let network = &self.plan.maps[self.plan.map_index(run)].network;
        let mut line = RunLine::new(self.eye.name(), &path, (&recording, network), case.as_deref());
        line.without_intervention = self.counterfactual(run, &recording)?;
        let verdict = line.without_intervention.is_some().then(|| self.plan.counterfactual_path(self.eye.name(), run));
        let files = std::iter::once(path).chain(case).chain(verdict).collect();
        Ok(Some(Driven { line, files }))
    }

    /// The recording of a run from an earlier call.
    fn known(&self, run: u32, path: &Path) -> anyhow::Result<Option<Recording>> {
        if path.exists() {
            let recording = Recording::open(path)?;
            self.check(run, path, &recording)?;
            return Ok(Some(recording));
        }
        let waiting = self.aside.place(path);
        Ok(Recording::open(&waiting).ok().filter(|recording| self.check(run, &waiting, recording).is_ok()))
    }

    /// Drives a run; its recording waits. `None` when interrupted.
    fn record(&mut self, run: u32, path: &Path) -> anyhow::Result<Option<Recording>> {
        let index = self.plan.map_index(run);
        let vision = self.vision(index)?;
        let keep_on = |_: &World| !self.interrupt.is_raised();
        let (scenario, map) = (self.plan.scenario_of(run), &self.plan.maps[index]);
        maps::put_beside(map.foreign.as_ref(), path)?;
        let (bytes, vision) = simulate::drive(&scenario, map, vision, Vec::new(), keep_on)?;
        self.renderers.insert(index, vision.into_renderer());
        if self.interrupt.is_raised() {
            return Ok(None);
        }
        self.aside.put(path, &bytes)?;
        maps::put_beside(map.foreign.as_ref(), &self.aside.place(path))?;
        Ok(Some(Recording::from_bytes(&bytes)?))
    }

    /// A recording that is there already must be the one that would be driven.
    fn check(&self, run: u32, path: &Path, recording: &Recording) -> anyhow::Result<()> {
        let map = &self.plan.maps[self.plan.map_index(run)];
        let expected = manifest(&self.plan.scenario_of(run), map, self.eye);
        if !recording.finished() {
            bail!("{}: is cut off; expected a whole run, or none, which would be driven again", path.display());
        }
        if recording.log().manifest != expected {
            bail!("{}: belongs to another campaign; expected an empty folder or this campaign's", path.display());
        }
        Ok(())
    }

    /// Cuts the corner case out of a recording, if there is one, and says where it goes.
    fn cut(&self, run: u32, recording: &Recording) -> anyhow::Result<Option<PathBuf>> {
        let Some(window) = Case::window(recording.log()) else { return Ok(None) };
        let path = self.plan.case_path(self.eye.name(), run);
        let is_cut = |case: &Case| case.info().source == recording.digest() && case.info().to == *window.end();
        if !Case::open(&self.aside.find(&path)).is_ok_and(|case| is_cut(&case)) {
            let network = &self.plan.maps[self.plan.map_index(run)].network;
            let case = Case::cut(recording, network, window)?;
            self.aside.put(&path, &case.encode()?)?;
        }
        Ok(Some(path))
    }

    /// What would have happened without the intervention, if there was one.
    fn counterfactual(&mut self, run: u32, recording: &Recording) -> anyhow::Result<Option<Counterfactual>> {
        if recording.log().intervention.is_none() {
            return Ok(None);
        }
        let path = self.plan.counterfactual_path(self.eye.name(), run);
        if let Some(known) = Counterfactual::read(&self.aside.find(&path), recording)? {
            return Ok(Some(known));
        }
        let index = self.plan.map_index(run);
        let vision = self.vision(index)?;
        let (found, vision) = Counterfactual::of(recording, &self.plan.maps[index].network, vision)?;
        self.renderers.insert(index, vision.into_renderer());
        let bytes = found.encode()?;
        // As it would be read again: numbers lose their last digits in JSON.
        let found = Counterfactual::decode(&bytes, recording);
        self.aside.put(&path, &bytes)?;
        Ok(found)
    }

    /// The bot's eye on a map.
    fn vision(&mut self, index: usize) -> anyhow::Result<Vision> {
        let renderer = match self.renderers.remove(&index) {
            Some(renderer) => renderer,
            None => Renderer::new(&self.plan.maps[index].network, &RenderOptions::default())?,
        };
        Ok(Vision::new(renderer, self.eye.clone()))
    }
}

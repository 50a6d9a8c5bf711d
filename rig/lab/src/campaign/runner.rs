//! One run of a campaign: driven, cut, and driven on without its intervention, unless that is there already.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use anyhow::bail;
use base::progress::Interrupt;
use base::{maps, output};
use drivers::simulate::{self, manifest};
use drivers::vision::{Eye, Vision};
use kernel::World;
use render::{RenderOptions, Renderer};
use replay::{Case, Recording};

use super::plan::Plan;
use super::run_line::RunLine;
use crate::redrive::Counterfactual;

/// A run, and its files that are not there yet.
pub struct Driven {
    line: RunLine,
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl Driven {
    /// Writes the files.
    pub fn keep(self) -> anyhow::Result<RunLine> {
        self.files.iter().try_for_each(|(path, bytes)| output::write_file(path, bytes))?;
        Ok(self.line)
    }
}

/// Drives runs, one after the other.
pub struct Runner<'a> {
    plan: &'a Plan,
    eye: &'a Eye,
    interrupt: &'a Interrupt,
    /// By the map's index.
    renderers: HashMap<usize, Renderer>,
}

impl<'a> Runner<'a> {
    /// One for a campaign.
    pub fn new(plan: &'a Plan, eye: &'a Eye, interrupt: &'a Interrupt) -> Self {
        Self { plan, eye, interrupt, renderers: HashMap::new() }
    }

    /// Drives a run, unless it is there already; `None` when interrupted.
    pub fn drive(&mut self, run: u32) -> anyhow::Result<Option<Driven>> {
        let path = self.plan.recording_path(self.eye.name(), run);
        let mut files = Vec::new();
        let recording = if path.exists() {
            let recording = Recording::open(&path)?;
            self.check(run, &path, &recording)?;
            recording
        } else {
            let Some(bytes) = self.record(run)? else { return Ok(None) };
            let recording = Recording::from_bytes(&bytes)?;
            files.push((path.clone(), bytes));
            recording
        };
        let case = self.cut(run, &recording, &mut files)?;
        let mut line = RunLine::new(self.eye.name(), &path, &recording, case.as_deref());
        line.without_intervention = self.counterfactual(run, &recording, &mut files)?;
        Ok(Some(Driven { line, files }))
    }

    /// The recording of a run; `None` when interrupted.
    fn record(&mut self, run: u32) -> anyhow::Result<Option<Vec<u8>>> {
        let index = self.plan.map_index(run);
        let vision = self.vision(index)?;
        let keep_on = |_: &World| !self.interrupt.is_raised();
        let (scenario, map) = (self.plan.scenario_of(run), &self.plan.maps[index]);
        maps::put_beside(map.foreign.as_ref(), &self.plan.recording_path(self.eye.name(), run))?;
        let (bytes, vision) = simulate::drive(&scenario, map, vision, Vec::new(), keep_on)?;
        self.renderers.insert(index, vision.into_renderer());
        Ok((!self.interrupt.is_raised()).then_some(bytes))
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
    fn cut(
        &self,
        run: u32,
        recording: &Recording,
        files: &mut Vec<(PathBuf, Vec<u8>)>,
    ) -> anyhow::Result<Option<PathBuf>> {
        let Some(window) = Case::window(recording.log()) else { return Ok(None) };
        let path = self.plan.case_path(self.eye.name(), run);
        let is_cut = |case: &Case| case.info().source == recording.digest() && case.info().to == *window.end();
        if !Case::open(&path).is_ok_and(|case| is_cut(&case)) {
            let network = &self.plan.maps[self.plan.map_index(run)].network;
            let case = Case::cut(recording, network, window)?;
            files.push((path.clone(), case.encode()?));
        }
        Ok(Some(path))
    }

    /// What would have happened without the intervention, if there was one.
    fn counterfactual(
        &mut self,
        run: u32,
        recording: &Recording,
        files: &mut Vec<(PathBuf, Vec<u8>)>,
    ) -> anyhow::Result<Option<Counterfactual>> {
        if recording.log().intervention.is_none() {
            return Ok(None);
        }
        let path = self.plan.counterfactual_path(self.eye.name(), run);
        if let Some(known) = Counterfactual::read(&path, recording)? {
            return Ok(Some(known));
        }
        let index = self.plan.map_index(run);
        let vision = self.vision(index)?;
        let (found, vision) = Counterfactual::of(recording, &self.plan.maps[index].network, vision)?;
        self.renderers.insert(index, vision.into_renderer());
        let bytes = found.encode()?;
        // As it would be read again: numbers lose their last digits in JSON.
        let found = Counterfactual::decode(&bytes, recording);
        files.push((path, bytes));
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

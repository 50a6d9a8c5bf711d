//! One run of a campaign: driven, cut, and driven on without its intervention, unless that is there already.

use std::collections::HashMap;
use std::path::Path;

use anyhow::bail;
use base::maps;
use drivers::simulate::{self, manifest};
use drivers::vision::{Eye, Vision};
use kernel::World;
use render::{AdapterChoice, Renderer};
use replay::{Case, ForeignMap, Recording};

use super::aside::Aside;
use super::kept::{is_cut, whole};
use super::places::Places;
use super::run_line::RunLine;
use super::task::Task;
use crate::redrive::Counterfactual;

/// Where recordings name the graphics adapter.
const ADAPTER: &str = "adapter";

/// A run, and its files, which are in their places or wait for them.
pub struct Driven {
    line: RunLine,
    places: Places,
    map: Option<ForeignMap>,
}

impl Driven {
    /// Gives the files their places.
    pub fn keep(self, aside: &Aside) -> anyhow::Result<RunLine> {
        maps::put_beside(self.map.as_ref(), &self.places.recording)?;
        self.places.of(&self.line).try_for_each(|path| aside.release(path))?;
        Ok(self.line)
    }
}

/// Drives runs, one after the other.
pub struct Runner<'a> {
    task: &'a Task<'a>,
    eye: &'a Eye,
    aside: &'a Aside,
    /// By the map's index.
    renderers: HashMap<usize, Renderer>,
}

impl<'a> Runner<'a> {
    /// One for a task.
    pub fn new(task: &'a Task<'a>, eye: &'a Eye, aside: &'a Aside) -> Self {
        Self { task, eye, aside, renderers: HashMap::new() }
    }

    /// Drives a run, unless it is there already; `None` when interrupted.
    pub fn drive(&mut self, run: u32) -> anyhow::Result<Option<Driven>> {
        let places = Places::new(&self.task.plan.out, self.eye.name(), run);
        let recording = match self.known(run, &places.recording)? {
            Some(known) => known,
            None => {
                let Some(recorded) = self.record(run, &places.recording)? else { return Ok(None) };
                recorded
            }
        };
        let has_case = self.cut(run, &recording, &places.case)?;
        let map = &self.task.plan.maps[self.task.plan.map_index(run)];
        let case = has_case.then_some(places.case.as_path());
        let mut line = RunLine::new(self.eye.name(), &places.recording, (&recording, &map.network), case);
        line.without_intervention = self.counterfactual(run, &recording, &places.counterfactual)?;
        Ok(Some(Driven { line, places, map: map.foreign.clone() }))
    }

    /// The recording of a run from an earlier call.
    fn known(&self, run: u32, path: &Path) -> anyhow::Result<Option<Recording>> {
        if path.exists() {
            let recording = whole(path)?;
            self.check(run, path, &recording)?;
            return Ok(Some(recording));
        }
        let waiting = self.aside.place(path);
        Ok(whole(&waiting).ok().filter(|recording| self.check(run, &waiting, recording).is_ok()))
    }

    /// Drives a run; its recording waits. `None` when interrupted.
    fn record(&mut self, run: u32, path: &Path) -> anyhow::Result<Option<Recording>> {
        let index = self.task.plan.map_index(run);
        let vision = self.vision(index)?;
        let keep_on = |_: &World| !self.task.interrupt.is_raised();
        let (scenario, map) = (self.task.plan.scenario_of(run), &self.task.plan.maps[index]);
        let (bytes, vision) = simulate::drive(&scenario, map, vision, Vec::new(), keep_on)?;
        self.renderers.insert(index, vision.into_renderer());
        if self.task.interrupt.is_raised() {
            return Ok(None);
        }
        self.aside.put(path, &bytes)?;
        maps::put_beside(map.foreign.as_ref(), &self.aside.place(path))?;
        Ok(Some(Recording::from_bytes(&bytes)?))
    }

    /// A recording that is there already must be the one that would be driven.
    fn check(&self, run: u32, path: &Path, recording: &Recording) -> anyhow::Result<()> {
        let plan = self.task.plan;
        let mut expected = manifest(&plan.scenario_of(run), &plan.maps[plan.map_index(run)], self.eye);
        let adapter = recording.log().manifest.provenance.get(ADAPTER);
        if let Some(known) = adapter.filter(|adapter| self.task.adapters.contains(adapter)) {
            expected.provenance.insert(ADAPTER.to_owned(), known.clone());
        }
        if recording.log().manifest != expected {
            bail!("{}: belongs to another campaign; expected an empty folder or this campaign's", path.display());
        }
        Ok(())
    }

    /// Cuts the corner case out of a recording, if there is one, to go to a path.
    fn cut(&self, run: u32, recording: &Recording, path: &Path) -> anyhow::Result<bool> {
        let Some(window) = Case::window(recording.log()) else { return Ok(false) };
        if !is_cut(&self.aside.find(path), recording, &window) {
            let network = &self.task.plan.maps[self.task.plan.map_index(run)].network;
            let case = Case::cut(recording, network, window)?;
            self.aside.put(path, &case.encode()?)?;
        }
        Ok(true)
    }

    /// What would have happened without the intervention, if there was one; it goes to a path.
    fn counterfactual(
        &mut self,
        run: u32,
        recording: &Recording,
        path: &Path,
    ) -> anyhow::Result<Option<Counterfactual>> {
        if recording.log().intervention.is_none() {
            return Ok(None);
        }
        if let Some(known) = Counterfactual::read(&self.aside.find(path), recording)? {
            return Ok(Some(known));
        }
        let index = self.task.plan.map_index(run);
        let vision = self.vision(index)?;
        let (found, vision) = Counterfactual::of(recording, &self.task.plan.maps[index].network, vision)?;
        self.renderers.insert(index, vision.into_renderer());
        let bytes = found.encode()?;
        // As it would be read again: numbers lose their last digits in JSON.
        let found = Counterfactual::decode(&bytes, recording);
        self.aside.put(path, &bytes)?;
        Ok(found)
    }

    /// The bot's eye on a map.
    fn vision(&mut self, index: usize) -> anyhow::Result<Vision> {
        let renderer = match self.renderers.remove(&index) {
            Some(renderer) => renderer,
            None => Renderer::new(&self.task.plan.maps[index].network, &AdapterChoice::default())?,
        };
        Ok(Vision::new(renderer, self.eye.clone()))
    }
}

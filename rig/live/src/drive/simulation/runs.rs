//! The runs of a session: which one is on, where it stands, and what those before it came to.

use std::path::{Path, PathBuf};

use kernel::{Scenario, World};
use replay::{Annotation, Label, Recording};

use super::plan::Plan;
use crate::drive::board::{self, Totals};
use crate::drive::disk;
use crate::drive::run::Run;
use crate::drive::stage::{Dialog, Stage};

/// The runs of a session.
pub struct Runs {
    /// Where the session stands.
    pub stage: Stage,
    number: u32,
    /// The world of a run that waits for its start.
    next: Option<World>,
    run: Option<Run>,
    /// The kind of corner case that the operators gave the run's takeover before its end.
    label: Option<Label>,
    totals: Totals,
}

impl Runs {
    /// A campaign goes on in a new session under the same name, with the runs after the last one.
    /// Gives what is to be said about those that are not counted, too.
    pub fn after_earlier_ones(record: &Path) -> (Self, Vec<String>) {
        let totals = Totals::default();
        let mut runs = Self { stage: Stage::Ready, number: 0, next: None, run: None, label: None, totals };
        let mut not_counted = Vec::new();
        for number in disk::numbers(record) {
            runs.number = number;
            match Recording::open(&disk::numbered(record, number)) {
                Ok(recording) => runs.totals.add_recorded(recording.log()),
                Err(error) => not_counted.push(format!("not counted: {error:#}")),
            }
        }
        (runs, not_counted)
    }

    /// Number of the run that is on, or that waits.
    pub fn number(&self) -> u32 {
        self.number
    }

    /// What the finished runs came to.
    pub fn totals(&self) -> Totals {
        self.totals
    }

    /// Ticks driven under this name, with those of the run that is on.
    pub fn driven_ticks(&self) -> u64 {
        self.totals.ticks + self.run.as_ref().map_or(0, |run| run.world().tick())
    }

    /// Whether the car drives.
    pub fn is_driving(&self) -> bool {
        self.stage == Stage::Driving
    }

    /// The world of the run that is on, or that waits.
    pub fn world(&self) -> Option<&World> {
        self.run.as_ref().map(Run::world).or(self.next.as_ref())
    }

    /// The run that is on.
    pub fn current(&mut self) -> Option<&mut Run> {
        self.run.as_mut()
    }

    /// What the bot in the safety driver's seat says about the end of the run, if there is one.
    pub fn bots_word(&self) -> Option<Annotation> {
        self.run.as_ref().and_then(Run::bots_word)
    }

    /// Makes the world of the next run, which waits for its start.
    pub fn prepare(&mut self, plan: &Plan) -> anyhow::Result<&World> {
        self.number += 1;
        let seed = plan.cast.seed_of_run(self.number);
        let scenario = Scenario { seed, ..plan.scenario.clone() };
        let world = World::new(&scenario, &plan.map.network)?;
        (self.run, self.label) = (None, None);
        self.stage = Stage::Ready;
        Ok(self.next.insert(world))
    }

    /// Hands out the world that waits, for its run to be started.
    pub fn take_next(&mut self) -> Option<World> {
        self.next.take()
    }

    /// The run drives.
    pub fn start(&mut self, run: Run) {
        self.run = Some(run);
        self.stage = Stage::Driving;
    }

    /// The takeover that is on is of this kind; says whether there is one.
    pub fn label(&mut self, label: Label) -> bool {
        let is_taken_over = self.run.as_ref().is_some_and(|run| run.world().arbiter().intervention.is_some());
        self.label = Some(label).filter(|_| is_taken_over);
        is_taken_over
    }

    /// What the operators have said of the run so far, however it ends.
    pub fn said(&self) -> Option<Annotation> {
        let early = || Some(Annotation { label: self.label?, comment: String::new(), perception_caused: None });
        self.stage.annotation().or_else(early)
    }

    /// The run has ended as a corner case and waits for its label.
    pub fn ask(&mut self) {
        self.stage = Stage::Labelling(Dialog::of_case(self.label));
    }

    /// The run is broken off. A takeover that is on is one all the same.
    pub fn break_off(&mut self) {
        let is_case = self.run.as_ref().is_some_and(|run| board::is_case(run.world()));
        let dialog = if is_case { Dialog::of_case(self.label) } else { Dialog::of_broken_off() };
        self.stage = Stage::Labelling(dialog);
    }

    /// Ends the recording of the run that is on, and counts the run unless it is for familiarisation.
    pub fn end(&mut self, annotation: Option<Annotation>, counts: bool) -> Option<anyhow::Result<PathBuf>> {
        let run = self.run.take()?;
        if counts {
            self.totals.add(run.world(), annotation.as_ref());
        }
        Some(run.finish(annotation))
    }
}

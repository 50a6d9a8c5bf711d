//! The runs of a session: which one is on, where it stands, and what those before it came to.

use std::path::PathBuf;
use std::sync::Arc;

use kernel::World;
use replay::{Annotation, Label, Provenance};
use study::protocol::{Ended, Progress, Recorded};

use super::agenda::Bill;
use super::plan::Plan;
use crate::drive::board::{About, Totals};
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
    bill: Bill,
    about: Arc<About>,
    /// The kind of corner case that the operators gave the run's takeover before its end.
    label: Option<Label>,
    progress: Progress,
    totals: Totals,
    tally: Arc<[String]>,
}

impl Runs {
    /// A campaign goes on in a new session under the same name, with the runs after the last one.
    /// Gives what is to be said about those that are not counted, too.
    pub fn after_earlier_ones(plan: &Plan) -> anyhow::Result<(Self, Vec<String>)> {
        let trial_of = |provenance: &Provenance| plan.agenda.trial_of(provenance);
        let Recorded { last, progress, not_counted } = Recorded::under(&plan.record, trial_of)?;
        let bill = plan.agenda.bill(last + 1, &progress);
        let mut runs = Self {
            stage: Stage::Ready,
            number: last,
            next: None,
            run: None,
            about: plan.about(&bill),
            bill,
            label: None,
            progress,
            totals: Totals::default(),
            tally: Arc::default(),
        };
        runs.sum_up(plan);
        Ok((runs, not_counted))
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

    /// Makes the world of the next run, which waits for its start; once all is driven, one that does not start.
    pub fn prepare(&mut self, plan: &Plan) -> anyhow::Result<&World> {
        self.number += 1;
        self.bill = plan.agenda.bill(self.number, &self.progress);
        self.about = plan.about(&self.bill);
        let world = World::new(&self.bill.scenario, &self.bill.map.network)?;
        (self.run, self.label) = (None, None);
        self.wait_for_start();
        Ok(self.next.insert(world))
    }

    /// Nothing but the start is waited for.
    pub fn wait_for_start(&mut self) {
        self.stage = if self.bill.is_over { Stage::Over } else { Stage::Ready };
    }

    /// What the run is to be that is on, or that waits.
    pub fn bill(&self) -> &Bill {
        &self.bill
    }

    /// What may be shown of it.
    pub fn about(&self) -> &Arc<About> {
        &self.about
    }

    /// The runs so far.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// What each of the people did in each seat, a line each.
    pub fn tally(&self) -> &Arc<[String]> {
        &self.tally
    }

    fn sum_up(&mut self, plan: &Plan) {
        self.totals = Totals::of(&self.progress);
        let tally = plan.agenda.protocol().map(|protocol| self.progress.totals(protocol));
        self.tally = tally.unwrap_or_default().into();
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
        let is_case = self.run.as_ref().is_some_and(|run| Ended::of_world(run.world(), None).is_case);
        let dialog = if is_case { Dialog::of_case(self.label) } else { Dialog::of_broken_off() };
        self.stage = Stage::Labelling(dialog);
    }

    /// Ends the recording of the run that is on, and counts the run unless it is for familiarisation.
    pub fn end(&mut self, annotation: Option<Annotation>, plan: &Plan) -> Option<anyhow::Result<PathBuf>> {
        let run = self.run.take()?;
        let ended = Ended::of_world(run.world(), annotation.as_ref());
        self.progress.add(self.bill.trial, Ended { counts: ended.counts && !plan.is_familiarisation, ..ended });
        self.sum_up(plan);
        Some(run.finish(annotation))
    }
}

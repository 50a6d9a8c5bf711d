//! A run and its recording, tick by tick.

use std::io::Write;

use kernel::arbiter::{Intervention, Outcome, Phase};
use kernel::{TickInput, TickOutput, World};
use replay::{Annotation, Manifest, MaskShown, Note, Recorder};

/// Where a session stands after a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SessionState {
    /// It goes on.
    Driving,
    /// The run has ended by an intervention, which waits for its label.
    Labelling(Intervention),
    /// The run has ended without one.
    Done(Outcome),
}

impl SessionState {
    /// That of the run of a world.
    pub fn of(world: &World) -> Self {
        let arbiter = world.arbiter();
        match (arbiter.phase, arbiter.outcome, arbiter.intervention) {
            (Phase::Done, Some(Outcome::Intervened), Some(intervention)) => Self::Labelling(intervention),
            (Phase::Done, Some(outcome), _) => Self::Done(outcome),
            _ => Self::Driving,
        }
    }
}

/// A world whose every tick is recorded.
pub struct Session<W: Write> {
    world: World,
    recorder: Recorder<W>,
}

impl<W: Write> Session<W> {
    /// Starts a recording with the state of a world that has not been stepped yet.
    pub fn new(world: World, manifest: &Manifest, out: W) -> anyhow::Result<Self> {
        let recorder = Recorder::new(out, manifest, &world.initial_keyframe())?;
        Ok(Self { world, recorder })
    }

    /// The world at the last tick.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Advances by one tick and records it.
    pub fn tick(&mut self, input: &TickInput) -> anyhow::Result<(SessionState, TickOutput)> {
        let output = self.world.step(input);
        self.recorder.tick(input, &output, &self.world.part_hashes())?;
        Ok((SessionState::of(&self.world), output))
    }

    /// Records what was on the semantic driver's screen.
    pub fn mask_shown(&mut self, mask: MaskShown) -> Result<(), replay::Error> {
        self.recorder.mask_shown(mask)
    }

    /// Records what happened to the rig.
    pub fn note(&mut self, note: Note) -> Result<(), replay::Error> {
        self.recorder.note(note)
    }

    /// Says what the intervention was.
    pub fn annotate(&mut self, annotation: Annotation) {
        self.recorder.annotate(annotation);
    }

    /// Ends the recording, whether the run has ended or not.
    pub fn finish(self) -> anyhow::Result<W> {
        Ok(self.recorder.finish(self.world.arbiter().outcome)?)
    }
}

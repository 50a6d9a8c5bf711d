//! A world, recorded or not.

use kernel::{TickInput, TickOutput, World};
use replay::{Annotation, Manifest, MaskShown};

use crate::session::Session;

/// A world, with its recording in memory where it is recorded.
pub enum Drive {
    /// Not recorded.
    Bare(Box<World>),
    /// Recorded.
    Kept(Box<Session<Vec<u8>>>),
}

impl Drive {
    /// Starts with a world that has not been stepped yet.
    pub fn new(world: World, manifest: Option<&Manifest>) -> anyhow::Result<Self> {
        Ok(match manifest {
            Some(manifest) => Self::Kept(Box::new(Session::new(world, manifest, Vec::new())?)),
            None => Self::Bare(Box::new(world)),
        })
    }

    /// Whether it is recorded.
    pub fn is_kept(&self) -> bool {
        matches!(self, Self::Kept(_))
    }

    /// The world at the last tick.
    pub fn world(&self) -> &World {
        match self {
            Self::Bare(world) => world,
            Self::Kept(session) => session.world(),
        }
    }

    /// Advances by one tick.
    pub fn tick(&mut self, input: &TickInput, shown: Option<MaskShown>) -> anyhow::Result<TickOutput> {
        match self {
            Self::Bare(world) => Ok(world.step(input)),
            Self::Kept(session) => {
                shown.map_or(Ok(()), |shown| session.mask_shown(shown))?;
                Ok(session.tick(input)?.1)
            }
        }
    }

    /// Ends it, and gives the recording.
    pub fn finish(self, annotation: Option<Annotation>) -> anyhow::Result<Option<Vec<u8>>> {
        let Self::Kept(mut session) = self else { return Ok(None) };
        annotation.into_iter().for_each(|annotation| session.annotate(annotation));
        session.finish().map(Some)
    }
}

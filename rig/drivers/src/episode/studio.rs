//! Graphics devices for many drives: each is of one map, and drives on that map take turns at it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use kernel::RoadNetwork;
use render::{RenderOptions, Renderer};

use crate::vision::{Eye, Optics};

/// As many devices as drives are stepped at the same time.
pub struct Studio {
    eye: Eye,
    most: usize,
    drives: usize,
    shelf: Mutex<Shelf>,
}

/// Those that nobody uses, longest unused first, and how many are in use.
#[derive(Default)]
struct Shelf {
    idle: Vec<(Arc<RoadNetwork>, Optics)>,
    lent: usize,
}

impl Studio {
    /// One that looks through an eye, with at most so many devices for so many drives.
    pub fn new(eye: Eye, most: usize, drives: usize) -> Self {
        Self { eye, most, drives, shelf: Mutex::default() }
    }

    /// What looks.
    pub fn eye(&self) -> &Eye {
        &self.eye
    }

    /// Does something with a device of a map.
    pub fn with<T>(
        &self,
        network: &Arc<RoadNetwork>,
        work: impl FnOnce(&mut Optics) -> anyhow::Result<T>,
    ) -> anyhow::Result<T> {
        let mut optics = match self.take(network) {
            Some(optics) => optics,
            None => self.build(network).inspect_err(|_| self.shelf().lent -= 1)?,
        };
        let done = work(&mut optics);
        let mut shelf = self.shelf();
        shelf.lent -= 1;
        // One that failed may be lost.
        if done.is_ok() {
            shelf.idle.push((network.clone(), optics));
        }
        done
    }

    /// One of the map that is free; where there is none, room for a new one.
    fn take(&self, network: &Arc<RoadNetwork>) -> Option<Optics> {
        let mut shelf = self.shelf();
        shelf.lent += 1;
        let found = shelf.idle.iter().position(|(of, _)| Arc::ptr_eq(of, network));
        if found.is_none() && shelf.idle.len() + shelf.lent > self.most && !shelf.idle.is_empty() {
            shelf.idle.remove(0);
        }
        found.map(|index| shelf.idle.remove(index).1)
    }

    fn build(&self, network: &RoadNetwork) -> anyhow::Result<Optics> {
        let renderer = Renderer::new(network, &RenderOptions::default())?.with_shadow_maps(self.drives);
        Ok(Optics::new(renderer, self.eye.clone()))
    }

    fn shelf(&self) -> MutexGuard<'_, Shelf> {
        self.shelf.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

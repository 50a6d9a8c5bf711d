//! Graphics devices for many drives: each is of one map, and drives on that map take turns at it.
//!
//! Each device keeps the shadow maps of the drives that it draws, so drives keep to their device where they can.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use kernel::RoadNetwork;
use render::{AdapterChoice, Renderer};

use crate::vision::{Eye, Optics};

/// As many devices as drives are stepped at the same time.
pub struct Studio {
    eye: Eye,
    with_colours: bool,
    most: usize,
    drives: usize,
    shelf: Mutex<Shelf>,
}

/// Those that nobody uses, longest unused first, and how many are in use.
#[derive(Default)]
struct Shelf {
    idle: Vec<Device>,
    lent: usize,
}

struct Device {
    network: Arc<RoadNetwork>,
    /// Which worker's drives it draws, if they are not taken over by another one.
    worker: usize,
    optics: Optics,
}

impl Studio {
    /// One that looks through an eye, and may need colours that the eye does not, with at most so many devices for so many
    /// drives.
    pub fn new(eye: Eye, with_colours: bool, most: usize, drives: usize) -> Self {
        Self { eye, with_colours, most, drives, shelf: Mutex::default() }
    }

    /// What looks.
    pub fn eye(&self) -> &Eye {
        &self.eye
    }

    /// Does something with a device of a map, if possible with the one that drew for this worker before.
    pub fn with<T>(
        &self,
        network: &Arc<RoadNetwork>,
        worker: usize,
        work: impl FnOnce(&mut Optics) -> anyhow::Result<T>,
    ) -> anyhow::Result<T> {
        let mut device = match self.take(network, worker) {
            Some(device) => device,
            None => {
                let optics = self.build(network).inspect_err(|_| self.shelf().lent -= 1)?;
                Device { network: network.clone(), worker, optics }
            }
        };
        let done = work(&mut device.optics);
        let mut shelf = self.shelf();
        shelf.lent -= 1;
        // One that failed may be lost.
        if done.is_ok() {
            shelf.idle.push(device);
        }
        done
    }

    /// One of the map that is free, the worker's own if that is; where there is none, room for a new one.
    fn take(&self, network: &Arc<RoadNetwork>, worker: usize) -> Option<Device> {
        let mut shelf = self.shelf();
        shelf.lent += 1;
        let of_map = |device: &&Device| Arc::ptr_eq(&device.network, network);
        let place = |is_it: &dyn Fn(&&Device) -> bool| shelf.idle.iter().position(|device| is_it(&device));
        let own = place(&|device| of_map(device) && device.worker == worker);
        let found = own.or_else(|| place(&of_map));
        if found.is_none() && shelf.idle.len() + shelf.lent > self.most && !shelf.idle.is_empty() {
            shelf.idle.remove(0);
        }
        found.map(|index| shelf.idle.remove(index))
    }

    fn build(&self, network: &RoadNetwork) -> anyhow::Result<Optics> {
        let renderer = Renderer::new(network, &AdapterChoice::default())?.with_shadow_maps(self.drives);
        let optics = Optics::new(renderer, self.eye.clone());
        Ok(if self.with_colours { optics.with_colours() } else { optics })
    }

    fn shelf(&self) -> MutexGuard<'_, Shelf> {
        self.shelf.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

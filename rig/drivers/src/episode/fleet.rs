//! Many episodes, stepped together over the cores.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use base::failure::Usage;
use base::maps::{self, Map};
use base::{output, spread};
use kernel::arbiter::Outcome;
use kernel::time::Tick;
use kernel::{Controls, Scenario, Seat, World};
use render::{Camera, Frame};

use super::studio::Studio;
use super::{Episode, Facts, hud, manifest};
use crate::readout::Readout;
use crate::vision::{Eye, Optics};

/// What all episodes of a fleet share.
pub struct Plan {
    /// The agent's seat.
    pub seat: Seat,
    /// Ticks that the controls of a step are held for.
    pub ticks: Tick,
    /// Whether masks are observed.
    pub masks: bool,
    /// What takes the images that are observed.
    pub images: Option<Camera>,
    /// Where recordings go.
    pub archive: Option<Archive>,
    /// Episodes that are stepped at the same time, each with a graphics device.
    pub jobs: usize,
}

/// A folder of recordings.
pub struct Archive(PathBuf);

impl Archive {
    /// Makes the folder, unless it is there.
    pub fn open(folder: &Path) -> anyhow::Result<Self> {
        output::create_folder(folder)?;
        Ok(Self(folder.to_owned()))
    }

    /// Keeps a recording under a name that is free.
    fn keep(&self, (number, seed): (u64, u64), map: &Map, bytes: &[u8]) -> anyhow::Result<PathBuf> {
        let path = output::write_new(&self.0.join(format!("episode-{number:06}-seed-{seed}")), "mcap", bytes)?;
        maps::put_beside(map.foreign.as_ref(), &path)?;
        Ok(path)
    }
}

/// An episode that is to start.
pub struct Start {
    /// Its place in the fleet.
    pub place: usize,
    /// What it starts from.
    pub scenario: Scenario,
    /// Where.
    pub map: Map,
}

/// Where the observation of an episode goes.
pub struct Row<'a> {
    /// Its place in the fleet.
    pub place: usize,
    /// The mask on the semantic driver's screen, a byte a pixel.
    pub mask: Option<&'a mut [u8]>,
    /// The safety driver's image, 3 bytes a pixel.
    pub image: Option<&'a mut [u8]>,
    /// As [`hud::row`].
    pub hud: &'a mut [f32],
    /// [`COLUMNS`].
    pub figures: &'a mut [f64],
}

/// What is told of a step in figures: tick that was reached, low 32 bits of its hash, outcome of the run (-1 while it goes
/// on; see [`Outcome`]), whether the safety driver has taken over, and the [`Facts`].
pub const COLUMNS: [&str; 4 + Facts::NAMES.len()] = {
    let mut names = ["tick", "hash", "outcome", "taken_over", "", "", "", "", "", "", "", "", ""];
    let mut i = 0;
    while i < Facts::NAMES.len() {
        names[4 + i] = Facts::NAMES[i];
        i += 1;
    }
    names
};

/// Episodes of one plan, by their places.
pub struct Fleet {
    plan: Plan,
    studio: Studio,
    places: Vec<Option<Running>>,
    begun: u64,
}

struct Running {
    episode: Episode,
    map: Map,
    number: u64,
    seed: u64,
}

impl Fleet {
    /// So many places, in which no episode runs yet.
    pub fn new(plan: Plan, eye: Eye, places: usize) -> Self {
        let with_colours = plan.images == Some(eye.camera());
        let studio = Studio::new(eye, with_colours, plan.jobs, places);
        Self { plan, studio, places: (0..places).map(|_| None).collect(), begun: 0 }
    }

    /// What looks.
    pub fn eye(&self) -> &Eye {
        self.studio.eye()
    }

    /// Starts episodes; those that still run there end. What each one's agent sees first goes to the row of its place.
    pub fn start(&mut self, starts: Vec<Start>, rows: Vec<Row<'_>>) -> anyhow::Result<()> {
        let places: Vec<usize> = starts.iter().map(|start| start.place).collect();
        self.finish(&places)?;
        let (plan, studio) = (&self.plan, &self.studio);
        let numbers = self.begun + 1..;
        self.begun += starts.len() as u64;
        let work: Vec<_> = starts.into_iter().zip(rows).zip(numbers).collect();
        let running = each(plan.jobs, work, |worker, ((start, row), number)| {
            let Start { place, scenario, map } = start;
            let manifest = plan.archive.as_ref().map(|_| manifest(&scenario, &map, plan.seat, studio.eye()));
            let mut episode = Episode::new(&scenario, &map, plan.seat, manifest.as_ref(), plan.masks)?;
            studio.with(&map.network, worker, |optics| plan.observe(&mut episode, optics, Facts::default(), row))?;
            Ok((place, Running { episode, map, number, seed: scenario.seed }))
        })?;
        for (place, running) in running {
            self.places[place] = Some(running);
        }
        Ok(())
    }

    /// Steps the episodes of rows with the agents' controls.
    pub fn step(&mut self, controls: &[Controls], rows: Vec<Row<'_>>) -> anyhow::Result<()> {
        let (plan, studio) = (&self.plan, &self.studio);
        let mut running: Vec<_> = self.places.iter_mut().map(Option::as_mut).collect();
        let mut work = Vec::with_capacity(rows.len());
        for (row, controls) in rows.into_iter().zip(controls) {
            let running = running.get_mut(row.place).and_then(Option::take);
            let Some(running) = running.filter(|running| !running.episode.is_over()) else {
                return Err(Usage("the episode is over; expected a reset before the next step".to_owned()).into());
            };
            work.push((running, *controls, row));
        }
        each(plan.jobs, work, |worker, (running, controls, row)| {
            let Running { episode, map, .. } = running;
            studio.with(&map.network, worker, |optics| {
                let facts = episode.step(optics, controls, plan.ticks)?;
                plan.observe(episode, optics, facts, row)
            })
        })?;
        Ok(())
    }

    /// Ends the episodes at those places, where some run, and tells where their recordings are.
    pub fn finish(&mut self, places: &[usize]) -> anyhow::Result<Vec<Option<PathBuf>>> {
        let plan = &self.plan;
        let ended = places.iter().map(|place| self.places.get_mut(*place).and_then(Option::take)).collect();
        each(plan.jobs, ended, |_, ended: Option<Running>| {
            let Some(Running { episode, map, number, seed }) = ended else { return Ok(None) };
            let has_begun = episode.world().tick() > 0;
            let Some(archive) = plan.archive.as_ref().filter(|_| has_begun) else { return Ok(None) };
            let bytes = episode.finish()?;
            bytes.map(|bytes| archive.keep((number, seed), &map, &bytes)).transpose()
        })
    }

    /// What a camera sees of an episode now.
    pub fn draw(&mut self, place: usize, camera: &Camera) -> anyhow::Result<Frame> {
        let running = self.places.get(place).and_then(Option::as_ref);
        let over = || Usage("the episode is over; expected a reset before a picture".to_owned());
        let Running { episode, map, .. } = running.ok_or_else(over)?;
        self.studio.with(&map.network, 0, |optics| episode.draw(optics, camera))
    }
}

impl Plan {
    fn observe(&self, episode: &mut Episode, optics: &mut Optics, facts: Facts, row: Row<'_>) -> anyhow::Result<()> {
        if let Some(mask) = row.mask {
            mask.copy_from_slice(episode.mask(optics)?.ids);
        }
        if let (Some(image), Some(camera)) = (row.image, &self.images) {
            image.copy_from_slice(&episode.image(optics, camera)?);
        }
        let world = episode.world();
        row.hud.copy_from_slice(&hud::row(&Readout::of(&world.hud())));
        row.figures.copy_from_slice(&figures(world, &facts));
        Ok(())
    }
}

fn figures(world: &World, facts: &Facts) -> [f64; COLUMNS.len()] {
    let arbiter = world.arbiter();
    let outcome = match arbiter.outcome {
        None => -1.0,
        Some(Outcome::Intervened) => 0.0,
        Some(Outcome::Missed) => 1.0,
        Some(Outcome::Censored) => 2.0,
    };
    let mut row = [0.0; COLUMNS.len()];
    let hash = f64::from(world.hash().0 as u32);
    row[..4].copy_from_slice(&[
        world.tick() as f64,
        hash,
        outcome,
        f64::from(u8::from(arbiter.intervention.is_some())),
    ]);
    row[4..].copy_from_slice(&facts.row());
    row
}

/// Does work on threads, and gives what it comes to in its order. The same worker does the same of it each time, as long as
/// none is behind: see [`Studio`].
fn each<W: Send, T: Send>(
    jobs: usize,
    work: Vec<W>,
    f: impl Fn(usize, W) -> anyhow::Result<T> + Sync,
) -> anyhow::Result<Vec<T>> {
    let workers = jobs.clamp(1, work.len().max(1));
    if workers == 1 {
        return work.into_iter().map(|work| f(0, work)).collect();
    }
    let count = work.len();
    let work: Vec<Mutex<Option<W>>> = work.into_iter().map(|work| Mutex::new(Some(work))).collect();
    let take = |index: usize| work[index].lock().unwrap_or_else(PoisonError::into_inner).take();
    let of_worker = |worker: usize| {
        let own = (worker..count).step_by(workers);
        let of_others = (0..count).rev().filter(|index| index % workers != worker);
        let done = own.chain(of_others).filter_map(|index| Some((index, f(worker, take(index)?))));
        done.collect::<Vec<_>>()
    };
    let done = spread::collect_in_order(workers, workers, of_worker);
    let mut done: Vec<_> = done.into_iter().flatten().collect();
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, done)| done).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Barrier;

    use anyhow::bail;

    use super::*;

    #[test]
    fn each_worker_does_its_own_work_and_then_that_of_others_and_all_is_told_in_order() {
        // Both begin together, and the second one waits with its first piece until all others are done.
        let (begun, done) = (Barrier::new(2), Mutex::new(0));
        let workers = each(2, (0..7).collect(), |worker, number| {
            if number < 2 {
                begun.wait();
            }
            while number == 1 && *done.lock().expect("no panic") < 6 {
                std::thread::yield_now();
            }
            *done.lock().expect("no panic") += 1;
            Ok((number, worker))
        });
        let expected = [(0, 0), (1, 1), (2, 0), (3, 0), (4, 0), (5, 0), (6, 0)];
        assert_eq!(workers.expect("no error"), expected);
    }

    #[test]
    fn an_error_of_one_is_that_of_all() {
        let failed = each(3, vec![1, 2, 3, 4], |_, number| if number == 3 { bail!("the third") } else { Ok(()) });
        assert_eq!(failed.expect_err("it fails").to_string(), "the third");
    }
}

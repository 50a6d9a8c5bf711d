//! The checkpoints of a session: which one drives which run, and what may be told of them.

use anyhow::{Context, anyhow};
use drivers::checkpoint::{CheckpointChoice, check_names};
use drivers::vision::{self, DEFAULT_SIZE, Eye};
use kernel::rng::{self, Stream};
use perception::{Compute, Mask};
use render::{Camera, Frame, Imaging};
use replay::Provenance;

use crate::blind::{BLIND, CANDIDATES};

/// The entity of the draw among the random numbers of drivers; bots count theirs from 0.
const DRAW: u64 = u64::MAX;

/// Seeds and checkpoints of runs that are drawn: functions of the session's seed and the run's number, from 1.
#[derive(Clone, Copy, Debug)]
pub struct Draw {
    seed: u64,
    candidates: u32,
}

impl Draw {
    /// The seed of a run's scenario; the first run has the session's.
    pub fn seed_of_run(&self, number: u32) -> u64 {
        if number == 1 { self.seed } else { rng::bits(self.seed, Stream::Scenario, u64::from(number), 0) >> 32 }
    }

    /// Which of the candidates drives a run: drawn from the run's seed, each with the same chance.
    pub fn eye_of_run(&self, number: u32) -> usize {
        rng::below(self.seed_of_run(number), Stream::Driver, DRAW, 0, self.candidates) as usize
    }
}

/// What is known of the eyes that may drive.
#[derive(Clone, Debug)]
pub struct Cast {
    public_names: Vec<String>,
    /// What recordings say about each of the checkpoints.
    provenances: Vec<Provenance>,
}

impl Cast {
    /// What the recording of a run says about its checkpoint.
    pub fn provenance(&self, eye: usize) -> &Provenance {
        &self.provenances[eye]
    }

    /// What the checkpoint may be called while driving.
    pub fn public_name(&self, eye: usize) -> &str {
        &self.public_names[eye]
    }

    /// For runs that are drawn, in a session of a seed.
    pub fn draw(&self, seed: u64) -> Draw {
        Draw { seed, candidates: self.provenances.len() as u32 }
    }
}

/// The eyes that may drive.
pub struct Lineup {
    eyes: Vec<Eye>,
    /// Of the pictures.
    camera: Camera,
    is_blind: bool,
    cast: Cast,
}

impl Lineup {
    /// Opens the checkpoints of a session; where there is more than one and it `is_blind`, nobody is told which of them drives.
    /// All of them look at pictures that are made alike and of one size, so that it gives nothing away: the one asked for, or
    /// else that of the first. All of them are computed by the same.
    pub fn open(
        checkpoints: &[CheckpointChoice],
        is_blind: bool,
        (size, imaging): (Option<(u32, u32)>, Imaging),
        compute: Compute,
    ) -> anyhow::Result<Self> {
        check_names(checkpoints)?;
        let (first, others) = checkpoints.split_first().context("expected a checkpoint")?;
        // Ground truth can be drawn at any size, and is drawn at this one where nothing asks for another.
        let has_truth = checkpoints.contains(&CheckpointChoice::Truth);
        let wanted = size.or(has_truth.then_some(DEFAULT_SIZE));
        let first = Eye::open_on(compute, first, wanted)?;
        let size = wanted.unwrap_or(first.size());
        let others = others.iter().map(|choice| Eye::open_on(compute, choice, Some(size)));
        let eyes = std::iter::once(Ok(first)).chain(others).map(|eye| Ok(eye?.at(imaging)));
        let eyes = eyes.collect::<anyhow::Result<Vec<_>>>()?;
        // Truth is the same however pictures are made.
        let imaging = if eyes.iter().any(Eye::needs_colours) { imaging } else { imaging.of_truth() };
        let camera = Camera::driver(size.0, size.1).at(imaging);
        let is_blind = is_blind && eyes.len() > 1;
        let cast =
            Cast { public_names: public_names(&eyes, is_blind), provenances: provenances(&eyes, &camera, is_blind) };
        Ok(Self { eyes, camera, is_blind, cast })
    }

    /// What is known of the eyes.
    pub fn cast(&self) -> &Cast {
        &self.cast
    }

    /// Of the pictures.
    pub fn camera(&self) -> Camera {
        self.camera
    }

    /// What an eye makes of a frame. The failure of a blind one does not tell which.
    pub fn see(&mut self, eye: usize, frame: Frame) -> anyhow::Result<Mask> {
        let seen = self.eyes[eye].see(frame);
        if !self.is_blind {
            return seen;
        }
        seen.map_err(|_| anyhow!("inference failed in the checkpoint that was drawn; `aeye inspect --reveal` names it"))
    }

    /// One of the eyes.
    pub fn eye(&self, eye: usize) -> &Eye {
        &self.eyes[eye]
    }
}

fn public_names(eyes: &[Eye], is_blind: bool) -> Vec<String> {
    let name = |eye: &Eye| if is_blind { format!("blind, one of {}", eyes.len()) } else { eye.name().to_owned() };
    eyes.iter().map(name).collect()
}

fn provenances(eyes: &[Eye], camera: &Camera, is_blind: bool) -> Vec<Provenance> {
    let names: Vec<&str> = eyes.iter().map(Eye::name).collect();
    let of = |eye: &Eye| {
        let blind = [(BLIND, format!("one of {} checkpoints", names.len())), (CANDIDATES, names.join(", "))];
        let blind = blind.into_iter().filter(|_| is_blind).map(|(key, value)| (key.to_owned(), value));
        vision::provenance(eye, camera).into_iter().chain(blind).collect()
    };
    eyes.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_candidate_drives_about_as_often() {
        for candidates in [1, 2, 3] {
            let draw = Draw { seed: 7, candidates };
            let mut counts = vec![0usize; candidates as usize];
            (1..=3000).for_each(|run| counts[draw.eye_of_run(run)] += 1);
            let even = 3000 / candidates as usize;
            assert!(counts.iter().all(|n| n.abs_diff(even) < 120), "{counts:?}");
        }
        // The first runs of different sessions are drawn, too.
        let firsts: usize = (0..1000).map(|seed| Draw { seed, candidates: 2 }.eye_of_run(1)).sum();
        assert!(firsts.abs_diff(500) < 70, "{firsts}");
    }

    #[test]
    fn candidates_differ_in_nothing_that_is_shown() {
        let checkpoints = [CheckpointChoice::Truth, CheckpointChoice::Bundled("early")];
        let pictures = (Some((64, 32)), render::Quality::Standard.into());
        let lineup = Lineup::open(&checkpoints, true, pictures, Compute::Cpu).expect("bundled");
        let cast = lineup.cast();
        assert_eq!((cast.public_name(1), lineup.camera().width), ("blind, one of 2", 64));
        for eye in &lineup.eyes {
            assert!(matches!(eye, Eye::Truth) || eye.size() == (64, 32));
        }
        let told: Vec<_> = cast.provenances.iter().map(|p| super::super::tellable(p, false)).collect();
        assert_eq!(told[0], told[1]);
        assert!(told[0]["camera"] == "driver 64x32 standard" && !told[0].contains_key("checkpoint"));
        let names: Vec<_> = cast.provenances.iter().map(|p| p["checkpoint"].clone()).collect();
        assert_eq!(names, ["truth", "early"]);
    }
}

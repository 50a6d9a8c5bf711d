//! Which checkpoint drives which run, where that is not to be known.

use anyhow::anyhow;
use drivers::checkpoint::{CheckpointChoice, check_names};
use drivers::vision::{self, DEFAULT_SIZE, Eye};
use kernel::rng::{self, Stream};
use perception::{Compute, Mask};
use render::{Camera, Frame, Imaging};
use replay::Provenance;

use crate::Study;
use crate::blind::{BLIND, CANDIDATES};

/// The entity of the draw among the random numbers of drivers; bots count theirs from 0.
const DRAW: u64 = u64::MAX;

/// Seeds and checkpoints of a session's runs: functions of its seed and the run's number, from 1.
#[derive(Clone, Debug)]
pub struct Cast {
    seed: u64,
    public_name: String,
    /// What recordings say about each of the checkpoints.
    provenances: Vec<Provenance>,
}

impl Cast {
    /// The seed of a run's scenario; the first run has the session's.
    pub fn seed_of_run(&self, number: u32) -> u64 {
        if number == 1 { self.seed } else { rng::bits(self.seed, Stream::Scenario, u64::from(number), 0) >> 32 }
    }

    /// What the recording of a run says about its checkpoint.
    pub fn provenance_of_run(&self, number: u32) -> &Provenance {
        &self.provenances[self.drawn(number)]
    }

    /// What the checkpoint may be called while driving.
    pub fn public_name(&self) -> &str {
        &self.public_name
    }

    /// Which of the candidates drives a run: drawn from the run's seed, each with the same chance.
    fn drawn(&self, number: u32) -> usize {
        let candidates = self.provenances.len() as u32;
        rng::below(self.seed_of_run(number), Stream::Driver, DRAW, 0, candidates) as usize
    }
}

/// The eyes that may drive.
pub struct Lineup {
    eyes: Vec<Eye>,
    /// Of the pictures.
    camera: Camera,
    cast: Cast,
}

impl Lineup {
    /// Opens the candidates of a blind session, or else the one checkpoint. All of them look at pictures that are made alike and
    /// of one size, so that it gives nothing away: the one asked for, or else that of the first. All of
    /// them are computed by the same.
    pub fn open(
        study: &Study,
        checkpoint: &CheckpointChoice,
        (size, imaging): (Option<(u32, u32)>, Imaging),
        compute: Compute,
        seed: u64,
    ) -> anyhow::Result<Self> {
        check_names(&study.blind)?;
        let (first, others) = study.blind.split_first().unwrap_or((checkpoint, &[]));
        // Ground truth can be drawn at any size, and is drawn at this one where nothing asks for another.
        let has_truth = std::iter::once(first).chain(others).any(|choice| *choice == CheckpointChoice::Truth);
        let wanted = size.or(has_truth.then_some(DEFAULT_SIZE));
        let first = Eye::open_on(compute, first, wanted)?;
        let size = wanted.unwrap_or(first.size());
        let others = others.iter().map(|choice| Eye::open_on(compute, choice, Some(size)));
        let eyes = std::iter::once(Ok(first)).chain(others).map(|eye| Ok(eye?.at(imaging)));
        let eyes = eyes.collect::<anyhow::Result<Vec<_>>>()?;
        // Truth is the same however pictures are made.
        let imaging = if eyes.iter().any(Eye::needs_colours) { imaging } else { imaging.of_truth() };
        let camera = Camera::driver(size.0, size.1).at(imaging);
        let cast = Cast { seed, public_name: public_name(&eyes), provenances: provenances(&eyes, &camera) };
        Ok(Self { eyes, camera, cast })
    }

    /// Who drives which run.
    pub fn cast(&self) -> &Cast {
        &self.cast
    }

    /// Of the pictures.
    pub fn camera(&self) -> Camera {
        self.camera
    }

    /// What the eye that drives a run makes of a frame. The failure of a blind one does not tell which.
    pub fn see(&mut self, run: u32, frame: Frame) -> anyhow::Result<Mask> {
        let seen = self.of_run(run).see(frame);
        if self.eyes.len() == 1 {
            return seen;
        }
        seen.map_err(|_| anyhow!("inference failed in the checkpoint that was drawn; `aeye inspect --reveal` names it"))
    }

    /// The eye that drives a run.
    pub fn of_run(&mut self, number: u32) -> &mut Eye {
        &mut self.eyes[self.cast.drawn(number)]
    }
}

fn public_name(eyes: &[Eye]) -> String {
    match eyes {
        [eye] => eye.name().to_owned(),
        eyes => format!("blind, one of {}", eyes.len()),
    }
}

fn provenances(eyes: &[Eye], camera: &Camera) -> Vec<Provenance> {
    let names: Vec<&str> = eyes.iter().map(Eye::name).collect();
    let of = |eye: &Eye| {
        let blind = [(BLIND, format!("one of {} checkpoints", names.len())), (CANDIDATES, names.join(", "))];
        let blind = blind.into_iter().filter(|_| names.len() > 1).map(|(key, value)| (key.to_owned(), value));
        vision::provenance(eye, camera).into_iter().chain(blind).collect()
    };
    eyes.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cast(seed: u64, candidates: usize) -> Cast {
        Cast { seed, public_name: String::new(), provenances: vec![Provenance::default(); candidates] }
    }

    #[test]
    fn every_candidate_drives_about_as_often() {
        for candidates in [1, 2, 3] {
            let cast = cast(7, candidates);
            let mut counts = vec![0usize; candidates];
            (1..=3000).for_each(|run| counts[cast.drawn(run)] += 1);
            let even = 3000 / candidates;
            assert!(counts.iter().all(|n| n.abs_diff(even) < 120), "{counts:?}");
        }
        // The first runs of different sessions are drawn, too.
        let firsts: usize = (0..1000).map(|seed| cast(seed, 2).drawn(1)).sum();
        assert!(firsts.abs_diff(500) < 70, "{firsts}");
    }

    #[test]
    fn candidates_differ_in_nothing_that_is_shown() {
        let study =
            Study { blind: vec![CheckpointChoice::Truth, CheckpointChoice::Bundled("early")], ..Default::default() };
        let lineup = Lineup::open(
            &study,
            &CheckpointChoice::Truth,
            (Some((64, 32)), render::Quality::Standard.into()),
            Compute::Cpu,
            3,
        )
        .expect("bundled");
        let cast = lineup.cast();
        assert_eq!((cast.public_name(), lineup.camera().width), ("blind, one of 2", 64));
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

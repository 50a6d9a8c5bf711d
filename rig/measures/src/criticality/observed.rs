//! By how much time road users really missed each other.

use std::collections::BTreeMap;

use base::words;
use kernel::scene::SceneSnapshot;
use kernel::time::{TICK_HZ, Tick};

use super::encounter::Mover;
use super::extreme::Extreme;

/// Where everyone was, tick by tick.
#[derive(Debug, Default)]
pub struct Tracks {
    ego: Vec<(Tick, Mover)>,
    others: BTreeMap<String, Vec<(Tick, Mover)>>,
}

impl Tracks {
    /// Adds a tick; ticks come in order.
    pub fn add(&mut self, scene: &SceneSnapshot) {
        self.ego.push((scene.tick, Mover::of_ego(&scene.ego)));
        for actor in &scene.actors {
            self.others.entry(words::actor(actor)).or_default().push((scene.tick, Mover::of_actor(actor)));
        }
    }

    /// Post-encroachment time: the least time from when the ego car or another left a place to when the
    /// other of the two came there, where their ways crossed. Told for the tick of the second one.
    pub fn post_encroachment(&self) -> Option<Extreme> {
        let closest = |(name, track): (&String, &Vec<(Tick, Mover)>)| {
            let (ticks, tick) = self.closest(track)?;
            Some(Extreme { value: ticks as f64 / f64::from(TICK_HZ), tick, with: name.clone() })
        };
        self.others.iter().filter_map(closest).min_by(|a, b| a.value.total_cmp(&b.value))
    }

    /// Ticks from the one to the other, and the tick of the second.
    fn closest(&self, track: &[(Tick, Mover)]) -> Option<(Tick, Tick)> {
        let pairs = self.ego.iter().flat_map(|ego| track.iter().map(move |other| (ego, other)));
        let share =
            pairs.filter(|((_, ego), (_, other))| ego.crosses(other) && ego.footprint.overlaps(&other.footprint));
        share.map(|((a, _), (b, _))| (a.abs_diff(*b), *a.max(b))).min()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use drivers::footprint::Footprint;

    /// Someone at a place who drives along an axis, 4 m long and 2 m wide.
    fn at(x: f32, y: f32, forward: Vec2, speed_mps: f32) -> Mover {
        let half = Vec2::new(2.0, 1.0);
        Mover { footprint: Footprint { centre: Vec2::new(x, y), forward, half }, speed_mps }
    }

    /// The ego car drives east at 12 m/s; another drives north at 6 m/s and is where both ways cross at a tick.
    fn tracks(crossing: Tick) -> Tracks {
        let seconds = |tick: Tick| tick as f32 / TICK_HZ as f32;
        let ego = |tick| (tick, at(12.0 * seconds(tick), 0.0, Vec2::X, 12.0));
        let other = |tick| (tick, at(30.0, 6.0 * (seconds(tick) - seconds(crossing)), Vec2::Y, 6.0));
        let ticks = 0..600;
        let others = [("car 7".to_owned(), ticks.clone().map(other).collect())].into();
        Tracks { ego: ticks.map(ego).collect(), others }
    }

    #[test]
    fn the_gap_is_from_leaving_to_coming() {
        // The ego car leaves the shared square at (30 + 1 + 2) / 12 = 2.75 s, tick 165. The other comes there
        // (2 + 1) / 6 = 0.5 s before it crosses, and leaves it 0.5 s after that.
        for (crossing, expected, tick) in [(300, 270 - 165, 270), (60, 135 - 90, 135), (150, 0, 135)] {
            let found = tracks(crossing).post_encroachment().expect("the ways cross");
            assert_eq!(found.with, "car 7");
            assert!((60.0 * found.value - f64::from(expected)).abs() < 2.1, "{found:?}, expected {expected} ticks");
            assert!(found.tick.abs_diff(tick) <= 15, "{found:?}, expected tick {tick}");
        }
    }

    #[test]
    fn who_stands_or_drives_along_has_no_time_between() {
        let mut standing = tracks(300);
        standing.others.values_mut().flatten().for_each(|(_, mover)| mover.speed_mps = 0.0);
        assert_eq!(standing.post_encroachment(), None);
        let mut behind = tracks(300);
        let follow = behind.ego.iter().map(|(tick, mover)| (tick + 30, *mover)).collect();
        behind.others.insert("car 7".into(), follow);
        assert_eq!(behind.post_encroachment(), None);
    }
}

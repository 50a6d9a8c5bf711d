//! What the control centre plots of a run: the last seconds of both drivers' controls, the way that
//! was driven, and what happened when.

use std::collections::VecDeque;

use glam::{Vec2, Vec3Swizzles};
use kernel::events::EventKind;
use kernel::time::{TICK_HZ, Tick};
use kernel::{TickInput, TickOutput, World};

/// One sample of the traces in so many ticks: 20 a second.
const SAMPLE_TICKS: Tick = 3;
/// Length of the traces, ticks.
pub const WINDOW_TICKS: Tick = 12 * TICK_HZ as Tick;
/// The driven way is kept at steps of this length, metres.
const STEP_M: f32 = 2.0;
/// How far ahead the route is drawn, metres.
const ROUTE_M: f32 = 150.0;

/// The plots of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Traces {
    /// Tick of the last sample.
    pub tick: Tick,
    /// The last [`WINDOW_TICKS`], oldest first.
    pub samples: VecDeque<Sample>,
    /// The way so far, metres.
    pub way: Vec<Vec2>,
    /// The route ahead, metres.
    pub route: Vec<Vec2>,
    /// Everything that happened.
    pub marks: Vec<(Tick, EventKind)>,
}

/// A moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// When.
    pub tick: Tick,
    /// Speed, m/s.
    pub speed_mps: f32,
    /// What both drivers did.
    pub input: TickInput,
}

impl Traces {
    /// Those of a world that waits for its start.
    pub fn of(world: &World) -> Self {
        let mut traces = Self::default();
        traces.follow(world);
        traces
    }

    /// Takes a tick in.
    pub fn tick(&mut self, world: &World, input: &TickInput, output: &TickOutput) {
        self.marks.extend(output.events.iter().map(|event| (output.tick, event.kind)));
        if !output.tick.is_multiple_of(SAMPLE_TICKS) {
            return;
        }
        self.tick = output.tick;
        self.samples.push_back(Sample { tick: output.tick, speed_mps: world.hud().speed_mps, input: *input });
        while self.samples.front().is_some_and(|sample| sample.tick + WINDOW_TICKS < output.tick) {
            self.samples.pop_front();
        }
        self.follow(world);
    }

    fn follow(&mut self, world: &World) {
        let place = world.scene().ego.position.xy();
        if self.way.last().is_none_or(|last| last.distance(place) >= STEP_M) {
            self.way.push(place);
        }
        self.route = world.route_ahead(ROUTE_M).into_iter().map(Vec3Swizzles::xy).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::maps::Map;
    use kernel::Controls;

    #[test]
    fn traces_are_bounded_and_the_way_is_the_one_that_was_driven() {
        let map = Map::find("city").expect("bundled");
        let mut world = World::new(&map.scenario(1), &map.network).expect("a world");
        let mut traces = Traces::of(&world);
        let input = TickInput { semantic: Controls::from_fractions(0.0, 0.4, 0.0), ..TickInput::default() };
        for _ in 0..WINDOW_TICKS + 300 {
            let output = world.step(&input);
            traces.tick(&world, &input, &output);
        }
        assert_eq!(traces.samples.len() as Tick, WINDOW_TICKS / SAMPLE_TICKS + 1);
        assert!(traces.samples.iter().all(|sample| sample.input == input));
        let length_m: f32 = traces.way.windows(2).map(|ends| ends[0].distance(ends[1])).sum();
        let driven_m = world.odometer_mm() as f32 / 1e3;
        assert!((length_m - driven_m).abs() < 0.05 * driven_m + STEP_M, "{length_m} of {driven_m}");
        assert!(traces.marks.iter().any(|(_, kind)| *kind == EventKind::Armed), "{:?}", traces.marks);
    }
}

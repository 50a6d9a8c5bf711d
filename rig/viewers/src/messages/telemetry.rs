//! The figures of a tick as a message of our own, made to be plotted.

use base::words;
use foxglove::Encode;
use kernel::arbiter::{Applied, Phase};
use kernel::{Controls, TickInput, TickOutput, World};

use crate::figures::TickFigures;

/// What the car does, both drivers' controls, and who is in control. Pedals are fractions, [0, 1];
/// steering is a fraction, [-1, 1], positive to the right; what is not known is NaN.
#[derive(Clone, Debug, PartialEq, Encode)]
pub struct Telemetry {
    /// Number of the tick.
    pub tick: u64,
    /// Speed of the ego car, m/s; negative in reverse.
    pub speed_mps: f64,
    /// Speed limit, m/s.
    pub limit_mps: f64,
    /// Distance driven since the run began, metres.
    pub odometer_m: f64,
    /// `arming`, `driving`, `taken over` or `done`.
    pub phase: String,
    /// Who steers: `semantic` or `safety`.
    pub steering_by: String,
    /// Who brakes and accelerates: `semantic` or `safety`.
    pub pedals_by: String,
    /// Steering that reaches the car.
    pub steer: f64,
    /// Accelerator that reaches the car.
    pub throttle: f64,
    /// Brake that reaches the car.
    pub brake: f64,
    /// The semantic driver's steering.
    pub semantic_steer: f64,
    /// The semantic driver's accelerator.
    pub semantic_throttle: f64,
    /// The semantic driver's brake.
    pub semantic_brake: f64,
    /// The safety driver's steering.
    pub safety_steer: f64,
    /// The safety driver's accelerator.
    pub safety_throttle: f64,
    /// The safety driver's brake.
    pub safety_brake: f64,
    /// Age of the mask that the semantic driver sees, milliseconds; simulated in a file. NaN without one.
    pub mask_age_ms: f64,
}

impl Telemetry {
    /// What a drive tells as it goes. The controls that reach the car are not among it.
    pub fn of(figures: &TickFigures) -> Self {
        let [semantic_steer, semantic_throttle, semantic_brake] = fractions(figures.input.map(|input| input.semantic));
        let [safety_steer, safety_throttle, safety_brake] = fractions(figures.input.map(|input| input.safety));
        let [steer, throttle, brake] = fractions(None);
        Self {
            tick: figures.tick,
            speed_mps: figures.speed_mps.into(),
            limit_mps: figures.limit_mps.into(),
            odometer_m: figures.odometer_mm as f64 / 1e3,
            phase: phase(figures.phase).into(),
            steering_by: words::seat(figures.steering).into(),
            pedals_by: words::seat(figures.pedals).into(),
            steer,
            throttle,
            brake,
            semantic_steer,
            semantic_throttle,
            semantic_brake,
            safety_steer,
            safety_throttle,
            safety_brake,
            mask_age_ms: figures.mask_age_us.map_or(f64::NAN, |us| us as f64 / 1e3),
        }
    }

    /// Of the tick that a world has just reached with an input, with a mask of this age.
    pub fn of_step(world: &World, input: &TickInput, output: &TickOutput, mask_age_ms: Option<f64>) -> Self {
        let Applied { controls, steering, pedals } = output.applied;
        let figures = TickFigures { input: Some(*input), steering, pedals, ..TickFigures::of_world(world, 1) };
        let [steer, throttle, brake] = fractions(Some(controls));
        let mask_age_ms = mask_age_ms.unwrap_or(f64::NAN);
        Self { steer, throttle, brake, mask_age_ms, ..Self::of(&figures) }
    }
}

/// Steering, accelerator and brake.
fn fractions(controls: Option<Controls>) -> [f64; 3] {
    let known = |c: Controls| [c.steer_fraction(), c.throttle_fraction(), c.brake_fraction()].map(f64::from);
    controls.map_or([f64::NAN; 3], known)
}

fn phase(phase: Phase) -> &'static str {
    match phase {
        Phase::Arming => "arming",
        Phase::Driving => "driving",
        Phase::TakenOver => "taken over",
        Phase::Done => "done",
    }
}

#[cfg(test)]
mod tests {
    use base::maps::Map;

    use super::*;

    #[test]
    fn a_step_tells_what_the_drive_tells_and_what_reaches_the_car() {
        let map = Map::find("rural").expect("bundled");
        let mut world = World::new(&map.scenario(1), &map.network).expect("a world");
        let input = TickInput { semantic: Controls::from_fractions(0.5, 0.25, 0.0), safety: Controls::default() };
        let output = world.step(&input);
        let told = Telemetry::of(&TickFigures { input: Some(input), ..TickFigures::of_world(&world, 3) });
        assert!([told.steer, told.throttle, told.brake, told.mask_age_ms].iter().all(|figure| figure.is_nan()));
        let stepped = Telemetry::of_step(&world, &input, &output, Some(100.0));
        assert_eq!((stepped.tick, stepped.mask_age_ms, stepped.phase.as_str()), (1, 100.0, "arming"));
        assert_eq!((stepped.steer, stepped.throttle), (stepped.semantic_steer, stepped.semantic_throttle));
        assert!((stepped.steer - 0.5).abs() < 1e-3 && stepped.safety_brake == 0.0);
        let (steer, throttle, brake, mask_age_ms) = (told.steer, told.throttle, told.brake, told.mask_age_ms);
        let without = |figures: Telemetry| Telemetry { steer, throttle, brake, mask_age_ms, ..figures };
        assert_eq!(format!("{told:?}"), format!("{:?}", without(stepped)));
    }
}

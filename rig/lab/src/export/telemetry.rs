//! The figures of a tick as a message of our own, made to be plotted.

use base::words;
use foxglove::Encode;
use kernel::arbiter::Phase;
use kernel::time::TICK_HZ;
use kernel::{TickInput, TickOutput, World};
use replay::Log;

/// What the car does, both drivers' controls, and who is in control. Pedals are fractions, [0, 1];
/// steering is a fraction, [-1, 1], positive to the right.
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
    /// Simulated age of the mask that the semantic driver sees, milliseconds; NaN without one.
    pub mask_age_ms: f64,
}

impl Telemetry {
    /// Of the tick that the world has just reached with an input.
    pub fn of(world: &World, input: &TickInput, output: &TickOutput, log: &Log) -> Self {
        let (hud, applied) = (world.hud(), &output.applied);
        let TickInput { semantic, safety } = input;
        Self {
            tick: output.tick,
            speed_mps: hud.speed_mps.into(),
            limit_mps: hud.limit_mps.into(),
            odometer_m: output.odometer_mm as f64 / 1e3,
            phase: phase(world.arbiter().phase).into(),
            steering_by: words::seat(applied.steering).into(),
            pedals_by: words::seat(applied.pedals).into(),
            steer: applied.controls.steer_fraction().into(),
            throttle: applied.controls.throttle_fraction().into(),
            brake: applied.controls.brake_fraction().into(),
            semantic_steer: semantic.steer_fraction().into(),
            semantic_throttle: semantic.throttle_fraction().into(),
            semantic_brake: semantic.brake_fraction().into(),
            safety_steer: safety.steer_fraction().into(),
            safety_throttle: safety.throttle_fraction().into(),
            safety_brake: safety.brake_fraction().into(),
            mask_age_ms: log
                .mask_at(output.tick)
                .map_or(f64::NAN, |mask| 1e3 * mask.age_at(output.tick) as f64 / f64::from(TICK_HZ)),
        }
    }
}

fn phase(phase: Phase) -> &'static str {
    match phase {
        Phase::Arming => "arming",
        Phase::Driving => "driving",
        Phase::TakenOver => "taken over",
        Phase::Done => "done",
    }
}

//! Who is in control, and what counts as an intervention.

use crate::controls::{Controls, Seat, TickInput};
use crate::scenario::Rules;
use crate::time::{CLIP_TICKS, Tick, seconds};
use crate::{state, state_enum};

/// Speed below which the car stands, m/s.
const STANDSTILL_MPS: f32 = 0.1;
/// Who has stood for so long has stopped.
const STOPPED_TICKS: u16 = seconds(1) as u16 / 2;

state_enum! {
    /// How a run ended.
    pub enum Outcome {
        /// The safety driver intervened.
        Intervened = 0,
        /// The ego car collided and nobody had intervened.
        Missed = 1,
        /// The time of the run was over, or the road.
        Censored = 2,
    }
}

state_enum! {
    /// Where a run stands.
    pub enum Phase {
        /// The first three seconds, so that every corner case has its full window.
        Arming = 0,
        /// The semantic driver drives.
        Driving = 1,
        /// The safety driver took over; runs on until it has stopped safely, for the time of the rules at most.
        TakenOver = 2,
        /// The run is over.
        Done = 3,
    }
}

state! {
    /// A takeover by the safety driver.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Intervention {
        /// The tick at which a threshold was passed.
        pub tick: Tick,
        /// The safety driver's controls at that tick.
        pub controls: Controls,
        /// Whether the brake passed its threshold.
        pub by_brake: bool,
        /// Whether the steering passed its threshold.
        pub by_steering: bool,
        /// Speed of the ego car, m/s.
        pub speed_mps: f32,
    }
}

state! {
    /// The arbitration's own state.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Arbiter {
        /// Where the run stands.
        pub phase: Phase,
        /// The safety driver has taken the wheel over and keeps it.
        pub safety_steers: bool,
        /// The intervention, once there was one.
        pub intervention: Option<Intervention>,
        /// Ticks for which the car has stood outside junctions since then, saturating.
        pub stands_ticks: u16,
        /// How the run ended, once it has.
        pub outcome: Option<Outcome>,
        /// Tick of the end.
        pub ended_at: Option<Tick>,
    }
}

state! {
    /// What the arbitration decided in one tick.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Applied {
        /// Controls that reach the car.
        pub controls: Controls,
        /// Who steers.
        pub steering: Seat,
        /// Who brakes or accelerates.
        pub pedals: Seat,
    }
}

/// What [`Arbiter::arbitrate`] found in one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// Controls that reach the car.
    pub applied: Applied,
    /// The run was armed in this tick.
    pub armed: bool,
    /// The intervention, if it happened in this tick.
    pub intervention: Option<Intervention>,
}

impl Arbiter {
    /// The arbitration at the start of a run.
    pub fn new() -> Self {
        Self {
            phase: Phase::Arming,
            safety_steers: false,
            intervention: None,
            stands_ticks: 0,
            outcome: None,
            ended_at: None,
        }
    }

    /// Arms the run, notes a takeover, and mixes the controls of both seats. `tick` is the tick that
    /// is being computed, `speed_mps` the speed before it.
    pub fn arbitrate(&mut self, tick: Tick, input: &TickInput, rules: &Rules, speed_mps: f32) -> Decision {
        let armed = self.phase == Phase::Arming && tick >= CLIP_TICKS;
        if armed {
            self.phase = Phase::Driving;
        }
        let wants = Wish::of(&input.safety, rules);
        let counts = self.phase == Phase::Driving && speed_mps.abs() >= rules.least_intervention_kmh / 3.6;
        let intervention = (counts && (wants.brake || wants.steer)).then_some(Intervention {
            tick,
            controls: input.safety,
            by_brake: wants.brake,
            by_steering: wants.steer,
            speed_mps,
        });
        if intervention.is_some() {
            self.phase = Phase::TakenOver;
            self.intervention = intervention;
        }
        Decision { applied: self.mix(input, wants), armed, intervention }
    }

    /// A takeover lasts; before arming, below the least speed of an intervention, and after a run that ended without one,
    /// the safety driver acts on the car for as long as a threshold is passed. Horn, lights and wipers are those of whoever has the
    /// pedals, the indicators those of whoever steers.
    fn mix(&mut self, input: &TickInput, wants: Wish) -> Applied {
        let taken = self.intervention.is_some();
        self.safety_steers = wants.steer || (taken && self.safety_steers);
        let seat = |safety| if safety { Seat::Safety } else { Seat::Semantic };
        let (steering, pedals) = (seat(self.safety_steers), seat(taken || wants.brake || wants.steer));
        let (semantic, safety) = (&input.semantic, &input.safety);
        let mut controls = match pedals {
            Seat::Semantic => *semantic,
            Seat::Safety => override_pedals(semantic, safety, taken),
        };
        controls.steer = if self.safety_steers { safety.steer } else { semantic.steer };
        let of = |seat| if seat == Seat::Safety { safety.flags } else { semantic.flags };
        controls.flags &= Controls::HAND_BRAKE | Controls::REVERSE;
        controls.flags |= of(pedals) & Controls::SIGNALS | of(steering) & Controls::INDICATORS;
        Applied { controls, steering, pedals }
    }

    /// Ends the run if this tick ended it. True when that happened now.
    pub fn judge(&mut self, tick: Tick, after: &After, rules: &Rules) -> bool {
        let stands = after.speed_mps.abs() < STANDSTILL_MPS && !after.in_junction && self.phase == Phase::TakenOver;
        self.stands_ticks = if stands { self.stands_ticks.saturating_add(1) } else { 0 };
        let outcome = match (self.phase, self.intervention) {
            (Phase::Driving, _) if after.collided => Outcome::Missed,
            (Phase::Driving, _) if after.at_end || tick >= seconds(rules.max_seconds) => Outcome::Censored,
            (Phase::TakenOver, Some(intervention))
                if self.stands_ticks >= STOPPED_TICKS || tick >= intervention.tick + seconds(rules.takeover_s) =>
            {
                Outcome::Intervened
            }
            _ => return false,
        };
        self.phase = Phase::Done;
        self.outcome = Some(outcome);
        self.ended_at = Some(tick);
        true
    }
}

/// What a tick did to the ego car.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct After {
    /// It began to touch an actor or scenery.
    pub collided: bool,
    /// It is inside a junction.
    pub in_junction: bool,
    /// Its road ends right ahead, or its story is over.
    pub at_end: bool,
    /// Its speed, m/s.
    pub speed_mps: f32,
}

impl Default for Arbiter {
    fn default() -> Self {
        Self::new()
    }
}

/// What the safety driver asks for by passing a threshold.
#[derive(Clone, Copy)]
struct Wish {
    brake: bool,
    steer: bool,
}

impl Wish {
    fn of(safety: &Controls, rules: &Rules) -> Self {
        Self {
            brake: safety.brake_fraction() > rules.brake_threshold || safety.has(Controls::HAND_BRAKE),
            steer: safety.steer_fraction().abs() > rules.steer_threshold,
        }
    }
}

/// The safety driver's pedals over the semantic driver's: the semantic throttle is cut; its brake
/// still adds, unless the safety driver accelerates, which only a takeover allows.
fn override_pedals(semantic: &Controls, safety: &Controls, taken: bool) -> Controls {
    let throttle = if taken { safety.throttle } else { 0 };
    let (brake, hand_brake) = if throttle > 0 {
        (safety.brake, safety.flags & Controls::HAND_BRAKE)
    } else {
        (safety.brake.max(semantic.brake), (safety.flags | semantic.flags) & Controls::HAND_BRAKE)
    };
    Controls { steer: 0, throttle, brake, flags: hand_brake | (safety.flags & Controls::REVERSE) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULES: Rules = Rules {
        max_speed_kmh: 50.0,
        max_seconds: 600,
        brake_threshold: 0.1,
        steer_threshold: 0.1,
        least_intervention_kmh: 0.0,
        takeover_s: 10,
    };

    fn after(collided: bool, speed_mps: f32) -> After {
        After { collided, in_junction: false, at_end: false, speed_mps }
    }

    fn controls(steer: f32, throttle: f32, brake: f32) -> Controls {
        Controls::from_fractions(steer, throttle, brake)
    }

    fn decide(arbiter: &mut Arbiter, tick: Tick, semantic: Controls, safety: Controls) -> Decision {
        arbiter.arbitrate(tick, &TickInput { semantic, safety }, &RULES, 10.0)
    }

    #[test]
    fn before_arming_the_safety_driver_acts_but_does_not_intervene() {
        let mut arbiter = Arbiter::new();
        let curve = controls(0.3, 0.8, 0.0);
        let acted = decide(&mut arbiter, 10, curve, controls(0.0, 0.0, 1.0));
        assert_eq!(acted.applied.controls, controls(0.3, 0.0, 1.0));
        assert_eq!(acted.intervention, None);
        let released = decide(&mut arbiter, 11, curve, Controls::default());
        assert_eq!(released.applied.controls, curve);
        assert_eq!(arbiter.phase, Phase::Arming);
    }

    #[test]
    fn indicators_go_with_the_wheel_and_horn_lights_and_wipers_with_the_pedals() {
        let flagged = |flags, controls: Controls| Controls { flags, ..controls };
        let semantic = flagged(Controls::ALL_FLAGS & !Controls::HAND_BRAKE, controls(0.3, 0.5, 0.0));
        let safety = |flags, steer, brake| flagged(flags, controls(steer, 0.0, brake));
        let mut arbiter = Arbiter::new();
        let mut flags = |safety| decide(&mut arbiter, 200, semantic, safety).applied.controls.flags;
        let (left, right) = (Controls::INDICATE_LEFT, Controls::INDICATE_RIGHT);
        let driven = Controls::REVERSE | Controls::INDICATORS | Controls::SIGNALS;
        assert_eq!(flags(safety(left | Controls::HORN, 0.0, 0.0)), driven, "nobody took over");
        let braked = flags(safety(left | Controls::HORN, 0.0, 1.0));
        assert_eq!(braked, Controls::INDICATORS | Controls::HORN, "the semantic driver still steers");
        assert_eq!(flags(safety(right | Controls::LIGHTS | Controls::SEEN, 0.5, 0.0)), right | Controls::LIGHTS);
    }

    #[test]
    fn braking_keeps_the_semantic_steering_until_the_safety_wheel_turns() {
        let mut arbiter = Arbiter::new();
        let curve = controls(0.3, 0.8, 0.2);
        let armed = decide(&mut arbiter, CLIP_TICKS, curve, Controls::default());
        assert!(armed.armed && armed.intervention.is_none());
        let braked = decide(&mut arbiter, 200, curve, controls(0.05, 0.7, 0.5));
        let intervention = braked.intervention.expect("braking is an intervention");
        assert!(intervention.by_brake && !intervention.by_steering);
        assert_eq!(braked.applied.controls, controls(0.3, 0.7, 0.5));
        assert_eq!((braked.applied.steering, braked.applied.pedals), (Seat::Semantic, Seat::Safety));
        let steered = decide(&mut arbiter, 201, curve, controls(-0.2, 0.0, 0.0));
        assert_eq!(steered.applied.controls, controls(-0.2, 0.0, 0.2));
        let centred = decide(&mut arbiter, 202, curve, Controls::default());
        assert_eq!(centred.applied.steering, Seat::Safety);
        assert_eq!(centred.intervention, None, "there is one intervention a run");
    }

    /// The arbitration right after a takeover at tick 300.
    fn taken_over() -> Arbiter {
        let mut arbiter = Arbiter::new();
        decide(&mut arbiter, 300, Controls::default(), controls(0.5, 0.0, 0.0));
        arbiter
    }

    /// The tick at which a takeover ends when the car moves so.
    fn end_of(after: impl Fn(Tick) -> After, rules: &Rules) -> Option<Tick> {
        let mut arbiter = taken_over();
        (300..2000).find(|tick| arbiter.judge(*tick, &after(*tick), rules))
    }

    #[test]
    fn a_takeover_ends_when_the_car_has_stopped_or_its_time_is_over() {
        let mut arbiter = taken_over();
        assert!(!arbiter.judge(300, &after(true, 9.0), &RULES), "a collision after the takeover is no miss");
        assert!(!arbiter.judge(899, &after(false, 9.0), &RULES));
        assert!(arbiter.judge(900, &after(false, 9.0), &RULES));
        assert_eq!((arbiter.outcome, arbiter.ended_at), (Some(Outcome::Intervened), Some(900)));
        assert!(!arbiter.judge(901, &after(false, 9.0), &RULES), "a run ends once");
        assert_eq!(end_of(|_| after(false, 9.0), &Rules { takeover_s: 3, ..RULES }), Some(480));
        assert_eq!(end_of(|tick| after(false, if tick < 400 { 5.0 } else { -0.05 }), &RULES), Some(429));
    }

    #[test]
    fn rocking_at_standstill_is_no_stop() {
        let rocks = |tick: Tick| after(false, if tick.is_multiple_of(20) { 0.3 } else { 0.0 });
        assert_eq!(end_of(rocks, &RULES), Some(900));
    }

    #[test]
    fn who_stands_in_a_junction_has_not_stopped_safely() {
        let leaves = |tick: Tick| After { in_junction: tick < 600, ..after(false, 0.0) };
        assert_eq!(end_of(leaves, &RULES), Some(629));
        assert_eq!(end_of(|_| After { in_junction: true, ..after(false, 0.0) }, &RULES), Some(900), "the limit holds");
    }

    #[test]
    fn standing_before_the_takeover_does_not_count() {
        let mut arbiter = Arbiter::new();
        for tick in 200..300 {
            decide(&mut arbiter, tick, Controls::default(), Controls::default());
            assert!(!arbiter.judge(tick, &after(false, 0.0), &RULES));
        }
        decide(&mut arbiter, 300, Controls::default(), controls(0.0, 0.0, 1.0));
        assert_eq!((300..400).find(|tick| arbiter.judge(*tick, &after(false, 0.0), &RULES)), Some(329));
    }

    #[test]
    fn below_the_least_speed_the_safety_driver_acts_but_does_not_intervene() {
        let rules = Rules { least_intervention_kmh: 18.0, ..RULES };
        let input = TickInput { semantic: controls(0.3, 0.8, 0.0), safety: controls(-0.5, 0.0, 1.0) };
        let mut arbiter = Arbiter::new();
        for (tick, speed_mps) in [(200, 4.9), (201, -4.9)] {
            let slow = arbiter.arbitrate(tick, &input, &rules, speed_mps);
            assert_eq!((slow.intervention, slow.applied.controls), (None, controls(-0.5, 0.0, 1.0)));
        }
        let released = arbiter.arbitrate(202, &TickInput { safety: Controls::default(), ..input }, &rules, 4.0);
        assert_eq!((released.applied.controls, arbiter.phase), (input.semantic, Phase::Driving), "it was no takeover");
        assert!(arbiter.arbitrate(203, &input, &rules, 5.0).intervention.is_some());
    }

    #[test]
    fn the_end_of_the_road_censors_unless_somebody_has_taken_over() {
        let mut arbiter = Arbiter::new();
        let ends = After { at_end: true, ..after(false, 9.0) };
        assert!(!arbiter.judge(100, &ends, &RULES), "nothing before arming is judged");
        let mut taken = arbiter.clone();
        decide(&mut arbiter, 200, Controls::default(), Controls::default());
        assert!(arbiter.judge(200, &ends, &RULES));
        assert_eq!((arbiter.outcome, arbiter.ended_at), (Some(Outcome::Censored), Some(200)));
        decide(&mut taken, 200, Controls::default(), Controls::from_fractions(0.0, 0.0, 1.0));
        assert!(taken.intervention.is_some() && !taken.judge(200, &ends, &RULES));
    }

    #[test]
    fn a_collision_is_missed_and_the_last_tick_censors() {
        let mut arbiter = Arbiter::new();
        assert!(!arbiter.judge(100, &after(true, 9.0), &RULES), "nothing before arming is judged");
        decide(&mut arbiter, 200, Controls::default(), Controls::default());
        let mut crashed = arbiter.clone();
        assert!(crashed.judge(200, &after(true, 9.0), &RULES));
        assert_eq!(crashed.outcome, Some(Outcome::Missed));
        assert!(arbiter.judge(36_000, &after(false, 9.0), &RULES));
        assert_eq!(arbiter.outcome, Some(Outcome::Censored));
    }
}

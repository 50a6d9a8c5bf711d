//! Measures of logs that are made by hand, so that every time is known beforehand.

use kernel::arbiter::Intervention;
use kernel::{Controls, Keyframe, Scenario, StateHash, TickInput};
use proptest::prelude::*;
use replay::{FORMAT_VERSION, LiveTimes, Manifest, MaskShown, Provenance};

use super::*;

const TICKS: Tick = 600;

/// A log of 10 s in which both drivers hold still.
fn log() -> Log {
    let manifest = Manifest {
        format: FORMAT_VERSION,
        kernel: kernel::identity(),
        engines: kernel::ENGINES.to_owned(),
        scenario: Scenario::default_for("city", 1),
        map_digest: 0,
        foreign_map: None,
        provenance: Provenance::default(),
        case: None,
    };
    let cruising = TickInput { semantic: Controls::from_fractions(0.0, 0.5, 0.0), safety: Controls::default() };
    Log {
        manifest,
        keyframes: vec![Keyframe { tick: 0, bytes: Vec::new() }],
        inputs: vec![cruising; TICKS as usize],
        hashes: vec![StateHash::default().0 as u32; TICKS as usize],
        marks: Vec::new(),
        events: Vec::new(),
        intervention: None,
        masks: Vec::new(),
        notes: Vec::new(),
        annotation: None,
        summary: None,
        scenes: Vec::new(),
    }
}

fn episode(onset: Tick, end: Tick) -> Episode {
    Episode { onset, end, label: "walker", what: "pedestrian 3".into(), mistake: None }
}

fn truth(episodes: Vec<Episode>) -> Truth {
    let following = vec![Following::default(); TICKS as usize];
    Truth { episodes, km: 0.1, moving: vec![true; TICKS as usize], following }
}

/// Changes one seat's controls from a tick on.
fn from(log: &mut Log, tick: Tick, seat: Seat, change: impl Fn(&mut Controls)) {
    for input in &mut log.inputs[tick as usize - 1..] {
        change(match seat {
            Seat::Semantic => &mut input.semantic,
            Seat::Safety => &mut input.safety,
        });
    }
}

fn brake(controls: &mut Controls) {
    controls.brake = u16::MAX;
}

fn intervene(log: &mut Log, tick: Tick) {
    from(log, tick, Seat::Safety, brake);
    let controls = Controls::from_fractions(0.0, 0.0, 1.0);
    log.intervention = Some(Intervention { tick, controls, by_brake: true, by_steering: false, speed_mps: 9.0 });
}

#[test]
fn times_run_from_the_onset() {
    let mut log = log();
    from(&mut log, 212, Seat::Semantic, |controls| controls.flags |= Controls::SEEN);
    from(&mut log, 215, Seat::Semantic, |controls| controls.flags = 0);
    from(&mut log, 224, Seat::Semantic, |controls| controls.throttle = 0);
    intervene(&mut log, 260);
    let measures = Measures::with_truth(&log, truth(vec![episode(200, 260)]));
    let [hazard] = &measures.hazards[..] else { panic!("{measures:?}") };
    assert_eq!(
        hazard.semantic,
        Response { reaction_ms: Some(400), by: Some("accelerator"), seen_ms: Some(200) },
        "24 and 12 ticks"
    );
    assert_eq!(hazard.safety, Response { reaction_ms: Some(1000), by: Some("brake"), seen_ms: None });
    assert_eq!(hazard.intervention_ms, Some(1000));
    assert_eq!(measures.decisive(), Some(hazard));
    assert_eq!(measures.seen, [Press { tick: 212, seat: "semantic" }]);
    assert_eq!(measures.mask_age, None);
}

#[test]
fn what_a_driver_does_after_the_takeover_is_no_answer() {
    let mut log = log();
    intervene(&mut log, 260);
    from(&mut log, 262, Seat::Semantic, |controls| {
        (controls.throttle, controls.flags) = (0, Controls::SEEN);
    });
    let measures = Measures::with_truth(&log, truth(vec![episode(200, 260)]));
    assert_eq!(measures.hazards[0].semantic, Response::default());
    assert_eq!((measures.hazards[0].intervention_ms, measures.seen.len()), (Some(1000), 0));
}

#[test]
fn what_happens_before_or_long_after_a_hazard_is_no_answer_to_it() {
    let mut log = log();
    from(&mut log, 190, Seat::Semantic, brake);
    intervene(&mut log, 430);
    let measures = Measures::with_truth(&log, truth(vec![episode(200, 240)]));
    let HazardTimes { semantic, safety, .. } = &measures.hazards[0];
    assert_eq!([semantic, safety], [&Response::default(); 2]);
    assert_eq!((measures.hazards[0].intervention_ms, measures.decisive()), (None, None));
    let lasting = Measures::with_truth(&log, truth(vec![episode(200, 440)]));
    assert_eq!(lasting.hazards[0].intervention_ms, Some(3833), "a hazard that lasts can be answered late");
}

/// What the semantic driver is found to do about a hazard from tick 200 to 440, steering and pedals as scripted, on a
/// route that asks for such angles.
fn answer(script: impl Fn(Tick) -> Controls, route: impl Fn(Tick) -> Following) -> Option<&'static str> {
    let mut log = log();
    for (tick, input) in (1..).zip(&mut log.inputs) {
        input.semantic = script(tick);
    }
    let truth = Truth { following: (1..=TICKS).map(route).collect(), ..truth(vec![episode(200, 440)]) };
    Measures::with_truth(&log, truth).hazards[0].semantic.by
}

/// Steering wheel in degrees, with the accelerator half pressed.
fn wheel(deg: f32) -> Controls {
    Controls::from_fractions(deg / 450.0, 0.5, 0.0)
}

#[test]
fn who_follows_a_curve_does_not_react_and_who_leaves_it_does() {
    // From tick 220 on the route bends to the right within half a second.
    let bend = |tick: Tick| 90.0 * (tick.saturating_sub(220) as f32 / 30.0).min(1.0);
    let route = |tick: Tick| Following { least_deg: 0.0, most_deg: bend(tick) };
    assert_eq!(answer(|tick| wheel(bend(tick)), route), None);
    assert_eq!(answer(|tick| wheel(bend(tick.saturating_sub(20))), route), None, "late");
    assert_eq!(answer(|tick| wheel(bend(tick)), |_| Following::default()), Some("steering"), "no curve is there");
    let swerve = |tick: Tick| if tick < 260 { 0.0 } else { 40.0 };
    assert_eq!(answer(|tick| wheel(bend(tick) + swerve(tick)), route), Some("steering"));
    assert_eq!(answer(|tick| wheel(-swerve(tick)), |_| Following::default()), Some("steering"));
}

#[test]
fn twitches_as_before_are_no_reaction_and_braking_is_one() {
    let twitch = |tick: Tick| 12.0 * (1.7 * tick as f32).sin();
    let pedals = |tick: Tick| 0.5 + 0.08 * (0.9 * tick as f32).cos();
    let nervous = |tick| Controls::from_fractions(twitch(tick) / 450.0, pedals(tick), 0.0);
    assert_eq!(answer(nervous, |_| Following::default()), None);
    let braking = |tick: Tick| if tick < 250 { nervous(tick) } else { Controls::from_fractions(0.0, 0.5, 0.3) };
    assert_eq!(answer(braking, |_| Following::default()), Some("brake"));
    // Who begins within 0.1 s had begun before he could know.
    let sooner = |tick: Tick| if tick < 204 { wheel(0.0) } else { Controls::from_fractions(0.0, 0.5, 0.3) };
    assert_eq!(answer(sooner, |_| Following::default()), None);
}

#[test]
fn an_answer_belongs_to_the_last_hazard_before_it() {
    let mut log = log();
    intervene(&mut log, 300);
    let measures = Measures::with_truth(&log, truth(vec![episode(200, 240), episode(270, 310)]));
    let times: Vec<_> = measures.hazards.iter().map(|h| (h.safety.reaction_ms, h.intervention_ms)).collect();
    assert_eq!(times, [(None, None), (Some(500), Some(500))]);
}

#[test]
fn a_wheel_that_swings_is_counted_until_the_intervention() {
    let mut log = log();
    let swing = |tick: usize| (10.0 / 450.0) * (std::f32::consts::TAU * tick as f32 / 120.0).sin();
    for (tick, input) in log.inputs.iter_mut().enumerate() {
        input.semantic = Controls::from_fractions(swing(tick), 0.5, 0.0);
    }
    let rate = |log: &Log| Measures::with_truth(log, truth(Vec::new())).steering_reversals_per_min;
    // 0.5 Hz: 60 reversals a minute; at the ends of 10 s up to two are open.
    let Seats { semantic, safety } = rate(&log);
    assert!((48.0..=60.0).contains(&semantic) && safety == 0.0, "{semantic} {safety}");
    for input in &mut log.inputs[300..] {
        input.semantic = Controls::default();
    }
    intervene(&mut log, 301);
    assert!((36.0..=60.0).contains(&rate(&log).semantic), "what follows the takeover does not count");
}

/// A mask every `every` ticks that is on the screen `late` ticks later; a tick takes `tick_us`.
fn masks(every: Tick, late: Tick, tick_us: u64) -> Vec<MaskShown> {
    let mask = |frame: Tick| {
        let capture_us = 5_000_000 + frame * tick_us;
        let times = LiveTimes { capture_us, inference_us: capture_us + 9_000, present_us: capture_us + 12_500 };
        MaskShown { tick_shown: frame + late, tick_of_frame: frame, camera: 0, digest: frame, times: Some(times) }
    };
    (1..TICKS - late).step_by(every as usize).map(mask).collect()
}

proptest! {
    /// The age of each tick's mask, looked up one by one; slow machines stretch the milliseconds.
    #[test]
    fn ages_are_those_of_the_newest_mask_in_view(
        every in 1u64..20, late in 1u64..20, tick_us in 10_000u64..50_000, standing in 0usize..300,
    ) {
        let mut log = log();
        log.masks = masks(every, late, tick_us);
        let mut truth = truth(Vec::new());
        truth.moving[..standing].fill(false);
        let age = Measures::with_truth(&log, truth).mask_age.expect("masks");
        let newest = |tick: Tick| log.masks.iter().rev().find(|m| m.tick_shown <= tick);
        let mut ages: Vec<Tick> =
            (standing as Tick + 1..=TICKS).filter_map(|tick| Some(tick - newest(tick)?.tick_of_frame)).collect();
        ages.sort_unstable();
        let median = (ages[(ages.len() - 1) / 2] + ages[ages.len() / 2]) as f64 / 2.0;
        prop_assert_eq!((age.ticks.n, age.ticks.median, age.ticks.max), (ages.len(), median, ages[ages.len() - 1] as f64));
        let ms = age.ms.expect("a live drive");
        // Beyond the last capture ticks are taken to keep real time.
        let slack_ms = 1e-3 * (late + every) as f64 * (tick_us as f64 - 1e6 / 60.0).abs() + 1e-6;
        prop_assert!((ms.median - median * tick_us as f64 / 1e3).abs() <= slack_ms, "{ms:?}");
        let screen = age.frame_to_screen_ms.expect("a live drive");
        prop_assert_eq!((screen.n, screen.median, screen.max), (log.masks.len(), 12.5, 12.5));
    }
}

#[test]
fn the_picture_of_the_first_tick_waits_for_the_start_and_has_no_latency() {
    let mut log = log();
    let times = LiveTimes { capture_us: 10, inference_us: 20, present_us: 30 };
    log.masks = vec![MaskShown { tick_shown: 1, tick_of_frame: 0, camera: 0, digest: 7, times: Some(times) }];
    log.masks.extend(masks(6, 6, 16_667));
    let age = Measures::with_truth(&log, truth(Vec::new())).mask_age.expect("masks");
    let ms = age.ms.expect("a live drive");
    assert!(ms.max < 250.0, "{ms:?}");
    assert_eq!(age.frame_to_screen_ms.expect("a live drive").n, log.masks.len() - 1);
}

#[test]
fn the_tally_tells_hazards_by_mistakes_from_others_over_the_kilometres() {
    let mistake = Mistake {
        tick: 190,
        kind: "HazardBraking".into(),
        actor: 7,
        words: "vehicle 7 brakes hard for no reason".into(),
    };
    let by_mistake = Episode { label: "vehicle", what: "car 7".into(), mistake: Some(mistake), ..episode(200, 260) };
    let measures = Measures::with_truth(&log(), truth(vec![episode(100, 120), by_mistake, episode(300, 320)]));
    let said = lines(&measures)[1].1.clone();
    assert_eq!(said, "tick 200 (3.33 s), car 7; vehicle 7 brakes hard for no reason: no reaction");

    let hazards: Vec<_> = measures.hazards.iter().collect();
    let mut tally = Tally { km: 0.1, ..Tally::default() };
    tally.add_hazards(&hazards);
    assert_eq!((tally.hazards, tally.hazards_by_mistakes), (3, 1));
    assert_eq!((tally.hazards_per_km, tally.hazards_by_mistakes_per_km), (Some(30.0), Some(10.0)));
    let said = "3, 1 of them by mistakes of others, in 0.10 km: 30.00 a km, 10.00 by mistakes of others";
    assert!(tally.lines().contains(&("hazards", said.into())), "{:?}", tally.lines());
    tally.km = 0.0;
    tally.add_hazards(&[]);
    assert_eq!((tally.hazards_per_km, tally.hazards_by_mistakes_per_km), (None, None));
}

#[test]
fn the_words_name_hazard_reaction_and_takeover() {
    let mut log = log();
    intervene(&mut log, 260);
    let measures = Measures::with_truth(&log, truth(vec![episode(200, 260)]));
    let lines = lines(&measures);
    let hazard = "tick 200 (3.33 s), pedestrian 3: safety driver's brake after 1000 ms, takeover after 1000 ms";
    assert_eq!(lines[0], ("hazard", hazard.into()));
    assert_eq!(lines[1], ("reversals", "semantic driver 0.0, safety driver 0.0 a minute, over 4.3 s".into()));
}

//! All voices together, as two channels.

use crate::dsp::Glide;
use crate::heard::Heard;
use crate::voices::{Cabin, Impacts, Motor, Others, Outside, Road, Signals};

/// Samples a second where a device asks for no other rate: 800 a tick.
pub const SAMPLE_HZ: u32 = 48_000;

/// A change of volume takes so long, seconds.
const VOLUME_S: f32 = 0.02;

/// Turns what is heard into samples: the same ones whenever it hears the same.
#[derive(Clone, Debug)]
pub struct Mixer {
    sample_hz: f32,
    volume: Glide,
    motor: Motor,
    road: Road,
    outside: Outside,
    cabin: Cabin,
    impacts: Impacts,
    others: Others,
    signals: Signals,
}

impl Mixer {
    /// Silence, at a rate of samples.
    pub fn new(sample_hz: u32) -> Self {
        Self {
            sample_hz: sample_hz as f32,
            volume: Glide::at(1.0),
            motor: Motor::default(),
            road: Road::default(),
            outside: Outside::default(),
            cabin: Cabin::default(),
            impacts: Impacts::default(),
            others: Others::default(),
            signals: Signals::default(),
        }
    }

    /// How loud all of it is, [0, 1].
    pub fn set_volume(&mut self, volume: f32) {
        self.volume.set(volume);
    }

    /// Takes in what is heard from now on; cues are heard once.
    pub fn hear(&mut self, heard: &Heard) {
        self.motor.hear(heard);
        self.road.hear(heard);
        self.outside.hear(heard);
        self.cabin.hear(heard);
        self.others.hear(&heard.around);
        self.impacts.hear(&heard.cues);
        self.signals.hear(&heard.cues);
    }

    /// The next sample on the left and on the right, [-1, 1].
    pub fn sample(&mut self) -> [f32; 2] {
        let hz = self.sample_hz;
        let middle = self.motor.next(hz) + self.road.next(hz) + self.outside.next(hz);
        let middle = middle + self.cabin.next(hz) + self.impacts.next(hz) + self.signals.next(hz);
        // What is too loud is rounded off.
        let volume = self.volume.next(VOLUME_S, hz);
        self.others.next(hz).map(|side| volume * (middle + side).tanh())
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use proptest::prelude::*;

    use super::*;
    use crate::heard::{Around, Cue, Size};

    const HZ: f32 = SAMPLE_HZ as f32;

    /// Left and right of so many seconds after the mixer has settled on what is heard.
    fn settled(heard: &Heard, seconds: f32) -> [Vec<f32>; 2] {
        let mut mixer = Mixer::new(SAMPLE_HZ);
        mixer.hear(heard);
        samples(&mut mixer, 1.0);
        samples(&mut mixer, seconds)
    }

    fn samples(mixer: &mut Mixer, seconds: f32) -> [Vec<f32>; 2] {
        let frames: Vec<[f32; 2]> = (0..(seconds * HZ) as usize).map(|_| mixer.sample()).collect();
        [0, 1].map(|side| frames.iter().map(|frame| frame[side]).collect())
    }

    fn power(samples: &[f32]) -> f32 {
        samples.iter().map(|sample| sample * sample).sum::<f32>() / samples.len() as f32
    }

    /// Power of a tone in samples (Goertzel 1958).
    fn tone(samples: &[f32], hz: f32) -> f32 {
        let turn = 2.0 * (TAU * hz / HZ).cos();
        let (a, b) = samples.iter().fold((0.0, 0.0), |(a, b), sample| (sample + turn * a - b, a));
        (a * a + b * b - turn * a * b) / (samples.len() as f32).powi(2)
    }

    /// The loudest of tones in steps of a hertz.
    fn loudest_hz(samples: &[f32], range: std::ops::Range<u16>) -> f32 {
        let tones = range.map(|hz| (f32::from(hz), tone(samples, f32::from(hz))));
        tones.max_by(|a, b| a.1.total_cmp(&b.1)).expect("a range of tones").0
    }

    fn other(size: Size, forward_m: f32, left_m: f32) -> Around {
        Around { id: 7, size, forward_m, left_m, speed_mps: 12.0, closing_mps: 0.0 }
    }

    fn with(around: Around) -> Heard {
        Heard { around: vec![around], ..Heard::default() }
    }

    #[test]
    fn a_car_that_stands_in_good_weather_is_silent() {
        assert_eq!(settled(&Heard::default(), 0.5), [vec![0.0; 24_000], vec![0.0; 24_000]]);
    }

    /// 9 turns of the motor for one of a wheel of 0.31 m, four pairs of poles.
    #[test]
    fn the_pitch_follows_the_motor() {
        for mps in [8.0, 12.0, 16.0, 24.0] {
            let [left, _] = settled(&Heard { speed_mps: mps, load: 1.0, ..Heard::default() }, 1.0);
            let (expected, found) = (mps * 9.0 / (TAU * 0.31) * 4.0, loudest_hz(&left, 100..600));
            assert!((found - expected).abs() < 2.0, "at {mps} m/s {found} Hz, expected {expected} Hz");
        }
    }

    #[test]
    fn load_speed_rain_and_squeal_are_louder() {
        let loud = |heard: Heard| power(&settled(&heard, 1.0)[0]);
        let at = |speed_mps: f32| Heard { speed_mps, ..Heard::default() };
        assert!(loud(Heard { load: 1.0, ..at(10.0) }) > 1.5 * loud(at(10.0)));
        // Slow cars hum, so that they are not louder the faster they are.
        assert!(loud(at(30.0)) > 1.5 * loud(at(20.0)) && loud(at(20.0)) > 1.5 * loud(at(12.0)));
        assert!(loud(at(3.0)) > 1e-4);
        assert!(loud(Heard { rain: 1.0, ..at(0.0) }) > 1e-5 && loud(Heard { wind: 1.0, ..at(0.0) }) > 1e-7);
        assert!(loud(Heard { grip_mps2: 8.0, ..at(10.0) }) > 1.5 * loud(Heard { grip_mps2: 5.0, ..at(10.0) }));
        assert!(loud(Heard { wet: 1.0, ..at(15.0) }) > 1.2 * loud(at(15.0)));
    }

    #[test]
    fn others_are_louder_near_and_on_their_side() {
        let of = |around: Around| settled(&with(around), 1.0).map(|side| power(&side));
        let [left, right] = of(other(Size::Light, 1.0, 8.0));
        assert!(left > 10.0 * right, "{left} {right}");
        let [left, right] = of(other(Size::Light, 10.0, 0.0));
        assert!((0.8..1.25).contains(&(left / right)), "{left} {right}");
        let far = of(other(Size::Light, 40.0, 0.0));
        assert!(left > 8.0 * far[0] && of(other(Size::Heavy, 10.0, 0.0))[0] > 1.5 * left);
        assert!(of(other(Size::Bicycle, 10.0, 0.0))[0] < 0.3 * left);
        assert!(of(other(Size::Light, -10.0, 0.0))[0] < left, "duller behind");
    }

    /// A motor of a car at 12 m/s turns at 127 Hz.
    #[test]
    fn who_comes_nearer_sounds_higher() {
        let hz = |closing_mps: f32| {
            let [left, _] = settled(&with(Around { closing_mps, ..other(Size::Light, 3.0, 0.0) }), 2.0);
            loudest_hz(&left, 100..160)
        };
        let [comes, stays, goes] = [25.0, 0.0, -25.0].map(hz);
        assert!((stays - 127.0).abs() < 1.5, "{stays}");
        assert!((comes / stays - 343.0 / 318.0).abs() < 0.02 && (goes / stays - 343.0 / 368.0).abs() < 0.02);
    }

    #[test]
    fn who_is_gone_fades() {
        let mut mixer = Mixer::new(SAMPLE_HZ);
        mixer.hear(&with(other(Size::Heavy, 4.0, 1.0)));
        assert!(power(&samples(&mut mixer, 1.0)[0]) > 1e-4);
        mixer.hear(&Heard::default());
        samples(&mut mixer, 1.0);
        assert_eq!(power(&samples(&mut mixer, 0.5)[0]), 0.0);
    }

    /// Bicycles that stand are silent from the first moment on.
    #[test]
    fn nobody_stays_who_is_silent() {
        let mut mixer = Mixer::new(SAMPLE_HZ);
        for id in 0..50 {
            mixer.hear(&with(Around { id, speed_mps: 0.0, ..other(Size::Bicycle, 5.0, 1.0) }));
            mixer.sample();
        }
        assert_eq!(mixer.others.count(), 0);
    }

    /// Numbers that shrink for ever would be slow to compute with.
    #[test]
    fn what_has_sounded_ends_in_silence() {
        let mut mixer = Mixer::new(SAMPLE_HZ);
        let loud = Heard { speed_mps: 20.0, rain: 1.0, wipes: true, cues: vec![Cue::Impact(9.0)], ..Heard::default() };
        mixer.hear(&loud);
        samples(&mut mixer, 0.5);
        mixer.hear(&Heard::default());
        samples(&mut mixer, 20.0);
        assert_eq!(samples(&mut mixer, 0.5)[0].iter().filter(|sample| **sample != 0.0).count(), 0);
    }

    /// Somebody drives by, and the volume is turned down.
    #[test]
    fn who_passes_does_not_click_and_neither_does_a_mute() {
        let steepest = |forward_m: fn(i16) -> f32, mute_at: Option<i16>| {
            let mut mixer = Mixer::new(SAMPLE_HZ);
            let (mut last, mut steepest) = (0.0, 0.0_f32);
            for tick in 0..180 {
                mixer.hear(&with(other(Size::Heavy, forward_m(tick), 2.5)));
                mixer.set_volume(if mute_at.is_some_and(|at| tick >= at) { 0.0 } else { 1.0 });
                for _ in 0..800 {
                    let [left, _] = mixer.sample();
                    steepest = if tick > 30 { steepest.max((left - last).abs()) } else { steepest };
                    last = left;
                }
            }
            steepest
        };
        let stays = steepest(|_| 0.1, None);
        let passes = steepest(|tick| if tick % 2 == 0 { 0.1 } else { -0.1 }, None);
        assert!(passes < 1.2 * stays && steepest(|_| 0.1, Some(90)) < 1.2 * stays, "{passes} {stays}");
    }

    #[test]
    fn each_cue_is_heard_and_then_no_more() {
        for cue in [Cue::Impact(8.0), Cue::Kerb, Cue::Warning, Cue::Takeover, Cue::Ended] {
            let mut mixer = Mixer::new(SAMPLE_HZ);
            mixer.hear(&Heard { cues: vec![cue], ..Heard::default() });
            let first = power(&samples(&mut mixer, 0.3)[0]);
            samples(&mut mixer, 2.0);
            let later = power(&samples(&mut mixer, 0.3)[0]);
            assert!(first > 1e-3 && later < 1e-6, "{cue:?}: {first} {later}");
        }
    }

    #[test]
    fn a_takeover_is_not_drowned_by_a_warning_of_the_same_moment() {
        let of = |cues: Vec<Cue>| {
            let mut mixer = Mixer::new(SAMPLE_HZ);
            mixer.hear(&Heard { cues, ..Heard::default() });
            samples(&mut mixer, 0.5)
        };
        assert_eq!(of(vec![Cue::Takeover]), of(vec![Cue::Warning, Cue::Takeover]));
        assert_eq!(of(vec![Cue::Takeover]), of(vec![Cue::Takeover, Cue::Warning]));
    }

    #[test]
    fn the_relay_clicks_three_times_a_second() {
        let mut mixer = Mixer::new(SAMPLE_HZ);
        mixer.hear(&Heard { indicates: true, ..Heard::default() });
        let [left, _] = samples(&mut mixer, 2.0);
        // Loud hundredths of a second after quiet ones.
        let loud: Vec<bool> = left.chunks(480).map(|chunk| power(chunk) > 1e-5).collect();
        let clicks = loud.windows(2).filter(|pair| !pair[0] && pair[1]).count() + usize::from(loud[0]);
        assert_eq!(clicks, 6);
    }

    #[test]
    fn nothing_jumps_when_the_car_does_something_else() {
        let mut mixer = Mixer::new(SAMPLE_HZ);
        let mut last = 0.0;
        let mut steepest = 0.0_f32;
        for tick in 0..240 {
            let is_odd = tick / 40 % 2 == 1;
            let (speed_mps, horn) = if is_odd { (20.0, true) } else { (0.0, false) };
            mixer.hear(&Heard { speed_mps, horn, load: 1.0, ..Heard::default() });
            for _ in 0..800 {
                let [left, _] = mixer.sample();
                steepest = steepest.max((left - last).abs());
                last = left;
            }
        }
        assert!(steepest < 0.4, "{steepest}");
    }

    fn any_heard() -> impl Strategy<Value = Heard> {
        let unit = 0.0f32..=1.0;
        let around = (any::<u32>(), -60f32..60.0, -60f32..60.0, 0f32..60.0, -90f32..90.0).prop_map(
            |(id, forward_m, left_m, speed_mps, closing_mps)| {
                let size = [Size::Bicycle, Size::Light, Size::Heavy][id as usize % 3];
                Around { id, size, forward_m, left_m, speed_mps, closing_mps }
            },
        );
        let cue = prop_oneof![
            (0f32..60.0).prop_map(Cue::Impact),
            Just(Cue::Kerb),
            Just(Cue::Warning),
            Just(Cue::Takeover),
            Just(Cue::Ended)
        ];
        let car = (0f32..70.0, unit.clone(), 0f32..30.0, any::<[bool; 3]>());
        let lists = (prop::collection::vec(around, 0..6), prop::collection::vec(cue, 0..4));
        (car, (unit.clone(), unit.clone(), unit), lists).prop_map(
            |((speed_mps, load, grip_mps2, [indicates, horn, wipes]), (rain, wet, wind), (around, cues))| Heard {
                speed_mps,
                load,
                grip_mps2,
                indicates,
                horn,
                wipes,
                rain,
                wet,
                wind,
                around,
                cues,
            },
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn whatever_is_heard_gives_the_same_samples_again_within_bounds(ticks in prop::collection::vec(any_heard(), 1..8)) {
            let play = |sample_hz: u32| {
                let mut mixer = Mixer::new(sample_hz);
                ticks.iter().flat_map(|heard| {
                    mixer.hear(heard);
                    (0..800).map(|_| mixer.sample()).collect::<Vec<_>>()
                }).collect::<Vec<_>>()
            };
            for sample_hz in [8_000, 44_100, SAMPLE_HZ, 192_000] {
                let once = play(sample_hz);
                prop_assert!(once.iter().flatten().all(|sample| sample.abs() <= 1.0));
                prop_assert!(once == play(sample_hz));
            }
        }
    }
}

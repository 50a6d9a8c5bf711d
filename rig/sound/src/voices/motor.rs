//! The electric motor of the ego car, and the hum with which electric cars make themselves heard when they are slow.

use crate::dsp::{Glide, Phase};
use crate::heard::Heard;

/// Turns of the motor for each metre: a reduction of 9 on a wheel of 0.31 m.
const TURNS_PER_M: f32 = 9.0 / (std::f32::consts::TAU * 0.31);
/// Pairs of poles: what is heard of a turn.
const POLE_PAIRS: f32 = 4.0;
/// Orders of the poles' frequency that are heard, and how loud.
const ORDERS: [(f32, f32); 3] = [(1.0, 0.5), (2.0, 0.3), (6.0, 0.2)];
/// Loudness of the motor without and with full load, once it turns.
const LEVEL: [f32; 2] = [0.015, 0.07];
const FULL_FROM_MPS: f32 = 3.0;
/// The hum (UN Regulation 138): up to 20 km/h, at least two tones, higher by 0.8 % for each km/h.
const HUM_HZ: [f32; 2] = [180.0, 430.0];
const HUM_UP_PER_MPS: f32 = 0.008 * 3.6;
const HUM_LEVEL: f32 = 0.02;
const HUM_TO_MPS: f32 = 5.6;
const HUM_FADES_MPS: f32 = 1.5;

/// What the motor does within a moment, seconds.
const FOLLOWS_S: f32 = 0.03;

#[derive(Clone, Debug, Default)]
pub struct Motor {
    speed_mps: Glide,
    load: Glide,
    orders: [Phase; ORDERS.len()],
    hum: [Phase; HUM_HZ.len()],
}

impl Motor {
    pub fn hear(&mut self, heard: &Heard) {
        self.speed_mps.set(heard.speed_mps);
        self.load.set(heard.load);
    }

    pub fn next(&mut self, sample_hz: f32) -> f32 {
        let speed_mps = self.speed_mps.next(FOLLOWS_S, sample_hz);
        let load = self.load.next(FOLLOWS_S, sample_hz);
        let hz = speed_mps * TURNS_PER_M * POLE_PAIRS;
        let turning = (speed_mps / FULL_FROM_MPS).min(1.0);
        let level = turning * (LEVEL[0] + (LEVEL[1] - LEVEL[0]) * load);
        let orders = self.orders.iter_mut().zip(ORDERS);
        let motor: f32 = orders.map(|(phase, (order, share))| share * phase.next(order * hz, sample_hz).sin()).sum();
        let moves = (2.0 * speed_mps).min(1.0);
        let hum_level = HUM_LEVEL * moves * (1.0 + (HUM_TO_MPS - speed_mps) / HUM_FADES_MPS).clamp(0.0, 1.0);
        let up = 1.0 + HUM_UP_PER_MPS * speed_mps;
        let hum: f32 = self.hum.iter_mut().zip(HUM_HZ).map(|(phase, hz)| phase.next(hz * up, sample_hz).sin()).sum();
        level * motor + hum_level * hum
    }
}

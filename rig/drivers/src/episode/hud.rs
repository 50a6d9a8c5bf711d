//! The HUD as numbers.

use kernel::map::Turn;
use kernel::signals::LightPhase;

use crate::readout::Readout;

/// Names of what [`row`] gives, in its order.
pub const NAMES: [&str; 11] = [
    "speed_mps",
    "limit_mps",
    "light_red",
    "light_yellow",
    "light_green",
    "light_distance_m",
    "turn_left",
    "turn_straight",
    "turn_right",
    "turn_distance_m",
    "bearing_deg",
];

/// Least and greatest values of what [`row`] gives.
pub const RANGES: [[f32; 2]; NAMES.len()] = [
    [0.0, 100.0],
    [0.0, 50.0],
    [0.0, 1.0],
    [0.0, 1.0],
    [0.0, 1.0],
    [0.0, 250.0],
    [0.0, 1.0],
    [0.0, 1.0],
    [0.0, 1.0],
    [0.0, 250.0],
    [-180.0, 180.0],
];

/// The HUD as numbers within [`RANGES`]: of light and turn the one that is shown is 1, and no light is all 0.
pub fn row(hud: &Readout) -> [f32; NAMES.len()] {
    let one = |is: bool| f32::from(u8::from(is));
    let [red, yellow, green] =
        [LightPhase::Red, LightPhase::Yellow, LightPhase::Green].map(|p| one(hud.light == Some(p)));
    let [left, straight, right] = [Turn::Left, Turn::Straight, Turn::Right].map(|turn| one(hud.turn == turn));
    let turn_m = hud.junction_m.map_or(RANGES[9][1], f32::from);
    let (light_m, bearing_deg) = (f32::from(hud.light_m), f32::from(hud.bearing_deg));
    let row =
        [hud.speed_mps(), hud.limit_mps(), red, yellow, green, light_m, left, straight, right, turn_m, bearing_deg];
    std::array::from_fn(|i| row[i].clamp(RANGES[i][0], RANGES[i][1]))
}

#[cfg(test)]
mod tests {
    use kernel::events::{Hud, RouteArrow};

    use super::*;

    #[test]
    fn what_is_shown_is_one_and_everything_stays_in_its_range() {
        let arrow = RouteArrow { turn: Turn::Right, distance_m: 31, bearing_deg: -15 };
        let hud = Hud { speed_mps: 8.5, limit_mps: 13.9, light: Some(LightPhase::Yellow), light_distance_m: 20, arrow };
        let (speed_mps, limit_mps) = (31.0 / 3.6, 50.0 / 3.6);
        let shown = [speed_mps, limit_mps, 0.0, 1.0, 0.0, 20.0, 0.0, 0.0, 1.0, 30.0, -15.0];
        assert_eq!(row(&Readout::of(&hud)), shown);
        let arrow = RouteArrow { distance_m: 500, ..arrow };
        let odd = Hud { speed_mps: 900.0, light: None, light_distance_m: u16::MAX, arrow, ..hud };
        let odd = row(&Readout::of(&odd));
        assert_eq!([&odd[..1], &odd[2..6], &odd[9..10]], [&[100.0][..], &[0.0, 0.0, 0.0, 250.0], &[250.0]]);
    }
}

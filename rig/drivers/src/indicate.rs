//! When the indicators are on before a turn of the route.

use kernel::Controls;
use kernel::map::Turn;

use crate::readout::Readout;

/// A turn is indicated from where the HUD shows this distance until it is driven, metres: the last 40 m, as the vehicles of
/// traffic do.
const INDICATE_M: u16 = 30;

/// The flag of the turn that the route takes at the junction ahead, or in it.
pub fn turn(hud: &Readout) -> u8 {
    let is_near = hud.junction_m.is_some_and(|distance_m| distance_m <= INDICATE_M);
    match hud.turn {
        Turn::Left if is_near => Controls::INDICATE_LEFT,
        Turn::Right if is_near => Controls::INDICATE_RIGHT,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use kernel::events::{Hud, RouteArrow};

    use super::*;

    #[test]
    fn a_turn_that_is_near_is_indicated() {
        let flag = |turn, distance_m| {
            let arrow = RouteArrow { turn, distance_m, bearing_deg: 0 };
            let hud = Hud { speed_mps: 8.0, limit_mps: 13.9, light: None, light_distance_m: 0, arrow };
            super::turn(&Readout::of(&hud))
        };
        assert_eq!([0, 39, 40].map(|m| flag(Turn::Left, m)), [Controls::INDICATE_LEFT, Controls::INDICATE_LEFT, 0]);
        assert_eq!([flag(Turn::Right, 12), flag(Turn::Straight, 12)], [Controls::INDICATE_RIGHT, 0]);
    }
}

//! When the indicators are on before a turn of the route.

use kernel::Controls;
use kernel::events::RouteArrow;
use kernel::map::Turn;

/// A turn is indicated from here on until it is driven, metres: as the vehicles of traffic do.
const INDICATE_M: u16 = 40;

/// The flag of the turn that the route takes at the junction ahead, or in it.
pub fn turn(arrow: &RouteArrow) -> u8 {
    match arrow.turn {
        Turn::Left if arrow.distance_m <= INDICATE_M => Controls::INDICATE_LEFT,
        Turn::Right if arrow.distance_m <= INDICATE_M => Controls::INDICATE_RIGHT,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_that_is_near_is_indicated() {
        let flag = |turn, distance_m| super::turn(&RouteArrow { turn, distance_m, bearing_deg: 0 });
        assert_eq!([0, 40, 41].map(|m| flag(Turn::Left, m)), [Controls::INDICATE_LEFT, Controls::INDICATE_LEFT, 0]);
        assert_eq!([flag(Turn::Right, 12), flag(Turn::Straight, 12)], [Controls::INDICATE_RIGHT, 0]);
    }
}

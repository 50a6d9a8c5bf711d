//! What the HUD shows to a driver, and no more: whole km/h, and distances in the steps of a navigation device.

use kernel::events::Hud;
use kernel::map::Turn;
use kernel::signals::LightPhase;

/// Farther junctions are not shown, metres.
const JUNCTION_SHOWN_M: u16 = 200;

/// The HUD as it is drawn for both drivers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Readout {
    /// Speed, km/h; never negative: the gear tells the direction.
    pub speed_kmh: u16,
    /// Speed limit, km/h.
    pub limit_kmh: u16,
    /// Phase of the next traffic light, as soon as a person would see it: see [`Hud::light`].
    pub light: Option<LightPhase>,
    /// Distance to its stop line in metres, as [`shown_m`]; 0 when there is none.
    pub light_m: u16,
    /// Which way the route leads at the junction ahead.
    pub turn: Turn,
    /// Distance to that junction in metres, as [`shown_m`]; 0 inside it, `None` where the next one is over 200 m away.
    pub junction_m: Option<u16>,
    /// Bearing of the route 12 m ahead relative to the car in degrees, positive to the right, in steps of 5.
    pub bearing_deg: i16,
}

impl Readout {
    /// As it is drawn.
    pub fn of(hud: &Hud) -> Self {
        let kmh = |mps: f32| (3.6 * mps.abs()).round() as u16;
        let junction_m = Some(hud.arrow.distance_m).filter(|distance_m| *distance_m <= JUNCTION_SHOWN_M);
        Self {
            speed_kmh: kmh(hud.speed_mps),
            limit_kmh: kmh(hud.limit_mps),
            light: hud.light,
            light_m: shown_m(hud.light_distance_m),
            turn: hud.arrow.turn,
            junction_m: junction_m.map(shown_m),
            bearing_deg: hud.arrow.bearing_deg,
        }
    }

    /// The speed, m/s.
    pub fn speed_mps(&self) -> f32 {
        f32::from(self.speed_kmh) / 3.6
    }

    /// The limit, m/s.
    pub fn limit_mps(&self) -> f32 {
        f32::from(self.limit_kmh) / 3.6
    }
}

/// A distance as it is shown: at least so far, in steps of 10 m, below 20 m of 5 m.
pub fn shown_m(distance_m: u16) -> u16 {
    distance_m / step_m(distance_m) * step_m(distance_m)
}

/// From a distance that is shown to the next greater one, metres.
pub fn step_m(shown_m: u16) -> u16 {
    if shown_m < 20 { 5 } else { 10 }
}

#[cfg(test)]
mod tests {
    use kernel::events::RouteArrow;

    use super::*;

    #[test]
    fn distances_are_shown_in_steps_that_are_never_too_far() {
        assert_eq!([0, 4, 5, 19, 20, 29, 84].map(shown_m), [0, 0, 5, 15, 20, 20, 80]);
        for distance_m in 0..300 {
            let shown = shown_m(distance_m);
            assert!((shown..shown + step_m(shown)).contains(&distance_m), "{distance_m} m as {shown} m");
        }
    }

    #[test]
    fn what_is_not_drawn_is_not_there() {
        let arrow = RouteArrow { turn: Turn::Straight, distance_m: 201, bearing_deg: -5 };
        let hud = Hud { speed_mps: -1.3, limit_mps: 50.0 / 3.6, light: None, light_distance_m: 0, arrow };
        let readout = Readout::of(&hud);
        assert_eq!((readout.speed_kmh, readout.limit_kmh, readout.junction_m), (5, 50, None));
        let near = Hud { arrow: RouteArrow { distance_m: 33, ..arrow }, ..hud };
        assert_eq!(Readout::of(&near).junction_m, Some(30));
    }
}

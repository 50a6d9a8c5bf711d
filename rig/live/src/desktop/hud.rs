//! What is written over both drivers' pictures, and where. Sizes and places are fractions of the
//! picture's height and of its width and height, so that they hold on every screen.

use drivers::readout::Readout;
use kernel::events::Hud;
use kernel::map::Turn;
use kernel::signals::LightPhase;
use kernel::{Controls, Seat};

/// Height of the speed's digits, fraction of the picture's height.
pub const SPEED_SIZE: f32 = 0.10;
/// Height of everything else that is written.
pub const TEXT_SIZE: f32 = 0.045;
/// Upper centre: the speed (paper, section 2).
pub const SPEED_AT: [f32; 2] = [0.5, 0.085];
/// Beside it: the limit.
pub const LIMIT_AT: [f32; 2] = [0.69, 0.085];
/// Below it: the route arrow and its distance.
pub const ARROW_AT: [f32; 2] = [0.5, 0.22];
/// Upper right: the phase of the traffic light (paper, section 2).
pub const LIGHT_AT: [f32; 2] = [0.945, 0.14];
/// Below it: the distance to its line.
pub const LIGHT_M_AT: [f32; 2] = [0.945, 0.34];
/// Upper left: gear, and who is in control.
pub const GEAR_AT: [f32; 2] = [0.04, 0.08];
/// Lower centre: what is to be done.
pub const NOTE_AT: [f32; 2] = [0.5, 0.92];
/// Above it: what the car did wrong, or what happened to it.
pub const ALERT_AT: [f32; 2] = [0.5, 0.78];
/// Width of the frame around the picture after a takeover.
pub const FRAME_WIDTH: f32 = 0.02;

/// The words and colours of the HUD.
#[derive(Clone, Debug, PartialEq)]
pub struct HudText {
    /// Speed, km/h.
    pub speed: String,
    /// Limit, km/h.
    pub limit: String,
    /// `D` or `R`.
    pub gear: char,
    /// Arrows of the indicators that are on, left and right.
    pub indicators: [&'static str; 2],
    /// Who is in control.
    pub control: String,
    /// Phase of the traffic light ahead, and the distance to its line.
    pub light: Option<(LightPhase, String)>,
    /// Direction of the arrow, radians clockwise from straight on.
    pub arrow_rad: f32,
    /// Distance to the next junction; empty where it is far.
    pub arrow_m: String,
    /// What is to be done; empty while driving.
    pub note: String,
    /// What the car did wrong, or what happened to it, a moment ago; mostly empty.
    pub alert: String,
    /// The safety driver has taken over.
    pub is_taken_over: bool,
}

impl HudText {
    /// What the kernel says, who steers and who has the pedals, and the flags of the car's controls; nothing is to be done.
    pub fn new(hud: &Hud, steering: Seat, pedals: Seat, flags: u8) -> Self {
        let hud = Readout::of(hud);
        let arrow = |flag: u8, arrow| if flags & flag != 0 { arrow } else { "" };
        let metres = |distance_m: u16| format!("{distance_m} m");
        Self {
            speed: hud.speed_kmh.to_string(),
            limit: hud.limit_kmh.to_string(),
            gear: if flags & Controls::REVERSE != 0 { 'R' } else { 'D' },
            indicators: [arrow(Controls::INDICATE_LEFT, "\u{25c0} "), arrow(Controls::INDICATE_RIGHT, " \u{25b6}")],
            control: control(steering, pedals).into(),
            light: hud.light.map(|phase| (phase, metres(hud.light_m))),
            arrow_rad: arrow_rad(&hud),
            arrow_m: hud.junction_m.map(metres).unwrap_or_default(),
            note: String::new(),
            alert: String::new(),
            is_taken_over: false,
        }
    }
}

/// Who is in control, in words.
pub fn control(steering: Seat, pedals: Seat) -> &'static str {
    match (steering, pedals) {
        (Seat::Semantic, Seat::Semantic) => "semantic driver",
        (Seat::Safety, Seat::Safety) => "SAFETY DRIVER",
        (Seat::Semantic, Seat::Safety) => "SAFETY DRIVER brakes",
        (Seat::Safety, Seat::Semantic) => "SAFETY DRIVER steers",
    }
}

/// Where a turn leads as long as it is ahead; near it, the bearing of the route itself.
fn arrow_rad(hud: &Readout) -> f32 {
    let at_junction = hud.junction_m.is_some_and(|distance_m| distance_m == 0);
    match hud.turn {
        Turn::Left if !at_junction => -core::f32::consts::FRAC_PI_2,
        Turn::Right if !at_junction => core::f32::consts::FRAC_PI_2,
        _ => f32::from(hud.bearing_deg).to_radians(),
    }
}

#[cfg(test)]
mod tests {
    use kernel::events::RouteArrow;

    use super::*;

    #[test]
    fn the_paper_has_the_light_upper_right_and_the_speed_upper_centre() {
        const { assert!(LIGHT_AT[0] > 0.85 && LIGHT_AT[1] < 0.25) };
        const { assert!(SPEED_AT[0] == 0.5 && SPEED_AT[1] < 0.15) };
    }

    #[test]
    fn what_is_written_stays_in_the_picture_and_apart() {
        for [x, y] in [SPEED_AT, LIMIT_AT, ARROW_AT, LIGHT_AT, LIGHT_M_AT, GEAR_AT, NOTE_AT, ALERT_AT] {
            assert!((0.03..0.97).contains(&x) && (0.05..0.95).contains(&y));
        }
        const { assert!(ARROW_AT[1] - SPEED_AT[1] > SPEED_SIZE) };
        const { assert!(NOTE_AT[1] - ALERT_AT[1] > 2.0 * TEXT_SIZE) };
        const { assert!(LIMIT_AT[0] - SPEED_AT[0] > SPEED_SIZE) };
    }

    #[test]
    fn the_arrow_points_to_the_turn_and_then_along_it() {
        let arrow = |turn, distance_m, bearing_deg| {
            let arrow = RouteArrow { turn, distance_m, bearing_deg };
            let hud = Hud { speed_mps: 8.0, limit_mps: 13.9, light: None, light_distance_m: 0, arrow };
            arrow_rad(&Readout::of(&hud))
        };
        assert!(arrow(Turn::Left, 40, 0) < -1.5 && arrow(Turn::Right, 40, 0) > 1.5);
        assert_eq!(arrow(Turn::Straight, 40, 0), 0.0);
        assert!((arrow(Turn::Left, 0, -30) + 0.52).abs() < 0.01);
    }

    #[test]
    fn a_braking_safety_driver_is_in_control_of_the_pedals_only() {
        assert_eq!(control(Seat::Semantic, Seat::Safety), "SAFETY DRIVER brakes");
    }
}

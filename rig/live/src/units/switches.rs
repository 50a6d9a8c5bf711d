//! What a driver switches beside wheel and pedals: indicators, horn, lights and wipers.

use kernel::Controls;

/// Steering of a turn, and that with which the wheel is back from it, fractions of full steering.
const TURNED: f32 = 0.2;
const BACK: f32 = 0.05;

/// The levers of a control unit. The horn sounds while its button is held; every other press switches on, and the next
/// one off. An indicator puts the other out unless that one's button is held, which gives the hazard lights, and goes
/// out itself when the wheel comes back from a turn to its side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Switches {
    /// What is switched on.
    on: u8,
    /// What is held down.
    held: u8,
    /// The wheel has turned to the side that is indicated.
    turned: bool,
    /// The horn went down since the last tick.
    honked: bool,
}

impl Switches {
    /// The switch of a flag went down or up.
    pub fn press(&mut self, flag: u8, pressed: bool) {
        // Systems repeat a key that is held.
        let went_down = pressed && self.held & flag == 0;
        self.held = if pressed { self.held | flag } else { self.held & !flag };
        if !went_down {
            return;
        }
        match flag {
            Controls::HORN => self.honked = true,
            Controls::INDICATE_LEFT | Controls::INDICATE_RIGHT => {
                let other = Controls::INDICATORS & !flag;
                self.on = if self.held & other != 0 { self.on | Controls::INDICATORS } else { self.on & !other ^ flag };
                self.turned = false;
            }
            _ => self.on ^= flag,
        }
    }

    /// Everything is let go of.
    pub fn release(&mut self) {
        self.held = 0;
    }

    /// The flags of the next tick, of a wheel that is turned so far, positive to the right.
    pub fn tick(&mut self, steer: f32) -> u8 {
        let to_side = match self.on & Controls::INDICATORS {
            Controls::INDICATE_LEFT => -steer,
            Controls::INDICATE_RIGHT => steer,
            _ => 0.0,
        };
        self.turned |= to_side > TURNED;
        if self.turned && to_side < BACK {
            self.on &= !Controls::INDICATORS;
            self.turned = false;
        }
        let horn = std::mem::take(&mut self.honked) || self.held & Controls::HORN != 0;
        self.on | if horn { Controls::HORN } else { 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEFT: u8 = Controls::INDICATE_LEFT;
    const RIGHT: u8 = Controls::INDICATE_RIGHT;

    fn tap(switches: &mut Switches, flag: u8) -> u8 {
        switches.press(flag, true);
        // Repeated by the system.
        switches.press(flag, true);
        switches.press(flag, false);
        switches.tick(0.0)
    }

    #[test]
    fn a_press_switches_on_and_the_next_one_off() {
        for flag in [LEFT, RIGHT, Controls::LIGHTS, Controls::WIPERS] {
            let mut switches = Switches::default();
            assert_eq!([0; 3].map(|_| tap(&mut switches, flag)), [flag, 0, flag]);
            assert_eq!(switches.tick(0.0), flag, "it stays on");
        }
    }

    #[test]
    fn one_indicator_puts_the_other_out_and_both_held_are_the_hazard_lights() {
        let mut switches = Switches::default();
        assert_eq!([LEFT, RIGHT].map(|flag| tap(&mut switches, flag)), [LEFT, RIGHT]);
        switches.press(LEFT, true);
        assert_eq!(tap(&mut switches, RIGHT), Controls::INDICATORS);
        switches.release();
        assert_eq!(switches.tick(0.9), Controls::INDICATORS, "no turn puts them out");
        assert_eq!([LEFT, LEFT].map(|flag| tap(&mut switches, flag)), [0, LEFT], "one side puts both out");
    }

    #[test]
    fn an_indicator_goes_out_after_the_turn() {
        let mut switches = Switches::default();
        tap(&mut switches, RIGHT);
        let steered = [0.1, -0.4, 0.0, 0.15, 0.3, 0.1, 0.04, 0.3].map(|steer| switches.tick(steer));
        assert_eq!(steered, [RIGHT, RIGHT, RIGHT, RIGHT, RIGHT, RIGHT, 0, 0]);
    }

    #[test]
    fn the_horn_sounds_while_it_is_held_and_once_for_a_tap() {
        let mut switches = Switches::default();
        assert_eq!((tap(&mut switches, Controls::HORN), switches.tick(0.0)), (Controls::HORN, 0));
        switches.press(Controls::HORN, true);
        assert_eq!([0; 2].map(|_| switches.tick(0.0)), [Controls::HORN; 2]);
    }
}

//! A half of the keyboard as a control unit: keys become a wheel and pedals that move smoothly.

use kernel::time::TICK_HZ;
use kernel::{Controls, Seat};

use super::switches::Switches;

/// Full travels per second: of the wheel away from and back to its centre, and of a pedal down and up.
const STEER_PER_S: f32 = 1.2;
const CENTRE_PER_S: f32 = 2.5;
const PRESS_PER_S: f32 = 2.0;
const RELEASE_PER_S: f32 = 4.0;
/// Steering, times speed squared, at which the car's lateral acceleration is about 0.45 g, m²/s².
const COMFORT_M2PS2: f32 = 20.0;
/// Speed below which the gear can be changed, m/s.
pub(super) const GEAR_CHANGE_MPS: f32 = 1.0;

/// A key with a meaning for one of the seats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Semantic driver: accelerate.
    W,
    /// Semantic driver: steer left.
    A,
    /// Semantic driver: brake.
    S,
    /// Semantic driver: steer right.
    D,
    /// Semantic driver: hand brake.
    Space,
    /// Semantic driver: change between forward and reverse, at standstill.
    R,
    /// Semantic driver: "I see the hazard".
    E,
    /// Semantic driver: indicate left.
    Z,
    /// Semantic driver: indicate right.
    C,
    /// Semantic driver: horn.
    V,
    /// Semantic driver: lights.
    T,
    /// Semantic driver: wipers.
    G,
    /// Safety driver: accelerate.
    Up,
    /// Safety driver: brake.
    Down,
    /// Safety driver: steer left.
    Left,
    /// Safety driver: steer right.
    Right,
    /// Safety driver: hand brake.
    RightCtrl,
    /// Safety driver: "I see the hazard".
    RightShift,
    /// Safety driver: change between forward and reverse, at standstill.
    PageDown,
    /// Safety driver: indicate left.
    Delete,
    /// Safety driver: indicate right.
    End,
    /// Safety driver: horn.
    Home,
    /// Safety driver: lights.
    Insert,
    /// Safety driver: wipers.
    PageUp,
}

/// What a key does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Action {
    Throttle,
    Brake,
    Left,
    Right,
    HandBrake,
    Gear,
    Seen,
    /// Works a switch: one of the flags of [`Switches`].
    Switch(u8),
}

impl Key {
    fn meaning(self) -> (Seat, Action) {
        match self {
            Self::W => (Seat::Semantic, Action::Throttle),
            Self::A => (Seat::Semantic, Action::Left),
            Self::S => (Seat::Semantic, Action::Brake),
            Self::D => (Seat::Semantic, Action::Right),
            Self::Space => (Seat::Semantic, Action::HandBrake),
            Self::R => (Seat::Semantic, Action::Gear),
            Self::E => (Seat::Semantic, Action::Seen),
            Self::Z => (Seat::Semantic, Action::Switch(Controls::INDICATE_LEFT)),
            Self::C => (Seat::Semantic, Action::Switch(Controls::INDICATE_RIGHT)),
            Self::V => (Seat::Semantic, Action::Switch(Controls::HORN)),
            Self::T => (Seat::Semantic, Action::Switch(Controls::LIGHTS)),
            Self::G => (Seat::Semantic, Action::Switch(Controls::WIPERS)),
            Self::Up => (Seat::Safety, Action::Throttle),
            Self::Down => (Seat::Safety, Action::Brake),
            Self::Left => (Seat::Safety, Action::Left),
            Self::Right => (Seat::Safety, Action::Right),
            Self::RightCtrl => (Seat::Safety, Action::HandBrake),
            Self::RightShift => (Seat::Safety, Action::Seen),
            Self::PageDown => (Seat::Safety, Action::Gear),
            Self::Delete => (Seat::Safety, Action::Switch(Controls::INDICATE_LEFT)),
            Self::End => (Seat::Safety, Action::Switch(Controls::INDICATE_RIGHT)),
            Self::Home => (Seat::Safety, Action::Switch(Controls::HORN)),
            Self::Insert => (Seat::Safety, Action::Switch(Controls::LIGHTS)),
            Self::PageUp => (Seat::Safety, Action::Switch(Controls::WIPERS)),
        }
    }
}

/// One half of the keyboard, named by the seat whose keys these are unless the seats are swapped.
#[derive(Clone, Debug)]
pub struct Keyboard {
    half: Seat,
    /// The seat that it drives.
    seat: Seat,
    /// Steering of the safety driver beyond which it takes over, fraction of full steering.
    takeover_steer: f32,
    held: Vec<Action>,
    gear_asked: bool,
    /// "I see it" went down since the last tick.
    seen_asked: bool,
    reverse: bool,
    switches: Switches,
    steer: f32,
    throttle: f32,
    brake: f32,
}

impl Keyboard {
    /// The half of a seat, with nothing pressed.
    pub fn new(half: Seat) -> Self {
        Self {
            half,
            seat: half,
            takeover_steer: 0.0,
            held: Vec::new(),
            gear_asked: false,
            seen_asked: false,
            reverse: false,
            switches: Switches::default(),
            steer: 0.0,
            throttle: 0.0,
            brake: 0.0,
        }
    }

    /// Drives another seat from now on, with the keys that it has.
    pub fn sit(&mut self, seat: Seat) {
        *self = Self { seat, takeover_steer: self.takeover_steer, ..Self::new(self.half) };
    }

    /// From now on the safety driver takes over beyond such steering.
    pub fn set_takeover_steer(&mut self, fraction: f32) {
        self.takeover_steer = fraction;
    }

    /// What tells it from the other half.
    pub fn name(&self) -> &'static str {
        match self.half {
            Seat::Semantic => "W A S D",
            Seat::Safety => "arrows",
        }
    }

    /// Its keys, for people to read.
    pub fn keys(&self) -> &'static str {
        match self.half {
            Seat::Semantic => {
                "W throttle, S brake, A and D steer, hand brake Space, gear R, hazard seen E, indicators Z and C, horn V, \
                 lights T, wipers G"
            }
            Seat::Safety => {
                "up throttle, down brake, left and right steer, hand brake right Ctrl, gear Page Down, \
                 hazard seen right Shift, indicators Delete and End, horn Home, lights Insert, wipers Page Up"
            }
        }
    }

    /// A key went down or up; keys of the other half are ignored.
    pub fn key(&mut self, key: Key, pressed: bool) {
        let (half, action) = key.meaning();
        if half != self.half {
            return;
        }
        if let Action::Switch(flag) = action {
            return self.switches.press(flag, pressed);
        }
        let held = self.is_held(action);
        self.held.retain(|a| *a != action);
        if pressed {
            self.held.push(action);
            // Systems repeat a key that is held.
            self.gear_asked |= action == Action::Gear && !held;
            self.seen_asked |= action == Action::Seen;
        }
    }

    /// All keys went up, as when the window loses the keyboard.
    pub fn release(&mut self) {
        self.held.clear();
        self.switches.release();
    }

    /// Gear D.
    pub fn engage_forward(&mut self) {
        (self.reverse, self.gear_asked) = (false, false);
    }

    /// Moves wheel and pedals by one tick.
    pub fn tick(&mut self, speed_mps: f32) -> Controls {
        if std::mem::take(&mut self.gear_asked) && speed_mps.abs() < GEAR_CHANGE_MPS {
            self.reverse = !self.reverse;
        }
        let side = f32::from(i8::from(self.is_held(Action::Right)) - i8::from(self.is_held(Action::Left)));
        let wanted = side * self.most_steer(speed_mps);
        let outward = wanted * self.steer >= 0.0 && wanted.abs() > self.steer.abs();
        self.steer = towards(self.steer, wanted, if outward { STEER_PER_S } else { CENTRE_PER_S });
        self.throttle = pedal(self.throttle, self.is_held(Action::Throttle));
        self.brake = pedal(self.brake, self.is_held(Action::Brake));
        let mut controls = Controls::from_fractions(self.steer, self.throttle, self.brake);
        let seen_asked = std::mem::take(&mut self.seen_asked);
        let flag = |on: bool, flag: u8| if on { flag } else { 0 };
        controls.flags = flag(self.is_held(Action::HandBrake), Controls::HAND_BRAKE)
            | flag(self.reverse, Controls::REVERSE)
            | flag(self.is_held(Action::Seen) || seen_asked, Controls::SEEN)
            | self.switches.tick(self.steer);
        controls
    }

    /// A key knows no halves: at speed it may not turn the wheel fully. The safety driver must pass
    /// the threshold of a takeover at any speed.
    fn most_steer(&self, speed_mps: f32) -> f32 {
        let least = if self.seat == Seat::Safety { (self.takeover_steer + 0.05).clamp(0.25, 1.0) } else { 0.12 };
        (COMFORT_M2PS2 / (speed_mps * speed_mps).max(COMFORT_M2PS2)).max(least)
    }

    fn is_held(&self, action: Action) -> bool {
        self.held.contains(&action)
    }
}

fn pedal(at: f32, pressed: bool) -> f32 {
    if pressed { towards(at, 1.0, PRESS_PER_S) } else { towards(at, 0.0, RELEASE_PER_S) }
}

fn towards(at: f32, wanted: f32, per_s: f32) -> f32 {
    let step = per_s / TICK_HZ as f32;
    at + (wanted - at).clamp(-step, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hold(keyboard: &mut Keyboard, key: Key, ticks: u32, speed_mps: f32) -> Controls {
        keyboard.key(key, true);
        (0..ticks).fold(Controls::default(), |_, _| keyboard.tick(speed_mps))
    }

    #[test]
    fn wheel_and_pedals_move_smoothly_and_come_back() {
        let mut keyboard = Keyboard::new(Seat::Semantic);
        let (mut before, mut steps) = (Controls::default(), 0);
        keyboard.key(Key::D, true);
        keyboard.key(Key::W, true);
        for tick in 0..200 {
            if tick == 100 {
                keyboard.release();
            }
            let now = keyboard.tick(0.0);
            assert!((now.steer_fraction() - before.steer_fraction()).abs() < 0.05);
            assert!((now.throttle_fraction() - before.throttle_fraction()).abs() < 0.07);
            steps += u32::from(now != before);
            before = now;
            if tick == 99 {
                assert_eq!((now.steer, now.throttle, now.brake), (32767, 65535, 0));
            }
        }
        assert_eq!(before, Controls::default());
        assert!(steps > 60, "{steps}");
    }

    #[test]
    fn each_half_hears_its_own_keys_only() {
        let mut safety = Keyboard::new(Seat::Safety);
        for key in [Key::W, Key::A, Key::S, Key::Space, Key::R, Key::E] {
            assert_eq!(hold(&mut safety, key, 5, 0.0), Controls::default());
        }
        assert!(hold(&mut safety, Key::Down, 60, 10.0).brake_fraction() > 0.99);
        assert!(hold(&mut safety, Key::Left, 60, 14.0).steer_fraction() < -0.2, "beyond the threshold at 50 km/h");
        for threshold in [0.1, 0.3, 0.99] {
            safety.set_takeover_steer(threshold);
            safety.sit(Seat::Safety);
            assert!(hold(&mut safety, Key::Left, 120, 14.0).steer_fraction() < -threshold, "{threshold}");
        }
        assert!(hold(&mut safety, Key::RightShift, 1, 0.0).has(Controls::SEEN));
        assert!(hold(&mut safety, Key::RightCtrl, 1, 0.0).has(Controls::HAND_BRAKE));
    }

    #[test]
    fn each_half_has_a_key_for_every_switch() {
        let flags =
            [Controls::INDICATE_LEFT, Controls::INDICATE_RIGHT, Controls::HORN, Controls::LIGHTS, Controls::WIPERS];
        let keys = [
            (Seat::Semantic, [Key::Z, Key::C, Key::V, Key::T, Key::G]),
            (Seat::Safety, [Key::Delete, Key::End, Key::Home, Key::Insert, Key::PageUp]),
        ];
        for (seat, keys) in keys {
            for (key, flag) in keys.into_iter().zip(flags) {
                let other = if seat == Seat::Safety { Seat::Semantic } else { Seat::Safety };
                assert_eq!(hold(&mut Keyboard::new(seat), key, 1, 0.0).flags, flag, "{key:?}");
                assert_eq!(hold(&mut Keyboard::new(other), key, 1, 0.0).flags, 0, "{key:?}");
            }
        }
    }

    #[test]
    fn steering_is_gentle_at_speed() {
        let fast = hold(&mut Keyboard::new(Seat::Semantic), Key::D, 200, 14.0).steer_fraction();
        let slow = hold(&mut Keyboard::new(Seat::Semantic), Key::D, 200, 2.0).steer_fraction();
        assert!(fast > 0.1 && fast < 0.15 && slow == 1.0, "{fast} {slow}");
        let mut both = Keyboard::new(Seat::Semantic);
        both.key(Key::A, true);
        assert_eq!(hold(&mut both, Key::D, 30, 5.0).steer, 0, "both sides are none");
    }

    #[test]
    fn a_tap_between_two_ticks_is_seen_in_one() {
        let mut keyboard = Keyboard::new(Seat::Semantic);
        keyboard.key(Key::E, true);
        keyboard.key(Key::E, false);
        assert_eq!([0; 3].map(|_| keyboard.tick(5.0).has(Controls::SEEN)), [true, false, false]);
    }

    #[test]
    fn the_gear_changes_once_a_press_and_only_at_standstill() {
        let mut keyboard = Keyboard::new(Seat::Semantic);
        assert!(!hold(&mut keyboard, Key::R, 3, 8.0).has(Controls::REVERSE), "not at speed");
        keyboard.key(Key::R, false);
        keyboard.key(Key::R, true);
        assert!(hold(&mut keyboard, Key::R, 3, 0.0).has(Controls::REVERSE), "a repeated key is one press");
        keyboard.key(Key::R, false);
        assert!(!hold(&mut keyboard, Key::R, 1, 0.0).has(Controls::REVERSE));
    }
}

//! Both seats' control units: what the drivers' hands and feet do, as [`Controls`], once a tick.
//!
//! Nothing here reads the clock: [`Seats::poll`] is called once for every tick of the world.

pub mod keyboard;
pub mod status;

use kernel::{Controls, Seat, TickInput};

pub use keyboard::Key;
use keyboard::Keyboard;
pub use status::{SeatChoice, UnitEvent, UnitEventKind, UnitState, UnitStatus};

/// What the units need to know of the car; that of the tick before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CarState {
    /// Speed along the car's x axis, m/s.
    pub speed_mps: f32,
    /// Whether the safety driver steers or has the pedals (`TickOutput::applied`).
    pub safety_in_control: bool,
}

/// What the units gave for one tick.
#[derive(Clone, Debug, PartialEq)]
pub struct Polled {
    /// Controls of the semantic driver.
    pub semantic: Controls,
    /// Controls of the safety driver.
    pub safety: Controls,
    /// What happened to the units since the tick before.
    pub events: Vec<UnitEvent>,
    /// How the units are, semantic driver's first.
    pub status: [UnitStatus; 2],
}

impl Polled {
    /// What goes into the world.
    pub fn input(&self) -> TickInput {
        TickInput { semantic: self.semantic, safety: self.safety }
    }

    /// Whether both units are armed, without which the car does not drive.
    pub fn ready(&self) -> bool {
        self.status.iter().all(|s| s.state == UnitState::Armed)
    }
}

/// What moves the controls of a seat.
#[derive(Debug)]
enum Unit {
    Keyboard(Keyboard),
    Bot,
}

/// Both seats' control units.
#[derive(Debug)]
pub struct Seats {
    units: [Unit; 2],
}

impl Seats {
    /// Units for both seats, semantic driver's first.
    pub fn new(choices: [SeatChoice; 2]) -> anyhow::Result<Self> {
        let seats = [Seat::Semantic, Seat::Safety];
        let [semantic, safety] = seats.map(|seat| match choices[seat as usize] {
            SeatChoice::Bot => Unit::Bot,
            SeatChoice::Keyboard => Unit::Keyboard(Keyboard::new(seat)),
        });
        Ok(Self { units: [semantic, safety] })
    }

    /// A key of any window went down or up.
    pub fn key(&mut self, key: Key, pressed: bool) {
        for unit in &mut self.units {
            if let Unit::Keyboard(keyboard) = unit {
                keyboard.key(key, pressed);
            }
        }
    }

    /// All keys went up: to be called when the last window that has the keyboard loses it.
    pub fn release_keys(&mut self) {
        for unit in &mut self.units {
            if let Unit::Keyboard(keyboard) = unit {
                keyboard.release();
            }
        }
    }

    /// The controls of the next tick; moves wheels and pedals of the keyboard by one tick.
    pub fn poll(&mut self, car: CarState) -> Polled {
        let [semantic, safety] = [0, 1].map(|seat| match &mut self.units[seat] {
            Unit::Keyboard(keyboard) => keyboard.tick(car.speed_mps),
            Unit::Bot => Controls::default(),
        });
        Polled { semantic, safety, events: Vec::new(), status: [0, 1].map(|seat| self.status(seat)) }
    }

    fn status(&self, seat: usize) -> UnitStatus {
        let unit = match &self.units[seat] {
            Unit::Keyboard(_) => String::from("keyboard"),
            Unit::Bot => String::from("bot"),
        };
        UnitStatus { unit, state: UnitState::Armed }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_people_share_a_keyboard() {
        let mut seats = Seats::new([SeatChoice::Keyboard, SeatChoice::Keyboard]).unwrap();
        seats.key(Key::W, true);
        seats.key(Key::Down, true);
        let polled = (0..60).map(|_| seats.poll(CarState::default())).last().unwrap();
        assert!(polled.ready());
        assert_eq!((polled.semantic.throttle, polled.semantic.brake), (65535, 0));
        assert_eq!((polled.safety.throttle, polled.safety.brake), (0, 65535));
        seats.release_keys();
        let polled = (0..60).map(|_| seats.poll(CarState::default())).last().unwrap();
        assert_eq!(polled.input(), TickInput::default());
    }

    #[test]
    fn a_bot_has_no_unit() {
        let mut seats = Seats::new([SeatChoice::Bot, SeatChoice::Keyboard]).unwrap();
        seats.key(Key::W, true);
        let polled = seats.poll(CarState::default());
        assert_eq!(polled.semantic, Controls::default());
        assert_eq!(polled.status[0].to_string(), "bot: armed");
    }
}

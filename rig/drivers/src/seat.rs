//! What a seat is to be driven with, as people say it.

use std::convert::Infallible;
use std::str::FromStr;

/// The unit that is the keyboard.
pub const KEYBOARD: &str = "keyboard";

/// What a seat is to be driven with.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum SeatChoice {
    /// What is there at the start: with one device it goes to the semantic driver (or to the only seat
    /// that asks); with more, each seat takes the one on which its driver presses a button; else the
    /// keyboard.
    #[default]
    Auto,
    /// Half of the keyboard: the letters for the semantic driver, the arrows for the safety driver.
    Keyboard,
    /// The device on which a button is pressed next; the semantic driver's comes first.
    Press,
    /// The device at a path such as `/dev/input/event5` or a link to it.
    Device(String),
    /// Nothing: a bot drives. The unit counts as armed and gives neutral controls; the bot's are to
    /// replace them while `Polled::ready`.
    Bot,
}

impl FromStr for SeatChoice {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(match text {
            "auto" => Self::Auto,
            KEYBOARD => Self::Keyboard,
            "press" => Self::Press,
            "bot" => Self::Bot,
            path => Self::Device(path.to_owned()),
        })
    }
}

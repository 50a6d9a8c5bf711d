//! What the keys of the viewer ask for.

use winit::keyboard::{Key, KeyCode, NamedKey, PhysicalKey};

use crate::view::layers::Layer;
use crate::view::viewing::{Action, FRAME_TICKS};

/// What a key means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// Something for what is shown.
    Do(Action),
    /// Fill the monitor, or stop doing so.
    FullScreen,
    /// End the viewer.
    Quit,
}

const DIGITS: [KeyCode; Layer::ALL.len()] =
    [KeyCode::Digit1, KeyCode::Digit2, KeyCode::Digit3, KeyCode::Digit4, KeyCode::Digit5, KeyCode::Digit6];

/// The meaning of a key by what it types and where it is; `repeated` says that it is held down, which
/// only moves on and on.
pub fn meaning(key: &Key, place: PhysicalKey, shift: bool, repeated: bool) -> Option<Meaning> {
    let moving = match key {
        Key::Named(NamedKey::ArrowLeft) => Some(Action::Step(if shift { -FRAME_TICKS } else { -1 })),
        Key::Named(NamedKey::ArrowRight) => Some(Action::Step(if shift { FRAME_TICKS } else { 1 })),
        _ => None,
    };
    match moving {
        Some(action) => Some(Meaning::Do(action)),
        None if repeated => None,
        None => layer(place, shift).or_else(|| pressed(key)),
    }
}

/// Number keys by their place, as Shift makes other characters of them.
fn layer(place: PhysicalKey, shift: bool) -> Option<Meaning> {
    let digit = DIGITS.into_iter().position(|digit| place == PhysicalKey::Code(digit))?;
    Some(Meaning::Do(Action::Show(usize::from(shift), Layer::ALL[digit])))
}

fn pressed(key: &Key) -> Option<Meaning> {
    let action = match key {
        Key::Named(NamedKey::F11) => return Some(Meaning::FullScreen),
        Key::Named(NamedKey::Escape) => return Some(Meaning::Quit),
        Key::Named(NamedKey::Space) => Action::TogglePlay,
        Key::Named(NamedKey::ArrowUp) => Action::Faster,
        Key::Named(NamedKey::ArrowDown) => Action::Slower,
        Key::Named(NamedKey::PageUp) => Action::PreviousMark,
        Key::Named(NamedKey::PageDown) => Action::NextMark,
        Key::Named(NamedKey::Home) => Action::Start,
        Key::Named(NamedKey::End) => Action::End,
        Key::Character(text) => match text.to_lowercase().as_str() {
            "q" => return Some(Meaning::Quit),
            " " => Action::TogglePlay,
            "v" => Action::NextViewpoint,
            "k" => Action::NextCheckpoint,
            "i" => Action::MarkFrom,
            "o" => Action::MarkTo,
            "c" => Action::Cut,
            "s" => Action::Screenshot,
            "h" => Action::ToggleHud,
            _ => return None,
        },
        _ => return None,
    };
    Some(Meaning::Do(action))
}

#[cfg(test)]
mod tests {
    use super::*;
    use winit::keyboard::SmolStr;

    const NOWHERE: PhysicalKey = PhysicalKey::Code(KeyCode::F24);

    fn typed(text: &str) -> Key {
        Key::Character(SmolStr::new(text))
    }

    #[test]
    fn shift_makes_a_frame_of_a_tick_and_the_right_view_of_the_left() {
        let right = Key::Named(NamedKey::ArrowRight);
        let step = |shift| meaning(&right, NOWHERE, shift, true);
        assert_eq!(step(false), Some(Meaning::Do(Action::Step(1))));
        assert_eq!(step(true), Some(Meaning::Do(Action::Step(6))));
        let five = PhysicalKey::Code(KeyCode::Digit5);
        let show = |view| Some(Meaning::Do(Action::Show(view, Layer::Difference)));
        assert_eq!(meaning(&typed("5"), five, false, false), show(0));
        assert_eq!(meaning(&typed("%"), five, true, false), show(1));
    }

    #[test]
    fn a_held_key_does_its_work_once_and_capitals_are_letters() {
        assert_eq!(meaning(&typed("C"), NOWHERE, true, false), Some(Meaning::Do(Action::Cut)));
        assert_eq!(meaning(&typed("c"), NOWHERE, false, true), None);
        assert_eq!(meaning(&typed("q"), NOWHERE, false, false), Some(Meaning::Quit));
        assert_eq!(meaning(&typed("x"), NOWHERE, false, false), None);
    }

    #[test]
    fn no_two_keys_ask_for_the_same() {
        let letters = ["v", "k", "i", "o", "c", "s", "h", "q"].map(|letter| pressed(&typed(letter)));
        for (i, meaning) in letters.iter().enumerate() {
            assert!(meaning.is_some() && !letters[..i].contains(meaning));
        }
    }
}

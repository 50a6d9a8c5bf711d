//! Keys of the keyboard, as the seats and the operators know them.

use winit::event::KeyEvent;
use winit::keyboard::{Key as Logical, KeyCode, NamedKey, PhysicalKey};

use crate::desktop::Pane;
use crate::drive::stage::Press;
use crate::units::Key;

/// The key of a seat, by its place on the keyboard.
pub fn seat_key(key: PhysicalKey) -> Option<Key> {
    let PhysicalKey::Code(code) = key else { return None };
    Some(match code {
        KeyCode::KeyW => Key::W,
        KeyCode::KeyA => Key::A,
        KeyCode::KeyS => Key::S,
        KeyCode::KeyD => Key::D,
        KeyCode::Space => Key::Space,
        KeyCode::KeyR => Key::R,
        KeyCode::KeyE => Key::E,
        KeyCode::KeyZ => Key::Z,
        KeyCode::KeyC => Key::C,
        KeyCode::KeyV => Key::V,
        KeyCode::KeyT => Key::T,
        KeyCode::KeyG => Key::G,
        KeyCode::ArrowUp => Key::Up,
        KeyCode::ArrowDown => Key::Down,
        KeyCode::ArrowLeft => Key::Left,
        KeyCode::ArrowRight => Key::Right,
        KeyCode::ControlRight => Key::RightCtrl,
        KeyCode::ShiftRight => Key::RightShift,
        KeyCode::PageDown => Key::PageDown,
        KeyCode::Delete => Key::Delete,
        KeyCode::End => Key::End,
        KeyCode::Home => Key::Home,
        KeyCode::Insert => Key::Insert,
        KeyCode::PageUp => Key::PageUp,
        _ => return None,
    })
}

/// The key of the operators.
pub fn press(event: &KeyEvent) -> Option<Press> {
    let place = event.physical_key;
    match &event.logical_key {
        Logical::Named(NamedKey::Enter) => Some(Press::Enter),
        Logical::Named(NamedKey::Escape) => seat_key(place).is_none().then_some(Press::Escape),
        Logical::Named(NamedKey::Backspace) => Some(Press::Backspace),
        _ => typed(event.text.as_deref().unwrap_or_default(), place),
    }
}

/// The press of a key that types this (nothing: a key without a text) and is at that place.
fn typed(text: &str, place: PhysicalKey) -> Option<Press> {
    let command = command(text, place);
    (command.is_some() || !text.is_empty()).then(|| Press::Text { text: text.to_owned(), command })
}

/// What a key asks for besides what it types: the operators' letter or digit that it types on this layout, or else the
/// one that is at its place on a US keyboard, as other scripts type no such letter. A seat's key asks for nothing on any
/// layout: on AZERTY steering left types Q.
fn command(text: &str, place: PhysicalKey) -> Option<char> {
    if seat_key(place).is_some() {
        return None;
    }
    let letter = text.to_ascii_lowercase();
    let typed = COMMANDS.iter().find(|(command, _)| letter.chars().eq([*command]));
    typed.or_else(|| COMMANDS.iter().find(|(_, code)| place == PhysicalKey::Code(*code))).map(|(command, _)| *command)
}

/// The operators' keys, each with its place on a US keyboard; what they do, labels among it, is in [`crate::drive::stage`].
const COMMANDS: [(char, KeyCode); 14] = [
    ('n', KeyCode::KeyN),
    ('x', KeyCode::KeyX),
    ('f', KeyCode::KeyF),
    ('m', KeyCode::KeyM),
    ('q', KeyCode::KeyQ),
    ('p', KeyCode::KeyP),
    ('b', KeyCode::KeyB),
    ('1', KeyCode::Digit1),
    ('2', KeyCode::Digit2),
    ('3', KeyCode::Digit3),
    ('4', KeyCode::Digit4),
    ('5', KeyCode::Digit5),
    ('6', KeyCode::Digit6),
    ('7', KeyCode::Digit7),
];

/// What a key does to the window that has the keyboard.
pub fn window_key(event: &KeyEvent) -> Option<fn(&Pane)> {
    match event.logical_key {
        _ if seat_key(event.physical_key).is_some() => None,
        Logical::Named(NamedKey::F9) => Some(Pane::span_monitors),
        Logical::Named(NamedKey::F10) => Some(Pane::to_next_monitor),
        Logical::Named(NamedKey::F11) => Some(Pane::toggle_full_screen),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::stage::{Dialog, Stage, Wish};

    const SEATS: [KeyCode; 24] = [
        KeyCode::KeyW,
        KeyCode::KeyA,
        KeyCode::KeyS,
        KeyCode::KeyD,
        KeyCode::Space,
        KeyCode::KeyR,
        KeyCode::KeyE,
        KeyCode::ArrowUp,
        KeyCode::ArrowDown,
        KeyCode::ArrowLeft,
        KeyCode::ArrowRight,
        KeyCode::ControlRight,
        KeyCode::ShiftRight,
        KeyCode::PageDown,
        KeyCode::KeyZ,
        KeyCode::KeyC,
        KeyCode::KeyV,
        KeyCode::KeyT,
        KeyCode::KeyG,
        KeyCode::Delete,
        KeyCode::End,
        KeyCode::Home,
        KeyCode::Insert,
        KeyCode::PageUp,
    ];

    fn wish(stage: &mut Stage, text: &str, code: KeyCode) -> Wish {
        typed(text, PhysicalKey::Code(code)).map_or(Wish::Nothing, |press| stage.press(&press, false))
    }

    #[test]
    fn a_seats_key_does_nothing_else_whatever_it_types() {
        for code in SEATS {
            assert!(seat_key(PhysicalKey::Code(code)).is_some(), "{code:?}");
            // On AZERTY A types q, on Colemak E types f, elsewhere anything.
            for text in ["q", "Q", "f", "n", "x", "p", "b", "1", "\u{11}", ""] {
                let mut stages = [Stage::Ready, Stage::Driving, Stage::Labelling(Dialog::of_case(None))];
                for stage in &mut stages {
                    let before = stage.clone();
                    assert_eq!(wish(stage, text, code), Wish::Nothing, "{text:?} at {code:?}");
                    assert_eq!(*stage, before, "{text:?} at {code:?}");
                }
            }
        }
    }

    #[test]
    fn operators_find_their_keys_on_any_layout() {
        let wish = |text, code| wish(&mut Stage::Ready, text, code);
        assert_eq!((wish("q", KeyCode::KeyQ), wish("X", KeyCode::KeyX)), (Wish::Quit, Wish::Swap));
        assert_eq!(wish("a", KeyCode::KeyQ), Wish::Quit, "AZERTY: the letter is at a seat's key");
        assert_eq!((wish("x", KeyCode::KeyB), wish("q", KeyCode::KeyX)), (Wish::Swap, Wish::Quit), "Dvorak: by letter");
        assert_eq!((wish("т", KeyCode::KeyN), wish("", KeyCode::KeyF)), (Wish::Start, Wish::Force), "other scripts");
        assert_eq!((wish("y", KeyCode::KeyY), wish("", KeyCode::ShiftLeft)), (Wish::Nothing, Wish::Nothing));
    }

    #[test]
    fn labels_are_chosen_by_the_number_row_and_comments_are_as_typed() {
        let mut stage = Stage::Labelling(Dialog::of_case(None));
        // AZERTY: the number row types signs; Z, A and Q are where W, Q and A are elsewhere.
        let keys = [("\u{e9}", KeyCode::Digit2), ("z", KeyCode::KeyW), ("a", KeyCode::KeyQ), ("q", KeyCode::KeyA)];
        for (text, code) in keys {
            assert_eq!(wish(&mut stage, text, code), Wish::Nothing);
        }
        let said = stage.annotation().map(|annotation| (annotation.label, annotation.comment));
        assert_eq!(said, Some((replay::Label::CASES[1], "zaq".into())));
    }
}

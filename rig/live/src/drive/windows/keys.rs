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
        KeyCode::ArrowUp => Key::Up,
        KeyCode::ArrowDown => Key::Down,
        KeyCode::ArrowLeft => Key::Left,
        KeyCode::ArrowRight => Key::Right,
        KeyCode::ControlRight => Key::RightCtrl,
        KeyCode::ShiftRight => Key::RightShift,
        KeyCode::PageDown => Key::PageDown,
        _ => return None,
    })
}

/// The key of the operators, by what it types.
pub fn press(event: &KeyEvent) -> Option<Press> {
    match &event.logical_key {
        Logical::Named(NamedKey::Enter) => Some(Press::Enter),
        Logical::Named(NamedKey::Escape) => Some(Press::Escape),
        Logical::Named(NamedKey::Backspace) => Some(Press::Backspace),
        _ => event.text.as_ref().map(|text| Press::Text(text.to_string())),
    }
}

/// What a key does to the window that has the keyboard.
pub fn window_key(event: &KeyEvent) -> Option<fn(&Pane)> {
    match event.logical_key {
        Logical::Named(NamedKey::F9) => Some(Pane::span_monitors),
        Logical::Named(NamedKey::F10) => Some(Pane::to_next_monitor),
        Logical::Named(NamedKey::F11) => Some(Pane::toggle_full_screen),
        _ => None,
    }
}

//! Colours with a meaning.

use egui::Color32;

/// What needs attention.
pub const ATTENTION: Color32 = Color32::from_rgb(255, 190, 60);
/// What is wrong.
pub const WRONG: Color32 = Color32::from_rgb(255, 90, 80);
/// What is right.
pub const RIGHT: Color32 = Color32::from_rgb(110, 220, 120);

//! An image in a window.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use base::image::Image;
use egui::{Color32, Rect, Vec2};

use super::blit::{self, Filter};
use super::hud::HudText;
use super::overlay;

/// A place in a window that shows an image.
pub struct Picture {
    filter: Filter,
    /// Its texture's number.
    slot: u64,
    /// Screens side by side that the image is spread over.
    screens: usize,
}

impl Picture {
    /// For masks: every pixel keeps its class's colour.
    pub fn sharp() -> Self {
        Self::new(Filter::Sharp)
    }

    /// For images.
    pub fn smooth() -> Self {
        Self::new(Filter::Smooth)
    }

    /// The same for an image that is spread over so many screens: the HUD is on the middle one.
    pub fn over(self, screens: usize) -> Self {
        Self { screens, ..self }
    }

    fn new(filter: Filter) -> Self {
        static PICTURES: AtomicU64 = AtomicU64::new(0);
        Self { filter, slot: PICTURES.fetch_add(1, Ordering::Relaxed), screens: 1 }
    }

    /// Fills the window with the image, black where its proportions differ, and the HUD; says where the image is.
    pub fn paint_with_hud(&self, ui: &egui::Ui, image: Option<&Arc<Image>>, hud: &HudText) -> Rect {
        let rect = self.paint(ui, ui.max_rect(), image);
        let middle = Vec2::new(rect.width() / self.screens as f32, rect.height());
        overlay::paint(ui.painter(), Rect::from_center_size(rect.center(), middle), hud);
        rect
    }

    /// Puts the image into the middle of a rectangle, as large as it fits, and says where.
    pub fn paint(&self, ui: &egui::Ui, into: Rect, image: Option<&Arc<Image>>) -> Rect {
        let Some(image) = image else {
            ui.painter().rect_filled(into, 0.0, Color32::BLACK);
            return into;
        };
        let size = Vec2::new(image.width as f32, image.height as f32);
        let scale = (into.width() / size.x).min(into.height() / size.y);
        let rect = Rect::from_center_size(into.center(), scale * size);
        ui.painter().add(blit::shape(rect, self.slot, image, self.filter));
        rect
    }
}

//! An image in a window.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use egui::{Color32, Rect, Vec2};
use render::Frame;

use super::blit::{self, Filter};
use super::hud::HudText;
use super::overlay;

/// Pixels for a screen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// 3 bytes a pixel: red, green, blue; rows from top to bottom.
    pub rgb: Vec<u8>,
}

impl Image {
    /// The colours of a frame.
    pub fn of(frame: Frame) -> Self {
        Self { width: frame.width as usize, height: frame.height as usize, rgb: frame.rgb }
    }

    /// The classes of a frame in their colours.
    pub fn of_classes(frame: &Frame) -> Self {
        Self { width: frame.width as usize, height: frame.height as usize, rgb: frame.class_colours() }
    }

    /// One image of several that are equally high, left one first.
    pub fn side_by_side(images: &[Self]) -> Self {
        let width = images.iter().map(|image| image.width).sum();
        let height = images.first().map_or(0, |image| image.height);
        let mut rgb = Vec::with_capacity(3 * width * height);
        for y in 0..height {
            images.iter().for_each(|image| rgb.extend_from_slice(&image.rgb[3 * image.width * y..][..3 * image.width]));
        }
        Self { width, height, rgb }
    }

    /// This image with an equally wide one below it.
    pub fn above(mut self, below: Self) -> Self {
        self.rgb.extend(below.rgb);
        Self { height: self.height + below.height, ..self }
    }
}

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

    /// Fills the window with the image, black where its proportions differ, and the HUD.
    pub fn paint_with_hud(&self, ui: &egui::Ui, image: Option<&Arc<Image>>, hud: &HudText) {
        let rect = self.paint(ui, ui.max_rect(), image);
        let middle = Vec2::new(rect.width() / self.screens as f32, rect.height());
        overlay::paint(ui.painter(), Rect::from_center_size(rect.center(), middle), hud);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_put_together_row_by_row() {
        let image = |width: usize, shade: u8| Image { width, height: 2, rgb: vec![shade; 6 * width] };
        let row = Image::side_by_side(&[image(1, 7), image(2, 9)]);
        assert_eq!((row.width, row.height), (3, 2));
        let line = [7, 7, 7, 9, 9, 9, 9, 9, 9];
        assert_eq!(row.rgb, [line, line].concat());
        let both = row.clone().above(row);
        assert_eq!((both.width, both.height, both.rgb), (3, 4, [line; 4].concat()));
    }
}

//! An image in a window.

use std::sync::Arc;

use egui::{Color32, ColorImage, Pos2, Rect, TextureHandle, TextureOptions, Vec2};

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

/// An image as a texture.
pub struct Picture {
    options: TextureOptions,
    loaded: Option<(Arc<Image>, TextureHandle)>,
}

impl Picture {
    /// For masks: every pixel keeps its class's colour.
    pub fn sharp() -> Self {
        Self { options: TextureOptions::NEAREST, loaded: None }
    }

    /// For images.
    pub fn smooth() -> Self {
        Self { options: TextureOptions::LINEAR, loaded: None }
    }

    /// Fills the window with the image, black where its proportions differ, and the HUD.
    pub fn paint_with_hud(&mut self, ui: &egui::Ui, image: Option<&Arc<Image>>, hud: &HudText) {
        let rect = self.paint(ui, ui.max_rect(), image);
        overlay::paint(ui.painter(), rect, hud);
    }

    /// Puts the image into the middle of a rectangle, as large as it fits, and says where.
    pub fn paint(&mut self, ui: &egui::Ui, into: Rect, image: Option<&Arc<Image>>) -> Rect {
        let Some(image) = image else {
            ui.painter().rect_filled(into, 0.0, Color32::BLACK);
            return into;
        };
        let size = Vec2::new(image.width as f32, image.height as f32);
        let scale = (into.width() / size.x).min(into.height() / size.y);
        let rect = Rect::from_center_size(into.center(), scale * size);
        let texture = self.texture(ui.ctx(), image);
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        ui.painter().image(texture, rect, whole, Color32::WHITE);
        rect
    }

    fn texture(&mut self, context: &egui::Context, image: &Arc<Image>) -> egui::TextureId {
        if let Some((loaded, texture)) = &mut self.loaded {
            if !Arc::ptr_eq(loaded, image) {
                texture.set(pixels(image), self.options);
                *loaded = image.clone();
            }
            return texture.id();
        }
        let texture = context.load_texture("picture", pixels(image), self.options);
        let id = texture.id();
        self.loaded = Some((image.clone(), texture));
        id
    }
}

fn pixels(image: &Image) -> ColorImage {
    ColorImage::from_rgb([image.width, image.height], &image.rgb)
}

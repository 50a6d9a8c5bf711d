//! What the colours of a picture of classes mean: a list of those in it, and the name of the one under the mouse.

use base::image::Image;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, RichText, Stroke, StrokeKind, Ui, Vec2};
use render::SemanticTag;

/// Pixels that are looked at for the list, at most: of larger pictures every n-th.
const MOST_PIXELS: usize = 1 << 15;
/// Size of letters and of the swatch beside them.
const TEXT_SIZE: f32 = 12.0;
const SWATCH: f32 = 11.0;
const SHADE: Color32 = Color32::from_black_alpha(190);

/// The classes in a picture, those that cover most of it first.
pub fn classes(image: &Image) -> Vec<SemanticTag> {
    let pixels = image.rgb.as_chunks::<3>().0;
    // A step that has no divisor in common with the width looks at all columns.
    let least = pixels.len().div_ceil(MOST_PIXELS).max(1);
    let step = (least..).find(|step| gcd(*step, image.width) == 1).unwrap_or(1);
    let mut counts = [0_u32; SemanticTag::ALL.len()];
    for pixel in pixels.iter().step_by(step) {
        if let Some(index) = SemanticTag::ALL.iter().position(|tag| tag.colour() == *pixel) {
            counts[index] += 1;
        }
    }
    let mut found: Vec<(u32, SemanticTag)> = counts.into_iter().zip(SemanticTag::ALL.iter().copied()).collect();
    found.retain(|(count, _)| *count > 0);
    found.sort_by_key(|(count, tag)| (std::cmp::Reverse(*count), *tag));
    found.into_iter().map(|(_, tag)| tag).collect()
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The class at a place of a picture that fills a rectangle.
pub fn class_at(image: &Image, rect: Rect, at: Pos2) -> Option<SemanticTag> {
    if !rect.contains(at) {
        return None;
    }
    let share = (at - rect.min) / rect.size();
    let pixel = |share: f32, length: usize| ((share * length as f32) as usize).min(length.saturating_sub(1));
    let (x, y) = (pixel(share.x, image.width), pixel(share.y, image.height));
    let colour = image.rgb.get(3 * (y * image.width + x)..)?.first_chunk::<3>()?;
    SemanticTag::ALL.iter().copied().find(|tag| tag.colour() == *colour)
}

/// Lists classes in lines, each beside its colour.
pub fn list(ui: &mut Ui, classes: &[SemanticTag]) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = Vec2::new(4.0, 1.0);
        for tag in classes {
            let (rect, _) = ui.allocate_exact_size(Vec2::splat(SWATCH), egui::Sense::hover());
            swatch(ui.painter(), rect, *tag);
            ui.label(RichText::new(tag.name()).size(TEXT_SIZE));
            ui.add_space(6.0);
        }
    });
}

/// Names the class under the mouse beside it.
pub fn name_under_mouse(ui: &Ui, image: &Image, rect: Rect) {
    let Some(at) = ui.ctx().pointer_hover_pos() else { return };
    let Some(tag) = class_at(image, rect, at) else { return };
    column(ui.painter(), at + Vec2::new(14.0, 14.0), rect, &[tag]);
}

/// Lists classes below each other at the lower left of a picture.
pub fn column_in(painter: &Painter, rect: Rect, classes: &[SemanticTag]) {
    column(painter, Pos2::new(rect.left() + 6.0, rect.bottom() - 6.0), rect, classes);
}

/// Classes below each other from a place on, moved so far that they stay inside a rectangle.
fn column(painter: &Painter, at: Pos2, within: Rect, classes: &[SemanticTag]) {
    let galleys = classes.iter().map(|tag| {
        let font = FontId::proportional(TEXT_SIZE);
        (tag, painter.layout_no_wrap(tag.name().to_owned(), font, Color32::WHITE))
    });
    let lines: Vec<_> = galleys.collect();
    let line_height = lines.iter().map(|(_, galley)| galley.size().y).fold(SWATCH, f32::max) + 1.0;
    let width = lines.iter().map(|(_, galley)| galley.size().x).fold(0.0, f32::max) + SWATCH + 14.0;
    let size = Vec2::new(width, line_height * lines.len() as f32 + 6.0);
    let room = within.size() - size;
    let inside = (at - within.min).max(Vec2::ZERO).min(room.max(Vec2::ZERO));
    let frame = Rect::from_min_size(within.min + inside, size);
    painter.rect_filled(frame, 3.0, SHADE);
    for (i, (tag, galley)) in lines.into_iter().enumerate() {
        let middle = frame.top() + 3.0 + (i as f32 + 0.5) * line_height;
        let beside = Rect::from_center_size(Pos2::new(frame.left() + 5.0 + 0.5 * SWATCH, middle), Vec2::splat(SWATCH));
        swatch(painter, beside, *tag);
        let text = Align2::LEFT_CENTER.anchor_size(Pos2::new(beside.right() + 5.0, middle), galley.size());
        painter.galley(text.min, galley, Color32::WHITE);
    }
}

fn swatch(painter: &Painter, rect: Rect, tag: SemanticTag) {
    let [r, g, b] = tag.colour();
    painter.rect_filled(rect, 2.0, Color32::from_rgb(r, g, b));
    painter.rect_stroke(rect, 2.0, Stroke::new(1.0, Color32::from_gray(150)), StrokeKind::Inside);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(rows: &[&[SemanticTag]]) -> Image {
        let rgb: Vec<u8> = rows.iter().flat_map(|row| row.iter().flat_map(|tag| tag.colour())).collect();
        Image { width: rows[0].len(), height: rows.len(), rgb }
    }

    #[test]
    fn classes_are_listed_by_how_much_they_cover() {
        use SemanticTag::{Pedestrian, Road, Sky};
        assert_eq!(classes(&image(&[&[Sky, Road, Road], &[Road, Pedestrian, Sky]])), [Road, Sky, Pedestrian]);
        let large = image(&vec![&[Road; 512][..]; 400]);
        assert_eq!(classes(&large), [Road]);
        assert!(classes(&Image { width: 1, height: 1, rgb: vec![1, 2, 3] }).is_empty(), "no colour of a class");
    }

    /// A column of signs is found in a large picture whatever its width.
    #[test]
    fn every_column_of_a_large_picture_is_looked_at() {
        use SemanticTag::{Pole, Sky};
        for width in [512, 600, 800, 1024, 1280, 1600, 1920] {
            let row: Vec<SemanticTag> = (0..width).map(|x| if x == 77 { Pole } else { Sky }).collect();
            assert_eq!(classes(&image(&vec![&row[..]; 600])), [Sky, Pole], "{width}");
        }
    }

    #[test]
    fn the_class_at_a_place_is_that_of_its_pixel() {
        use SemanticTag::{Building, Pedestrian, Road, Sky};
        let image = image(&[&[Sky, Building], &[Road, Pedestrian]]);
        let rect = Rect::from_min_size(Pos2::new(100.0, 50.0), Vec2::new(200.0, 100.0));
        let at = |x: f32, y: f32| class_at(&image, rect, Pos2::new(x, y));
        assert_eq!([at(101.0, 51.0), at(299.0, 51.0), at(150.0, 120.0)], [Some(Sky), Some(Building), Some(Road)]);
        assert_eq!([at(300.0, 150.0), at(99.0, 60.0), at(310.0, 60.0)], [Some(Pedestrian), None, None]);
    }
}

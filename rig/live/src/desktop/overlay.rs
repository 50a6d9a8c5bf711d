//! The HUD over a driver's picture.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, StrokeKind, Vec2};
use kernel::signals::LightPhase;

use super::hud::{self, HudText};

const SHADE: Color32 = Color32::from_black_alpha(150);
const WHITE: Color32 = Color32::WHITE;
const ALARM: Color32 = Color32::from_rgb(200, 20, 30);
/// Words that are wider are broken into lines, fraction of the picture's width.
const MOST_WIDTH: f32 = 0.9;
const OFF: Color32 = Color32::from_gray(60);

/// Paints the HUD over a picture that fills a rectangle.
pub fn paint(painter: &Painter, rect: Rect, hud: &HudText) {
    let at = |[x, y]: [f32; 2]| rect.min + Vec2::new(x * rect.width(), y * rect.height());
    let font = |size: f32| FontId::proportional(size * rect.height());
    let write_on = |shade: Color32, place, anchor: Align2, text: &str, size: f32| {
        let galley = painter.layout(text.to_owned(), font(size), WHITE, MOST_WIDTH * rect.width());
        let box_ = anchor.anchor_size(at(place), galley.size());
        painter.rect_filled(box_.expand(0.15 * size * rect.height()), 0.1 * size * rect.height(), shade);
        painter.galley(box_.min, galley, WHITE);
    };
    let write = |place, anchor, text: &str, size| write_on(SHADE, place, anchor, text, size);
    if hud.is_taken_over {
        let stroke = Stroke::new(hud::FRAME_WIDTH * rect.height(), ALARM);
        painter.rect_stroke(rect, 0.0, stroke, StrokeKind::Inside);
    }
    write(hud::SPEED_AT, Align2::CENTER_CENTER, &format!("{} km/h", hud.speed), hud::SPEED_SIZE);
    let [left, right] = hud.indicators;
    let gear = format!("{left}{}{right}   {}", hud.gear, hud.control);
    write(hud::GEAR_AT, Align2::LEFT_CENTER, &gear, hud::TEXT_SIZE);
    if !hud.note.is_empty() {
        write(hud::NOTE_AT, Align2::CENTER_CENTER, &hud.note, hud::TEXT_SIZE);
    }
    if !hud.alert.is_empty() {
        write_on(ALARM, hud::ALERT_AT, Align2::CENTER_CENTER, &hud.alert, hud::TEXT_SIZE);
    }
    paint_limit(painter, at(hud::LIMIT_AT), hud, rect.height());
    paint_arrow(painter, at(hud::ARROW_AT), hud, rect.height());
    if let Some((phase, distance)) = &hud.light {
        paint_light(painter, at(hud::LIGHT_AT), *phase, rect.height());
        write(hud::LIGHT_M_AT, Align2::CENTER_CENTER, distance, hud::TEXT_SIZE);
    }
}

/// The limit as its sign.
fn paint_limit(painter: &Painter, at: Pos2, hud: &HudText, height: f32) {
    let radius = 0.05 * height;
    painter.circle_filled(at, radius, WHITE);
    painter.circle_stroke(at, 0.88 * radius, Stroke::new(0.24 * radius, Color32::from_rgb(200, 20, 30)));
    painter.text(at, Align2::CENTER_CENTER, &hud.limit, FontId::proportional(radius), Color32::BLACK);
}

/// Where the route leads.
fn paint_arrow(painter: &Painter, at: Pos2, hud: &HudText, height: f32) {
    let size = 0.045 * height;
    painter.circle_filled(at, 1.4 * size, SHADE);
    let turned = |x: f32, y: f32| {
        let (sin, cos) = hud.arrow_rad.sin_cos();
        at + size * Vec2::new(x * cos + y * sin, x * sin - y * cos)
    };
    let stroke = Stroke::new(0.28 * size, WHITE);
    painter.line_segment([turned(0.0, -1.0), turned(0.0, 0.9)], stroke);
    painter.line(vec![turned(-0.6, 0.3), turned(0.0, 1.0), turned(0.6, 0.3)], stroke);
    let below = at + Vec2::new(2.0 * size, 0.0);
    painter.text(below, Align2::LEFT_CENTER, &hud.arrow_m, FontId::proportional(hud::TEXT_SIZE * height), WHITE);
}

/// Three lamps, one of them lit.
fn paint_light(painter: &Painter, at: Pos2, phase: LightPhase, height: f32) {
    let radius = 0.035 * height;
    let gap = 2.4 * radius;
    let case = Rect::from_center_size(at, Vec2::new(1.4 * gap, 3.4 * gap));
    painter.rect_filled(case, 0.4 * radius, Color32::from_black_alpha(220));
    let lamps = [
        (LightPhase::Red, Color32::from_rgb(255, 40, 40)),
        (LightPhase::Yellow, Color32::from_rgb(255, 200, 0)),
        (LightPhase::Green, Color32::from_rgb(40, 230, 90)),
    ];
    for (i, (lamp, colour)) in lamps.into_iter().enumerate() {
        let centre = at + Vec2::new(0.0, (i as f32 - 1.0) * gap);
        painter.circle_filled(centre, radius, if lamp == phase { colour } else { OFF });
    }
}

//! The timeline of a run and the traces of both control units.

use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Sense, Stroke, Ui, Vec2};
use kernel::Controls;
use kernel::events::EventKind;
use kernel::time::{TICK_HZ, Tick};

use crate::drive::traces::{Sample, Traces, WINDOW_TICKS};

const GROUND: Color32 = Color32::from_rgb(24, 27, 30);
const AXIS: Color32 = Color32::from_rgb(60, 64, 70);
const TEXT: Color32 = Color32::from_rgb(170, 176, 184);
const SPEED: Color32 = Color32::from_rgb(255, 190, 60);
const SEMANTIC: Color32 = Color32::from_rgb(110, 200, 255);
const SAFETY: Color32 = Color32::from_rgb(255, 120, 120);
/// Speed at the upper edge of its plot, m/s.
const TOP_MPS: f32 = 30.0;
const TRACE_HEIGHT: f32 = 42.0;
const TIMELINE_HEIGHT: f32 = 44.0;
/// The timeline is at least so long.
const SHORTEST_TICKS: Tick = 30 * TICK_HZ as Tick;

/// A curve: its colour and its value in -1 to 1 or 0 to 1.
type Curve = (Color32, fn(&Sample) -> f32);

/// Speed, steering and pedals of the last seconds.
pub fn traces(ui: &mut Ui, traces: &Traces) {
    fn pedals(controls: &Controls) -> f32 {
        controls.throttle_fraction() - controls.brake_fraction()
    }
    let steer: [Curve; 2] =
        [(SEMANTIC, |s| -s.input.semantic.steer_fraction()), (SAFETY, |s| -s.input.safety.steer_fraction())];
    let pedal: [Curve; 2] = [(SEMANTIC, |s| pedals(&s.input.semantic)), (SAFETY, |s| pedals(&s.input.safety))];
    plot(ui, traces, "speed, 0 to 108 km/h", &[(SPEED, |s| 2.0 * s.speed_mps / TOP_MPS - 1.0)]);
    plot(ui, traces, "steering, left above", &steer);
    plot(ui, traces, "throttle above, brake below", &pedal);
    ui.horizontal(|ui| {
        ui.colored_label(SEMANTIC, "semantic driver");
        ui.colored_label(SAFETY, "safety driver");
        ui.colored_label(TEXT, format!("last {} s", WINDOW_TICKS / Tick::from(TICK_HZ)));
    });
}

fn plot(ui: &mut Ui, traces: &Traces, title: &str, curves: &[Curve]) {
    let (response, painter) = ui.allocate_painter(Vec2::new(ui.available_width(), TRACE_HEIGHT), Sense::hover());
    let rect = response.rect.shrink(1.0);
    painter.rect_filled(rect, 2.0, GROUND);
    painter.hline(rect.x_range(), rect.center().y, Stroke::new(1.0, AXIS));
    let at = |sample: &Sample, value: f32| {
        let age = (traces.tick - sample.tick) as f32 / WINDOW_TICKS as f32;
        Pos2::new(rect.right() - age * rect.width(), rect.center().y - 0.48 * value.clamp(-1.0, 1.0) * rect.height())
    };
    for (colour, value) in curves {
        let points = traces.samples.iter().map(|sample| at(sample, value(sample))).collect();
        painter.line(points, Stroke::new(1.5, *colour));
    }
    painter.text(rect.left_top() + Vec2::new(4.0, 1.0), Align2::LEFT_TOP, title, FontId::proportional(10.0), TEXT);
}

/// What happened when, from the start of the run to now.
pub fn timeline(ui: &mut Ui, traces: &Traces, now: Tick) {
    let (response, painter) = ui.allocate_painter(Vec2::new(ui.available_width(), TIMELINE_HEIGHT), Sense::hover());
    let rect = response.rect.shrink2(Vec2::new(2.0, 1.0));
    painter.rect_filled(rect, 2.0, GROUND);
    let length = now.max(SHORTEST_TICKS) as f32;
    let x = |tick: Tick| rect.left() + rect.width() * tick as f32 / length;
    let driven = Rect::from_min_max(rect.left_bottom() - Vec2::new(0.0, 4.0), Pos2::new(x(now), rect.bottom()));
    painter.rect_filled(driven, 0.0, TEXT);
    seconds(&painter, rect, length, x);
    for (tick, kind) in &traces.marks {
        let (colour, name) = mark(*kind);
        painter.vline(x(*tick), rect.y_range(), Stroke::new(1.5, colour));
        let at = Pos2::new(x(*tick) + 3.0, rect.top() + 1.0);
        painter.text(at, Align2::LEFT_TOP, name, FontId::proportional(10.0), colour);
    }
}

fn seconds(painter: &Painter, rect: Rect, length: f32, x: impl Fn(Tick) -> f32) {
    let length_s = (length / TICK_HZ as f32) as Tick;
    let step_s = [5, 10, 30, 60, 300, 600].into_iter().find(|step| length_s / step <= 12).unwrap_or(3600);
    for second in (0..=length_s).step_by(step_s as usize) {
        let at = Pos2::new(x(second * Tick::from(TICK_HZ)) + 2.0, rect.bottom() - 5.0);
        painter.text(at, Align2::LEFT_BOTTOM, format!("{second} s"), FontId::proportional(9.0), TEXT);
    }
}

/// Colour and name of an event.
fn mark(kind: EventKind) -> (Color32, &'static str) {
    match kind {
        EventKind::CollisionActor | EventKind::CollisionScenery => (SAFETY, "collision"),
        EventKind::RedLight => (SAFETY, "red light"),
        EventKind::Speeding => (SPEED, "speeding"),
        EventKind::OffRoad => (SPEED, "off road"),
        EventKind::WrongWay => (SPEED, "wrong way"),
        EventKind::Armed => (SEMANTIC, "armed"),
        EventKind::Intervention => (SAFETY, "intervention"),
        EventKind::Seen => (SEMANTIC, "seen"),
        EventKind::Ended => (TEXT, "end"),
        EventKind::Stuck => (TEXT, "stuck"),
        EventKind::Dissolved => (TEXT, "taken off"),
        EventKind::HazardRedLight => (TEXT, "other runs red"),
        EventKind::HazardRollingStop => (TEXT, "other rolls"),
        EventKind::HazardBraking => (TEXT, "other brakes"),
        EventKind::HazardCutIn => (TEXT, "cut-in"),
        EventKind::HazardPullOut => (TEXT, "pull-out"),
        EventKind::HazardDoor => (TEXT, "door"),
        EventKind::HazardCollision => (TEXT, "others collide"),
    }
}

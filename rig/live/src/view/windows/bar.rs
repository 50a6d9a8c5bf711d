//! The timeline: drag on it to go anywhere. Its curve is the age of the mask on the semantic driver's
//! screen.

use drivers::film::Film;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Sense, Stroke, Ui, Vec2};
use kernel::time::{TICK_HZ, Tick};

use super::colours::{ATTENTION, WRONG};
use crate::view::staleness::greatest_ages;
use crate::view::timeline::{MarkKind, Timeline, seconds};
use crate::view::viewing::{Action, Viewing};

const HEIGHT: f32 = 54.0;
/// Height of the line with seconds.
const SCALE_HEIGHT: f32 = 14.0;
/// Marks this near to the pointer are named, points.
const NEAR: f32 = 5.0;
/// Seconds between labels; the first that leaves them this far apart is taken, points.
const STEPS_S: [u64; 11] = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1800];
const LABEL_WIDTH: f32 = 60.0;

const GROUND: Color32 = Color32::from_gray(38);
const RANGE: Color32 = Color32::from_rgb(40, 95, 60);
const RANGE_END: Color32 = Color32::from_rgb(110, 220, 120);
/// The curve has no finer steps, points.
const CURVE_STEP: f32 = 2.0;
/// The age that fills the height: half a second.
const FULL_HEIGHT_TICKS: f32 = 0.5 * TICK_HZ as f32;
const CURVE: Color32 = Color32::from_rgb(95, 120, 150);
const SCALE: Color32 = Color32::from_gray(110);
const NOTE: Color32 = Color32::from_rgb(110, 170, 255);

/// Paints the timeline; where it is clicked or dragged is sought.
pub fn paint(ui: &mut Ui, viewing: &Viewing, film: &Film, actions: &mut Vec<Action>) {
    let size = Vec2::new(ui.available_width(), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let place = Place { timeline: &viewing.timeline, rect: rect.shrink2(Vec2::new(6.0, 2.0)) };
    if let Some(pointer) = response.interact_pointer_pos() {
        let tick = place.tick_at(pointer.x);
        if tick != viewing.playback.tick() {
            actions.push(Action::Seek(tick));
        }
    }
    let painter = ui.painter();
    painter.rect_filled(place.track(), 3.0, GROUND);
    range(painter, &place, viewing);
    ages(painter, &place, film);
    scale(painter, &place);
    marks(painter, &place);
    let x = place.x_of(viewing.playback.tick());
    painter.vline(x, rect.y_range(), Stroke::new(2.0, Color32::WHITE));
    if let Some(pointer) = response.hover_pos() {
        hint(painter, &place, film, pointer);
    }
}

/// Where ticks are on the screen.
struct Place<'a> {
    timeline: &'a Timeline,
    rect: Rect,
}

impl Place<'_> {
    fn x_of(&self, tick: Tick) -> f32 {
        self.rect.left() + self.timeline.fraction_of(tick) * self.rect.width()
    }

    fn tick_at(&self, x: f32) -> Tick {
        self.timeline.tick_at((x - self.rect.left()) / self.rect.width())
    }

    /// Without the line with seconds.
    fn track(&self) -> Rect {
        self.rect.with_max_y(self.rect.bottom() - SCALE_HEIGHT)
    }

    fn between(&self, from: Tick, to: Tick) -> Rect {
        self.track().with_min_x(self.x_of(from)).with_max_x(self.x_of(to))
    }
}

fn range(painter: &Painter, place: &Place<'_>, viewing: &Viewing) {
    if let Some(ticks) = viewing.range.ticks() {
        painter.rect_filled(place.between(*ticks.start(), *ticks.end()), 0.0, RANGE);
    }
    for tick in [viewing.range.from, viewing.range.to].into_iter().flatten() {
        painter.vline(place.x_of(tick), place.track().y_range(), Stroke::new(1.5, RANGE_END));
    }
}

fn ages(painter: &Painter, place: &Place<'_>, film: &Film) {
    let track = place.track();
    let ages = greatest_ages(&film.log().masks, place.timeline, (track.width() / CURVE_STEP) as usize);
    let height = |age: Tick| (age as f32 / FULL_HEIGHT_TICKS).min(1.0) * track.height();
    let step = track.width() / ages.len().max(1) as f32;
    let point =
        |(i, age): (usize, &Tick)| Pos2::new(track.left() + (i as f32 + 0.5) * step, track.bottom() - height(*age));
    painter.line(ages.iter().enumerate().map(point).collect(), Stroke::new(1.0, CURVE));
}

fn scale(painter: &Painter, place: &Place<'_>) {
    let Timeline { first, last, .. } = *place.timeline;
    let width_of = |s: u64| place.x_of(first + s * u64::from(TICK_HZ)) - place.x_of(first);
    let length_s = (last - first) / u64::from(TICK_HZ);
    let wide_enough = |step: &u64| *step > length_s || width_of(*step) >= LABEL_WIDTH;
    let step = STEPS_S.into_iter().find(wide_enough).unwrap_or(3600);
    let (from, to) = (first.div_ceil(u64::from(TICK_HZ)).next_multiple_of(step), last / u64::from(TICK_HZ));
    for second in (from..=to).step_by(step as usize) {
        let x = place.x_of(second * u64::from(TICK_HZ));
        let bottom = place.track().bottom();
        painter.vline(x, bottom - 4.0..=bottom, Stroke::new(1.0, SCALE));
        let font = FontId::proportional(10.5);
        painter.text(Pos2::new(x, bottom + 1.0), Align2::CENTER_TOP, format!("{second} s"), font, SCALE);
    }
}

fn marks(painter: &Painter, place: &Place<'_>) {
    let track = place.track();
    for mark in &place.timeline.marks {
        let x = place.x_of(mark.tick);
        let colour = colour(mark.kind);
        painter.vline(x, track.top() + 4.0..=track.bottom() - 6.0, Stroke::new(1.5, colour));
        painter.circle_filled(Pos2::new(x, track.top() + 5.0), 3.0, colour);
    }
}

/// The colour of a kind of mark.
pub fn colour(kind: MarkKind) -> Color32 {
    match kind {
        MarkKind::CornerCase => WRONG,
        MarkKind::Event => ATTENTION,
        MarkKind::Note => NOTE,
    }
}

/// The time below the pointer, and what happened there.
fn hint(painter: &Painter, place: &Place<'_>, film: &Film, pointer: Pos2) {
    let tick = place.tick_at(pointer.x);
    let near = |tick: Tick| (place.x_of(tick) - pointer.x).abs() <= NEAR;
    let marks = place.timeline.marks.iter().filter(|mark| near(mark.tick)).take(3);
    let mut texts = vec![format!("{:.2} s", seconds(tick))];
    texts.extend(film.mask_at(tick).map(|mask| format!("mask {:.0} ms old", 1e3 * seconds(mask.age_at(tick)))));
    texts.extend(marks.map(|mark| mark.text.clone()));
    let galley = painter.layout_no_wrap(texts.join("   "), FontId::proportional(12.0), Color32::WHITE);
    let half = 0.5 * galley.size().x + 4.0;
    let x = pointer.x.clamp(place.rect.left() + half, (place.rect.right() - half).max(place.rect.left() + half));
    let at = Rect::from_center_size(Pos2::new(x, place.track().center().y), galley.size());
    painter.rect_filled(at.expand(4.0), 3.0, Color32::from_black_alpha(220));
    painter.galley(at.min, galley, Color32::WHITE);
}

//! The control centre: both views, how the run is, and the dialog that labels a corner case.

use egui::{Color32, Frame, Label as Words, Margin, Panel, Rect, RichText, Ui, Vec2};
use kernel::Seat;
use kernel::arbiter::Phase;
use kernel::time::TICK_HZ;
use measures::stats;
use replay::Label;

use super::map::MapView;
use super::plots;
use crate::desktop::{Picture, hud};
use crate::drive::board::{Board, Status, Totals};
use crate::drive::stage::{Dialog, Form, Pause, Stage};
use crate::drive::strip::Strip;
use crate::drive::traces::Traces;

const ATTENTION: Color32 = Color32::from_rgb(255, 190, 60);
const ALARM: Color32 = Color32::from_rgb(255, 90, 80);
/// Height of both views, points.
const VIEWS_HEIGHT: f32 = 210.0;
const FIGURES_WIDTH: f32 = 430.0;
const MAP_WIDTH: f32 = 330.0;
const WINDOW_KEYS: &str = "; F9 all monitors, F10 next monitor, F11 full screen";

/// Panels are not filled, since the window is: filling it again is most of the work on a CPU.
fn bare() -> Frame {
    Frame::NONE.inner_margin(Margin::symmetric(8, 2))
}

/// The control centre's own pictures.
pub struct Centre {
    semantic: Picture,
    safety: Picture,
    strip: Picture,
    map: MapView,
}

impl Centre {
    /// With nothing to show yet.
    pub fn new() -> Self {
        Self { semantic: Picture::sharp(), safety: Picture::smooth(), strip: Picture::smooth(), map: MapView::new() }
    }

    /// Paints the window.
    pub fn paint(&mut self, ui: &mut Ui, status: &Status, board: &Board) {
        let traces = board.traces.get().unwrap_or_default();
        Panel::top("stage").frame(bare()).show(ui, |ui| headline(ui, status));
        Panel::right("figures").frame(bare()).exact_size(FIGURES_WIDTH).show(ui, |ui| {
            figures(ui, status);
            ui.add_space(6.0);
            plots::traces(ui, &traces);
        });
        egui::CentralPanel::default().frame(bare()).show(ui, |ui| {
            self.views(ui, board);
            plots::timeline(ui, &traces, status.tick);
            ui.horizontal_top(|ui| self.map_and_words(ui, status, board, &traces));
        });
    }

    fn views(&mut self, ui: &mut Ui, board: &Board) {
        let (rect, _) = ui.allocate_exact_size(Vec2::new(ui.available_width(), VIEWS_HEIGHT), egui::Sense::hover());
        let (left, right) = rect.split_left_right_at_fraction(0.5);
        let inner = |rect: Rect| rect.shrink(2.0);
        self.semantic.paint(ui, inner(left), board.feed.semantic.get().as_ref().map(|view| &view.image));
        self.safety.paint(ui, inner(right), board.feed.safety.get().as_ref().map(|view| &view.image));
    }

    fn map_and_words(&mut self, ui: &mut Ui, status: &Status, board: &Board, traces: &Traces) {
        let look = board.feed.scene.get();
        let size = Vec2::new(MAP_WIDTH, ui.available_height());
        self.map.paint(ui, size, look.as_deref(), traces);
        ui.vertical(|ui| match &status.stage {
            Stage::Labelling(dialog) => label_dialog(ui, dialog),
            Stage::Asking(form) => questions(ui, form),
            Stage::Ready | Stage::Driving | Stage::Paused(_) | Stage::Over => {
                ui.label(RichText::new(keys(&status.stage, status.phase, status.about.trial.is_some())).weak());
                between_runs(ui, status);
                let strip = board.strip.get();
                if strip.is_none() && status.stage == Stage::Ready {
                    status.setup.iter().for_each(|line| drop(ui.label(line)));
                }
                strip.iter().for_each(|strip| self.last_case(ui, strip));
                status.events.lines().for_each(|event| drop(ui.label(RichText::new(event).monospace())));
            }
        });
    }

    fn last_case(&self, ui: &mut Ui, strip: &Strip) {
        ui.label(RichText::new(format!("{}: 3 s, images and true classes", strip.name)).color(ATTENTION));
        let proportion = strip.image.height as f32 / strip.image.width as f32;
        let width = ui.available_width();
        let (rect, _) = ui.allocate_exact_size(Vec2::new(width, proportion * width), egui::Sense::hover());
        self.strip.paint(ui, rect, Some(&strip.image));
    }
}

/// What a plan has to say while nobody drives.
fn between_runs(ui: &mut Ui, status: &Status) {
    if !matches!(status.stage, Stage::Ready | Stage::Over) {
        return;
    }
    if let Some(link) = &status.link {
        ui.label(RichText::new(format!("Questions about the run before: {link}")).color(ATTENTION));
    }
    status.tally.iter().for_each(|line| drop(ui.label(RichText::new(line).strong())));
}

/// What the operators' keys do now.
fn keys(stage: &Stage, phase: Phase, is_planned: bool) -> String {
    let words = match (stage, phase) {
        (Stage::Ready, _) if is_planned => "N starts the run, Q quits",
        (Stage::Ready, _) => "N starts the run, X swaps the seats, Q quits",
        (Stage::Over, _) => "Q quits",
        (Stage::Driving, Phase::TakenOver) => "1 to 4 label the takeover, P pauses, B breaks the run off, Escape quits",
        (Stage::Driving, _) => "P pauses, B breaks the run off, Escape quits",
        (Stage::Paused(Pause::Ending), _) => "P drives on, B breaks the run off, Q or Escape ends the session",
        (Stage::Paused(_), _) => "P drives on, B breaks the run off, Q quits",
        (Stage::Labelling(_) | Stage::Asking(_), _) => "",
    };
    format!("{words}{WINDOW_KEYS}")
}

/// Where a run stands, in words.
fn phase(phase: Phase) -> &'static str {
    match phase {
        Phase::Arming => "arming",
        Phase::Driving => "the semantic driver drives",
        Phase::TakenOver => "the safety driver has taken over",
        Phase::Done => "over",
    }
}

fn headline(ui: &mut Ui, status: &Status) {
    let text = match &status.stage {
        Stage::Ready if status.units_note.is_some() => format!("Run {} waits for both units", status.run),
        Stage::Ready => match (crate::drive::hud::rest(status), &status.about.trial) {
            (Some(rest), _) => rest,
            (None, Some(trial)) => format!("Run {} is ready, {trial}: N starts it", status.run),
            (None, None) => format!("Run {} is ready: N starts it", status.run),
        },
        Stage::Asking(_) => "Questions for both drivers".into(),
        Stage::Over => "All trials of the plan are driven".into(),
        Stage::Driving => format!("Run {}: {}", status.run, phase(status.phase)),
        Stage::Paused(Pause::Asked) => format!("Run {}: time stands", status.run),
        Stage::Paused(Pause::UnitLost) => format!("Run {}: time stands, since a unit is lost", status.run),
        Stage::Paused(Pause::Ending) => format!("Run {}: time stands. End the session?", status.run),
        Stage::Labelling(dialog) if dialog.may_be_empty() => format!("Run {} is broken off", status.run),
        Stage::Labelling(_) => format!("Run {} has ended as a corner case", status.run),
    };
    ui.horizontal(|ui| {
        ui.label(RichText::new(text).size(22.0).strong());
        ui.add_space(20.0);
        ui.label(RichText::new(hud::control(status.steering, status.pedals)).size(22.0).color(ATTENTION));
        if let Some(alert) = status.alert.as_ref().and_then(|alert| alert.words(Seat::Safety)) {
            ui.label(RichText::new(alert).size(22.0).color(ALARM));
        }
        if status.about.is_familiarisation {
            ui.label(RichText::new("familiarisation: does not count").size(22.0));
        }
    });
}

fn figures(ui: &mut Ui, status: &Status) {
    let kmh = |mps: f32| base::words::kmh(mps.into());
    let mut lines = vec![
        ("map", status.about.map.clone()),
        ("checkpoint", status.about.checkpoint.clone()),
        ("semantic driver", status.units[0].clone()),
        ("safety driver", status.units[1].clone()),
        ("intervention from", thresholds(status)),
        ("force feedback", status.force.clone()),
        ("sound", status.sound.clone()),
        ("speed", format!("{} of {} km/h", kmh(status.hud.speed_mps), kmh(status.hud.limit_mps))),
        ("this run", exposure(status.odometer_mm, status.tick)),
        (
            "runs so far",
            format!("{}, {}", status.totals.runs, exposure(status.totals.odometer_mm, status.totals.ticks)),
        ),
        ("corner cases so far", status.totals.cases.to_string()),
        ("age of mask, image", format!("{}, {}", age(status.mask_age_us), age(status.image_age_us))),
        ("last tick was late by", format!("{:.1} ms", status.late_us as f64 / 1e3)),
    ];
    if status.totals.cases > 0 {
        lines.extend(rates(&status.totals));
    }
    if status.slowed_us > 0 {
        lines.push(("slower than real time", format!("{:.2} s so far", status.slowed_us as f64 / 1e6)));
    }
    let grid = egui::Grid::new("figures").num_columns(2).spacing([16.0, 4.0]);
    grid.max_col_width(0.5 * FIGURES_WIDTH).show(ui, |ui| {
        for (name, value) in lines {
            ui.label(name);
            ui.add(Words::new(RichText::new(value).strong()).truncate());
            ui.end_row();
        }
        for (name, controls) in [("semantic", status.input.semantic), ("safety", status.input.safety)] {
            ui.label(format!("{name} steer / throttle / brake"));
            let (steer, throttle) = (controls.steer_fraction(), controls.throttle_fraction());
            let text = format!("{steer:+.2} / {throttle:.2} / {:.2}", controls.brake_fraction());
            ui.label(RichText::new(text).monospace());
            ui.end_row();
        }
    });
}

/// Of what is on a screen.
fn age(age_us: Option<u64>) -> String {
    age_us.map_or("none yet".into(), |us| format!("{} ms", us / 1000))
}

/// What the safety driver has to do to take over.
fn thresholds(status: &Status) -> String {
    let percent = |fraction: f32| 100.0 * fraction;
    let rules = &status.about.rules;
    format!("brake {:.0} %, steering {:.0} %", percent(rules.brake_threshold), percent(rules.steer_threshold))
}

fn exposure(odometer_mm: u64, ticks: u64) -> String {
    format!("{:.2} km, {:.1} min", odometer_mm as f64 / 1e6, ticks as f64 / f64::from(60 * TICK_HZ))
}

/// Kilometres and minutes for each corner case, with exact 95 % intervals.
fn rates(totals: &Totals) -> [(&'static str, String); 2] {
    let number = u64::from(totals.cases);
    let (low, high) = stats::poisson_interval(number);
    let for_each =
        |exposure: f64| format!("{:.2} [{:.2}, {:.2}]", exposure / number as f64, exposure / high, exposure / low);
    let minutes = totals.ticks as f64 / f64::from(60 * TICK_HZ);
    [("km for each", for_each(totals.odometer_mm as f64 / 1e6)), ("minutes for each", for_each(minutes))]
}

fn label_dialog(ui: &mut Ui, dialog: &Dialog) {
    let question = if dialog.may_be_empty() { "Why is it broken off?" } else { "What kind of corner case is it?" };
    ui.label(RichText::new(question).size(18.0).color(ATTENTION));
    for (number, label) in dialog.choices() {
        let text = RichText::new(format!(" {number}  {} ", words(label))).size(16.0);
        let is_chosen = dialog.label == Some(label);
        ui.label(if is_chosen { text.background_color(ATTENTION).color(Color32::BLACK) } else { text });
    }
    let help = match dialog.label {
        None if dialog.may_be_empty() => "Press its number, or Enter: it was stopped, and what was driven counts.",
        None => "Press its number.",
        Some(_) => "Type a comment; Enter saves, Backspace in an empty comment chooses another label.",
    };
    ui.label(RichText::new(help).weak());
    ui.label(RichText::new(format!("Comment: {}_", dialog.comment)).size(16.0));
}

fn questions(ui: &mut Ui, form: &Form) {
    let ((name, question, typed), (place, last)) = (form.asks(), form.place());
    ui.label(RichText::new(format!("{name}: {}", question.words)).size(18.0).color(ATTENTION));
    ui.label(RichText::new(format!("Answer: {typed}_")).size(16.0));
    let (low, high) = (question.range.start(), question.range.end());
    let help = format!(
        "Question {place} of {last}. {low} to {high}, or nothing, and Enter; Backspace goes back; Escape ends the session."
    );
    ui.label(RichText::new(help).weak());
}

/// The four labels of the paper, and what is none of them.
fn words(label: Label) -> &'static str {
    match label {
        Label::Walker => "walker overlooked",
        Label::Vehicle => "vehicle overlooked",
        Label::Rules => "rules disregarded",
        Label::Boredom => "boredom",
        Label::DriverError => "no corner case: the driver's error (counts as driven)",
        Label::TechnicalFault => "no corner case: the rig failed (does not count)",
        Label::Discarded => "no corner case: discard the run (does not count)",
    }
}

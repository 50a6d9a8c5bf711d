//! What the window looks like: both views above, the facts and the events below them, and at the
//! bottom the timeline with its buttons.

use drivers::film::{Film, Viewpoint};
use egui::{Align, Color32, Layout, Panel, Rect, RichText, Sense, Ui, Vec2};

use super::colours::ATTENTION;
use super::{bar, facts};
use crate::desktop::{HudText, Picture, legend, overlay};
use crate::view::hud;
use crate::view::layers::Layer;
use crate::view::projector::Shown;
use crate::view::timeline::seconds;
use crate::view::viewing::{Action, FRAME_TICKS, Viewing};

const FACTS_HEIGHT: f32 = 236.0;

/// The window's pictures.
pub struct Face {
    views: [Picture; 2],
}

impl Default for Face {
    fn default() -> Self {
        Self { views: [Picture::sharp(), Picture::sharp()] }
    }
}

impl Face {
    /// Paints the window; what its buttons ask for is added to `actions`.
    pub fn paint(
        &mut self,
        ui: &mut Ui,
        viewing: &Viewing,
        film: &Film,
        shown: Option<&Shown>,
        actions: &mut Vec<Action>,
    ) {
        Panel::top("headline").show(ui, |ui| headline(ui, viewing, film));
        Panel::bottom("timeline").show(ui, |ui| {
            buttons(ui, viewing, actions);
            bar::paint(ui, viewing, film, actions);
            ui.label(if viewing.said.is_empty() { RichText::new(HELP).weak() } else { RichText::new(&viewing.said) });
        });
        Panel::bottom("facts").exact_size(FACTS_HEIGHT).show(ui, |ui| facts::paint(ui, viewing, film, shown, actions));
        egui::CentralPanel::default().show(ui, |ui| {
            ui.columns_const(|columns: &mut [Ui; 2]| {
                for (i, column) in columns.iter_mut().enumerate() {
                    self.view(column, i, viewing, shown, actions);
                }
            });
        });
    }

    /// One of the two views, below the buttons that choose what it shows.
    fn view(&mut self, ui: &mut Ui, i: usize, viewing: &Viewing, shown: Option<&Shown>, actions: &mut Vec<Action>) {
        ui.horizontal(|ui| {
            for layer in Layer::ALL {
                if ui.selectable_label(viewing.layers[i] == layer, layer.name()).clicked() {
                    actions.push(Action::Show(i, layer));
                }
            }
        });
        ui.label(RichText::new(meaning(i, viewing, shown)).weak());
        if let Some(Ok(image)) = shown.filter(|shown| shows_classes(shown, i)).map(|shown| &shown.views[i]) {
            legend::list(ui, &legend::classes(image));
        }
        let (into, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        match shown.map(|shown| &shown.views[i]) {
            Some(Ok(image)) => {
                let rect = self.views[i].paint(ui, into, Some(image));
                if let Some(hud) = shown.filter(|_| viewing.has_hud).and_then(|shown| hud(shown, i)) {
                    overlay::paint(ui.painter(), rect, &hud);
                }
                if shown.is_some_and(|shown| shows_classes(shown, i)) {
                    legend::name_under_mouse(ui, image, rect);
                }
            }
            Some(Err(reason)) => reason_instead(ui, into, reason),
            None => reason_instead(ui, into, "drawing ..."),
        }
    }
}

const HELP: &str = "Space plays   arrows step (Shift: a frame) and change speed   Page Up / Down: events   \
                    1-6, Shift 1-6: left, right view   V camera   K checkpoint   I O mark   C cut   \
                    S screenshot   H HUD   Q quits";

/// Whether the picture that is shown has the colours of classes.
fn shows_classes(shown: &Shown, i: usize) -> bool {
    shown.request.layers[i].shows_classes()
}

/// What a view's colours mean, and whose they are.
fn meaning(i: usize, viewing: &Viewing, shown: Option<&Shown>) -> String {
    let layer = viewing.layers[i];
    match layer {
        Layer::Prediction | Layer::Difference | Layer::Confidence => {
            let accuracy = shown.and_then(|shown| shown.accuracy);
            let right = accuracy.map_or_else(String::new, |share| format!(", {:.1} % of pixels right", 100.0 * share));
            format!("{}{right}: {}", viewing.checkpoint_name(), layer.legend())
        }
        _ => layer.legend().into(),
    }
}

/// The HUD belongs to what both drivers saw.
fn hud(shown: &Shown, i: usize) -> Option<HudText> {
    let is_drivers = shown.request.viewpoint == Viewpoint::Driver || shown.request.layers[i] == Layer::Seen;
    shown.moment.as_ref().filter(|_| is_drivers).map(|moment| hud::text(moment))
}

fn reason_instead(ui: &mut Ui, into: Rect, reason: &str) {
    ui.painter().rect_filled(into, 0.0, Color32::BLACK);
    let words = into.shrink(into.width().min(into.height()) / 6.0);
    let text = egui::Label::new(RichText::new(reason).color(ATTENTION)).wrap();
    ui.put(words, text);
}

fn headline(ui: &mut Ui, viewing: &Viewing, film: &Film) {
    let log = film.log();
    let kind = if log.manifest.case.is_some() { "case" } else { "recording" };
    let rest = if film.recording.finished() { "" } else { ", cut off" };
    let label = log.annotation.as_ref().map_or_else(String::new, |a| format!("   {}: {}", a.label, a.comment));
    ui.horizontal(|ui| {
        let name = film.path.file_name().unwrap_or_default().to_string_lossy();
        ui.label(RichText::new(name).size(16.0).strong());
        ui.label(format!("{kind} on {}{rest}{label}", log.manifest.scenario.map));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let (tick, last) = (viewing.playback.tick(), viewing.timeline.last);
            let text = format!("{:.2} of {:.2} s   tick {tick}", seconds(tick), seconds(last));
            ui.label(RichText::new(text).size(16.0).monospace().strong());
        });
    });
}

fn buttons(ui: &mut Ui, viewing: &Viewing, actions: &mut Vec<Action>) {
    let playback = &viewing.playback;
    let play = if playback.is_playing() { "stop" } else { "play" };
    let speed = format!("{}x", playback.speed_permille() as f64 / 1000.0);
    let camera = format!("camera: {}", viewing.viewpoint.name());
    let checkpoint = format!("checkpoint: {}", viewing.checkpoint_name());
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        let mut button = |ui: &mut Ui, text: &str, what: &str, action: Action| {
            if ui.add(egui::Button::new(text).min_size(Vec2::new(30.0, 0.0))).on_hover_text(what).clicked() {
                actions.push(action);
            }
        };
        button(ui, "|<<", "event before (Page Up)", Action::PreviousMark);
        button(ui, "<<", "a frame back (Shift Left)", Action::Step(-FRAME_TICKS));
        button(ui, "<", "a tick back (Left)", Action::Step(-1));
        button(ui, play, "Space", Action::TogglePlay);
        button(ui, ">", "a tick on (Right)", Action::Step(1));
        button(ui, ">>", "a frame on (Shift Right)", Action::Step(FRAME_TICKS));
        button(ui, ">>|", "next event (Page Down)", Action::NextMark);
        ui.separator();
        button(ui, "-", "slower (Down)", Action::Slower);
        ui.label(RichText::new(speed).monospace());
        button(ui, "+", "faster (Up)", Action::Faster);
        ui.separator();
        button(ui, &camera, "the next camera (V)", Action::NextViewpoint);
        button(ui, &checkpoint, "the next checkpoint (K)", Action::NextCheckpoint);
        ui.separator();
        button(ui, "mark in", "the range begins here (I)", Action::MarkFrom);
        button(ui, "mark out", "the range ends here (O)", Action::MarkTo);
        button(ui, "cut case", "cut the range as a case beside the file (C)", Action::Cut);
        button(ui, "screenshot", "both views as PNG beside the file (S)", Action::Screenshot);
    });
}

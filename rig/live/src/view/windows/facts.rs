//! What there is to know about the tick: the car, both drivers, the mask on the screen, and what
//! happened around it.

use drivers::film::Film;
use drivers::film::digests::hex;
use drivers::film::reel::Moment;
use drivers::film::seen::Seen;
use egui::{Color32, Grid, RichText, ScrollArea, Ui};
use kernel::time::{TICK_HZ, Tick};
use kernel::{Controls, Seat};
use replay::MaskShown;

use super::bar;
use super::colours::{ATTENTION, RIGHT, WRONG};
use crate::view::hud;
use crate::view::projector::Shown;
use crate::view::timeline::seconds;
use crate::view::viewing::{Action, Viewing};

/// Paints the facts; a click on an event seeks it.
pub fn paint(ui: &mut Ui, viewing: &Viewing, film: &Film, shown: Option<&Shown>, actions: &mut Vec<Action>) {
    ui.columns_const(|[car, mask, events]: &mut [Ui; 3]| {
        if let Some(moment) = shown.and_then(|shown| shown.moment.as_deref()) {
            car_and_drivers(car, moment);
        }
        if let Some(shown) = shown {
            on_screen(mask, film, shown);
        }
        list(events, viewing, actions);
    });
}

fn row(ui: &mut Ui, name: &str, value: impl Into<String>, colour: Color32) {
    ui.label(name);
    ui.label(RichText::new(value).color(colour).monospace());
    ui.end_row();
}

const PLAIN: Color32 = Color32::from_gray(235);

fn car_and_drivers(ui: &mut Ui, moment: &Moment) {
    let hud = &moment.hud;
    let text = hud::text(moment);
    Grid::new("car").num_columns(2).spacing([14.0, 3.0]).show(ui, |ui| {
        let is_taken = moment.applied.is_some_and(|a| a.steering == Seat::Safety || a.pedals == Seat::Safety);
        row(ui, "in control", text.control, if is_taken { ATTENTION } else { PLAIN });
        row(ui, "phase", format!("{:?}", moment.phase), PLAIN);
        let speed = format!("{:.1} of {} km/h, gear {}", 3.6 * hud.speed_mps.abs(), text.limit, text.gear);
        row(ui, "speed", speed, PLAIN);
        let light = hud.light.map_or_else(|| "none".into(), |phase| format!("{phase:?} in {} m", hud.light_distance_m));
        row(ui, "traffic light", light, PLAIN);
        row(ui, "route", format!("{:?} in {} m", hud.arrow.turn, hud.arrow.distance_m), PLAIN);
        row(ui, "driven", format!("{:.3} km", moment.odometer_mm as f64 / 1e6), PLAIN);
        row(ui, "", "steer  throttle  brake", Color32::GRAY);
        row(ui, "semantic driver", controls(&moment.input.semantic), PLAIN);
        row(ui, "safety driver", controls(&moment.input.safety), PLAIN);
        let applied = moment.applied.map_or_else(|| "-".into(), |applied| controls(&applied.controls));
        row(ui, "the car got", applied, PLAIN);
    });
}

fn controls(controls: &Controls) -> String {
    let (steer, throttle) = (controls.steer_fraction(), controls.throttle_fraction());
    format!("{steer:+.2}   {throttle:.2}      {:.2}", controls.brake_fraction())
}

/// The mask on the semantic driver's screen, and whether it is the one that was logged.
fn on_screen(ui: &mut Ui, film: &Film, shown: &Shown) {
    Grid::new("mask").num_columns(2).spacing([14.0, 3.0]).show(ui, |ui| {
        let eye = if film.eye.name.is_empty() { "not said" } else { &film.eye.name };
        row(ui, "driven through", format!("{eye}, {}x{}", film.eye.size().0, film.eye.size().1), PLAIN);
        let Some(Seen { logged, rebuilt }) = &shown.seen else {
            row(ui, "mask on the screen", "none", Color32::GRAY);
            return;
        };
        row(ui, "mask of tick", logged.tick_of_frame.to_string(), PLAIN);
        row(ui, "shown since tick", logged.tick_shown.to_string(), PLAIN);
        row(ui, "its age", age(logged, shown.request.tick), PLAIN);
        if let Some(times) = &logged.times {
            let ms = |from: u64, to: u64| to.saturating_sub(from) as f64 / 1e3;
            let text = format!(
                "{:.0} ms, {:.0} of them to predict",
                ms(times.capture_us, times.present_us),
                ms(times.capture_us, times.inference_us)
            );
            row(ui, "scene to screen", text, PLAIN);
        }
        row(ui, "logged digest", hex(logged.digest), PLAIN);
        match rebuilt {
            Some(digest) if *digest == logged.digest => row(ui, "made again", format!("{} equal", hex(*digest)), RIGHT),
            Some(digest) => row(ui, "made again", format!("{} DIFFERENT", hex(*digest)), WRONG),
            None => row(ui, "made again", "in the layer \"seen\"", Color32::GRAY),
        }
    });
}

/// Only changes of the mask are logged: where the picture stood still, the true age is less.
fn age(logged: &MaskShown, tick: Tick) -> String {
    let ticks = logged.age_at(tick);
    format!("{ticks} ticks, {:.0} ms", 1000.0 * ticks as f64 / f64::from(TICK_HZ))
}

fn list(ui: &mut Ui, viewing: &Viewing, actions: &mut Vec<Action>) {
    if viewing.timeline.marks.is_empty() {
        ui.label(RichText::new("no events").weak());
    }
    let now = viewing.playback.tick();
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for mark in &viewing.timeline.marks {
            let text = RichText::new(format!("{:7.2} s  {}", seconds(mark.tick), mark.text)).monospace();
            let line = ui.selectable_label(mark.tick == now, text.color(bar::colour(mark.kind)));
            if line.clicked() {
                actions.push(Action::Seek(mark.tick));
            }
        }
    });
}

//! How the session is, gathered from those of its parts that have something to show.

use kernel::Seat;

use super::display::Display;
use super::pace::Pace;
use super::rest::Rest;
use super::runs::Runs;
use super::sights::Sights;
use super::voice::Voice;
use crate::drive::board::{About, Status};
use crate::drive::force::Force;
use crate::drive::seating::Seating;
use crate::speakers::Sound;

/// The parts of a session that have something to show.
pub struct Parts<'a> {
    pub rest: &'a Rest,
    pub link: Option<&'a String>,
    pub seating: &'a Seating,
    pub force: &'a Force,
    pub sound: &'a Sound,
    pub voice: &'a Voice,
    pub display: &'a Display,
    pub runs: &'a Runs,
    pub pace: &'a Pace,
    pub sights: &'a Sights,
}

impl Parts<'_> {
    /// How the session is; nothing where no run is on and none waits.
    pub fn status(&self) -> Option<Status> {
        let Self { rest, link, seating, force, sound, voice, display, runs, pace, sights } = self;
        let world = runs.world()?;
        let now_us = pace.now_us();
        let applied = display.last().map(|output| output.applied);
        let seat = |by: Option<Seat>| by.unwrap_or(Seat::Semantic);
        let age_us = |of_us: Option<u64>| of_us.filter(|_| runs.is_driving()).map(|us| now_us.saturating_sub(us));
        let [mask_age_us, image_age_us] = sights.captured_us().map(age_us);
        Some(Status {
            stage: runs.stage.clone(),
            run: runs.number(),
            tick: world.tick(),
            hud: world.hud(),
            phase: world.arbiter().phase,
            steering: seat(applied.map(|a| a.steering)),
            pedals: seat(applied.map(|a| a.pedals)),
            flags: applied.map_or(0, |a| a.controls.flags),
            input: display.input,
            odometer_mm: world.odometer_mm(),
            totals: runs.totals(),
            tally: runs.tally().clone(),
            rest_s: rest.left_s(now_us),
            link: link.cloned(),
            alert: display.alert(world.tick()).cloned(),
            late_us: pace.schedule().late_us(),
            slowed_us: pace.schedule().slowed_us(),
            mask_age_us,
            image_age_us,
            events: voice.events().clone(),
            units: operators(runs.about(), seating),
            units_note: seating.note(),
            setup: seating.setup(),
            force: force.words(),
            sound: sound.words(),
            about: runs.about().clone(),
        })
    }
}

/// Who sits in the seats, as far as that is to be known, and how their units are.
fn operators(about: &About, seating: &Seating) -> [String; 2] {
    let [semantic, safety] = seating.words();
    let [named, other] = seating.seated(about.operators.clone());
    let with = |name: Option<String>, unit: String| name.map_or(unit.clone(), |name| format!("{name}, {unit}"));
    [with(named, semantic), with(other, safety)]
}

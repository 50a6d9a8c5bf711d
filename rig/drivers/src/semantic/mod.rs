//! The simulated semantic driver: a function of the mask, the HUD and the little it remembers of them.

pub mod arc;
mod aside;
mod backing;
mod coming;
mod crossing;
mod flank;
mod memory;
mod moved;
pub mod path;
mod pedals;
pub mod sight;
pub mod speed;
mod squeeze;
#[cfg(test)]
mod tests;
mod tracks;

use kernel::map::Turn;
use kernel::signals::LightPhase;
use kernel::time::{TICK_S, Tick};
use kernel::{Controls, Seat};

use super::{Driver, SemanticView};
use crate::temper::Temper;
use crate::vision::FRAME_TICKS;
use crate::{indicate, single_track};
use arc::Arc;
use aside::Course;
use backing::Backing;
use memory::{Ahead, Dash, Patience, Reading, Room, Trail};
use moved::{Lag, Moved};
use pedals::{Foot, Nose};
use sight::{Contact, Sight};
use speed::{Scene, Wish};
use squeeze::{SQUEEZING_MPS, Squeeze, Way};
use tracks::Tracks;

/// Fastest turning of the steering wheel, fractions of full steering a second.
const STEER_RATE: f32 = 1.6;
/// Distance to a junction within which a light that is no longer shown was its own, metres.
const PASSED_LIGHT_M: f32 = 10.0;
/// The car waits for what it would have to stand before within this, metres.
const IN_THE_WAY_M: f32 = 3.0;
/// Slower than this it may be driving off beside somebody whom it no longer sees, m/s.
const CREEPING_MPS: f32 = 3.0;

/// Drives by the mask and the HUD alone.
#[derive(Clone, Debug, Default)]
pub struct SemanticBot {
    temper: Temper,
    /// Steering of the last tick, [-1, 1], positive to the right.
    steer: f32,
    foot: Foot,
    nose: Nose,
    /// How far the nose was down in the picture of the mask that was looked at last, radians.
    down_rad: f32,
    lag: Lag,
    reading: Reading,
    trail: Trail,
    tracks: Tracks,
    people: Tracks,
    patience: Patience,
    room: Room,
    squeeze: Squeeze,
    backing: Backing,
    /// Somebody or something stood in the way of the car when it looked last.
    is_blocked: bool,
    has_lights: bool,
    /// The mask that was looked at last, how long ago, and where others stood in it.
    ids: Vec<u8>,
    looked_ticks: Tick,
    contacts: Vec<Contact>,
}

impl Driver<SemanticView<'_>> for SemanticBot {
    fn controls(&mut self, view: &SemanticView<'_>) -> Controls {
        let is_new = self.ids != view.mask.ids;
        if is_new {
            self.down_rad = self.nose.down_rad();
        }
        let sight = Sight::new(view.mask, self.down_rad);
        let (arc, wish) = self.decide(&sight, view, is_new);
        if self.backing.is_on() {
            self.steer = follow(self.steer, 0.0);
            self.nose.dip(0.0, 0.0, view.hud.speed_mps());
            return Backing::controls(self.steer, view.hud.speed_mps());
        }
        self.steer = follow(self.steer, single_track::steering(arc.curvature));
        let (throttle, brake) = self.foot.press(view.hud.speed_mps(), &wish, self.temper.reaction_factor());
        self.nose.dip(throttle, brake, view.hud.speed_mps());
        Controls { flags: indicate::turn(&view.hud), ..Controls::from_fractions(self.steer, throttle, brake) }
    }
}

impl SemanticBot {
    /// Who sits there in the run of a seed.
    pub fn drawn(seed: u64) -> Self {
        Self::of_temper(Temper::drawn(seed, Seat::Semantic))
    }

    /// Somebody of a temper; [`SemanticBot::default`] is attentive.
    pub fn of_temper(temper: Temper) -> Self {
        Self { temper, ..Self::default() }
    }

    /// Takes in the view: where to steer, and how fast to go.
    fn decide(&mut self, sight: &Sight<'_>, view: &SemanticView<'_>, is_new: bool) -> (Arc, Wish) {
        let forward_mps = if self.backing.is_on() { -view.hud.speed_mps() } else { view.hud.speed_mps() };
        let moved = Moved::along(Arc { curvature: single_track::curvature(self.steer) }, forward_mps);
        self.lag.push(moved);
        let dash = self.reading.read(&view.hud, moved);
        self.trail.extend(moved, path::arrow_point(dash.bearing_deg));
        self.tracks.carry(moved);
        self.people.carry(moved);
        self.room.carry(moved);
        let waits = self.is_blocked && dash.light.is_none_or(|light| light == LightPhase::Green);
        self.squeeze.carry(moved, waits);
        self.backing.carry(moved, waits && self.squeeze.way().is_none() && backing::is_close(&self.contacts));
        let arc = path::choose(sight, &dash, &self.trail);
        self.looked_ticks += 1;
        // Nothing moves in the picture of a car that stands before a parked one, and yet it is a new picture.
        let stands_still = view.hud.speed_kmh == 0 && self.looked_ticks >= FRAME_TICKS;
        if is_new {
            self.look(sight, view.mask.ids);
            self.make_room(sight, self.course(sight, arc), &dash);
        } else if stands_still {
            self.track();
            self.make_room(sight, self.course(sight, arc), &dash);
        }
        let steered = self.course(sight, arc).steered;
        // A light leaves the HUD once its line is passed, but the junction still has it.
        self.has_lights = dash.light.is_some() || (self.has_lights && dash.junction_m < PASSED_LIGHT_M);
        // Lights keep crossing traffic away, but not the oncoming one that a left turn crosses.
        let gives_way = !self.has_lights || dash.turn == Turn::Left;
        let give_way_m = if gives_way { crossing::give_way_m(arc, &dash, &self.tracks) } else { None };
        let give_way_m = self.patience.keep(give_way_m, moved);
        let after_turn_m = speed::after_turn_m(&self.contacts, &self.tracks, arc, &dash);
        let others_m = [self.room.stop_in_m(), self.beside_m(steered, &dash), self.coming_m(arc, &dash)];
        let obstacle_m = others_m.into_iter().flatten().reduce(f32::min);
        let scene = Scene { obstacle_m, after_turn_m, give_way_m, has_lights: self.has_lights };
        let vigour = self.temper.vigour();
        match self.squeeze.way() {
            None => {
                let limit_mps = dash.limit_mps.min(self.squeeze.narrow_mps(steered));
                (steered, speed::wish(sight, arc, &Dash { limit_mps, ..dash }, scene, vigour))
            }
            Some(Way { arc, free_m }) => {
                let slow = Dash { limit_mps: SQUEEZING_MPS, ..dash };
                let obstacle_m = self.crosses_m(arc, SQUEEZING_MPS).into_iter().fold(free_m, f32::min);
                let wish = speed::wish(sight, arc, &slow, Scene { obstacle_m: Some(obstacle_m), ..scene }, vigour);
                (arc, Wish { expects_others: true, ..wish })
            }
        }
    }

    /// Where the car goes by the mask that was looked at last.
    fn course(&self, sight: &Sight<'_>, arc: Arc) -> Course {
        Course::aside(sight, arc, &self.contacts, &self.tracks)
    }

    /// Metres from the front of the car to where it must stand because of those who come towards it.
    fn coming_m(&self, arc: Arc, dash: &Dash) -> Option<f32> {
        coming::coming_m(arc, dash.speed_mps, &self.tracks)
    }

    /// Metres from the front of the car to where it must stand because of those who will be in its way.
    fn crosses_m(&self, arc: Arc, speed_mps: f32) -> Option<f32> {
        let walks = crossing::walkers_m(&self.people, arc, speed_mps);
        let drives = crossing::vehicles_m(&self.tracks, arc, speed_mps);
        walks.into_iter().chain(drives).reduce(f32::min)
    }

    /// The same, while the car creeps or drives off, because of what it no longer sees beside it.
    fn beside_m(&self, arc: Arc, dash: &Dash) -> Option<f32> {
        self.squeeze.beside_m(arc).filter(|_| dash.speed_mps < CREEPING_MPS)
    }

    /// Takes in a new mask.
    fn look(&mut self, sight: &Sight<'_>, ids: &[u8]) {
        self.ids.clear();
        self.ids.extend_from_slice(ids);
        let now = |seen: Contact| {
            let (x_m, y_m) = self.lag.now((seen.x_m, seen.y_m));
            Contact { x_m, y_m, ..seen }
        };
        self.contacts = sight.contacts().into_iter().map(now).collect();
        self.track();
    }

    /// How those move who are seen in the mask that was looked at last; an unchanged one says that nobody in it did.
    fn track(&mut self) {
        self.tracks.look(self.contacts.iter().filter(|contact| !contact.is_person));
        self.people.look(self.contacts.iter().filter(|contact| contact.is_person));
    }

    /// What stands in the way by the mask that was looked at last.
    fn make_room(&mut self, sight: &Sight<'_>, course: Course, dash: &Dash) {
        self.looked_ticks = 0;
        let Course { wanted: arc, steered } = course;
        let stands = speed::obstacle(&self.contacts, &self.tracks, course, dash.speed_mps);
        let beside_m = self.beside_m(steered, dash);
        self.is_blocked = stands.map(|ahead| ahead.stop_in_m).into_iter().chain(beside_m).any(|m| m < IN_THE_WAY_M);
        let crosses = self.crosses_m(arc, dash.speed_mps).map(Ahead::standing);
        self.room.look(stands.into_iter().chain(crosses).reduce(Ahead::nearer));
        self.squeeze.look(sight, &self.contacts, &[&self.tracks, &self.people], arc);
    }
}

/// Turns the wheel towards the wanted angle as fast as hands do.
fn follow(steer: f32, wanted: f32) -> f32 {
    steer + (wanted - steer).clamp(-STEER_RATE * TICK_S, STEER_RATE * TICK_S)
}

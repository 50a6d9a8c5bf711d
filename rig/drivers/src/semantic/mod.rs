//! The simulated semantic driver: a function of the mask, the HUD and the little it remembers of them.

pub mod arc;
mod memory;
pub mod path;
pub mod sight;
pub mod speed;
#[cfg(test)]
mod tests;

use kernel::Controls;
use kernel::map::Turn;
use kernel::time::TICK_S;

use super::{Driver, SemanticView};
use crate::vision::LATENCY_TICKS;
use crate::{indicate, single_track};
use arc::Arc;
use memory::{Moved, Patience, Room, Tracks, Trail};
use sight::{Contact, Sight};
use speed::{COMFORT_MPS2, SPEED_TIME_S, Scene, Wish};

/// Fastest turning of the steering wheel, fractions of full steering a second.
const STEER_RATE: f32 = 1.6;
/// Acceleration at full throttle and deceleration at full brake, m/s^2.
const FULL_THROTTLE_MPS2: f32 = 4.0;
const FULL_BRAKE_MPS2: f32 = 8.4;

/// Drives by the mask and the HUD alone.
#[derive(Clone, Debug, Default)]
pub struct SemanticBot {
    /// Steering of the last tick, [-1, 1], positive to the right.
    steer: f32,
    trail: Trail,
    tracks: Tracks,
    people: Tracks,
    patience: Patience,
    room: Room,
    has_lights: bool,
    /// The mask that was looked at last, and where others stood in it.
    ids: Vec<u8>,
    contacts: Vec<Contact>,
}

impl Driver<SemanticView<'_>> for SemanticBot {
    fn controls(&mut self, view: &SemanticView<'_>) -> Controls {
        let sight = Sight::new(view.mask);
        let (arc, wish) = self.decide(&sight, view);
        self.steer = follow(self.steer, single_track::steering(arc.curvature));
        let (throttle, brake) = pedals(view.hud.speed_mps, &wish);
        let flags = indicate::turn(&view.hud.arrow);
        Controls { flags, ..Controls::from_fractions(self.steer, throttle, brake) }
    }
}

impl SemanticBot {
    /// Takes in the view: where to steer, and how fast to go.
    pub fn decide(&mut self, sight: &Sight<'_>, view: &SemanticView<'_>) -> (Arc, Wish) {
        let moved = Moved::along(Arc { curvature: single_track::curvature(self.steer) }, view.hud.speed_mps);
        self.trail.extend(moved, path::arrow_point(&view.hud.arrow));
        self.tracks.carry(moved);
        self.people.carry(moved);
        self.room.carry(moved);
        let arc = path::choose(sight, &view.hud, &self.trail);
        if self.ids != view.mask.ids {
            self.ids.clear();
            self.ids.extend_from_slice(view.mask.ids);
            self.contacts = sight.contacts();
            self.tracks.look(self.contacts.iter().filter(|contact| !contact.is_person));
            self.people.look(self.contacts.iter().filter(|contact| contact.is_person));
            // The picture of a new mask is that old.
            let driven_m = view.hud.speed_mps * LATENCY_TICKS as f32 * TICK_S;
            let stands_m = speed::obstacle_m(&self.contacts, arc).map(|seen_m| seen_m - driven_m);
            let walks_m = speed::crossing_m(&self.people, arc, view.hud.speed_mps);
            self.room.look(stands_m.into_iter().chain(walks_m).reduce(f32::min));
        }
        // A light leaves the HUD once its line is passed, but the junction still has it.
        self.has_lights = view.hud.light.is_some() || (self.has_lights && view.hud.arrow.distance_m < 10);
        // Lights keep crossing traffic away, but not the oncoming one that a left turn crosses.
        let gives_way = !self.has_lights || view.hud.arrow.turn == Turn::Left;
        let give_way_m = if gives_way { speed::give_way_m(arc, &view.hud, &self.tracks) } else { None };
        let give_way_m = self.patience.keep(give_way_m, moved);
        let scene = Scene { obstacle_m: self.room.ahead_m(), give_way_m, has_lights: self.has_lights };
        (arc, speed::wish(sight, arc, &view.hud, scene))
    }
}

/// Turns the wheel towards the wanted angle as fast as hands do.
fn follow(steer: f32, wanted: f32) -> f32 {
    steer + (wanted - steer).clamp(-STEER_RATE * TICK_S, STEER_RATE * TICK_S)
}

/// Throttle and brake for a wish.
fn pedals(speed_mps: f32, wish: &Wish) -> (f32, f32) {
    let towards = |wanted_mps: f32| (wanted_mps - speed_mps) / SPEED_TIME_S;
    let safe_mps = wish.stop_in_m.map_or(f32::INFINITY, speed::safe_mps);
    let needed_mps2 = wish.stop_in_m.map_or(0.0, |d| speed_mps * speed_mps / (2.0 * d.max(0.3)));
    // Comfortable as long as that is enough, then as hard as the distance that is left asks for.
    let by_stop = towards(safe_mps).max(-needed_mps2.max(COMFORT_MPS2));
    let acceleration = towards(wish.speed_mps).clamp(-4.0, 2.5).min(by_stop);
    if wish.speed_mps.min(safe_mps) < 0.3 && speed_mps < 0.5 {
        return (0.0, 0.5);
    }
    if acceleration >= 0.0 { (acceleration / FULL_THROTTLE_MPS2, 0.0) } else { (0.0, -acceleration / FULL_BRAKE_MPS2) }
}

//! Vehicles that run into each other: because of a mistake, or for all their braking.

use crate::events::EventKind;

use super::actors::Actors;
use super::body::{Body, Surroundings};
use super::hazard::Hazard;
use super::lapse::Lapse;
use super::passage::Told;
use super::vehicle::Vehicle;
use super::watchdog::STUCK_S;

/// Nobody farther away is touched, metres.
const NEAR_M: f32 = 12.0;
/// Touching by less than this is none, metres.
const SKIN_M: f32 = 0.025;
/// Who runs into somebody without a mistake of his own brakes harder than this, cm/s²: he has noticed too late.
const TOO_LATE_CMPS2: i16 = -300;

impl Actors {
    /// Whoever makes a mistake, or brakes too late, and touches another vehicle stands from then on, and so does that. The
    /// watchdog takes them off the road after a minute.
    pub(super) fn crash(&mut self, around: &Surroundings<'_>, told: &mut Vec<Told>) {
        let vehicles = &self.state.vehicles;
        let late = |v: &Vehicle| v.speed_mps > 0.0 && v.accel_cmps2 < TOO_LATE_CMPS2;
        let endangers = |v: &Vehicle| (v.lapse.endangers() || late(v)) && !around.holds(v.id);
        let mut crashed = Vec::new();
        for (i, _) in vehicles.iter().enumerate().filter(|(_, v)| endangers(v)) {
            let meets = |k: usize| k != i && !around.holds(vehicles[k].id) && touches(&self.bodies[i], &self.bodies[k]);
            crashed.extend((0..vehicles.len()).filter(|k| meets(*k)).flat_map(|k| [i, k]));
        }
        crashed.sort_unstable();
        crashed.dedup();
        for i in crashed {
            let vehicle = &mut self.state.vehicles[i];
            if vehicle.lapse != Lapse::Crashed {
                (vehicle.lapse, vehicle.stuck_s) = (Lapse::Crashed, STUCK_S + 1);
                told.push((EventKind::HazardCollision, u32::from(vehicle.id)));
            }
        }
    }
}

fn touches(a: &Body, b: &Body) -> bool {
    let near = a.position.distance_squared(b.position) < NEAR_M * NEAR_M;
    let box_of = Hazard::of_body(a);
    near && box_of.is_level_with(b.position.z) && box_of.is_within(&Hazard::of_body(b), -2.0 * SKIN_M)
}

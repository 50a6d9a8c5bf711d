//! Vehicles that run into each other: because of a mistake, for all their braking, or because nobody saw it coming.

use crate::events::EventKind;

use super::actors::Actors;
use super::body::{Body, Surroundings};
use super::hazard::Hazard;
use super::hazards::Hazards;
use super::lapse::Lapse;
use super::passage::Told;
use super::vehicle::Vehicle;
use super::watchdog::STUCK_S;

/// In a tick nobody comes nearer to another than by this, metres.
const MOVED_M: f32 = 2.0;
/// Touching by less than this is none, metres.
const SKIN_M: f32 = 0.025;
/// Who brakes harder than this is looked at in every tick, cm/s²: he may have noticed too late.
const TOO_LATE_CMPS2: i16 = -300;

impl Actors {
    /// Whoever touches another vehicle stands from then on, and so does that. The watchdog takes them off the road after a
    /// minute. `hazards` are those of before the tick.
    pub(super) fn crash(&mut self, hazards: &Hazards, around: &Surroundings<'_>, told: &mut Vec<Told>) {
        let mut crashed = Vec::new();
        for (i, vehicle) in self.state.vehicles.iter().enumerate() {
            if looks(vehicle, around) {
                let touched = self.touched(i, hazards, around);
                crashed.extend(touched.flat_map(|k| [i, k]));
            }
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

    /// The vehicles of traffic that one touches.
    fn touched<'a>(
        &'a self,
        index: usize,
        hazards: &'a Hazards,
        around: &'a Surroundings<'_>,
    ) -> impl Iterator<Item = usize> + 'a {
        let (vehicles, body) = (&self.state.vehicles, &self.bodies[index]);
        let reach_m = body.kind.size_m().truncate().length() * 0.5 + MOVED_M;
        let driven = |id: u32| vehicles.binary_search_by_key(&id, |v| u32::from(v.id)).ok();
        let near = hazards.reaching(body.position, reach_m).filter_map(move |hazard| driven(hazard.id));
        let meets = move |k: &usize| *k != index && !around.holds(vehicles[*k].id);
        near.filter(move |k| meets(k) && touches(body, &self.bodies[*k]))
    }
}

/// Whether it is looked at in a tick whom a vehicle touches: when it moves and decides, and while it is likely to.
fn looks(vehicle: &Vehicle, around: &Surroundings<'_>) -> bool {
    let late = vehicle.speed_mps > 0.0 && vehicle.accel_cmps2 < TOO_LATE_CMPS2;
    let likely = late || vehicle.lapse.endangers();
    let moves = vehicle.speed_mps > 0.0 && vehicle.decides(around.tick);
    (likely || moves) && !around.holds(vehicle.id)
}

fn touches(a: &Body, b: &Body) -> bool {
    let box_of = Hazard::of_body(a);
    box_of.is_level_with(b.position.z) && box_of.is_within(&Hazard::of_body(b), -2.0 * SKIN_M)
}

//! Vehicles that run into each other because of a mistake.

use glam::{Vec2, Vec3};

use crate::events::EventKind;
use crate::geometry::rectangles_overlap;

use super::actors::Actors;
use super::body::{Body, Surroundings};
use super::lapse::Lapse;
use super::passage::Told;
use super::vehicle::Vehicle;
use super::watchdog::STUCK_S;

/// Nobody farther away is touched, metres.
const NEAR_M: f32 = 12.0;
/// Nor anybody at another level, metres.
const LEVEL_M: f32 = 2.0;
/// Touching by less than this is none, metres.
const SKIN_M: f32 = 0.025;

impl Actors {
    /// Whoever makes a mistake and touches another vehicle stands from then on, and so does that. The watchdog takes
    /// them off the road after a minute.
    pub(super) fn crash(&mut self, around: &Surroundings<'_>, told: &mut Vec<Told>) {
        let first = told.len();
        let vehicles = &self.state.vehicles;
        let endangers = |v: &Vehicle| v.lapse != Lapse::None && v.lapse != Lapse::Crashed && !around.holds(v.id);
        for (i, _) in vehicles.iter().enumerate().filter(|(_, v)| endangers(v)) {
            for (k, other) in vehicles.iter().enumerate() {
                let meets = k != i && !around.holds(other.id) && touches(&self.bodies[i], &self.bodies[k]);
                if meets {
                    told.extend([i, k].map(|at| (EventKind::HazardCollision, u32::from(vehicles[at].id))));
                }
            }
        }
        for at in first..told.len() {
            let id = told[at].1;
            if let Some(vehicle) = self.state.vehicles.iter_mut().find(|v| u32::from(v.id) == id) {
                vehicle.stuck_s = if vehicle.lapse == Lapse::Crashed { vehicle.stuck_s } else { STUCK_S + 1 };
                vehicle.lapse = Lapse::Crashed;
            }
        }
        let found = told.split_off(first);
        let new = found.iter().enumerate().filter(|(k, one)| !found[..*k].contains(one));
        told.extend(new.map(|(_, one)| *one));
        told[first..].sort_unstable_by_key(|(_, id)| *id);
    }
}

fn touches(a: &Body, b: &Body) -> bool {
    let to = b.position - a.position;
    if to.length_squared() > NEAR_M * NEAR_M || to.z.abs() > LEVEL_M {
        return false;
    }
    let [forward, axis] = [a, b].map(|body| (body.rotation * Vec3::X).truncate());
    let turned = |v: Vec2| Vec2::new(v.dot(forward), forward.perp_dot(v));
    let half = |body: &Body| body.kind.size_m().truncate() * 0.5 - SKIN_M;
    rectangles_overlap(half(a), turned(to.truncate()), turned(axis), half(b))
}

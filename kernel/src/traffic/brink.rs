//! The last look: who is slow and would touch another vehicle, or somebody on the road, where it comes to a stand steers straight
//! on or brakes as hard as can be. All else that keeps vehicles apart looks along lanes; this looks at boxes, tails that swing
//! out among them.

use glam::{Vec2, Vec3};

use crate::geometry::rectangles_overlap;
use crate::time::TICK_S;

use super::body::Body;
use super::drive::{View, turns_in_m};
use super::hazard::Hazard;
use super::vehicle::{DECIDE_TICKS, Vehicle};

/// Who is faster takes no last look, m/s.
const SLOW_MPS: f32 = 7.0;
/// Room to others, metres: who has more keeps that.
const ROOM_M: [f32; 3] = [0.12, 0.04, 0.0];
/// Who starts looks so far ahead, metres.
const START_M: f32 = 0.12;
/// Others at heights farther apart than this are on another road, metres.
const LEVEL_M: f32 = 2.0;

impl View<'_> {
    /// What is left of the acceleration that a driver wants, m/s²: who would touch somebody steers straight on, if that is
    /// enough, and brakes else.
    pub(super) fn last_look(&self, index: usize, next: &mut Vehicle, accel_mps2: f32) -> f32 {
        let (driver, mps) = (&self.drivers[index], next.speed_mps);
        if mps > SLOW_MPS || (mps == 0.0 && accel_mps2 <= 0.0) {
            return accel_mps2;
        }
        let stop_s = mps / driver.hardest_mps2 + f32::from(DECIDE_TICKS) * TICK_S;
        let ahead_m = START_M + mps * 0.5 * (stop_s + f32::from(DECIDE_TICKS) * TICK_S);
        let now = &self.bodies[index];
        let half_m = 0.5 * driver.size_m.truncate().length();
        let around = self.hazards.reaching(now.position, half_m + ahead_m + ROOM_M[0]);
        let level = |h: &&Hazard| (h.position.z - now.position.z).abs() < LEVEL_M;
        let mut others = around.filter(|h| h.vehicle != Some(index as u32)).filter(level).peekable();
        if others.peek().is_none() {
            return accel_mps2;
        }
        let others: Vec<_> = others.flat_map(|h| [*h, h.after(stop_s)]).collect();
        let touches = |drift: [i8; 2], room_m: &[f32]| {
            let then = self.rolled(index, next, ahead_m, drift);
            others.iter().any(|other| room_m.iter().any(|m| is_within(&then, other, *m) && !is_within(now, other, *m)))
        };
        let straight = straightened(next.drift, (ahead_m / turns_in_m(driver)) as i8);
        if !touches([next.drift; 2], &ROOM_M) {
            accel_mps2
        } else if next.drift != 0 && !touches([next.drift, straight], &ROOM_M[1..]) {
            next.drift_aim = 0;
            accel_mps2
        } else {
            -driver.hardest_mps2
        }
    }

    /// A vehicle so far ahead on its way, that drifts by the first now and by the second there.
    fn rolled(&self, index: usize, vehicle: &Vehicle, ahead_m: f32, drift: [i8; 2]) -> Body {
        let driver = &self.drivers[index];
        let mut then = *vehicle;
        then.s_m += ahead_m;
        self.change_lane(driver, &mut then);
        then.drift = drift[1];
        then.offset_m += 0.5 * (f32::from(drift[0]) + f32::from(drift[1])) * 0.01 * ahead_m;
        self.ways.vehicle_body(self.seed, &then, driver)
    }
}

/// What is left of a drift after one has steered straight on by so much.
fn straightened(drift: i8, steered: i8) -> i8 {
    drift - drift.clamp(-steered, steered)
}

/// Whether another is nearer to a vehicle than `room_m`.
fn is_within(body: &Body, other: &Hazard, room_m: f32) -> bool {
    let forward = (body.rotation * Vec3::X).truncate().normalize_or(Vec2::X);
    let turned = |v: Vec2| Vec2::new(v.dot(forward), forward.perp_dot(v));
    let way = (other.position - body.position).truncate();
    rectangles_overlap(body.kind.size_m().truncate() * 0.5 + room_m, turned(way), turned(other.forward), other.half)
}

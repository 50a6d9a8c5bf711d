//! The last look: whoever would touch somebody on the way to a stand brakes as hard as can be. All else that keeps vehicles
//! apart looks along lanes; this looks at boxes, tails that swing out among them.

use glam::{Vec2, Vec3};

use crate::geometry::rectangles_overlap;
use crate::time::TICK_S;

use super::body::Body;
use super::drive::View;
use super::hazard::Hazard;
use super::vehicle::{DECIDE_TICKS, Vehicle};

/// Who is faster looks farther ahead than this does, m/s.
const SLOW_MPS: f32 = 7.0;
/// Room to others, metres; who is nearer already may go on where that leads no nearer than this.
const ROOM_M: [f32; 2] = [0.12, 0.03];
/// Who starts looks so far ahead, metres.
const START_M: f32 = 0.12;
/// Others at heights farther apart than this are on another road, metres.
const LEVEL_M: f32 = 2.0;

impl View<'_> {
    /// The greatest acceleration of a vehicle that wants to speed up by `accel_mps2`, m/s².
    pub(super) fn brink_mps2(&self, index: usize, next: &Vehicle, accel_mps2: f32) -> f32 {
        let (driver, mps) = (&self.drivers[index], next.speed_mps);
        if mps > SLOW_MPS || (mps == 0.0 && accel_mps2 <= 0.0) {
            return f32::MAX;
        }
        let stop_s = mps / driver.hardest_mps2;
        let decides_s = f32::from(DECIDE_TICKS) * TICK_S;
        let ahead_m = START_M + mps * (decides_s + 0.5 * stop_s);
        let now = &self.bodies[index];
        let half_m = 0.5 * driver.size_m.truncate().length();
        let mut around = self.hazards.reaching(now.position, half_m + ahead_m + ROOM_M[0]);
        let mut then = None;
        let touches = |other: &Hazard| {
            let then = then.get_or_insert_with(|| self.rolled(index, next, ahead_m));
            let later =
                Hazard { position: other.position + other.velocity.extend(0.0) * (decides_s + stop_s), ..*other };
            [*other, later].iter().any(|other| would_touch(now, then, other))
        };
        let other = |h: &&Hazard| h.vehicle != Some(index as u32) && (h.position.z - now.position.z).abs() < LEVEL_M;
        if around.by_ref().filter(other).any(touches) { -driver.hardest_mps2 } else { f32::MAX }
    }

    /// A vehicle so far ahead on its way.
    fn rolled(&self, index: usize, vehicle: &Vehicle, ahead_m: f32) -> Body {
        let driver = &self.drivers[index];
        let mut then = *vehicle;
        then.s_m += ahead_m;
        self.change_lane(driver, &mut then);
        then.offset_m += f32::from(then.drift) * 0.01 * ahead_m;
        self.ways.vehicle_body(self.seed, &then, driver)
    }
}

/// Whether a vehicle gets nearer to another than it may.
fn would_touch(now: &Body, then: &Body, other: &Hazard) -> bool {
    ROOM_M.iter().any(|room_m| is_within(then, other, *room_m) && !is_within(now, other, *room_m))
}

/// Whether another is nearer to a vehicle than `room_m`.
fn is_within(body: &Body, other: &Hazard, room_m: f32) -> bool {
    let forward = (body.rotation * Vec3::X).truncate().normalize_or(Vec2::X);
    let turned = |v: Vec2| Vec2::new(v.dot(forward), forward.perp_dot(v));
    let way = (other.position - body.position).truncate();
    rectangles_overlap(body.kind.size_m().truncate() * 0.5 + room_m, turned(way), turned(other.forward), other.half)
}

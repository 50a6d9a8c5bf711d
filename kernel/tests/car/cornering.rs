//! Turning.

use super::*;

/// Slip stiffness of a tyre under a load, N by unit of slip.
fn stiffness_n(load_n: f64) -> f64 {
    22.0 * load_n / (1.0 + 0.4 * (load_n / (MASS * G / 4.0) - 1.0))
}

/// Yaw rate by angle of the wheels of the linear bicycle model, 1/s.
pub fn yaw_gain(speed: f64) -> f64 {
    let [front, rear] = [FRONT, 1.0 - FRONT].map(|share| MASS * share / (2.0 * stiffness_n(0.5 * MASS * G * share)));
    speed / (BASE + (front - rear) * speed * speed)
}

/// A steady turn for which the bicycle model gives a sideways acceleration in g: the speed, m/s, and the yaw rate,
/// rad/s, that the car comes to, and its yaw gain, 1/s.
pub fn turned(speed: f64, g: f64) -> (f64, f64, f64) {
    let angle = g * G / speed / yaw_gain(speed);
    let mut drive = Drive::over(SurfaceKind::Road, speed as f32, HELPED);
    let steer = angle / 35f64.to_radians();
    drive.hold(seconds(4), |car| cruise(car, speed as f32 + 0.2, steer as f32));
    let (driven, yaw) = (f64::from(drive.ego.speed_mps()), -f64::from(drive.yaw_radps()));
    (driven, yaw, yaw / f64::from(drive.ego.gear.wheel_angle_rad))
}

#[test]
fn the_yaw_gain_is_that_of_the_bicycle_model_up_to_0_4_g() {
    for speed in [7.0, 14.0, 21.0, 28.0] {
        for g in [0.1, 0.25, 0.4] {
            let (driven, _, gain) = turned(speed, g);
            let expected = yaw_gain(driven);
            assert!((gain / expected - 1.0).abs() < 0.1, "{gain}, expected {expected} at {driven} m/s and {g} g");
        }
    }
}

/// Sideways acceleration, m/s^2, that an axle holds at most under the loads that it brings.
fn axle_limit(friction: f64) -> f64 {
    // The roll moment by each axle's share of the roll stiffness: spring, bar and tyre.
    let rate = |share: f64, bar: f64| {
        let spring = 0.5 * MASS * G * share / 0.086 + 2.0 * bar;
        1.0 / (1.0 / spring + 1.0 / 200_000.0)
    };
    let [front, rear] = [rate(FRONT, 18_000.0), rate(1.0 - FRONT, 8_000.0)];
    let axle = |share: f64, rolls: f64| {
        let mut a = friction * G;
        for _ in 0..50 {
            let moved = rolls * MASS * a * HEIGHT / TRACK;
            let half = 0.5 * MASS * G * share;
            a = (most_n(friction, half + moved) + most_n(friction, half - moved)) / (MASS * share);
        }
        a
    };
    axle(FRONT, front / (front + rear)).min(axle(1.0 - FRONT, rear / (front + rear)))
}

#[test]
fn the_skid_pad_ends_where_the_tyres_do() {
    // Rolling without pedals, as what drives the front wheels is lost to the turn, and the wheel turned ever more.
    let cases = [
        (SurfaceKind::Road, 26.0),
        (SurfaceKind::Setts, 22.0),
        (SurfaceKind::Gravel, 22.0),
        (SurfaceKind::Terrain, 20.0),
    ];
    for (kind, from_mps) in cases {
        let mut drive = Drive::over(kind, from_mps, BARE);
        let (mut best, mut angle_rad) = (0f32, 0f32);
        for tick in 0..seconds(8) / 6 {
            let before = drive.ego.motion.velocity_mps.truncate();
            drive.hold(6, |_| Controls::from_fractions(0.01 * tick as f32, 0.0, 0.0));
            let after = drive.ego.motion.velocity_mps.truncate();
            let sideways = (after - before).perp_dot((before + after).normalize()).abs() * 10.0;
            if sideways > best {
                (best, angle_rad) = (sideways, drive.ego.gear.wheel_angle_rad);
            }
        }
        // What the front tyres hold points inwards as far as they do.
        let expected = axle_limit(friction(kind)[0]) * libm::cos(f64::from(angle_rad));
        assert!((f64::from(best) / expected - 1.0).abs() < 0.05, "{kind:?}: {best} m/s^2, expected {expected}");
    }
}

#[test]
fn full_steering_at_speed_slides_but_does_not_roll() {
    for setup in [HELPED, BARE] {
        let mut drive = Drive::over(SurfaceKind::Road, 20.0, setup);
        drive.hold(seconds(3), |_| Controls::from_fractions(-1.0, 0.3, 0.0));
        assert!(drive.upright() > 0.9, "{}", drive.upright());
    }
}

#[test]
fn the_hand_brake_turns_the_car_round() {
    let turned = |flags: u8| {
        let mut drive = Drive::over(SurfaceKind::Road, 16.0, HELPED);
        drive.hold(20, |_| Controls::from_fractions(-0.6, 0.0, 0.0));
        let (mut turned, mut last, mut slip) = (0.0, drive.ego.heading_rad(), 0f32);
        for _ in 0..seconds(4) {
            drive.step(&Controls { flags, ..Controls::from_fractions(-1.0, 0.0, 0.0) });
            let heading = drive.ego.heading_rad();
            turned += kernel::ops::wrap_angle(heading - last);
            last = heading;
            if drive.ego.motion.velocity_mps.length() < 1.0 {
                break;
            }
            slip = slip.max(side_slip_rad(&drive.ego).abs());
        }
        (turned.to_degrees(), slip.to_degrees())
    };
    let ((degrees, slip), (_, gripped)) = (turned(Controls::HAND_BRAKE), turned(0));
    assert!((120.0..300.0).contains(&degrees), "{degrees} degrees");
    assert!(slip > 60.0 && gripped < 20.0, "sideways by {slip} degrees, without the hand brake by {gripped}");
}

/// Angle from the car's x axis to its way, radians counter-clockwise.
fn side_slip_rad(ego: &Ego) -> f32 {
    let velocity = ego.motion.rotation.conjugate() * ego.motion.velocity_mps;
    kernel::ops::atan2(velocity.y, velocity.x)
}

/// ISO 3888-2: lengths of the sections and the sides of the three lanes, metres, for a car 1.8 m wide; the last lane with
/// the same offset of 1 m from the second as the first.
pub const LANES: [([f32; 2], [f32; 2]); 3] =
    [([0.0, 12.0], [-1.115, 1.115]), ([25.5, 36.5], [2.115, 4.915]), ([49.0, 61.0], [-1.885, 1.115])];

/// Where the middle of the car shall be, metres to the left, by its way.
fn path(x: f32) -> f32 {
    let ease = |from: f32, to: f32| {
        let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
        t * t * t * (10.0 - t * (15.0 - 6.0 * t))
    };
    3.4 * ease(12.0, 28.0) - 3.9 * ease(34.0, 52.0)
}

/// What became of a lane change.
pub struct LaneChange {
    /// How far the car got out of the lanes, metres, negative for room that was left.
    pub out_m: f32,
    /// Its corners at each tick, metres from where the lanes begin.
    pub boxes: Vec<[Vec3; 4]>,
}

pub fn lane_change(entry_mps: f32, setup: CarSetup) -> LaneChange {
    let mut drive = Drive::over(SurfaceKind::Road, entry_mps, setup);
    let start = 20.0;
    let mut change = LaneChange { out_m: f32::MIN, boxes: Vec::new() };
    while drive.ego.middle().x < start + 64.0 {
        let middle = drive.ego.middle();
        let at = middle.x - start;
        let heading = drive.ego.heading_rad();
        let ahead_m = 5.0;
        let target = path(at + ahead_m);
        let bearing = kernel::ops::atan2(target - middle.y, ahead_m) - heading;
        let curvature = 2.0 * bearing / ahead_m;
        let steer = -kernel::ops::atan2(2.7 * curvature, 1.0) / 0.611;
        let throttle = if at < 2.0 { cruise(&drive.ego, entry_mps, 0.0).throttle_fraction() } else { 0.0 };
        drive.step(&Controls::from_fractions(steer, throttle, 0.0));
        let corners = [(2.25, 0.9), (2.25, -0.9), (-2.25, -0.9), (-2.25, 0.9)]
            .map(|(x, y)| drive.ego.middle() + drive.ego.motion.rotation * Vec3::new(x, y, 0.0) - Vec3::X * start);
        for place in corners {
            for ([from, to], [right, left]) in LANES {
                if (from..to).contains(&place.x) {
                    change.out_m = change.out_m.max(place.y - left).max(right - place.y);
                }
            }
        }
        change.boxes.push(corners);
    }
    change
}

#[test]
fn an_iso_3888_2_lane_change_at_50_kmh_hits_no_cone() {
    let out_m = lane_change(50.0 / 3.6, HELPED).out_m;
    assert!(out_m <= 0.0, "{out_m} m out of the lanes");
}

#[test]
fn stability_control_catches_a_car_that_turns_too_much() {
    // A flick of the wheel at speed, lifting off the throttle.
    let slid = |setup| {
        let mut drive = Drive::over(SurfaceKind::Road, 33.0, setup);
        let mut most = 0f32;
        for tick in 0..seconds(4) {
            let steer = match tick {
                0..30 => 0.35,
                30..75 => -0.45,
                _ => 0.0,
            };
            drive.step(&Controls::from_fractions(steer, 0.0, 0.0));
            most = most.max(side_slip_rad(&drive.ego).abs());
        }
        most.to_degrees()
    };
    let (bare, helped) = (slid(CarSetup { abs: true, esc: false }), slid(HELPED));
    assert!(helped < 12.0 && bare > 1.5 * helped, "{bare} degrees, {helped} with it");
}

//! Standing.

use super::*;

#[test]
fn it_stands_still_on_flat_ground() {
    let mut drive = Drive::at(0.0);
    drive.hold(seconds(10), |_| Controls::default());
    let at = drive.ego.motion.position;
    assert!(at.length() < 0.005, "{at}");
    assert!(drive.upright() > 0.9999);
    assert!(drive.ego.odometer_um < 10_000, "{}", drive.ego.odometer_um);
}

#[test]
fn it_stands_on_a_slope_of_10_percent_for_ten_minutes() {
    let foot = pedals(0.0, 0.3);
    let hand = Controls { flags: Controls::HAND_BRAKE, ..Controls::default() };
    for heading_rad in [0.0, 1.0, 2.2] {
        for held in [Controls::default(), foot, hand] {
            let up = Quat::from_rotation_y(-kernel::ops::atan2(0.1, 1.0));
            let rotation = up * Quat::from_rotation_z(heading_rad);
            let mut drive = Drive::posed(plain(SurfaceKind::Road, 0.1), rotation, 0.0, HELPED);
            drive.hold(seconds(5), |_| held);
            let (at, turned) = (drive.ego.motion.position, drive.ego.heading_rad());
            drive.hold(seconds(595), |_| held);
            let moved = drive.ego.motion.position.distance(at);
            assert!(at.length() < 0.1, "{at} at first");
            assert!(moved < 0.005, "{moved} m at {heading_rad} with {held:?}");
            assert!((drive.ego.heading_rad() - turned).abs() < 1e-4);
        }
    }
}

#[test]
fn it_rolls_back_where_nothing_holds_it() {
    let up = Quat::from_rotation_y(-kernel::ops::atan2(0.1, 1.0));
    let mut drive = Drive::posed(plain(SurfaceKind::Road, 0.1), up, 0.0, HELPED);
    drive.hold(1, |_| pedals(0.01, 0.0));
    drive.hold(seconds(3), |_| Controls::default());
    // 0.1 g less creeping of 450 N and rolling resistance.
    let expected = 3.0 * (0.1 * G - 0.13 - 450.0 / MASS) / (1.0 + 47.0 / MASS);
    let speed = -f64::from(drive.ego.speed_mps());
    assert!((speed / expected - 1.0).abs() < 0.1, "{speed} m/s, expected {expected}");
}

#[test]
fn a_stop_ends_without_rocking() {
    let mut drive = Drive::at(14.0);
    drive.hold(seconds(3), |_| pedals(0.0, 0.9));
    let at = drive.ego.motion.position;
    for _ in 0..60 {
        drive.step(&pedals(0.0, 0.9));
        assert!(drive.ego.motion.position.distance(at) < 0.01);
    }
    assert!(drive.ego.speed_mps().abs() < 1e-3);
}

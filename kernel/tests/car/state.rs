//! Everything that steers the car's future is in its state.

use super::*;
use kernel::state::State;

/// A drive in the middle of everything: braking in a turn.
fn busy() -> Drive {
    let mut drive = Drive::at(15.0);
    drive.hold(20, |car| cruise(car, 15.0, 0.2));
    drive.hold(10, |_| Controls::from_fractions(0.25, 0.0, 0.5));
    drive
}

/// The state after a second more, from nothing but the state.
fn future(ego: &Ego) -> Vec<u8> {
    let physics = Physics::new(&Arc::new(Statics::new(&plain(SurfaceKind::Road, 0.0))), &ego.motion);
    let mut drive = Drive { ego: *ego, physics, setup: HELPED, water: Water::default() };
    drive.hold(seconds(1), |_| Controls::from_fractions(-0.2, 0.0, 0.2));
    drive.ego.to_bytes()
}

#[test]
fn a_new_engine_goes_on_from_the_state_as_the_old_one_does() {
    let mut drive = busy();
    let other = future(&drive.ego);
    drive.hold(seconds(1), |_| Controls::from_fractions(-0.2, 0.0, 0.2));
    assert_eq!(drive.ego.to_bytes(), other);
}

type Change = fn(&mut Ego);

#[test]
fn no_field_of_the_running_gear_could_be_left_out() {
    let ego = busy().ego;
    let expected = future(&ego);
    let changes: [(&str, Change); 7] = [
        ("wheel angle", |ego| ego.gear.wheel_angle_rad = 0.0),
        ("spin", |ego| ego.gear.wheels[0].spin_radps = ego.speed_mps() / 0.32),
        ("spin of a rear wheel", |ego| ego.gear.wheels[3].spin_radps = ego.speed_mps() / 0.32),
        ("travel", |ego| ego.gear.wheels[1].travel_m = 0.086),
        ("tread", |ego| ego.gear.wheels[2].tread_m = glam::Vec2::ZERO),
        ("parking brake", |ego| ego.gear.parked = !ego.gear.parked),
        ("meant yaw", |ego| ego.gear.meant_yaw_radps = 0.5),
    ];
    for (what, change) in changes {
        let mut changed = ego;
        change(&mut changed);
        assert_ne!(changed, ego, "{what}");
        assert_ne!(future(&changed), expected, "{what} steers nothing");
    }
}

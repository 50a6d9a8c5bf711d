//! Two long vehicles let each other through where a street is too narrow for both.

use super::standing::with_vehicles;
use super::*;
use crate::actor::ActorKind;

/// Drives two buses for a minute, one before a bend and one before the same on its side, so far from it, metres. How long
/// somebody stood, ticks.
fn meet(network: &Arc<RoadNetwork>, [a, b]: [(u32, f32); 2], speed_mps: f32) -> u32 {
    let bus = |id, (lane, s_m)| {
        let flags = if s_m < 6.0 { Vehicle::CROSSING } else { 0 };
        Vehicle { id, kind: ActorKind::Bus, lane, before: lane, s_m, speed_mps, flags, ..Vehicle::standing() }
    };
    let mut traffic = with_vehicles(network, vec![bus(1, a), bus(2, b)]);
    let mut stood = 0;
    for tick in 1..=MINUTE {
        let conditions = Conditions::default();
        traffic.step(&Surroundings { tick, ego: nowhere(), ego_flags: 0, loose: &[], conditions });
        let vehicles = &traffic.state().vehicles;
        assert_eq!(overlaps(&traffic), [], "{a:?} and {b:?}, tick {tick}: {vehicles:?}");
        stood += u32::from(vehicles.iter().any(|v| v.speed_mps == 0.0));
        assert!(vehicles.iter().all(|v| v.stuck_s < 30), "{a:?} and {b:?}, tick {tick}: {vehicles:?}");
    }
    stood
}

#[test]
fn long_vehicles_let_each_other_through_narrow_bends() {
    for name in ["old_town", "suburb"] {
        let network = bundled(name).expect("it is bundled");
        let (mut met, mut stood) = (0, 0);
        for lane in 0..network.lanes.len() as u32 {
            for (bend_m, there) in network.ways().lanes[lane as usize].bends.iter().map(|bend| bend.begins()) {
                let (other, other_m) = there;
                for (mine_m, theirs_m) in [(14.0, 14.0), (14.0, 20.0), (25.0, 16.0), (9.0, 12.0)] {
                    let places = [(lane, bend_m - mine_m), (other, other_m - theirs_m)];
                    if places.iter().all(|(_, s_m)| *s_m > 0.0) {
                        met += 1;
                        stood += u32::from(meet(&network, places, 5.0) > 0);
                    }
                }
            }
        }
        assert!(met > 4 && stood > 0, "{name}: {met} met, {stood} times somebody stood");
    }
}

/// Where there is room for both nobody waits.
#[test]
fn wide_streets_have_no_bends_to_wait_at() {
    for name in ["city", "motorway"] {
        let network = bundled(name).expect("it is bundled");
        assert!(network.ways().lanes.iter().all(|lane| lane.bends.is_empty()), "{name}");
    }
}

//! What holds for every signal programme.

use kernel::RoadNetwork;
use kernel::geometry::direction;
use kernel::map::{LaneId, LightGroupId, Turn};
use kernel::signals::{LightPhase, phase};

/// Lanes whose lights are green or yellow at once overlap only where one turns off across oncoming traffic and gives way,
/// and every light is green once in each cycle, then yellow.
pub fn check_programmes(map: &RoadNetwork) {
    let light = |l: LaneId| map.lanes[l as usize].predecessors.iter().find_map(|p| map.light_between(*p, l));
    for (id, lane) in map.lanes.iter().enumerate() {
        let Some(ours) = light(id as LaneId) else { continue };
        for other in lane.conflicts.iter().filter(|conflict| !conflict.other_first) {
            let Some(theirs) = light(other.lane).filter(|theirs| *theirs != ours) else { continue };
            let there = &map.lanes[other.lane as usize];
            let oncoming = direction(lane.start().heading_rad).dot(direction(there.start().heading_rad)) < -0.5;
            let turns = lane.turn != Turn::Straight || there.turn != Turn::Straight;
            let protected = [lane.light, there.light].into_iter().flatten().next().is_some();
            let cycle = u64::from(map.junctions[lane.junction.unwrap() as usize].cycle_ticks);
            let both = (0..cycle).step_by(7).any(|tick| {
                let goes = |group| phase(map, 3, group, tick).0 != LightPhase::Red;
                goes(ours) && goes(theirs)
            });
            assert!(!both || oncoming && turns && !protected, "{} and {} at once", lane.name, there.name);
        }
    }
    for (group, light) in map.light_groups.iter().enumerate() {
        let cycle = u64::from(map.junctions[light.junction as usize].cycle_ticks);
        let shown: Vec<_> = (0..cycle).map(|tick| phase(map, 3, group as LightGroupId, tick)).collect();
        let count = |wanted| shown.iter().filter(|(phase, _)| *phase == wanted).count() as u32;
        assert_eq!((count(LightPhase::Green), count(LightPhase::Yellow)), (light.green_ticks, light.yellow_ticks));
        for (tick, (now, left)) in shown.iter().enumerate() {
            let then = |ahead: u64| shown[((tick as u64 + ahead) % cycle) as usize].0;
            assert!(then(left - 1) == *now && then(*left) != *now, "group {group}, tick {tick}");
        }
        let after = shown.iter().zip(shown.iter().cycle().skip(1)).filter(|((now, _), (then, _))| now != then);
        assert!(
            after.clone().count() == 3
                && after.into_iter().all(|((now, _), (then, _))| (*now, *then) != (LightPhase::Green, LightPhase::Red))
        );
    }
}

//! Traffic lights. To the standard each lamp is one, lit or not.

use glam::Vec3;
use kernel::geometry::direction;
use kernel::map::{LaneId, LightGroupId, LightHead, MapData, StopKind};
use kernel::signals::LightPhase;

use super::ids;
use super::messages::{Color, Icon, Identifier, Mode, TrafficLight, TrafficLightClassification};
use super::place::{Frame, upright};

/// The lamps of a head: what each tells, and how far it is above the middle one, metres; as heads are drawn.
const LAMPS: [(LightPhase, Color, f32); 3] = [
    (LightPhase::Red, Color::Red, 0.32),
    (LightPhase::Yellow, Color::Yellow, 0.0),
    (LightPhase::Green, Color::Green, -0.32),
];
/// From the axis of the pole to the lamps, metres.
const BEFORE_POLE_M: f32 = 0.306;
/// A lamp along its light, across it and up, metres.
const LAMP_M: Vec3 = Vec3::new(0.01, 0.25, 0.25);

/// The lights of a map.
pub struct Lights {
    /// The lanes that each group holds.
    lanes: Vec<Vec<Identifier>>,
}

impl Lights {
    /// Those of a map.
    pub fn of(map: &MapData) -> Self {
        let mut lanes = vec![Vec::new(); map.light_groups.len()];
        for (id, lane) in (0..).zip(&map.lanes) {
            let at_line = lane.stop.and_then(|stop| match stop.kind {
                StopKind::Light(group) => Some(group),
                StopKind::Stop | StopKind::Yield => None,
            });
            hold(&mut lanes, at_line, id);
            hold(&mut lanes, lane.light, id);
        }
        Self { lanes }
    }

    /// All lamps, as they burn when the groups are in these phases.
    pub fn burning(&self, map: &MapData, phases: &[LightPhase], frame: Frame) -> Vec<TrafficLight> {
        let heads = map.light_heads.iter().enumerate();
        heads.flat_map(|(number, head)| self.head(number, head, phases, frame)).collect()
    }

    fn head(&self, number: usize, head: &LightHead, phases: &[LightPhase], frame: Frame) -> Vec<TrafficLight> {
        let group = head.group as usize;
        let (phase, lanes) = (phases.get(group).copied(), self.lanes.get(group).cloned().unwrap_or_default());
        let before = (BEFORE_POLE_M * direction(head.facing_rad)).extend(head.height_m);
        let lamp = |(index, (own, color, up_m)): (usize, (LightPhase, Color, f32))| TrafficLight {
            id: ids::lamp(number, index),
            base: frame.stationary(head.position + before + up_m * Vec3::Z, upright(head.facing_rad), LAMP_M),
            classification: TrafficLightClassification {
                color: color as i32,
                icon: Icon::None as i32,
                mode: if phase == Some(own) { Mode::Constant } else { Mode::Off } as i32,
                assigned_lane_id: lanes.clone(),
            },
        };
        LAMPS.into_iter().enumerate().map(lamp).collect()
    }
}

fn hold(lanes: &mut [Vec<Identifier>], group: Option<LightGroupId>, lane: LaneId) {
    if let Some(held) = group.and_then(|group| lanes.get_mut(group as usize)) {
        held.push(ids::lane(lane));
    }
}

#[cfg(test)]
mod tests {
    use kernel::map::bundled;

    use super::*;

    #[test]
    fn one_lamp_of_each_head_burns_and_holds_lanes() {
        let map = bundled("city").expect("bundled");
        let phases: Vec<LightPhase> = (0..map.light_groups.len())
            .map(|k| [LightPhase::Red, LightPhase::Yellow, LightPhase::Green][k % 3])
            .collect();
        let lamps = Lights::of(&map).burning(&map, &phases, Frame { origin_m: [0.0; 2] });
        assert_eq!(lamps.len(), 3 * map.light_heads.len());
        for (head, lamps) in map.light_heads.iter().zip(lamps.chunks(3)) {
            let lit: Vec<i32> = lamps
                .iter()
                .filter(|lamp| lamp.classification.mode == Mode::Constant as i32)
                .map(|lamp| lamp.classification.color)
                .collect();
            let color = [Color::Red, Color::Yellow, Color::Green][phases[head.group as usize] as usize];
            assert_eq!(lit, [color as i32]);
            assert!(!lamps[0].classification.assigned_lane_id.is_empty(), "{head:?}");
            assert!(lamps.is_sorted_by(|a, b| a.base.position.z > b.base.position.z), "red is above");
        }
    }
}

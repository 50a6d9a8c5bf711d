//! Gratings of drains, which lie in the roadway at the kerbs of streets.

use glam::{Vec2, Vec3};
use kernel::map::{Lane, LaneKind, RoadNetwork, SurfaceKind};

use crate::mesh::{Mesh, Paint};

/// From one drain to the next, and from where its pavement begins, metres.
const PITCH_M: f32 = 23.0;
const FIRST_M: f32 = 6.0;
/// Half of a grating along the kerb and across it, and its middle from the edge of the pavement, metres.
const HALF_M: Vec2 = Vec2::new(0.25, 0.17);
const FROM_EDGE_M: f32 = 0.24;
/// How far it lies above the ground, metres, as paint does.
const UP_M: f32 = 16.0 / 1024.0;
/// Pavements look for the road that they are beside so far away, metres.
const BESIDE_M: f32 = 12.0;

/// The middle of each grating with its mesh in the world's frame: iron of `paint`, uv are metres along the kerb and from it.
pub(super) fn gratings(network: &RoadNetwork, paint: Paint) -> impl Iterator<Item = (Vec3, Mesh)> + '_ {
    let pavements = network.lanes.iter().filter(|lane| lane.kind == LaneKind::Sidewalk && lane.junction.is_none());
    pavements.flat_map(move |lane| {
        let count = ((lane.length_m - FIRST_M) / PITCH_M).ceil().max(0.0) as u32;
        (0..count).filter_map(move |i| {
            let at = at_kerb(network, lane, FIRST_M + i as f32 * PITCH_M)?;
            Some((at.middle, at.mesh(paint)))
        })
    })
}

/// A place at the kerb of a pavement.
struct Place {
    middle: Vec3,
    along: Vec2,
    /// The way from the pavement over the road.
    out: Vec2,
}

impl Place {
    fn mesh(&self, paint: Paint) -> Mesh {
        let mut mesh = Mesh::default();
        let uv = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| HALF_M * Vec2::new(x, y));
        let corners = uv.map(|at| self.middle + (at.x * self.along + at.y * self.out).extend(0.0));
        let turned = self.along.perp_dot(self.out) < 0.0;
        let order = if turned { [3, 2, 1, 0] } else { [0, 1, 2, 3] };
        mesh.quad_uv(paint, order.map(|i| corners[i]), order.map(|i| uv[i] + HALF_M));
        mesh
    }
}

/// The place at the kerb beside `s_m` of a pavement, where there is asphalt.
fn at_kerb(network: &RoadNetwork, lane: &Lane, s_m: f32) -> Option<Place> {
    let middle = lane.at(s_m);
    let road = network.nearest_lane(middle.position, LaneKind::Driving, None, BESIDE_M)?;
    let to_road = (network.lanes[road.lane as usize].at(road.s_m).position - middle.position).truncate();
    let along = Vec2::from_angle(middle.heading_rad);
    let out = along.perp() * along.perp_dot(to_road).signum();
    let off_m = middle.half_width_m + FROM_EDGE_M;
    let at = middle.position + (out * off_m).extend(0.0);
    // All of it, and of the road around it, is asphalt.
    let around = [Vec2::ZERO, out * 0.2, 0.3 * along, -0.3 * along].map(|off| network.ground(at + off.extend(0.0)));
    let is_asphalt = around.iter().all(|found| found.as_ref().is_some_and(|on| on.kind == SurfaceKind::Road));
    let height_m = around[0].as_ref().filter(|_| is_asphalt)?.height_m;
    Some(Place { middle: at.with_z(height_m + UP_M), along, out })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SemanticTag;

    #[test]
    fn drains_lie_in_the_road_beside_its_kerbs() {
        for name in ["city", "suburb"] {
            let network = kernel::map::bundled(name).expect("a bundled map");
            let drains: Vec<(Vec3, Mesh)> = gratings(&network, Paint::plain(SemanticTag::Road, [52; 3])).collect();
            assert!(drains.len() > 40, "{name}: {}", drains.len());
            for (at, mesh) in drains {
                assert_eq!(network.ground(at).expect("ground").kind, SurfaceKind::Road);
                let aside = |out_m: f32| {
                    let places = (0..8).map(|i| Vec2::from_angle(0.785 * i as f32) * out_m);
                    let kinds = places.filter_map(|off| network.ground(at + off.extend(0.1))).map(|on| on.kind);
                    kinds.filter(|kind| *kind == SurfaceKind::Sidewalk).count()
                };
                assert!(aside(0.2) == 0 && aside(0.5) > 0, "{name}: {at}");
                assert!(mesh.vertices.iter().all(|v| v.normal == [0, 0, 127]));
            }
        }
    }
}

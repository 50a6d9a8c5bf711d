//! The sidewalks at bus stops, onto which the doors of buses open.

use glam::Vec2;

use crate::map_data::{BusStop, WalkEdgeId};

use super::calls::{DOORS_M, OUT_M};
use super::jaywalk;
use super::ways::Ways;

/// From the edge of the lane to the border of the sidewalk, at most, metres.
const REACH_M: f32 = 4.0;
/// And at most so much higher or lower, metres.
const LEVEL_M: f32 = 2.0;

impl Ways {
    /// Finds for each stop the sidewalks onto which the doors of a bus there open.
    pub(super) fn add_stops(&mut self) {
        let places = self.places.clone();
        for stop in &places.map.bus_stops {
            let edges = 0..places.map.walk_edges.len() as WalkEdgeId;
            let doors = self.doors(stop);
            let onto: Vec<_> = edges.filter(|edge| self.opens_onto(stop, &doors, *edge)).collect();
            for &edge in &onto {
                let (s_m, _) = self.project(edge, doors[0].0);
                self.edges[edge as usize].stops.push(s_m);
            }
            self.stop_ways.push(onto);
        }
    }

    /// Where people get on and off a bus at a stop, and the direction out of the doors.
    pub(super) fn doors(&self, stop: &BusStop) -> [(Vec2, Vec2); 2] {
        DOORS_M.map(|m| {
            let place = self.places.map.lanes[stop.lane as usize].straight_on(stop.s_m - m);
            let out = place.left() * f32::from(self.kerb);
            (place.position.truncate() + out * (place.half_width_m + OUT_M), out)
        })
    }

    /// Whether one gets from the doors of a bus at a stop onto a sidewalk.
    fn opens_onto(&self, stop: &BusStop, doors: &[(Vec2, Vec2)], edge: WalkEdgeId) -> bool {
        let map = &*self.places.map;
        let way = &map.walk_edges[edge as usize];
        // Most are far away.
        let near = |door: &Vec2| way.points[0].truncate().distance(*door) < way.length_m + way.half_width_m + REACH_M;
        way.crosswalk.is_none()
            && doors.iter().filter(|(door, _)| near(door)).any(|(door, out)| {
                let (s_m, offset_m) = self.project(edge, *door);
                let place = self.edge_place(edge, s_m).position;
                let there = place.truncate();
                let level = (place.z - map.lanes[stop.lane as usize].straight_on(stop.s_m).position.z).abs() < LEVEL_M;
                let near = offset_m.abs() < way.half_width_m + REACH_M && (0.0..=way.length_m).contains(&s_m);
                level && near && (there - *door).dot(*out) > 0.0 && jaywalk::is_free(map, *door, there)
            })
    }

    /// The place in the middle of an edge right beside another.
    pub(super) fn onto(&self, edge: WalkEdgeId, place: Vec2) -> Vec2 {
        let (s_m, _) = self.project(edge, place);
        self.edge_place(edge, s_m).position.truncate()
    }

    /// A place as metres along an edge and to the left of it.
    pub(super) fn project(&self, edge: WalkEdgeId, place: Vec2) -> (f32, f32) {
        let (way, points) = (&self.edges[edge as usize], &self.places.map.walk_edges[edge as usize].points);
        let on_piece = |i: usize| {
            let forward = way.forward[i].truncate().normalize_or(Vec2::X);
            let offset = place - points[i].truncate();
            let (along_m, length_m) = (offset.dot(forward), way.s_m[i + 1] - way.s_m[i]);
            let beyond_m = along_m - along_m.clamp(0.0, length_m);
            let aside_m = forward.perp_dot(offset);
            (beyond_m * beyond_m + aside_m * aside_m, way.s_m[i] + along_m, aside_m)
        };
        let nearest = (0..points.len() - 1).map(on_piece).min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map_or((0.0, 0.0), |(_, s_m, offset_m)| (s_m, offset_m))
    }
}

//! The roads of a file by their ids, along their reference lines, to which other formats refer.

use glam::Vec3;

use super::notes::Notes;
use super::shapes::point;
use super::source::Source;
use crate::ops;

/// From one place to the next, from which the direction of a road follows, metres.
const STEP_M: f64 = 0.1;

/// The roads of a file.
pub(crate) struct Survey(xodr::RoadNetwork);

impl Survey {
    /// That of a text that bakes.
    pub fn of(text: &str) -> Option<Self> {
        Source::read(text, &mut Notes::unwanted()).ok().map(|source| Self(source.net))
    }

    fn road(&self, id: &str) -> Result<xodr::RoadId, String> {
        self.0.road_by_od_id(id).map(xodr::Road::id).ok_or_else(|| format!("there is no road {id} on the map"))
    }

    /// A place on a lane: so far along the reference line of its road, and so far to the left of its middle, seen along that,
    /// metres.
    pub fn on_lane(&self, road: &str, lane: i32, s_m: f64, offset_m: f64) -> Result<Vec3, String> {
        let of_file = self.road(road)?;
        let is_asked =
            |id: &xodr::LaneId| self.0.road_lane(*id).is_some_and(|at| at.road == of_file && at.od_id == lane);
        let sections = self.0.lanes().iter().map(|lane| lane.id).filter(is_asked);
        let mut points = sections.filter_map(|lane| {
            let at = xodr::LanePosition { lane, s: s_m, offset: offset_m };
            self.0.lane_point(at)
        });
        points.next().map(point).ok_or_else(|| format!("road {road} has no lane {lane} at s {s_m}"))
    }

    /// A place so far along the reference line of a road and so far to the left of it, metres, and the direction of the road
    /// there, radians.
    pub fn on_road(&self, road: &str, s_m: f64, t_m: f64) -> Result<(Vec3, f32), String> {
        let at = |s: f64| Ok::<_, String>(self.0.road_point(xodr::RoadPosition { road: self.road(road)?, s, t: t_m }));
        let here = at(s_m)?.map(point).ok_or_else(|| format!("road {road} has no place at s {s_m}, t {t_m}"))?;
        let step_m = if s_m > STEP_M { -STEP_M } else { STEP_M };
        let along = (at(s_m + step_m)?.map_or(here, point) - here) * step_m as f32;
        Ok((here, ops::atan2(along.y, along.x)))
    }
}

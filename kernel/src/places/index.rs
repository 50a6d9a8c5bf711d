//! A map with its grids.

use std::sync::Arc;

use glam::Vec3;

use super::ground::{Ground, GroundGrid};
use super::parked::ParkedCars;
use super::roads::{LaneGrid, Roads};
use crate::map_data::MapData;

/// A map with grids over its lanes and its ground.
#[derive(Debug)]
pub(crate) struct Places {
    /// The map.
    pub map: Arc<MapData>,
    lanes: LaneGrid,
    ground: GroundGrid,
    /// The parked cars.
    pub parked: ParkedCars,
}

impl Places {
    /// Those of a map.
    pub fn new(map: &Arc<MapData>) -> Self {
        let (lanes, ground) = (LaneGrid::new(&map.lanes), GroundGrid::new(&map.surfaces));
        Self { map: map.clone(), lanes, ground, parked: ParkedCars::new(&map.props) }
    }

    /// The highest ground at most 1 m above `position` and below it; `None` beyond the map.
    pub fn ground(&self, position: Vec3) -> Option<Ground> {
        self.ground.below(&self.map.surfaces, position)
    }

    /// The lanes with the grid over them.
    pub fn roads(&self) -> Roads<'_> {
        self.lanes.over(&self.map.lanes)
    }
}

//! Parked cars by place.

use glam::Vec3;

use super::grid::Grid;
use crate::actor::FIRST_PARKED_ID;
use crate::map_data::{Prop, PropKind};

/// Side of a cell, metres.
const CELL_M: f32 = 10.0;

/// The parked cars of a map, numbered in the order of its props, with a grid over them.
#[derive(Debug)]
pub(crate) struct ParkedCars {
    /// Where each stands.
    pub cars: Vec<Prop>,
    grid: Grid,
}

impl ParkedCars {
    pub fn new(props: &[Prop]) -> Self {
        let cars: Vec<Prop> = props.iter().filter(|prop| prop.kind == PropKind::ParkedCar).copied().collect();
        let around = |car: &Prop| {
            let (middle, reach_m) = (car.position.truncate(), car.size.truncate().length() * 0.5);
            (middle - reach_m, middle + reach_m)
        };
        let boxes: Vec<_> = cars.iter().map(around).collect();
        Self { grid: Grid::new(&boxes, CELL_M), cars }
    }

    /// Numbers of those that may touch the square of half side `radius_m` around a place; some come twice.
    pub fn around(&self, place: Vec3, radius_m: f32) -> impl Iterator<Item = u32> + '_ {
        self.grid.around(place.truncate(), radius_m)
    }

    /// The car of an id; none where that is another's.
    pub fn of_id(&self, id: u32) -> Option<&Prop> {
        self.cars.get(id.checked_sub(FIRST_PARKED_ID)? as usize)
    }
}

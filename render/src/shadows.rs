//! Which shadow maps are kept, and which tiles they show.

use glam::{IVec2, Vec3};

use crate::shadow_box::{ShadowBox, ShadowGrid, TILES, slot};

/// A step in both directions lacks so many tiles: whoever lacks more has another map, if there is one.
const MOST_OF_A_STEP: usize = 2 * TILES as usize;

/// Shadow maps by their numbers. What moves casts no shadow on their tiles, so those are as good as new for the same grid with
/// the same parked cars.
pub(crate) struct ShadowMaps {
    most: usize,
    maps: Vec<Map>,
    draws: u64,
}

struct Map {
    grid: ShadowGrid,
    /// Parked cars that are left out.
    gone: Vec<usize>,
    /// What each place shows.
    shown: [Option<IVec2>; (TILES * TILES) as usize],
    last_draw: u64,
}

impl Map {
    fn new(grid: ShadowGrid, gone: &[usize]) -> Self {
        Self { grid, gone: gone.to_vec(), shown: [None; (TILES * TILES) as usize], last_draw: 0 }
    }

    fn shows(&self, tile: IVec2) -> bool {
        self.shown[place(tile)] == Some(tile)
    }

    fn lacking(&self, shadow: &ShadowBox) -> Vec<IVec2> {
        if self.grid != shadow.grid {
            return shadow.tiles().collect();
        }
        shadow.tiles().filter(|tile| !self.shows(*tile)).collect()
    }

    /// Forgets the tiles on which parked cars cast a shadow that have gone or come back since.
    fn move_cars(&mut self, gone: &[usize], extent_of: impl Fn(usize) -> Option<[Vec3; 2]>) {
        let (was, grid) = (&self.gone, self.grid);
        let moved = was.iter().filter(|car| !gone.contains(car)).chain(gone.iter().filter(|car| !was.contains(car)));
        for [low, high] in moved.filter_map(|car| extent_of(*car)).map(|extent| grid.span(extent)) {
            for tile in self.shown.iter_mut() {
                if tile.is_some_and(|tile| tile.cmpge(low).all() && tile.cmple(high).all()) {
                    *tile = None;
                }
            }
        }
        self.gone = gone.to_vec();
    }
}

/// The number of a tile's place in a map.
fn place(tile: IVec2) -> usize {
    let slot = slot(tile);
    (slot.y * TILES + slot.x) as usize
}

impl ShadowMaps {
    /// So many at most.
    pub(crate) fn new(most: usize) -> Self {
        Self { most: most.max(1), maps: Vec::new(), draws: 0 }
    }

    /// Casts all of them anew: something else stands there.
    pub(crate) fn forget(&mut self) {
        self.maps.clear();
    }

    /// The number of the map for a box, and the tiles to draw before it shows all of that without some parked cars. It is the one
    /// that lacks least or, where all lack much, one that was not used for longest. `extent_of` is the box around a parked car.
    pub(crate) fn find(
        &mut self,
        shadow: &ShadowBox,
        gone: &[usize],
        extent_of: impl Fn(usize) -> Option<[Vec3; 2]>,
    ) -> (usize, Vec<IVec2>) {
        self.draws += 1;
        let best = (0..self.maps.len()).min_by_key(|index| self.maps[*index].lacking(shadow).len());
        let best = best.filter(|index| self.maps[*index].lacking(shadow).len() <= MOST_OF_A_STEP);
        let number = best.unwrap_or_else(|| self.replaced());
        if self.maps.get(number).is_none_or(|map| map.grid != shadow.grid) {
            let map = Map::new(shadow.grid, gone);
            match self.maps.get_mut(number) {
                Some(old) => *old = map,
                None => self.maps.push(map),
            }
        }
        let map = &mut self.maps[number];
        map.move_cars(gone, extent_of);
        map.last_draw = self.draws;
        let lacking = map.lacking(shadow);
        lacking.iter().for_each(|tile| map.shown[place(*tile)] = Some(*tile));
        (number, lacking)
    }

    /// The number of one more map, or of the one that was not used for longest.
    fn replaced(&self) -> usize {
        if self.maps.len() < self.most {
            return self.maps.len();
        }
        (0..self.maps.len()).min_by_key(|index| self.maps[*index].last_draw).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn around(x_m: f32) -> ShadowBox {
        ShadowBox::around(Vec3::new(x_m, 0.0, 0.0), Vec3::Z, 64.0)
    }

    /// The map for a place without some cars, and how many tiles it lacks. Car 7 stands at the origin.
    fn find(maps: &mut ShadowMaps, x_m: f32, gone: &[usize]) -> (usize, usize) {
        let extent_of = |car: usize| (car == 7).then_some([Vec3::splat(-1.0), Vec3::splat(2.0)]);
        let (map, lacking) = maps.find(&around(x_m), gone, extent_of);
        (map, lacking.len())
    }

    #[test]
    fn only_tiles_that_come_into_a_box_are_drawn() {
        let mut maps = ShadowMaps::new(2);
        assert_eq!(find(&mut maps, 0.0, &[]), (0, 64));
        assert_eq!(find(&mut maps, 5.0, &[]), (0, 0));
        assert_eq!(find(&mut maps, 16.0, &[]), (0, 8));
        assert_eq!(find(&mut maps, 0.0, &[]), (0, 8), "and where one goes back");
        assert_eq!(find(&mut maps, 0.0, &[7]), (0, 4), "a parked car was pushed");
        assert_eq!(find(&mut maps, 0.0, &[8, 7]), (0, 0), "one far away");
        assert_eq!(find(&mut maps, 0.0, &[8]), (0, 4), "it is back");
    }

    #[test]
    fn the_map_that_was_not_used_for_longest_is_drawn_anew() {
        let mut maps = ShadowMaps::new(2);
        assert_eq!(find(&mut maps, 0.0, &[]), (0, 64));
        assert_eq!(find(&mut maps, 500.0, &[]), (1, 64));
        assert_eq!(find(&mut maps, 0.0, &[]), (0, 0));
        assert_eq!(find(&mut maps, 1000.0, &[]), (1, 64));
        assert_eq!(find(&mut maps, 0.0, &[]), (0, 0));
        assert_eq!(find(&mut maps, 500.0, &[]), (1, 64));
        let other = ShadowBox::around(Vec3::ZERO, Vec3::X, 64.0);
        assert_eq!(maps.find(&other, &[], |_| None).1.len(), 64, "another sun");
        assert_eq!(find(&mut maps, 500.0, &[]), (1, 0));
    }
}

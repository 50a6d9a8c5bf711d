//! Which shadow maps are kept, and what they show.

use crate::light::ShadowBox;

/// Shadow maps by their numbers. What moves casts no shadow in them, so one is as good as new for the same square with the
/// same parked cars.
pub(crate) struct ShadowMaps {
    most: usize,
    shown: Vec<Shown>,
    draws: u64,
}

struct Shown {
    square: ShadowBox,
    /// Parked cars that are left out.
    gone: Vec<usize>,
    last_draw: u64,
}

impl ShadowMaps {
    /// So many at most.
    pub(crate) fn new(most: usize) -> Self {
        Self { most: most.max(1), shown: Vec::new(), draws: 0 }
    }

    /// Casts all of them anew: something else stands there.
    pub(crate) fn forget(&mut self) {
        self.shown.clear();
    }

    /// The number of the map for a square, and whether it shows that already; if not, it is one that was not used for longest.
    pub(crate) fn find(&mut self, square: ShadowBox, gone: Vec<usize>) -> (usize, bool) {
        self.draws += 1;
        if let Some(index) = self.shown.iter().position(|shown| shown.square == square && shown.gone == gone) {
            self.shown[index].last_draw = self.draws;
            return (index, true);
        }
        let shown = Shown { square, gone, last_draw: self.draws };
        if self.shown.len() < self.most {
            self.shown.push(shown);
            return (self.shown.len() - 1, false);
        }
        let oldest = (0..self.shown.len()).min_by_key(|index| self.shown[*index].last_draw).unwrap_or(0);
        self.shown[oldest] = shown;
        (oldest, false)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn the_map_that_was_not_used_for_longest_is_drawn_anew() {
        let square = |x| ShadowBox { centre: Vec3::new(x, 0.0, 0.0), sun: Vec3::Z, reach_m: 64.0 };
        let mut maps = ShadowMaps::new(2);
        assert_eq!(maps.find(square(1.0), vec![]), (0, false));
        assert_eq!(maps.find(square(2.0), vec![]), (1, false));
        assert_eq!(maps.find(square(1.0), vec![]), (0, true));
        assert_eq!(maps.find(square(2.0), vec![7]), (1, false), "a parked car was pushed");
        assert_eq!(maps.find(square(3.0), vec![]), (0, false));
        assert_eq!(maps.find(square(1.0), vec![]), (1, false));
        assert_eq!(maps.find(square(3.0), vec![]), (0, true));
    }
}

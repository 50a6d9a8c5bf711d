//! What the drivers of a population are like, as far as a scenario says so.

use crate::state;

state! {
    /// Numbers of drivers; each draws its own between the two of a range.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Population {
        /// Share of the speed limit that cars aim at. Other motor vehicles aim at as much more or less of it as cars do.
        pub speed_share: [f32; 2],
        /// Time headway, s.
        pub headway_s: [f32; 2],
        /// How much the others' accelerations count for who changes lanes: 0 not at all, 1 as much as the own.
        pub politeness: f32,
    }
}

impl Population {
    /// Speeds about the limit, as free speeds measured in towns are; headways around the 1.5 s of the intelligent driver
    /// model; the politeness of MOBIL between the 0.2 and 0.5 that its authors call realistic.
    pub const USUAL: Self = Self { speed_share: [0.88, 1.06], headway_s: [1.0, 1.8], politeness: 0.3 };
}

impl Default for Population {
    fn default() -> Self {
        Self::USUAL
    }
}

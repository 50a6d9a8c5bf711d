//! How much traffic there is.

use crate::state;

state! {
    /// How many actors of each kind there are, and how they behave.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct TrafficCounts {
        /// Cars, lorries and buses.
        pub cars: u16,
        /// Motorcycles.
        pub motorcycles: u16,
        /// Bicycles.
        pub bicycles: u16,
        /// Pedestrians.
        pub pedestrians: u16,
        /// Mean number of times a minute that anyone walking beside a road steps onto it, of all together.
        pub jaywalks_per_min: f32,
    }
}

//! Bus stops.

use super::digest::digested;
use super::ids::LaneId;

digested! {
    /// A place at which buses on a lane halt.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct BusStop {
        /// The lane, that at the kerb.
        pub lane: LaneId,
        /// Where their fronts come to a stand, metres from its start.
        pub s_m: f32,
    }
}

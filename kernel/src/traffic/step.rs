//! A lane on the way of a vehicle.

use crate::map_data::LaneId;

/// Distance kept from a line, metres.
pub(super) const LINE_MARGIN_M: f32 = 1.0;

/// A lane of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Step {
    pub lane: LaneId,
    /// From the vehicle's middle to the start of the lane, metres; negative for the lane it is on.
    pub start_m: f32,
    /// Where on the lane the vehicle arrives, metres from its start.
    pub from_m: f32,
}

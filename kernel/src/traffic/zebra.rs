//! Crosswalks are kept clear: nobody drives onto one without room behind it.

use super::lane_way::CrosswalkSpan;
use super::step::{LINE_MARGIN_M, Step};
use super::traits::Driver;
use super::ways::Ways;

/// Where a vehicle that has to stop at `stop_m` stops so that it stands on no crosswalk; both from
/// its front, metres. A crosswalk that its front is over already counts no more.
pub(super) fn kept_clear(ways: &Ways, steps: &[Step], driver: &Driver, stop_m: f32) -> f32 {
    let (front_m, length_m) = (driver.size_m.x * 0.5, driver.size_m.x);
    let mut stop_m = stop_m;
    for step in steps.iter().rev() {
        for span in ways.lanes[step.lane as usize].crosswalks.iter().rev() {
            let [near_m, far_m] = [span.near_m, span.far_m].map(|m| step.start_m + m - front_m);
            if near_m > -0.3 && near_m < stop_m && far_m > stop_m - length_m {
                stop_m = near_m - LINE_MARGIN_M;
            }
        }
    }
    stop_m
}

/// How far a vehicle's tail has to get so that it stands neither before `end_m` nor on a crosswalk
/// right behind it, measured as `end_m` is.
pub(super) fn beyond(ways: &Ways, steps: &[Step], driver: &Driver, end_m: f32) -> f32 {
    let spans = |step: &Step| {
        let start_m = step.start_m;
        let at = move |span: &CrosswalkSpan| [span.near_m, span.far_m].map(|m| start_m + m);
        ways.lanes[step.lane as usize].crosswalks.iter().map(at)
    };
    let mut end_m = end_m;
    for [near_m, far_m] in steps.iter().flat_map(spans) {
        if far_m > end_m && near_m - end_m < driver.size_m.x + driver.gap_m {
            end_m = far_m;
        }
    }
    end_m
}

//! How fast the file lets people drive, within what traffic can do.

use crate::map_data::URBAN_MPS;

/// No limit is lower, 5 km/h: who drives slower than a walk counts as standing.
const LEAST_MPS: f32 = 5.0 / 3.6;
/// Nor is any higher, 130 km/h, as on motorways, and where the file says that there is no limit.
const MOST_MPS: f32 = 130.0 / 3.6;

/// A limit that the file tells.
pub(super) fn within(told_mps: f32) -> f32 {
    told_mps.clamp(LEAST_MPS, MOST_MPS)
}

/// The limit of a lane by what the file tells of it, else by the type of its road; `None` where it tells 0.
pub(super) fn limit_mps(told: Option<xodr::SpeedLimit>, kind: Option<xodr::RoadType>) -> Option<f32> {
    match told {
        Some(xodr::SpeedLimit::Max(mps)) => (mps > 0.0).then(|| within(mps)),
        Some(xodr::SpeedLimit::Unlimited) => Some(MOST_MPS),
        None => Some(by_type(kind)),
    }
}

fn by_type(kind: Option<xodr::RoadType>) -> f32 {
    use xodr::RoadType as R;
    match kind {
        Some(R::Motorway) => MOST_MPS,
        Some(R::Rural) => 100.0 / 3.6,
        Some(R::TownExpressway) => 80.0 / 3.6,
        Some(R::LowSpeed | R::Bicycle) => 30.0 / 3.6,
        Some(R::TownPlayStreet | R::Pedestrian) => 7.0 / 3.6,
        _ => URBAN_MPS,
    }
}

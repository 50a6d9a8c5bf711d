//! The part of a picture that is the map: which places it shows, and how large.

use glam::{Vec2, Vec3Swizzles};
use kernel::map::MapData;

/// Room around the lanes, metres, and as a share of the longer side.
const MARGIN_M: f32 = 12.0;
const MARGIN: f32 = 0.02;
/// The map is at least so wide and high, pixels.
const LEAST_PX: f64 = 60.0;

/// Coordinates in the picture are centimetres from the north-west corner, so that they are short.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// South-west corner.
    low: Vec2,
    /// North-east corner.
    high: Vec2,
    /// Pixels for a metre.
    pub px_per_m: f64,
}

impl Sheet {
    /// That of a map whose longer side has so many pixels.
    pub fn of(map: &MapData, longest_px: u32) -> Self {
        let points = map.lanes.iter().flat_map(|lane| &lane.points).map(|point| point.position.xy());
        let (low, high) = points.fold((Vec2::MAX, Vec2::MIN), |(low, high), p| (low.min(p), high.max(p)));
        let margin = Vec2::splat(MARGIN_M + MARGIN * (high - low).max_element());
        let (low, high) = (low - margin, high + margin);
        Self { low, high, px_per_m: f64::from(longest_px) / f64::from((high - low).max_element()) }
    }

    /// Width and height in centimetres.
    pub fn size_cm(&self) -> [i64; 2] {
        let size = self.high - self.low;
        [size.x, size.y].map(|m| (100.0 * f64::from(m)).ceil() as i64)
    }

    /// Width and height in pixels.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_cm().map(|cm| (cm as f64 / 100.0 * self.px_per_m).ceil().max(LEAST_PX) as u32)
    }

    /// A place in the picture.
    pub fn cm(&self, place: Vec2) -> [i64; 2] {
        [place.x - self.low.x, self.high.y - place.y].map(|m| (100.0 * f64::from(m)).round() as i64)
    }

    /// Whether a place is in the picture, give or take so many metres.
    pub fn holds(&self, place: Vec2, reach_m: f32) -> bool {
        (place + reach_m).cmpge(self.low).all() && (place - reach_m).cmple(self.high).all()
    }

    /// So many pixels in metres, within a range: what is to be seen at any size is no smaller than it is, nor much larger.
    pub fn metres(&self, px: f64, least_m: f64, most_m: f64) -> f32 {
        (px / self.px_per_m).clamp(least_m, most_m) as f32
    }
}

/// Metres as centimetres.
pub fn cm(metres: f32) -> i64 {
    (100.0 * f64::from(metres)).round() as i64
}

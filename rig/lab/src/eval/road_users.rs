//! How much of each road user is seen, by size and by distance: of people on foot, riders and vehicles.
//!
//! Somebody with the number of a vehicle in the same picture rides it, as a two-wheeler and its rider are one instance;
//! a rider whose two-wheeler is hidden is taken for a person on foot.
//!
//! A dataset holds no depth. The distance is that of the point of flat ground at which the lowest
//! visible row of the road user is seen by the level driver's camera, along the view: `f h / (v - v0)`
//! with focal length `f` and horizon `v0` in pixels, and height `h` in metres. Who would be too tall at
//! that distance has hidden feet, and none is told; nor is it of datasets of other cameras. Slopes, a pitching
//! car and other hidden feet bend it, and one row is much of a great distance, hence few and wide ranges.

use std::collections::BTreeMap;

use perception::classes::PEDESTRIAN_TAG;
use render::{Camera, SemanticTag};
use serde::Serialize;

/// Lower ends of the ranges of height, pixels.
const HEIGHTS_PX: [f64; 4] = [0.0, 8.0, 16.0, 32.0];
/// Lower ends of the ranges of distance, metres.
const DISTANCES_M: [f64; 4] = [0.0, 10.0, 20.0, 40.0];
const VEHICLE_TAG: u8 = SemanticTag::Vehicles as u8;

/// A kind of road user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// On foot.
    Pedestrian,
    /// On a two-wheeler, without it.
    Rider,
    /// A vehicle, two-wheelers among them.
    Vehicle,
}

impl Kind {
    /// None is taller, metres.
    fn tallest_m(self) -> f64 {
        match self {
            Self::Pedestrian => 2.0,
            Self::Rider => 2.2,
            Self::Vehicle => 4.2,
        }
    }
}

/// A road user in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoadUser {
    /// What it is.
    pub kind: Kind,
    /// Visible pixels.
    pub pixels: u64,
    /// Those that are predicted as what they are: Pedestrian of people, Vehicles of vehicles.
    pub hits: u64,
    /// Rows from the highest to the lowest visible pixel, both included.
    pub height_px: u32,
    /// From the camera along its view, by the lowest row; `None` where feet or wheels are hidden.
    pub distance_m: Option<f64>,
}

/// How much of some road users is seen; shares are in [0, 1], absent where there is nobody.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Recall {
    /// Road users, counted once a picture.
    pub count: u64,
    /// Their visible pixels.
    pub pixels: u64,
    /// Share of those pixels that are predicted as what they are.
    pub pixel_recall: Option<f64>,
    /// Mean over the road users of that share of each.
    pub mean_recall: Option<f64>,
    /// Share of the road users of whom at least half of the pixels are.
    pub half_seen: Option<f64>,
}

/// The recall of those whose size or distance is at least `from` and less than the next one's.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Range {
    /// Where it begins, pixels or metres.
    pub from: f64,
    /// Where the next one begins; absent for the last.
    pub to: Option<f64>,
    /// Of those within.
    #[serde(flatten)]
    pub recall: Recall,
}

/// The recall of a kind of road users.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// Of all.
    #[serde(flatten)]
    pub all: Recall,
    /// By height in the picture, pixels.
    pub by_height_px: Vec<Range>,
    /// By distance, metres.
    pub by_distance_m: Vec<Range>,
    /// Of those whose distance is not known: their feet or wheels are hidden, or other cameras than the drivers' took
    /// the dataset.
    pub feet_hidden: Recall,
}

/// The recall of road users by kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RoadUsers {
    /// People on foot.
    pub pedestrians: Group,
    /// Riders of two-wheelers.
    pub riders: Group,
    /// Vehicles, two-wheelers among them.
    pub vehicles: Group,
}

/// The road users of a picture, by their ids: `instances` as Cityscapes has them (tag * 1000 + number),
/// `predicted` in tags, both row by row from the top.
pub fn road_users(instances: &[u16], (width, height): (u32, u32), predicted: &[u8]) -> Vec<RoadUser> {
    struct Found {
        pixels: u64,
        hits: u64,
        highest: usize,
        lowest: usize,
    }
    let mut found: BTreeMap<(u8, u16), Found> = BTreeMap::new();
    for (i, (id, predicted)) in instances.iter().zip(predicted).enumerate() {
        let (tag, row) = ((id / 1000) as u8, i / width as usize);
        if tag == PEDESTRIAN_TAG || tag == VEHICLE_TAG {
            let user = found.entry((tag, id % 1000)).or_insert(Found { pixels: 0, hits: 0, highest: row, lowest: row });
            user.pixels += 1;
            user.hits += u64::from(*predicted == tag);
            user.lowest = row;
        }
    }
    let camera = Camera::driver(width, height);
    let user = |(&(tag, number), &Found { pixels, hits, highest, lowest }): (&(u8, u16), &Found)| {
        let kind = match tag {
            VEHICLE_TAG => Kind::Vehicle,
            _ if found.contains_key(&(VEHICLE_TAG, number)) => Kind::Rider,
            _ => Kind::Pedestrian,
        };
        let height_px = (lowest - highest + 1) as u32;
        let distance_m = distance_m(&camera, lowest + 1, height_px, kind.tallest_m());
        RoadUser { kind, pixels, hits, height_px, distance_m }
    };
    found.iter().map(user).collect()
}

/// Distance along the view of somebody who is `height_px` high and whose feet are seen by the level
/// camera at `v` pixels below the picture's upper edge, on flat ground.
fn distance_m(camera: &Camera, v: usize, height_px: u32, tallest_m: f64) -> Option<f64> {
    let focal_px = 0.5 * f64::from(camera.width) / (0.5 * f64::from(camera.fov_x_rad)).tan();
    let below_horizon_px = v as f64 - 0.5 * f64::from(camera.height);
    let distance_m = focal_px * f64::from(camera.position.z) / below_horizon_px;
    let is_seen = below_horizon_px > 0.0 && f64::from(height_px) * distance_m <= focal_px * tallest_m;
    is_seen.then_some(distance_m)
}

impl Recall {
    fn of<'a>(users: impl Iterator<Item = &'a RoadUser>) -> Self {
        let (mut recall, mut hits, mut shares, mut half) = (Self::default(), 0, 0.0, 0u64);
        for user in users {
            recall.count += 1;
            recall.pixels += user.pixels;
            hits += user.hits;
            shares += user.hits as f64 / user.pixels as f64;
            half += u64::from(2 * user.hits >= user.pixels);
        }
        let share = |part: f64, whole: u64| (whole > 0).then(|| part / whole as f64);
        recall.pixel_recall = share(hits as f64, recall.pixels);
        recall.mean_recall = share(shares, recall.count);
        recall.half_seen = share(half as f64, recall.count);
        recall
    }
}

impl Group {
    fn of(users: &[RoadUser], kind: Kind) -> Self {
        let users: Vec<RoadUser> = users.iter().copied().filter(|user| user.kind == kind).collect();
        Self {
            all: Recall::of(users.iter()),
            by_height_px: ranges(&users, &HEIGHTS_PX, |user| Some(user.height_px.into())),
            by_distance_m: ranges(&users, &DISTANCES_M, |user| user.distance_m),
            feet_hidden: Recall::of(users.iter().filter(|user| user.distance_m.is_none())),
        }
    }
}

impl RoadUsers {
    /// That of some, in an order that is always the same.
    pub(super) fn of(users: &[RoadUser]) -> Self {
        let [pedestrians, riders, vehicles] =
            [Kind::Pedestrian, Kind::Rider, Kind::Vehicle].map(|kind| Group::of(users, kind));
        Self { pedestrians, riders, vehicles }
    }
}

fn ranges(users: &[RoadUser], ends: &[f64], value: impl Fn(&RoadUser) -> Option<f64>) -> Vec<Range> {
    let range = |(i, from): (usize, &f64)| {
        let to = ends.get(i + 1).copied();
        let within = |user: &&RoadUser| value(user).is_some_and(|v| v >= *from && to.is_none_or(|to| v < to));
        Range { from: *from, to, recall: Recall::of(users.iter().filter(within)) }
    };
    ends.iter().enumerate().map(range).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn road_users_are_told_apart_and_measured() {
        // Columns 0 and 1: a person of four pixels, two of them seen; column 2: a rider of one pixel above the horizon, a
        // bicycle below; column 3: a person of three pixels.
        let instances = [7, 7, 7, 4002, 4000, 4000, 4001, 4002, 4000, 4000, 10_001, 4002, 7, 7, 7, 7];
        let predicted = [4, 7, 7, 7, 4, 7, 7, 7, 4, 7, 10, 7, 7, 7, 7, 7];
        let found = road_users(&instances, (4, 4), &predicted);
        let [first, rider, third, bicycle] = found[..] else { panic!("four road users") };
        assert_eq!(
            [first, rider, third, bicycle].map(|user| (user.kind, user.pixels, user.hits, user.height_px)),
            [
                (Kind::Pedestrian, 4, 2, 2),
                (Kind::Rider, 1, 0, 1),
                (Kind::Pedestrian, 3, 0, 3),
                (Kind::Vehicle, 1, 1, 1)
            ]
        );
        // f = 2 px, h = 1.5 m: 3 m at one pixel below the horizon, where three pixels are 4.5 m.
        assert_eq!((rider.distance_m, third.distance_m), (None, None));
        assert!(bicycle.distance_m.is_some_and(|d| (d - 3.0).abs() < 1e-6));
        let camera = Camera::driver(4, 4);
        let far = |height_px, tallest_m| distance_m(&camera, 3, height_px, tallest_m);
        assert!(far(1, 2.0).is_some() && far(3, 2.0).is_none() && far(3, 4.5).is_some());
        let first = RoadUser { distance_m: Some(3.0), ..first };

        let RoadUsers { pedestrians, riders, vehicles } = RoadUsers::of(&[first, third, rider, bicycle]);
        let Group { all, by_height_px, by_distance_m, feet_hidden } = pedestrians;
        let shares = (all.pixel_recall, all.mean_recall, all.half_seen);
        assert_eq!((all.count, all.pixels, shares), (2, 7, (Some(2.0 / 7.0), Some(0.25), Some(0.5))));
        assert_eq!(by_height_px.iter().map(|range| range.recall.count).collect::<Vec<_>>(), [2, 0, 0, 0]);
        assert_eq!(by_distance_m.iter().map(|range| range.recall.count).collect::<Vec<_>>(), [1, 0, 0, 0]);
        assert_eq!((feet_hidden.count, by_distance_m[1].recall.half_seen), (1, None));
        assert_eq!((riders.all.half_seen, vehicles.all.half_seen), (Some(0.0), Some(1.0)));
    }
}

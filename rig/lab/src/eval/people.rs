//! How much of each pedestrian is seen, by size and by distance.
//!
//! A dataset holds no depth. The distance is that of the point of flat ground at which the lowest
//! visible row of the person is seen by the level driver's camera, along the view: `f h / (v - v0)`
//! with focal length `f` and horizon `v0` in pixels, and height `h` in metres. Who would be too tall at
//! that distance has hidden feet, and none is told; nor is it of datasets of other cameras. Slopes, a pitching car and other hidden feet bend
//! it, and one row is much of a great distance, hence few and wide ranges.

use std::collections::BTreeMap;

use perception::classes::PEDESTRIAN_TAG;
use render::Camera;
use serde::Serialize;

/// Lower ends of the ranges of height, pixels.
const HEIGHTS_PX: [f64; 4] = [0.0, 8.0, 16.0, 32.0];
/// Lower ends of the ranges of distance, metres.
const DISTANCES_M: [f64; 4] = [0.0, 10.0, 20.0, 40.0];
/// Nobody is taller, metres.
const TALLEST_M: f64 = 2.0;
/// Ids of pedestrians begin here: tag * 1000 + number.
const FIRST_ID: u16 = PEDESTRIAN_TAG as u16 * 1000;

/// A pedestrian in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Person {
    /// Visible pixels.
    pub pixels: u64,
    /// Those that are predicted as Pedestrian.
    pub hits: u64,
    /// Rows from the highest to the lowest visible pixel, both included.
    pub height_px: u32,
    /// From the camera along its view, by the lowest row; `None` where the feet are hidden.
    pub distance_m: Option<f64>,
}

/// How much of some pedestrians is seen; shares are in [0, 1], absent where there is nobody.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Recall {
    /// Pedestrians, counted once a picture.
    pub people: u64,
    /// Their visible pixels.
    pub pixels: u64,
    /// Share of those pixels that are predicted as Pedestrian.
    pub pixel_recall: Option<f64>,
    /// Mean over the people of that share of each.
    pub mean_recall: Option<f64>,
    /// Share of the people of whom at least half of the pixels are.
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

/// The recall of pedestrians.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pedestrians {
    /// Of all.
    #[serde(flatten)]
    pub all: Recall,
    /// By height in the picture, pixels.
    pub by_height_px: Vec<Range>,
    /// By distance, metres.
    pub by_distance_m: Vec<Range>,
    /// Of those whose distance is not known: their feet are hidden, or other cameras than the drivers' took the dataset.
    pub feet_hidden: Recall,
}

/// The pedestrians of a picture, by their ids: `instances` as Cityscapes has them (tag * 1000 + number),
/// `predicted` in tags, both row by row from the top.
pub fn people(instances: &[u16], (width, height): (u32, u32), predicted: &[u8]) -> Vec<Person> {
    let mut found: BTreeMap<u16, (Person, usize, usize)> = BTreeMap::new();
    for (i, (id, tag)) in instances.iter().zip(predicted).enumerate() {
        let row = i / width as usize;
        if (FIRST_ID..FIRST_ID + 1000).contains(id) {
            let none = Person { pixels: 0, hits: 0, height_px: 0, distance_m: None };
            let (person, _, lowest) = found.entry(*id).or_insert((none, row, row));
            person.pixels += 1;
            person.hits += u64::from(*tag == PEDESTRIAN_TAG);
            *lowest = row;
        }
    }
    let camera = Camera::driver(width, height);
    let person = |(person, highest, lowest): (Person, usize, usize)| {
        let height_px = (lowest - highest + 1) as u32;
        Person { height_px, distance_m: distance_m(&camera, lowest + 1, height_px), ..person }
    };
    found.into_values().map(person).collect()
}

/// Distance along the view of somebody who is `height_px` high and whose feet are seen by the level
/// camera at `v` pixels below the picture's upper edge, on flat ground.
fn distance_m(camera: &Camera, v: usize, height_px: u32) -> Option<f64> {
    let focal_px = 0.5 * f64::from(camera.width) / (0.5 * f64::from(camera.fov_x_rad)).tan();
    let below_horizon_px = v as f64 - 0.5 * f64::from(camera.height);
    let distance_m = focal_px * f64::from(camera.position.z) / below_horizon_px;
    let is_seen = below_horizon_px > 0.0 && f64::from(height_px) * distance_m <= focal_px * TALLEST_M;
    is_seen.then_some(distance_m)
}

impl Recall {
    fn of<'a>(people: impl Iterator<Item = &'a Person>) -> Self {
        let (mut recall, mut hits, mut shares, mut half) = (Self::default(), 0, 0.0, 0u64);
        for person in people {
            recall.people += 1;
            recall.pixels += person.pixels;
            hits += person.hits;
            shares += person.hits as f64 / person.pixels as f64;
            half += u64::from(2 * person.hits >= person.pixels);
        }
        let share = |part: f64, whole: u64| (whole > 0).then(|| part / whole as f64);
        recall.pixel_recall = share(hits as f64, recall.pixels);
        recall.mean_recall = share(shares, recall.people);
        recall.half_seen = share(half as f64, recall.people);
        recall
    }
}

impl Pedestrians {
    /// That of some people, in an order that is always the same.
    pub(super) fn of(people: &[Person]) -> Self {
        Self {
            all: Recall::of(people.iter()),
            by_height_px: ranges(people, &HEIGHTS_PX, |person| Some(person.height_px.into())),
            by_distance_m: ranges(people, &DISTANCES_M, |person| person.distance_m),
            feet_hidden: Recall::of(people.iter().filter(|person| person.distance_m.is_none())),
        }
    }
}

fn ranges(people: &[Person], ends: &[f64], value: impl Fn(&Person) -> Option<f64>) -> Vec<Range> {
    let range = |(i, from): (usize, &f64)| {
        let to = ends.get(i + 1).copied();
        let within = |person: &&Person| value(person).is_some_and(|v| v >= *from && to.is_none_or(|to| v < to));
        Range { from: *from, to, recall: Recall::of(people.iter().filter(within)) }
    };
    ends.iter().enumerate().map(range).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn people_are_told_apart_and_measured() {
        // Columns 0 and 1: a person of four pixels, two of them seen; column 2: one of one pixel above
        // the horizon, a rider's bicycle below; column 3: one of three pixels.
        let instances = [7, 7, 7, 4002, 4000, 4000, 4001, 4002, 4000, 4000, 10_001, 4002, 7, 7, 7, 7];
        let predicted = [4, 7, 7, 7, 4, 7, 7, 7, 4, 7, 4, 7, 7, 7, 7, 7];
        let [first, second, third] = people(&instances, (4, 4), &predicted)[..] else { panic!("three people") };
        assert_eq!((first.pixels, first.hits, first.height_px), (4, 2, 2));
        assert_eq!((second.pixels, second.hits, second.height_px), (1, 0, 1));
        // f = 2 px, h = 1.5 m: 3 m at one pixel below the horizon, where three pixels are 4.5 m.
        assert_eq!((second.distance_m, third.distance_m), (None, None));
        let camera = Camera::driver(4, 4);
        assert!(
            distance_m(&camera, 3, 1).is_some_and(|d| (d - 3.0).abs() < 1e-6) && distance_m(&camera, 3, 2).is_none()
        );
        let first = Person { distance_m: Some(3.0), ..first };

        let Pedestrians { all, by_height_px, by_distance_m, feet_hidden } = Pedestrians::of(&[first, second]);
        let shares = (all.pixel_recall, all.mean_recall, all.half_seen);
        assert_eq!((all.people, all.pixels, shares), (2, 5, (Some(0.4), Some(0.25), Some(0.5))));
        assert_eq!(by_height_px.iter().map(|range| range.recall.people).collect::<Vec<_>>(), [2, 0, 0, 0]);
        assert_eq!(by_distance_m.iter().map(|range| range.recall.people).collect::<Vec<_>>(), [1, 0, 0, 0]);
        assert_eq!(feet_hidden.people, 1);
        assert_eq!(by_distance_m[1].recall.half_seen, None);
    }
}

//! How well people are seen who are not small, where the small ones count nowhere: neither what is predicted of them nor
//! that they were not seen. What is taken for people and is none counts.

use perception::ConfusionMatrix;
use perception::classes::{PEDESTRIAN, TRAIN_CLASSES};
use serde::Serialize;

use super::road_users::{Kind, RoadUser};

/// Least heights that are told of, pixels.
const LEAST_PX: [u32; 3] = [8, 16, 32];

/// How well people of at least a height are seen, riders among them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tall {
    /// The least height, pixels; smaller people count nowhere.
    pub least_px: u32,
    /// People, counted once a picture.
    pub count: u64,
    /// Their visible pixels.
    pub pixels: u64,
    /// IoU of pedestrians.
    pub iou: Option<f64>,
    /// Share of those pixels that are predicted as pedestrian.
    pub recall: Option<f64>,
}

/// That of each least height, from all road users and the matrix of the same pictures.
pub(super) fn tall(users: &[RoadUser], matrix: &ConfusionMatrix) -> Vec<Tall> {
    let others = (0..TRAIN_CLASSES.len()).filter(|class| *class != PEDESTRIAN);
    let mistaken: u64 = others.map(|class| matrix.count(class as u8, PEDESTRIAN as u8)).sum();
    let of = |least_px: u32| {
        let (mut count, mut pixels, mut hits) = (0, 0, 0);
        for user in users.iter().filter(|user| user.kind != Kind::Vehicle && user.height_px >= least_px) {
            (count, pixels, hits) = (count + 1, pixels + user.pixels, hits + user.hits);
        }
        let share = |whole: u64| (whole > 0).then(|| hits as f64 / whole as f64);
        Tall { least_px, count, pixels, iou: share(pixels + mistaken), recall: share(pixels) }
    };
    LEAST_PX.map(of).to_vec()
}

#[cfg(test)]
mod tests {
    use super::super::road_users::road_users;
    use super::*;

    const ROAD: u8 = 7;
    const PERSON: u8 = 4;

    #[test]
    fn small_people_count_nowhere_and_what_is_nobody_does() {
        // A column each: somebody of 20 rows, half seen; somebody of 10, seen; road taken for people in 5 rows.
        let (width, height) = (4, 20);
        let instance = |i: u32| match (i % width, i / width) {
            (0, _) => 4000,
            (1, 0..10) => 4001,
            _ => u16::from(ROAD),
        };
        let seen = |i: u32| match (i % width, i / width) {
            (0, 0..10) | (1, 0..10) | (2, 0..5) => PERSON,
            _ => ROAD,
        };
        let instances: Vec<u16> = (0..width * height).map(instance).collect();
        let truth: Vec<u8> = instances.iter().map(|id| if *id >= 1000 { (*id / 1000) as u8 } else { ROAD }).collect();
        let predicted: Vec<u8> = (0..width * height).map(seen).collect();
        let mut matrix = ConfusionMatrix::default();
        matrix.add(&truth, &predicted);
        let [from_8, from_16, from_32] =
            tall(&road_users(&instances, (width, height), &predicted), &matrix).try_into().expect("three heights");
        assert_eq!((from_8.count, from_8.iou, from_8.recall), (2, Some(20.0 / 35.0), Some(20.0 / 30.0)));
        assert_eq!((from_16.count, from_16.iou, from_16.recall), (1, Some(10.0 / 25.0), Some(0.5)));
        assert_eq!((from_32.count, from_32.pixels, from_32.iou, from_32.recall), (0, 0, Some(0.0), None));
    }
}

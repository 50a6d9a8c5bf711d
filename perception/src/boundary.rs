//! How well the outlines of things fit: IoU of what lies near boundaries.
//!
//! Boundary IoU (Cheng et al. 2021, "Boundary IoU: Improving Object-Centric Image Segmentation Evaluation"): of each
//! class, only those pixels of truth and prediction count that lie within a distance of 2 % of the picture's diagonal
//! from another class or from the picture's edge. Large areas weigh no more than their outlines.

use crate::classes::{IGNORE, TRAIN_CLASSES, TRAIN_ID_OF_TAG};

const CLASSES: usize = TRAIN_CLASSES.len();
/// How far a boundary reaches, as a share of the picture's diagonal.
const REACH: f64 = 0.02;

/// Pixels near boundaries, by class.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BoundaryCounts {
    both: [u64; CLASSES],
    either: [u64; CLASSES],
}

impl BoundaryCounts {
    /// Counts a picture of tags, row by row from the top; pixels whose truth is not trained count nowhere.
    ///
    /// # Panics
    /// If a length is not that of the size.
    pub fn add(&mut self, (width, height): (usize, usize), truth: &[u8], predicted: &[u8]) {
        assert!(truth.len() == width * height && predicted.len() == truth.len(), "truth and prediction must be whole");
        let reach_px = (REACH * ((width * width + height * height) as f64).sqrt()).round().max(1.0) as usize;
        let near = |tags: &[u8]| -> Vec<u8> {
            let ids: Vec<u8> = tags.iter().map(|tag| TRAIN_ID_OF_TAG[usize::from(*tag)]).collect();
            let mask = near_boundaries(&ids, width, reach_px);
            // What lies within stands for no class.
            ids.iter().zip(mask).map(|(id, near)| if near { *id } else { IGNORE }).collect()
        };
        for ((tag, t), p) in truth.iter().zip(near(truth)).zip(near(predicted)) {
            if TRAIN_ID_OF_TAG[usize::from(*tag)] == IGNORE {
                continue;
            }
            let mut count = |counts: fn(&mut Self) -> &mut [u64; CLASSES], id: u8| {
                counts(self).get_mut(usize::from(id)).into_iter().for_each(|count| *count += 1);
            };
            count(|own| &mut own.either, t);
            if t == p {
                count(|own| &mut own.both, t);
            } else {
                count(|own| &mut own.either, p);
            }
        }
    }

    /// Adds the counts of another one.
    pub fn merge(&mut self, other: &Self) {
        let add = |sums: &mut [u64], others: &[u64]| sums.iter_mut().zip(others).for_each(|(sum, more)| *sum += more);
        add(&mut self.both, &other.both);
        add(&mut self.either, &other.either);
    }

    /// That of each class in [0, 1], at the index of its train id; NaN for an absent class.
    pub fn iou(&self) -> [f64; CLASSES] {
        std::array::from_fn(|class| self.both[class] as f64 / self.either[class] as f64)
    }
}

/// Which pixels lie within `reach_px` (in rows and columns, so within a square) of another id or of the picture's edge.
fn near_boundaries(ids: &[u8], width: usize, reach_px: usize) -> Vec<bool> {
    let height = ids.len() / width;
    // The lowest and highest id around each pixel, first along the rows, then along the columns: one id alone lies between.
    let along = |low: &[u8], high: &[u8], len: usize, stride: usize| {
        let extreme = |i: usize| {
            let (at, base) = (i / stride % len, i - i / stride % len * stride);
            let window = at.saturating_sub(reach_px)..(at + reach_px + 1).min(len);
            let places = window.map(|k| base + k * stride);
            places.fold((u8::MAX, 0), |(least, most), k| (least.min(low[k]), most.max(high[k])))
        };
        (0..low.len()).map(extreme).unzip::<u8, u8, Vec<u8>, Vec<u8>>()
    };
    let (low, high) = along(ids, ids, width, 1);
    let (low, high) = along(&low, &high, height, width);
    let is_edge = |i: usize| {
        let (x, y) = (i % width, i / width);
        x.min(y).min(width - 1 - x).min(height - 1 - y) < reach_px
    };
    (0..ids.len()).map(|i| low[i] != high[i] || is_edge(i)).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::classes::tag_of_train_id;

    const ROAD: u8 = 7;
    const SKY: u8 = 13;

    /// The reference's way: a mask less what is left of it after so many erosions by one pixel, with nothing around it.
    fn eroded(mask: &[bool], width: usize, times: usize) -> Vec<bool> {
        let height = mask.len() / width;
        (0..times).fold(mask.to_vec(), |mask, _| {
            let at = |x: isize, y: isize| {
                let is_in = (0..width as isize).contains(&x) && (0..height as isize).contains(&y);
                is_in && mask[y as usize * width + x as usize]
            };
            let survives = |i: usize| {
                let (x, y) = ((i % width) as isize, (i / width) as isize);
                (-1..=1).all(|dy| (-1..=1).all(|dx| at(x + dx, y + dy)))
            };
            (0..mask.len()).map(survives).collect()
        })
    }

    proptest! {
        #[test]
        fn boundaries_are_what_erosion_takes(
            ids in prop::collection::vec(0u8..3, 60), patch in (0usize..10, 0usize..6, 1usize..9), reach_px in 1usize..4,
        ) {
            let (width, mut ids) = (10, ids);
            let (x, y, side) = patch;
            (0..60).filter(|i| (x..x + side).contains(&(i % 10)) && (y..y + side).contains(&(i / 10))).for_each(|i| ids[i] = 1);
            let near = near_boundaries(&ids, width, reach_px);
            for id in 0..3 {
                let mask: Vec<bool> = ids.iter().map(|other| *other == id).collect();
                let inner = eroded(&mask, width, reach_px);
                for i in 0..60 {
                    prop_assert_eq!(near[i] && mask[i], mask[i] && !inner[i]);
                }
            }
        }

        #[test]
        fn the_truth_is_perfect_and_parts_make_a_whole(classes in prop::collection::vec(0u8..16, 64), other in prop::collection::vec(0u8..16, 64)) {
            let tags = |classes: &[u8]| classes.iter().map(|class| tag_of_train_id(*class)).collect::<Vec<_>>();
            let (truth, other) = (tags(&classes), tags(&other));
            let count = |predicted: &[u8]| {
                let mut counts = BoundaryCounts::default();
                counts.add((8, 8), &truth, predicted);
                counts
            };
            prop_assert!(count(&truth).iou().iter().all(|iou| iou.is_nan() || *iou == 1.0));
            let (mut sum, more) = (count(&truth), count(&other));
            sum.merge(&more);
            let mut whole = count(&other);
            whole.add((8, 8), &truth, &truth);
            prop_assert_eq!(sum, whole);
        }
    }

    #[test]
    fn outlines_weigh_more_than_areas() {
        // A horizon that is two rows too low, in a picture of 200x100: IoU hardly sees it, the boundary does.
        let picture = |horizon: usize| -> Vec<u8> {
            (0..200 * 100).map(|i| if i / 200 < horizon { SKY } else { ROAD }).collect()
        };
        let (truth, predicted) = (picture(50), picture(52));
        let mut counts = BoundaryCounts::default();
        counts.add((200, 100), &truth, &predicted);
        let mut matrix = crate::ConfusionMatrix::default();
        matrix.add(&truth, &predicted);
        let (outline, area) = (counts.iou()[5], matrix.iou(5));
        assert!(outline < 0.85 && area > 0.95, "{outline}, {area}");
    }
}

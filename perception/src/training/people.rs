//! People in a frame, from the instance ids of Cityscapes' layout: how tall each is, and where.

use std::collections::BTreeMap;

use crate::classes::{IGNORE, PEDESTRIAN_TAG};

/// Somebody who is seen, riders among them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Person {
    /// Rows from the highest to the lowest visible pixel, both included; pixels of the frame.
    pub height_px: u32,
    /// The middle of the box around what is seen: column and row, pixels of the frame.
    pub middle: (u32, u32),
    /// All visible pixels, as places in the frame row by row; sorted.
    pub pixels: Vec<u32>,
}

/// All people of a frame of `width` pixels, whose `instances` are tag * 1000 + number, row by row.
pub fn people(instances: &[u16], width: usize) -> Vec<Person> {
    let mut found: BTreeMap<u16, Vec<u32>> = BTreeMap::new();
    for (i, id) in instances.iter().enumerate().filter(|(_, id)| *id / 1000 == u16::from(PEDESTRIAN_TAG)) {
        found.entry(*id).or_default().push(i as u32);
    }
    found.into_values().map(|pixels| person(pixels, width as u32)).collect()
}

fn person(pixels: Vec<u32>, width: u32) -> Person {
    let span = |places: &mut dyn Iterator<Item = u32>| {
        places.fold((u32::MAX, 0), |(low, high), place| (low.min(place), high.max(place)))
    };
    let (left, right) = span(&mut pixels.iter().map(|i| i % width));
    let (top, bottom) = span(&mut pixels.iter().map(|i| i / width));
    Person { height_px: bottom - top + 1, middle: (left.midpoint(right), top.midpoint(bottom)), pixels }
}

/// Labels in which people who are less than `least_px` high count nowhere, where there are any; heights are `scale`
/// times as many pixels as in the frame.
pub(super) fn without_small(labels: &[u8], people: &[Person], scale: f32, least_px: u32) -> Option<Vec<u8>> {
    let is_small = |person: &&Person| (person.height_px as f32) * scale < least_px as f32;
    let mut small = people.iter().filter(is_small).peekable();
    small.peek()?;
    let mut labels = labels.to_vec();
    small.flat_map(|person| &person.pixels).for_each(|i| labels[*i as usize] = IGNORE);
    Some(labels)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Somebody of two columns and three rows, somebody of one pixel, a car.
    const INSTANCES: [u16; 12] = [7, 4001, 10_000, 4000, 4001, 4001, 7, 7, 7, 4001, 7, 7];

    #[test]
    fn people_are_found_with_their_heights() {
        let found = people(&INSTANCES, 4);
        assert_eq!(found.iter().map(|p| p.height_px).collect::<Vec<_>>(), [1, 3]);
        assert_eq!((found[0].middle, found[1].middle), ((3, 0), (0, 1)));
        assert_eq!(found[1].pixels, [1, 4, 5, 9]);
    }

    #[test]
    fn the_small_count_nowhere_and_nobody_else() {
        let found = people(&INSTANCES, 4);
        let labels = [2; 12];
        let marked = |scale, least| {
            let without = without_small(&labels, &found, scale, least)?;
            Some((0..12).filter(|i| without[*i] == IGNORE).collect::<Vec<_>>())
        };
        assert_eq!(marked(1.0, 1), None);
        assert_eq!(marked(1.0, 2), Some(vec![3]));
        assert_eq!(marked(2.0, 6), Some(vec![3]));
        assert_eq!(marked(0.5, 2), Some(vec![1, 3, 4, 5, 9]));
    }
}

//! What of a picture belongs together: an instance of a class that is counted, or all of a class that is not.

use std::collections::BTreeMap;

use render::{Frame, SemanticTag};

/// The id of what is no segment.
pub const VOID: u32 = 0;

/// Whether a class is counted: the renderer numbers people and vehicles, with their riders.
pub fn is_thing(tag: SemanticTag) -> bool {
    matches!(tag, SemanticTag::Pedestrian | SemanticTag::Vehicles)
}

/// What belongs together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Its class.
    pub tag: u8,
    /// The renderer's number of the instance; 0 of what is not counted.
    pub instance: u16,
    /// Pixels.
    pub area_px: u32,
    /// Its first and last column.
    pub columns: (u32, u32),
    /// Its first and last row.
    pub rows: (u32, u32),
}

impl Segment {
    /// Left, top, width and height, pixels.
    pub fn box_px(&self) -> [u32; 4] {
        let ((left, right), (top, bottom)) = (self.columns, self.rows);
        [left, top, right - left + 1, bottom - top + 1]
    }
}

/// The id of each pixel's segment: 65536 times its class and the number of the instance, so that the blue of a picture of ids
/// is the class. Nothing known is [`VOID`].
pub fn ids(frame: &Frame) -> Vec<u32> {
    let id = |(tag, instance): (&u8, &u16)| {
        let is_counted = SemanticTag::from_id(*tag).is_some_and(is_thing);
        match *tag {
            tag if tag == SemanticTag::Unlabeled as u8 => VOID,
            tag if is_counted => u32::from(tag) << 16 | u32::from(*instance),
            tag => u32::from(tag) << 16,
        }
    };
    frame.class_ids.iter().zip(&frame.instance_ids).map(id).collect()
}

/// The segments of a picture by their ids.
pub fn segments(ids: &[u32], width: u32) -> BTreeMap<u32, Segment> {
    let mut found = BTreeMap::new();
    for (row, pixels) in (0..).zip(ids.chunks(width as usize)) {
        for (column, id) in (0..).zip(pixels).filter(|(_, id)| **id != VOID) {
            let segment = found.entry(*id).or_insert(Segment {
                tag: (id >> 16) as u8,
                instance: *id as u16,
                area_px: 0,
                columns: (column, column),
                rows: (row, row),
            });
            segment.area_px += 1;
            segment.columns = (segment.columns.0.min(column), segment.columns.1.max(column));
            segment.rows.1 = row;
        }
    }
    found
}

/// A mask as COCO's lengths of runs down the columns, in turn of what is outside and of what is inside.
pub fn runs(ids: &[u32], (width, height): (u32, u32), id: u32, segment: &Segment) -> Vec<u32> {
    let ((left, right), (top, bottom)) = (segment.columns, segment.rows);
    let pixels = (left..=right).flat_map(|column| (top..=bottom).map(move |row| (column, row)));
    let inside = pixels.filter(|(column, row)| ids[(row * width + column) as usize] == id);
    // From and to, counted down the columns.
    let mut spans: Vec<(u32, u32)> = Vec::new();
    for at in inside.map(|(column, row)| column * height + row) {
        match spans.last_mut() {
            Some((_, end)) if *end == at => *end += 1,
            _ => spans.push((at, at + 1)),
        }
    }
    let (mut lengths, mut done) = (Vec::with_capacity(2 * spans.len() + 1), 0);
    for (from, to) in spans {
        lengths.extend([from - done, to - from]);
        done = to;
    }
    let rest = width * height - done;
    lengths.extend((rest > 0).then_some(rest));
    lengths
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two cars, one of them behind a rider, on a road under a sky of which nothing is known.
    fn picture() -> Frame {
        let (car, rider, road) = (10, 4, 7);
        Frame {
            width: 4,
            height: 3,
            class_ids: vec![0, car, car, 0, car, rider, car, road, road, rider, car, road],
            instance_ids: vec![0, 8, 9, 0, 8, 8, 9, 0, 0, 8, 9, 3],
            ..Frame::default()
        }
    }

    #[test]
    fn instances_of_things_and_classes_of_stuff_are_segments() {
        let ids = ids(&picture());
        assert_eq!((ids[0], ids[1], ids[5], ids[7]), (VOID, 10 << 16 | 8, 4 << 16 | 8, 7 << 16));
        let found = segments(&ids, 4);
        let told: Vec<_> = found.values().map(|s| (s.tag, s.instance, s.area_px, s.box_px())).collect();
        assert_eq!(
            told,
            [(4, 8, 2, [1, 1, 1, 2]), (7, 0, 3, [0, 1, 4, 2]), (10, 8, 2, [0, 0, 2, 2]), (10, 9, 3, [2, 0, 1, 3])]
        );
    }

    #[test]
    fn runs_go_down_the_columns_and_make_the_whole_picture() {
        let ids = ids(&picture());
        let of = |id| runs(&ids, (4, 3), id, &segments(&ids, 4)[&id]);
        assert_eq!(of(10 << 16 | 9), [6, 3, 3]);
        assert_eq!(of(10 << 16 | 8), [1, 1, 1, 1, 8]);
        assert_eq!(of(7 << 16), [2, 1, 7, 2]);
        for (id, segment) in segments(&ids, 4) {
            let runs = of(id);
            assert_eq!(runs.iter().sum::<u32>(), 12, "{id}");
            assert_eq!(runs.iter().skip(1).step_by(2).sum::<u32>(), segment.area_px, "{id}");
        }
    }
}

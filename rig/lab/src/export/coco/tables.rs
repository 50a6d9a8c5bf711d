//! The annotations as COCO has them: `panoptic.json`, with everything in the pictures, and `instances.json`, with what is
//! counted.

use std::collections::BTreeMap;

use kernel::time::{TICK_HZ, Tick};
use render::tags::TAGS;
use render::{SemanticTag, actor_of_instance};
use serde::{Deserialize, Serialize};

use super::segments::{Segment, is_thing, runs};

/// What an export follows from, by names.
pub type About = BTreeMap<String, String>;

/// About the annotations; `aeye` is what they were made from.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Info {
    pub description: String,
    pub version: String,
    pub aeye: About,
}

/// A file of annotations.
#[derive(Serialize)]
pub struct Table<'a, A> {
    pub info: &'a Info,
    /// None: what is simulated is nobody's picture.
    pub licenses: [u8; 0],
    pub images: &'a [Image],
    pub annotations: &'a [A],
    pub categories: Vec<Category>,
}

/// A picture; its id is its tick.
#[derive(Serialize)]
pub struct Image {
    pub id: Tick,
    pub file_name: String,
    pub width: u32,
    pub height: u32,
    /// Simulated time, seconds.
    pub time_s: f64,
}

impl Image {
    /// That of a tick.
    pub fn of(tick: Tick, file_name: String, (width, height): (u32, u32)) -> Self {
        Self { id: tick, file_name, width, height, time_s: tick as f64 / f64::from(TICK_HZ) }
    }
}

/// A class; its id is that of CARLA 0.9.10.
#[derive(Serialize)]
pub struct Category {
    pub id: u8,
    pub name: &'static str,
    pub supercategory: &'static str,
    pub isthing: u8,
    pub color: [u8; 3],
}

impl Category {
    /// Every class.
    pub fn all() -> Vec<Self> {
        TAGS.iter().map(|tag| Self::of(*tag)).collect()
    }

    /// Those that are counted.
    pub fn things() -> Vec<Self> {
        TAGS.iter().filter(|tag| is_thing(**tag)).map(|tag| Self::of(*tag)).collect()
    }

    fn of(tag: SemanticTag) -> Self {
        let isthing = u8::from(is_thing(tag));
        Self { id: tag as u8, name: tag.name(), supercategory: supercategory(tag), isthing, color: tag.colour() }
    }
}

/// The group that Cityscapes has a class in.
fn supercategory(tag: SemanticTag) -> &'static str {
    use SemanticTag as Tag;
    match tag {
        Tag::Unlabeled | Tag::Other | Tag::Static | Tag::Dynamic => "void",
        Tag::Building | Tag::Wall | Tag::Fence | Tag::GuardRail | Tag::Bridge => "construction",
        Tag::Pole | Tag::TrafficSign | Tag::TrafficLight => "object",
        Tag::Pedestrian | Tag::Rider => "human",
        Tag::Road | Tag::RoadLine | Tag::SideWalk | Tag::Ground | Tag::RailTrack => "flat",
        Tag::Vegetation | Tag::Terrain | Tag::Water => "nature",
        Tag::Sky => "sky",
        Tag::Vehicles | Tag::Truck | Tag::Bus | Tag::Motorcycle | Tag::Bicycle | Tag::Train => "vehicle",
    }
}

/// All of a picture.
#[derive(Serialize)]
pub struct Panoptic {
    pub image_id: Tick,
    pub file_name: String,
    pub segments_info: Vec<SegmentInfo>,
}

/// A segment of a picture.
#[derive(Serialize)]
pub struct SegmentInfo {
    pub id: u32,
    pub category_id: u8,
    pub iscrowd: u8,
    pub area: u32,
    pub bbox: [u32; 4],
}

impl SegmentInfo {
    /// That of a segment.
    pub fn of(id: u32, segment: &Segment) -> Self {
        Self { id, category_id: segment.tag, iscrowd: 0, area: segment.area_px, bbox: segment.box_px() }
    }
}

/// An instance in a picture; `track_id` is the same in all pictures, and the number that it has in the recording; `segment_id`
/// is that of its segment in the panoptic picture.
#[derive(Serialize)]
pub struct Instance {
    pub id: usize,
    pub image_id: Tick,
    pub category_id: u8,
    pub track_id: u32,
    pub segment_id: u32,
    pub iscrowd: u8,
    pub area: u32,
    pub bbox: [u32; 4],
    pub segmentation: Mask,
}

/// A mask: the size, height first, and lengths of runs.
#[derive(Serialize)]
pub struct Mask {
    pub size: [u32; 2],
    pub counts: Vec<u32>,
}

impl Instance {
    /// Those of a picture whose pixels have these ids, numbered from `first` on.
    pub fn of_picture(
        first: usize,
        (tick, size): (Tick, (u32, u32)),
        ids: &[u32],
        segments: &BTreeMap<u32, Segment>,
    ) -> Vec<Self> {
        let counted = segments.iter().filter(|(_, segment)| SemanticTag::from_id(segment.tag).is_some_and(is_thing));
        let instance = |(number, (id, segment)): (usize, (&u32, &Segment))| Self {
            id: first + number,
            image_id: tick,
            category_id: segment.tag,
            track_id: actor_of_instance(segment.instance),
            segment_id: *id,
            iscrowd: 0,
            area: segment.area_px,
            bbox: segment.box_px(),
            segmentation: Mask { size: [size.1, size.0], counts: runs(ids, size, *id, segment) },
        };
        counted.enumerate().map(instance).collect()
    }
}

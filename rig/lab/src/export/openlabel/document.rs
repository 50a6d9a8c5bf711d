//! The parts of OpenLABEL 1.0 that are written.

use std::collections::BTreeMap;

use kernel::time::Tick;
use serde::Serialize;

/// By numbers, which are keys in JSON.
pub type Numbered<T> = BTreeMap<u32, T>;

/// A file.
#[derive(Serialize)]
pub struct Document {
    pub openlabel: Labels,
}

/// What is in it. Parts that hold nothing are left out.
#[derive(Serialize)]
pub struct Labels {
    pub metadata: Metadata,
    pub ontologies: Numbered<Ontology>,
    pub coordinate_systems: BTreeMap<String, System>,
    pub streams: BTreeMap<String, Stream>,
    pub tags: Numbered<Tag>,
    pub frame_intervals: Vec<Interval>,
    pub objects: Numbered<Element>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub events: Numbered<Element>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub actions: Numbered<Element>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub relations: Numbered<Relation>,
    pub frames: Numbered<Frame>,
}

/// About the file.
#[derive(Serialize)]
pub struct Metadata {
    pub schema_version: &'static str,
    pub annotator: String,
    pub comment: String,
    /// Name of the recording.
    pub tagged_file: String,
    /// BLAKE3 of it.
    pub tagged_file_blake3: String,
    pub map: String,
    /// What to add to coordinates to have those of the map's file, metres to the east and to the north.
    pub origin_m: [f64; 2],
}

#[derive(Serialize)]
pub struct Ontology {
    pub uri: &'static str,
    pub boundary_list: Vec<&'static str>,
    pub boundary_mode: &'static str,
}

/// A coordinate system.
#[derive(Serialize)]
pub struct System {
    pub r#type: &'static str,
    pub parent: &'static str,
    pub children: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose_wrt_parent: Option<Pose>,
}

/// A place and a rotation (x, y, z, w).
#[derive(Clone, Copy, Serialize)]
pub struct Pose {
    pub quaternion: [f32; 4],
    pub translation: [f32; 3],
}

#[derive(Serialize)]
pub struct Stream {
    pub r#type: &'static str,
    pub description: String,
    pub stream_properties: StreamProperties,
}

#[derive(Serialize)]
pub struct StreamProperties {
    pub intrinsics_pinhole: Pinhole,
}

#[derive(Serialize)]
pub struct Pinhole {
    pub width_px: u32,
    pub height_px: u32,
    pub camera_matrix: [f64; 12],
    pub distortion_coeffs: [f64; 5],
}

/// What is true of the whole window.
#[derive(Serialize)]
pub struct Tag {
    pub r#type: &'static str,
    pub ontology_uid: &'static str,
    #[serde(skip_serializing_if = "Data::is_empty")]
    pub tag_data: Data,
}

/// From frame to frame, both included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Interval {
    pub frame_start: u32,
    pub frame_end: u32,
}

/// An object, an event or an action.
#[derive(Default, Serialize)]
pub struct Element {
    pub name: String,
    pub r#type: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ontology_uid: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coordinate_system: Option<&'static str>,
    pub frame_intervals: Vec<Interval>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub object_data_pointers: BTreeMap<&'static str, Pointer>,
    #[serde(skip_serializing_if = "Data::is_empty")]
    pub event_data: Data,
    #[serde(skip_serializing_if = "Data::is_empty")]
    pub action_data: Data,
}

/// Where data of an object is.
#[derive(Serialize)]
pub struct Pointer {
    pub r#type: &'static str,
    pub frame_intervals: Vec<Interval>,
}

/// Named values.
#[derive(Default, Serialize)]
pub struct Data {
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cuboid: Vec<Cuboid>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub num: Vec<Value<f64>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub text: Vec<Value<String>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub boolean: Vec<Value<bool>>,
}

impl Data {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        let Self { cuboid, num, text, boolean } = self;
        cuboid.is_empty() && num.is_empty() && text.is_empty() && boolean.is_empty()
    }
}

#[derive(Serialize)]
pub struct Value<T> {
    pub name: &'static str,
    pub val: T,
}

/// A box: middle, rotation (x, y, z, w), length, width and height.
#[derive(Serialize)]
pub struct Cuboid {
    pub name: &'static str,
    pub val: [f32; 10],
    pub coordinate_system: &'static str,
}

/// Who had to do with what.
#[derive(Serialize)]
pub struct Relation {
    pub name: String,
    pub r#type: &'static str,
    pub rdf_subjects: [Agent; 1],
    pub rdf_objects: [Agent; 1],
}

#[derive(Serialize)]
pub struct Agent {
    pub r#type: &'static str,
    pub uid: String,
}

/// A moment.
#[derive(Serialize)]
pub struct Frame {
    pub frame_properties: FrameProperties,
    pub objects: Numbered<InFrame>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub events: Numbered<InFrame>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub actions: Numbered<InFrame>,
}

#[derive(Serialize)]
pub struct FrameProperties {
    /// Simulated time, seconds.
    pub timestamp: f64,
    pub tick: Tick,
    pub transforms: BTreeMap<&'static str, Transform>,
}

#[derive(Serialize)]
pub struct Transform {
    pub src: &'static str,
    pub dst: &'static str,
    pub transform_src_to_dst: Pose,
}

/// What is told of an element in one frame.
#[derive(Default, Serialize)]
pub struct InFrame {
    #[serde(skip_serializing_if = "Data::is_empty")]
    pub object_data: Data,
}

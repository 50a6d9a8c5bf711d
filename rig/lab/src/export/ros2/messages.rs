//! The messages of ROS 2 that a bag holds; `msg` has their definitions. Fields come in the order of these, since that is all
//! that CDR, their encoding, knows of them.

use byteorder::LittleEndian;
use serde::{Serialize, Serializer};

/// Tells that what follows is plain CDR, little-endian.
const ENCAPSULATION: [u8; 4] = [0, 1, 0, 0];

/// A message that a topic can hold.
pub trait Message: Serialize + Sized {
    /// Its type, as in `std_msgs/msg/Header`.
    const TYPE: &'static str;

    /// Its bytes, with the encapsulation's.
    fn encode(&self) -> anyhow::Result<Vec<u8>> {
        let mut bytes = ENCAPSULATION.to_vec();
        // Fields are aligned from behind the encapsulation on.
        cdr_encoding::to_writer::<_, LittleEndian, _>(&mut bytes, self)?;
        Ok(bytes)
    }
}

macro_rules! message {
    ($name:ident, $type:literal) => {
        impl Message for $name {
            const TYPE: &'static str = $type;
        }
    };
}

message!(Clock, "rosgraph_msgs/msg/Clock");
message!(TFMessage, "tf2_msgs/msg/TFMessage");
message!(Odometry, "nav_msgs/msg/Odometry");
message!(CompressedImage, "sensor_msgs/msg/CompressedImage");
message!(CameraInfo, "sensor_msgs/msg/CameraInfo");
message!(LabelInfo, "vision_msgs/msg/LabelInfo");
message!(MarkerArray, "visualization_msgs/msg/MarkerArray");
message!(Log, "rcl_interfaces/msg/Log");

/// A time, or a length of time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Time {
    pub sec: i32,
    pub nanosec: u32,
}

impl Time {
    /// From nanoseconds.
    pub fn of(time_ns: u64) -> Self {
        let sec = i32::try_from(time_ns / 1_000_000_000).unwrap_or(i32::MAX);
        Self { sec, nanosec: (time_ns % 1_000_000_000) as u32 }
    }
}

#[derive(Serialize)]
pub struct Clock {
    pub clock: Time,
}

/// When, and in which frame.
#[derive(Clone, Default, Serialize)]
pub struct Header {
    pub stamp: Time,
    pub frame_id: String,
}

/// A place or a direction.
#[derive(Clone, Copy, Default, Serialize)]
pub struct Vector3 {
    pub x: f64,
    pub y: f64,
    pub z: f64,
}

#[derive(Clone, Copy, Serialize)]
pub struct Quaternion {
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub w: f64,
}

impl Default for Quaternion {
    fn default() -> Self {
        Self { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }
    }
}

/// A place with a rotation; also a transform, which has the same fields.
#[derive(Clone, Copy, Default, Serialize)]
pub struct Pose {
    pub position: Vector3,
    pub orientation: Quaternion,
}

#[derive(Serialize)]
pub struct TransformStamped {
    pub header: Header,
    pub child_frame_id: String,
    pub transform: Pose,
}

#[derive(Serialize)]
pub struct TFMessage {
    pub transforms: Vec<TransformStamped>,
}

/// Row by row, nothing where nothing is uncertain.
type Covariance = [[f64; 6]; 6];

#[derive(Serialize)]
pub struct Odometry {
    pub header: Header,
    pub child_frame_id: String,
    pub pose: Pose,
    pub pose_covariance: Covariance,
    /// m/s along the child's axes.
    pub linear: Vector3,
    /// rad/s about the child's axes.
    pub angular: Vector3,
    pub twist_covariance: Covariance,
}

/// Bytes that are written as they are.
#[derive(Clone, Default)]
pub struct Bytes(pub Vec<u8>);

impl Serialize for Bytes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(&self.0)
    }
}

#[derive(Clone, Default, Serialize)]
pub struct CompressedImage {
    pub header: Header,
    pub format: String,
    pub data: Bytes,
}

#[derive(Clone, Serialize)]
pub struct CameraInfo {
    pub header: Header,
    pub height: u32,
    pub width: u32,
    pub distortion_model: String,
    pub d: Vec<f64>,
    pub k: [f64; 9],
    pub r: [f64; 9],
    pub p: [f64; 12],
    pub binning_x: u32,
    pub binning_y: u32,
    pub roi: Region,
}

/// A part of a picture; the whole of it where all is 0.
#[derive(Clone, Default, Serialize)]
pub struct Region {
    pub x_offset: u32,
    pub y_offset: u32,
    pub height: u32,
    pub width: u32,
    pub do_rectify: bool,
}

#[derive(Serialize)]
pub struct VisionClass {
    pub class_id: u16,
    pub class_name: String,
}

#[derive(Serialize)]
pub struct LabelInfo {
    pub header: Header,
    pub class_map: Vec<VisionClass>,
    pub threshold: f32,
}

/// [0, 1] each.
#[derive(Clone, Copy, Default, Serialize)]
pub struct Colour {
    pub r: f32,
    pub g: f32,
    pub b: f32,
    pub a: f32,
}

#[derive(Clone, Default, Serialize)]
pub struct MeshFile {
    pub filename: String,
    pub data: Bytes,
}

/// Something to see in a 3D view; lists that nothing here fills are of no length.
#[derive(Clone, Default, Serialize)]
pub struct Marker {
    pub header: Header,
    pub ns: String,
    pub id: i32,
    pub r#type: i32,
    pub action: i32,
    pub pose: Pose,
    pub scale: Vector3,
    pub color: Colour,
    pub lifetime: Time,
    pub frame_locked: bool,
    pub points: Vec<Vector3>,
    pub colors: Vec<Colour>,
    pub texture_resource: String,
    pub texture: CompressedImage,
    pub uv_coordinates: Vec<[f32; 2]>,
    pub text: String,
    pub mesh_resource: String,
    pub mesh_file: MeshFile,
    pub mesh_use_embedded_materials: bool,
}

impl Marker {
    /// `type` of a box.
    pub const CUBE: i32 = 1;
    /// `action` that takes away all markers.
    pub const DELETE_ALL: i32 = 3;
}

#[derive(Serialize)]
pub struct MarkerArray {
    pub markers: Vec<Marker>,
}

/// A line of a log.
#[derive(Serialize)]
pub struct Log {
    pub stamp: Time,
    pub level: u8,
    pub name: String,
    pub msg: String,
    pub file: String,
    pub function: String,
    pub line: u32,
}

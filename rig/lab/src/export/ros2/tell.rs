//! What a tick is in messages of ROS 2. Frames are those of REP 105: `map`, in which the map lies, and `base_link`, the ego
//! car's rear axle on the ground, x ahead, y left, z up; pictures of the drivers are of `camera_optical_frame`, x right, y down, z
//! ahead, those of others of frames of their own.

use foxglove::messages::Log as Line;
use glam::{Quat, Vec3};
use kernel::scene::{EgoScene, SceneSnapshot};
use render::camera::OPTICAL;
use render::{Camera, tags};
use replay::nanoseconds;
use viewers::boxes::{MAP, RoadUser, road_users};

use super::messages::{
    Bytes, CameraInfo, Colour, CompressedImage, Header, LabelInfo, Log, Marker, MarkerArray, Odometry, Pose,
    Quaternion, Region, TFMessage, Time, TransformStamped, Vector3, VisionClass,
};
use super::motion::Twist;

/// Frame of the ego car.
const BASE: &str = "base_link";
/// Frame of the pictures of the drivers' camera.
pub const OPTICAL_FRAME: &str = "camera_optical_frame";
/// Of a picture, its colours and how it is compressed, as `image_transport` writes it.
const RGB_PNG: &str = "rgb8; png compressed bgr8";
/// The same of a mask.
const GREY_PNG: &str = "mono8; png compressed mono8";

fn header(frame: &str, time_ns: u64) -> Header {
    Header { stamp: Time::of(time_ns), frame_id: frame.into() }
}

fn vector(v: Vec3) -> Vector3 {
    let [x, y, z] = v.as_dvec3().to_array();
    Vector3 { x, y, z }
}

fn pose(position: Vec3, rotation: Quat) -> Pose {
    let q = rotation.as_dquat().normalize();
    Pose { position: vector(position), orientation: Quaternion { x: q.x, y: q.y, z: q.z, w: q.w } }
}

fn transform(parent: &str, child: &str, transform: Pose, time_ns: u64) -> TransformStamped {
    TransformStamped { header: header(parent, time_ns), child_frame_id: child.into(), transform }
}

/// Where the ego car is.
pub fn ego(ego: &EgoScene, time_ns: u64) -> TFMessage {
    TFMessage { transforms: vec![transform(MAP, BASE, pose(ego.position, ego.rotation), time_ns)] }
}

/// Where the cameras are on it, each in its frame, for good.
pub fn mounting<'a>(cameras: impl IntoIterator<Item = (&'a str, &'a Camera)>, time_ns: u64) -> TFMessage {
    let of = |(frame, camera): (&str, &Camera)| {
        transform(BASE, frame, pose(camera.position, camera.rotation * OPTICAL), time_ns)
    };
    TFMessage { transforms: cameras.into_iter().map(of).collect() }
}

/// Where the ego car is, and how it moves.
pub fn odometry(ego: &EgoScene, twist: &Twist, time_ns: u64) -> Odometry {
    Odometry {
        header: header(MAP, time_ns),
        child_frame_id: BASE.into(),
        pose: pose(ego.position, ego.rotation),
        pose_covariance: Default::default(),
        linear: vector(twist.linear_mps),
        angular: vector(twist.angular_radps),
        twist_covariance: Default::default(),
    }
}

/// What the pixels of the camera in a frame are: square, and where its lens shows them.
pub fn camera_info(camera: &Camera, frame: &str, time_ns: u64) -> CameraInfo {
    let k = camera.intrinsics();
    let [fx, _, cx, _, fy, cy, ..] = k;
    CameraInfo {
        header: header(frame, time_ns),
        height: camera.height,
        width: camera.width,
        distortion_model: "plumb_bob".into(),
        d: camera.distortion().to_vec(),
        k,
        r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p: [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        binning_x: 0,
        binning_y: 0,
        roi: Region::default(),
    }
}

/// A picture of the camera in a frame, a PNG file.
pub fn picture(png: Vec<u8>, frame: &str, time_ns: u64) -> CompressedImage {
    CompressedImage { header: header(frame, time_ns), format: RGB_PNG.into(), data: Bytes(png) }
}

/// A mask, a grey PNG file whose values are classes.
pub fn mask(png: Vec<u8>, frame: &str, time_ns: u64) -> CompressedImage {
    CompressedImage { format: GREY_PNG.into(), ..picture(png, frame, time_ns) }
}

/// What the values of masks are called.
pub fn labels(time_ns: u64) -> LabelInfo {
    let class = |tag: &tags::SemanticTag| VisionClass { class_id: *tag as u16, class_name: tag.name().into() };
    let class_map = tags::TAGS.iter().map(class).collect();
    LabelInfo { header: header(OPTICAL_FRAME, time_ns), class_map, threshold: 0.0 }
}

/// Every road user as a box; those before are gone. The ego car has the number 0, others those that they keep.
pub fn markers(scene: &SceneSnapshot) -> MarkerArray {
    let time_ns = nanoseconds(scene.tick);
    let gone = Marker { header: header(MAP, time_ns), action: Marker::DELETE_ALL, ..Marker::default() };
    let ids = std::iter::once(0).chain(scene.actors.iter().map(|actor| actor.id as i32));
    let boxes = ids.zip(road_users(scene)).map(|(id, user)| cube(id, user, time_ns));
    MarkerArray { markers: std::iter::once(gone).chain(boxes).collect() }
}

fn cube(id: i32, user: RoadUser, time_ns: u64) -> Marker {
    let [r, g, b] = user.colour;
    // Markers of a kind are shown and hidden together.
    let ns = user.name.trim_end_matches(|c: char| c.is_ascii_digit()).trim_end().to_owned();
    Marker {
        header: header(MAP, time_ns),
        ns,
        id,
        r#type: Marker::CUBE,
        pose: pose(user.middle, user.rotation),
        scale: vector(user.size_m),
        color: Colour { r, g, b, a: 1.0 },
        text: user.name,
        ..Marker::default()
    }
}

/// Something that happened.
pub fn happening(line: Line, time_ns: u64) -> Log {
    // Levels of ROS are ten times those of Foxglove.
    let level = u8::try_from(10 * line.level).unwrap_or_default();
    Log {
        stamp: Time::of(time_ns),
        level,
        name: line.name,
        msg: line.message,
        file: line.file,
        function: String::new(),
        line: line.line,
    }
}

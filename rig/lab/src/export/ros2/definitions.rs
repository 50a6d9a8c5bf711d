//! The definitions of ROS 2's messages, as a bag holds them.

use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Every definition that is needed, by package and name.
const DEFINITIONS: [(&str, &str); 26] = [
    ("builtin_interfaces/Duration", include_str!("msg/builtin_interfaces/Duration.msg")),
    ("builtin_interfaces/Time", include_str!("msg/builtin_interfaces/Time.msg")),
    ("geometry_msgs/Point", include_str!("msg/geometry_msgs/Point.msg")),
    ("geometry_msgs/Pose", include_str!("msg/geometry_msgs/Pose.msg")),
    ("geometry_msgs/PoseWithCovariance", include_str!("msg/geometry_msgs/PoseWithCovariance.msg")),
    ("geometry_msgs/Quaternion", include_str!("msg/geometry_msgs/Quaternion.msg")),
    ("geometry_msgs/Transform", include_str!("msg/geometry_msgs/Transform.msg")),
    ("geometry_msgs/TransformStamped", include_str!("msg/geometry_msgs/TransformStamped.msg")),
    ("geometry_msgs/Twist", include_str!("msg/geometry_msgs/Twist.msg")),
    ("geometry_msgs/TwistWithCovariance", include_str!("msg/geometry_msgs/TwistWithCovariance.msg")),
    ("geometry_msgs/Vector3", include_str!("msg/geometry_msgs/Vector3.msg")),
    ("nav_msgs/Odometry", include_str!("msg/nav_msgs/Odometry.msg")),
    ("rcl_interfaces/Log", include_str!("msg/rcl_interfaces/Log.msg")),
    ("rosgraph_msgs/Clock", include_str!("msg/rosgraph_msgs/Clock.msg")),
    ("sensor_msgs/CameraInfo", include_str!("msg/sensor_msgs/CameraInfo.msg")),
    ("sensor_msgs/CompressedImage", include_str!("msg/sensor_msgs/CompressedImage.msg")),
    ("sensor_msgs/RegionOfInterest", include_str!("msg/sensor_msgs/RegionOfInterest.msg")),
    ("std_msgs/ColorRGBA", include_str!("msg/std_msgs/ColorRGBA.msg")),
    ("std_msgs/Header", include_str!("msg/std_msgs/Header.msg")),
    ("tf2_msgs/TFMessage", include_str!("msg/tf2_msgs/TFMessage.msg")),
    ("vision_msgs/LabelInfo", include_str!("msg/vision_msgs/LabelInfo.msg")),
    ("vision_msgs/VisionClass", include_str!("msg/vision_msgs/VisionClass.msg")),
    ("visualization_msgs/Marker", include_str!("msg/visualization_msgs/Marker.msg")),
    ("visualization_msgs/MarkerArray", include_str!("msg/visualization_msgs/MarkerArray.msg")),
    ("visualization_msgs/MeshFile", include_str!("msg/visualization_msgs/MeshFile.msg")),
    ("visualization_msgs/UVCoordinate", include_str!("msg/visualization_msgs/UVCoordinate.msg")),
];

/// Stands between definitions.
const RULE: &str = "================================================================================";

/// The definition of a type, as in `std_msgs/msg/Header`, with those of all that it is made of.
pub fn whole(name: &str) -> String {
    let name = name.replace("/msg/", "/");
    let mut parts = BTreeSet::new();
    collect(&name, &mut parts);
    let mut text = of(&name).to_owned();
    for part in parts.iter().filter(|part| **part != name) {
        // Writing to a string cannot fail.
        let _ = write!(text, "{RULE}\nMSG: {part}\n{}", of(part));
    }
    text
}

/// The definition of a type alone; empty where there is none, which a test finds.
fn of(name: &str) -> &'static str {
    DEFINITIONS.iter().find(|(known, _)| *known == name).map_or("", |(_, text)| text)
}

fn collect(name: &str, parts: &mut BTreeSet<String>) {
    if !parts.insert(name.to_owned()) {
        return;
    }
    for part in fields(name).filter_map(|(of_field, _)| made_of(name, of_field)) {
        collect(&part, parts);
    }
}

/// The fields of a type: type and name of each.
pub(super) fn fields(name: &str) -> impl Iterator<Item = (&'static str, &'static str)> {
    let words = of(name).lines().filter(|line| !line.starts_with('#') && !line.contains('='));
    words.filter_map(|line| {
        let mut words = line.split(' ');
        Some((words.next()?, words.next()?))
    })
}

/// The type that a field is made of, with its package; nothing for a number or a text.
pub(super) fn made_of(name: &str, of_field: &str) -> Option<String> {
    let part = of_field.split('[').next().unwrap_or(of_field);
    let package = name.split('/').next().unwrap_or_default();
    let part = if part.contains('/') { part.to_owned() } else { format!("{package}/{part}") };
    (!of(&part).is_empty()).then_some(part)
}

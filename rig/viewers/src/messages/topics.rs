//! The names of topics, live and in files, and what each holds.

/// Frames `map`, `ego`, `camera` and each actor's; in a file a message a picture.
pub const TRANSFORMS: &str = "/tf";
/// Every road user as a box; in a file a message a picture.
pub const ACTORS: &str = "/actors";
/// Figures to plot; in a file every tick.
pub const TELEMETRY: &str = "/telemetry";
/// What happened.
pub const EVENTS: &str = "/events";

/// Live: how the rig keeps up.
pub const RIG: &str = "/rig";
/// Live: what the safety driver sees.
pub const SAFETY: &str = "/camera/safety";
/// Live: what the semantic driver sees.
pub const SEMANTIC: &str = "/camera/semantic";

/// In files: pose of the ego car's rear axle, every tick.
pub const POSE: &str = "/ego/pose";
/// In files: the whole way of the ego car, once.
pub const PATH: &str = "/ego/path";
/// In files: how critical it is, ten times a second.
pub const CRITICALITY: &str = "/criticality";
/// In files: roads, paint and sidewalks, once.
pub const GROUND: &str = "/map";
/// In files: what the camera is, a message a picture.
pub const CALIBRATION: &str = "/camera/calibration";
/// In files: the picture.
pub const RGB: &str = "/camera/rgb";
/// In files: ground truth of the picture.
pub const TRUTH: &str = "/camera/truth";

/// In files: what another camera is, a message a picture.
pub fn calibration_of(camera: &str) -> String {
    format!("/cameras/{camera}/calibration")
}

/// In files: its picture.
pub fn rgb_of(camera: &str) -> String {
    format!("/cameras/{camera}/rgb")
}

/// In files: ground truth of that.
pub fn truth_of(camera: &str) -> String {
    format!("/cameras/{camera}/truth")
}

/// In files: what a checkpoint predicts for the picture.
pub fn predicted(checkpoint: &str) -> String {
    format!("/camera/predicted/{checkpoint}")
}

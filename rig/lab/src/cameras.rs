//! Cameras on the ego car, as files in TOML and the recipes of datasets describe them.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::Context;
use base::asked;
use base::failure::Usage;
use base::files::{self, check_name, most};
use glam::{Quat, Vec3};
use render::{Camera, Imaging, Mount, Quality, Sensor};
use serde::{Deserialize, Serialize};

use crate::looks::Size;

/// Cameras of a file, at most.
const MOST: usize = 32;

/// A camera with a name, which is that of its files.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// Its name.
    pub name: String,
    /// Itself.
    pub camera: Camera,
}

/// What a file holds.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Rig {
    cameras: Vec<Mounted>,
}

/// A camera as it is described: in the car's axes, x forward from the middle of the rear axle, y to the left, z up from
/// the ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mounted {
    /// Its name, which is part of those of its files.
    name: String,
    /// Forward from the middle of the rear axle.
    x_m: f32,
    /// To the left.
    #[serde(default)]
    y_m: f32,
    /// Up from the ground.
    z_m: f32,
    /// To the left.
    #[serde(default)]
    yaw_rad: f32,
    /// Upwards.
    #[serde(default)]
    pitch_rad: f32,
    /// Horizontal field of view.
    #[serde(default = "usual_fov_x_rad")]
    fov_x_rad: f32,
    /// Pixels a row; where it is left out that of all pictures, as all that follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    width: Option<u32>,
    /// Rows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    height: Option<u32>,
    /// How good its pictures are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    quality: Option<Quality>,
    /// What lens and chip do to them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    sensor: Option<Sensor>,
}

// No value of one that was checked is NaN.
impl Eq for Mounted {}

fn usual_fov_x_rad() -> f32 {
    core::f32::consts::FRAC_PI_2
}

/// The cameras of a file. Those that do not say how large their pictures are, and how they are made, make them as is asked.
pub fn read(path: &Path, size: Size, imaging: Imaging) -> anyhow::Result<Vec<Named>> {
    let named = |cameras: Vec<Mounted>| Ok(named(&cameras, size, imaging).map_err(Usage)?);
    described(path).and_then(named).with_context(|| path.display().to_string())
}

/// What a file says of its cameras, if there is one, once it is certain that they are [`named`] well.
pub fn of_file(path: Option<&Path>, (size, imaging): (Size, Imaging)) -> anyhow::Result<Vec<Mounted>> {
    let Some(path) = path else { return Ok(Vec::new()) };
    let checked = |cameras: Vec<Mounted>| {
        named(&cameras, size, imaging).map_err(Usage)?;
        Ok(cameras)
    };
    described(path).and_then(checked).with_context(|| path.display().to_string())
}

fn described(path: &Path) -> anyhow::Result<Vec<Mounted>> {
    parse(&files::read_text(path, most::TEXT)?)
}

fn parse(text: &str) -> anyhow::Result<Vec<Mounted>> {
    let Rig { cameras } =
        toml::from_str(text).map_err(|error| Usage(error.to_string().trim_end().replace('\n', " ")))?;
    if cameras.is_empty() {
        return Err(Usage(format!("0 cameras; expected 1 to {MOST}")).into());
    }
    Ok(cameras)
}

/// The cameras that are described; see [`read`].
pub fn named(cameras: &[Mounted], size: Size, imaging: Imaging) -> Result<Vec<Named>, String> {
    if cameras.len() > MOST {
        return Err(format!("{} cameras; expected 1 to {MOST}", cameras.len()));
    }
    check_apart(cameras, str::to_owned)?;
    cameras.iter().map(|mounted| mounted.named(size, imaging)).collect()
}

/// Refuses cameras of which two have the same name in files and messages, as `written` has them.
pub fn check_apart(cameras: &[Mounted], written: impl Fn(&str) -> String) -> Result<(), String> {
    let mut names = BTreeSet::new();
    let mut written = cameras.iter().map(|mounted| written(&mounted.name));
    // Some file systems know no capital letters.
    let twice = written.find(|name| !names.insert(name.to_lowercase()));
    match twice {
        Some(name) => Err(format!("two cameras are named {name:?}; expected different names")),
        None => Ok(()),
    }
}

/// Refuses a camera whose pictures cannot be drawn, before anything else is done.
pub fn check(camera: &Camera) -> Result<(), Usage> {
    let Camera { width, height, quality, .. } = *camera;
    asked::check_size((width, height))?;
    let longest = quality.longest_side();
    if width.max(height) > longest {
        let name = quality.name();
        return Err(Usage(format!("{name} pictures of {width}x{height}; expected sides of at most {longest}")));
    }
    render::check_lens(camera).map_err(|error| Usage(error.to_string()))
}

impl Mounted {
    fn named(&self, size: Size, imaging: Imaging) -> Result<Named, String> {
        let Self { name, x_m, y_m, z_m, yaw_rad, pitch_rad, fov_x_rad, .. } = self;
        check_name(name)?;
        let within = |what: &str, value: &f32, low: f32, high: f32| {
            let expected = || format!("camera {name}: {what} is {value}; expected a number from {low} to {high}");
            if (low..=high).contains(value) { Ok(()) } else { Err(expected()) }
        };
        [("x_m", x_m), ("y_m", y_m), ("z_m", z_m)].iter().try_for_each(|(what, m)| within(what, m, -50.0, 50.0))?;
        within("yaw_rad", yaw_rad, -7.0, 7.0)?;
        within("pitch_rad", pitch_rad, -1.6, 1.6)?;
        within("fov_x_rad", fov_x_rad, 0.05, 3.0)?;
        let (width, height) = (self.width.unwrap_or(size.0), self.height.unwrap_or(size.1));
        let imaging = Imaging {
            quality: self.quality.unwrap_or(imaging.quality),
            sensor: self.sensor.unwrap_or(imaging.sensor),
            ..imaging
        };
        let camera = Camera {
            mount: Mount::Ego,
            position: Vec3::new(*x_m, *y_m, *z_m),
            rotation: Quat::from_rotation_z(*yaw_rad) * Quat::from_rotation_y(-pitch_rad),
            fov_x_rad: *fov_x_rad,
            ..Camera::driver(width, height).at(imaging)
        };
        check(&camera).map_err(|Usage(said)| format!("camera {name}: {said}"))?;
        Ok(Named { name: name.clone(), camera })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, imaging: Imaging) -> anyhow::Result<Vec<Named>> {
        Ok(named(&parse(text)?, (64, 32), imaging).map_err(Usage)?)
    }

    fn said(text: &str) -> String {
        format!("{:#}", read(text, Imaging::default()).expect_err("refused"))
    }

    #[test]
    fn a_file_describes_cameras() {
        let text = "[[cameras]]\nname = \"driver\"\nx_m = 2.55\nz_m = 1.5\n\
                    [[cameras]]\nname = \"rear\"\nx_m = -0.8\ny_m = 0.3\nz_m = 1.1\nyaw_rad = 3.14159265\npitch_rad = -0.1\n\
                    fov_x_rad = 1.2\nwidth = 128\nheight = 96\nquality = \"standard\"\nsensor = \"k1=-0.1\"\n";
        let imaging = "plain noise=4".parse().expect("an imaging");
        let [driver, rear] = &read(text, imaging).expect("readable")[..] else { panic!("two cameras") };
        let expected = Camera::driver(64, 32).at(imaging);
        assert_eq!((driver.name.as_str(), driver.camera.imaging(), driver.camera.width), ("driver", imaging, 64));
        assert!((driver.camera.position, driver.camera.rotation) == (Vec3::new(2.55, 0.0, 1.5), expected.rotation));
        assert_eq!((rear.camera.width, rear.camera.imaging().to_string()), (128, "standard k1=-0.1".into()));
        assert_eq!(rear.camera.position, Vec3::new(-0.8, 0.3, 1.1));
        let looks = rear.camera.rotation * Vec3::X;
        assert!(looks.x < -0.99 && looks.z < -0.09, "back and down: {looks}");
    }

    #[test]
    fn what_is_described_is_kept_in_full() {
        let text = "[[cameras]]\nname = \"a\"\nx_m = 0.1\nz_m = 1.3\nwidth = 48\nsensor = \"noise=0.3\"\n";
        let described = parse(text).expect("readable");
        let json = serde_json::to_string(&described).expect("written");
        assert_eq!(serde_json::from_str::<Vec<Mounted>>(&json).expect("read"), described);
        assert!(json.contains("\"x_m\":0.1,") && !json.contains("quality"), "{json}");
    }

    #[test]
    fn nonsense_is_refused_in_a_sentence() {
        let with = |line: &str| format!("[[cameras]]\nname = \"a\"\nx_m = 1\nz_m = 1\n{line}\n");
        assert_eq!(said("cameras = []"), "0 cameras; expected 1 to 32");
        assert_eq!(said(&with("").repeat(2)), "two cameras are named \"a\"; expected different names");
        assert_eq!(said(&with("y_m = nan")), "camera a: y_m is NaN; expected a number from -50 to 50");
        assert_eq!(said(&with("fov_x_rad = inf")), "camera a: fov_x_rad is inf; expected a number from 0.05 to 3");
        assert!(said(&with("width = 4")).starts_with("camera a: pictures of 4x32; expected sides of 8 to 8192"));
        assert!(said(&with("sensor = \"noise=99\"")).contains("noise is \"99\"; expected a number from 0 to 32"));
        assert!(said(&with("sensor = \"k1=-0.9\"")).starts_with("camera a: a lens of k1=-0.9 folds the picture"));
        let many: String = (0..33).map(|i| format!("[[cameras]]\nname = \"{i}\"\nx_m = 1\nz_m = 1\n")).collect();
        assert_eq!(said(&many), "33 cameras; expected 1 to 32");
        assert!(said(&with("tilt = 1")).contains("unknown field `tilt`"));
        assert!(said("[[cameras]]\nname = \"../a\"\nx_m = 1\nz_m = 1\n").contains("cannot be a file's"));
        assert!(said("cameras = 3").contains("invalid type") && !said("[[cameras").contains('\n'));
    }
}

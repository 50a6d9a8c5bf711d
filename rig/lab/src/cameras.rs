//! Cameras on the ego car, as a file in TOML describes them.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::Context;
use base::asked;
use base::failure::Usage;
use base::files::{self, check_name, most};
use glam::{Quat, Vec3};
use render::{Camera, Imaging, Mount, Quality, Sensor};
use serde::Deserialize;

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

/// A camera as a file describes it: in the car's axes, x forward from the middle of the rear axle, y to the left, z up from
/// the ground.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Mounted {
    name: String,
    x_m: f32,
    #[serde(default)]
    y_m: f32,
    z_m: f32,
    /// To the left.
    #[serde(default)]
    yaw_rad: f32,
    /// Upwards.
    #[serde(default)]
    pitch_rad: f32,
    #[serde(default = "usual_fov_x_rad")]
    fov_x_rad: f32,
    width: Option<u32>,
    height: Option<u32>,
    quality: Option<Quality>,
    sensor: Option<Sensor>,
}

fn usual_fov_x_rad() -> f32 {
    core::f32::consts::FRAC_PI_2
}

/// The cameras of a file. Those that do not say how large their pictures are, and how they are made, make them as is asked.
pub fn read(path: &Path, size: Size, imaging: Imaging) -> anyhow::Result<Vec<Named>> {
    let text = files::read_text(path, most::TEXT)?;
    parse(&text, size, imaging).with_context(|| path.display().to_string())
}

fn parse(text: &str, size: Size, imaging: Imaging) -> anyhow::Result<Vec<Named>> {
    let Rig { cameras } =
        toml::from_str(text).map_err(|error| Usage(error.to_string().trim_end().replace('\n', " ")))?;
    if !(1..=MOST).contains(&cameras.len()) {
        return Err(Usage(format!("{} cameras; expected 1 to {MOST}", cameras.len())).into());
    }
    let mut names = BTreeSet::new();
    if let Some(twice) = cameras.iter().find(|mounted| !names.insert(&mounted.name)) {
        return Err(Usage(format!("two cameras are named {:?}; expected different names", twice.name)).into());
    }
    cameras.iter().map(|mounted| Ok(mounted.named(size, imaging).map_err(Usage)?)).collect()
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
        asked::check_size((width, height)).map_err(|Usage(said)| format!("camera {name}: {said}"))?;
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
        Ok(Named { name: name.clone(), camera })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(text: &str) -> String {
        format!("{:#}", parse(text, (64, 32), Imaging::default()).expect_err("refused"))
    }

    #[test]
    fn a_file_describes_cameras() {
        let text = "[[cameras]]\nname = \"driver\"\nx_m = 2.55\nz_m = 1.5\n\
                    [[cameras]]\nname = \"rear\"\nx_m = -0.8\ny_m = 0.3\nz_m = 1.1\nyaw_rad = 3.14159265\npitch_rad = -0.1\n\
                    fov_x_rad = 2.0\nwidth = 128\nheight = 96\nquality = \"standard\"\nsensor = \"k1=-0.1\"\n";
        let imaging = "plain noise=4".parse().expect("an imaging");
        let [driver, rear] = &parse(text, (64, 32), imaging).expect("readable")[..] else { panic!("two cameras") };
        let expected = Camera::driver(64, 32).at(imaging);
        assert_eq!((driver.name.as_str(), driver.camera.imaging(), driver.camera.width), ("driver", imaging, 64));
        assert!((driver.camera.position, driver.camera.rotation) == (Vec3::new(2.55, 0.0, 1.5), expected.rotation));
        assert_eq!((rear.camera.width, rear.camera.imaging().to_string()), (128, "standard k1=-0.1".into()));
        assert_eq!(rear.camera.position, Vec3::new(-0.8, 0.3, 1.1));
        let looks = rear.camera.rotation * Vec3::X;
        assert!(looks.x < -0.99 && looks.z < -0.09, "back and down: {looks}");
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
        assert!(said(&with("tilt = 1")).contains("unknown field `tilt`"));
        assert!(said("[[cameras]]\nname = \"../a\"\nx_m = 1\nz_m = 1\n").contains("cannot be a file's"));
        assert!(said("cameras = 3").contains("invalid type") && !said("[[cameras").contains('\n'));
    }
}

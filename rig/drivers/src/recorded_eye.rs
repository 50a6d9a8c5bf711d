//! The eye behind the masks of a recording, found again.

use anyhow::anyhow;
use perception::Compute;
use render::{Camera, Imaging};
use replay::Provenance;

use crate::checkpoint::CheckpointChoice;
use crate::external;
use crate::vision::{DEFAULT_SIZE, EXTERNAL, Eye};

/// What a recording says about the eye behind its masks.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedEye {
    /// Name of the checkpoint; empty when nothing is said.
    pub name: String,
    /// Its digest in hexadecimal digits, `truth`, or `external NAME@VERSION`; empty when nothing is said.
    pub digest: String,
    /// The version of a function of somebody's own program, which no file holds.
    pub external: Option<String>,
    /// The camera of the pictures it looked at.
    pub camera: Camera,
    /// Adapter and driver that drew them; empty when nothing is said.
    pub adapter: String,
    /// What computed it; the CPU when nothing is said.
    pub compute: Compute,
}

impl RecordedEye {
    /// As the provenance of a recording has it.
    pub fn of(provenance: &Provenance) -> anyhow::Result<Self> {
        let said = |name: &str| provenance.get(name).cloned().unwrap_or_default();
        let expected =
            "expected as in \"driver 256x128\", \"driver 256x128 standard\" or \"driver 256x128 plain noise=4\"";
        let camera = match provenance.get("camera") {
            None => Camera::driver(DEFAULT_SIZE.0, DEFAULT_SIZE.1).at(Imaging::unsaid()),
            Some(text) => camera_of(text).ok_or_else(|| anyhow!("provenance \"camera\" is {text:?}; {expected}"))?,
        };
        let compute = match provenance.get("inference") {
            None => Compute::default(),
            Some(name) => {
                name.parse().map_err(|expected| anyhow!("provenance \"inference\" is {name:?}; {expected}"))?
            }
        };
        let (name, adapter, external) = (said("checkpoint"), said("adapter"), provenance.get(EXTERNAL).cloned());
        let digest = digest_of(provenance).unwrap_or_default();
        Ok(Self { name, digest, external, camera, adapter, compute })
    }

    /// Width and height of the pictures, pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.camera.width, self.camera.height)
    }

    /// Finds it among ground truth, these checkpoints and the bundled ones, by its digest; the CPU computes
    /// it.
    pub fn find(&self, choices: &[CheckpointChoice]) -> anyhow::Result<Option<Eye>> {
        Ok(self.choice(choices)?.map(|(_, eye)| eye))
    }

    /// As [`RecordedEye::find`], computed by what computed it then, if that is at hand.
    pub fn find_as_it_was(&self, choices: &[CheckpointChoice]) -> anyhow::Result<Option<Eye>> {
        let Some((choice, eye)) = self.choice(choices)? else { return Ok(None) };
        if eye.compute() == self.compute {
            return Ok(Some(eye));
        }
        let on_it = Eye::open_on(self.compute, &choice, Some(self.size()));
        Ok(Some(on_it.map_or(eye, |eye| eye.at(self.camera.imaging()))))
    }

    /// A sentence for where it is not found; `option` names the file on the command line.
    pub fn not_found(&self, option: &str) -> String {
        let name = &self.name;
        match &self.external {
            Some(version) => format!(
                "was driven through {name:?}, version {version}, a function outside of this program, which cannot be opened \
                 again; expected it to be handed over, which the Python package can"
            ),
            None if self.digest.is_empty() => "does not say through which checkpoint it was driven".into(),
            None => format!(
                "was driven through checkpoint {name} with digest {}; expected that file with {option}",
                self.digest
            ),
        }
    }

    fn choice(&self, choices: &[CheckpointChoice]) -> anyhow::Result<Option<(CheckpointChoice, Eye)>> {
        let bundled = perception::BUNDLED.map(CheckpointChoice::Bundled);
        for choice in choices.iter().chain(&bundled).chain(&[CheckpointChoice::Truth]) {
            let eye = Eye::open_at(choice, self.size())?.at(self.camera.imaging());
            if eye.digest() == self.digest {
                return Ok(Some((choice.clone(), eye)));
            }
        }
        Ok(None)
    }
}

/// What a recording's checkpoint is told from others by: its digest, or name and version of what no file holds.
pub fn digest_of(provenance: &Provenance) -> Option<String> {
    let name = || provenance.get("checkpoint").map(String::as_str).unwrap_or_default();
    let external = provenance.get(EXTERNAL).map(|version| external::identity(name(), version));
    external.or_else(|| provenance.get("checkpoint_digest").cloned())
}

/// From `driver WxH`, `driver WxH QUALITY` or `driver WxH QUALITY SENSOR`.
fn camera_of(text: &str) -> Option<Camera> {
    let said = text.strip_prefix("driver ")?;
    let (size, imaging) = match said.split_once(' ') {
        Some((size, imaging)) => (size, imaging.parse().ok()?),
        None => (said, Imaging::unsaid()),
    };
    let (width, height) = size.split_once('x')?;
    let side = |text: &str| text.parse().ok().filter(|pixels| (1..=8192).contains(pixels));
    Some(Camera::driver(side(width)?, side(height)?).at(imaging))
}

#[cfg(test)]
mod tests {
    use render::Quality;

    use super::*;
    use crate::vision::camera_text;

    #[test]
    fn a_camera_has_a_size_a_quality_and_a_sensor() {
        for quality in Quality::ALL {
            for sensor in ["noise=0", "exposure_ev=-1,noise=4", "k1=-0.3,k2=0.1,motion_blur_s=0.01,vignetting=1"] {
                let sensor = sensor.parse().expect("a sensor");
                let camera = Camera::driver(256, 128).at(Imaging { quality, sensor, models: None });
                assert_eq!(camera_of(&camera_text(&camera)), Some(camera));
                let camera = Camera { models: Some([9; 16].into()), ..camera };
                assert_eq!(camera_of(&camera_text(&camera)), Some(camera));
            }
        }
        let noisy = Camera::driver(64, 32).at("plain noise=4".parse::<Imaging>().expect("an imaging"));
        assert_eq!(camera_text(&noisy), "driver 64x32 plain noise=4");
        let plain = Camera::driver(64, 32).at(Quality::Plain);
        assert_eq!(camera_text(&plain), "driver 64x32");
        assert_eq!(camera_text(&Camera::driver(64, 32)), "driver 64x32 standard");
        assert_eq!(camera_of("driver 64x32"), Some(plain), "as it was before there were qualities");
        let wrong = [
            "",
            "driver",
            "driver 256",
            "driver 0x128",
            "driver 256x128x3",
            "roof 256x128",
            "driver 2x1 best",
            "driver 2x1 noise=4",
            "driver 2x1 plain noise=-1",
        ];
        wrong.iter().for_each(|wrong| assert_eq!(camera_of(wrong), None, "{wrong}"));
    }

    #[test]
    fn what_computed_it_is_the_cpu_unless_the_recording_says_otherwise() {
        let of = |inference: Option<&str>| {
            let said = inference.map(|name| ("inference".to_owned(), name.to_owned()));
            RecordedEye::of(&said.into_iter().collect()).map(|eye| eye.compute)
        };
        assert_eq!(of(None).unwrap(), Compute::Cpu);
        assert_eq!(of(Some("cuda")).unwrap(), Compute::Cuda);
        assert_eq!(of(Some("ort")).unwrap(), Compute::OnnxRuntime);
        let said = of(Some("abacus")).unwrap_err().to_string();
        assert_eq!(said, "provenance \"inference\" is \"abacus\"; expected cpu, cuda or ort");
    }

    #[test]
    fn the_eye_is_found_by_its_digest() {
        let eye = |digest: &str| RecordedEye {
            name: "some".into(),
            digest: digest.into(),
            external: None,
            camera: Camera::driver(32, 16),
            adapter: String::new(),
            compute: Compute::Cpu,
        };
        let found = |digest: &str| eye(digest).find(&[]).expect("readable").map(|eye| eye.name().to_owned());
        let early = perception::bundled("early").expect("bundled").expect("readable");
        assert_eq!(found(early.digest().to_hex().as_str()).as_deref(), Some("early"));
        assert_eq!(found("truth").as_deref(), Some("truth"));
        assert_eq!(found(""), None);
    }
}

//! The eye behind the masks of a recording, found again.

use anyhow::anyhow;
use perception::Compute;
use replay::Provenance;

use crate::checkpoint::CheckpointChoice;
use crate::external;
use crate::vision::{DEFAULT_SIZE, EXTERNAL, Eye};

/// What a recording says about the eye behind its masks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordedEye {
    /// Name of the checkpoint; empty when nothing is said.
    pub name: String,
    /// Its digest in hexadecimal digits, `truth`, or `external NAME@VERSION`; empty when nothing is said.
    pub digest: String,
    /// The version of a function of somebody's own program, which no file holds.
    pub external: Option<String>,
    /// Width and height of the pictures it looked at, pixels.
    pub size: (u32, u32),
    /// Adapter and driver that drew them; empty when nothing is said.
    pub adapter: String,
    /// What computed it; the CPU when nothing is said.
    pub compute: Compute,
}

impl RecordedEye {
    /// As the provenance of a recording has it.
    pub fn of(provenance: &Provenance) -> anyhow::Result<Self> {
        let said = |name: &str| provenance.get(name).cloned().unwrap_or_default();
        let size = match provenance.get("camera") {
            None => DEFAULT_SIZE,
            Some(camera) => camera_size(camera)
                .ok_or_else(|| anyhow!("provenance \"camera\" is {camera:?}; expected as in \"driver 256x128\""))?,
        };
        let compute = match provenance.get("inference") {
            None => Compute::default(),
            Some(name) => {
                name.parse().map_err(|expected| anyhow!("provenance \"inference\" is {name:?}; {expected}"))?
            }
        };
        let (name, adapter, external) = (said("checkpoint"), said("adapter"), provenance.get(EXTERNAL).cloned());
        let digest = digest_of(provenance).unwrap_or_default();
        Ok(Self { name, digest, external, size, adapter, compute })
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
        Ok(Some(Eye::open_on(self.compute, &choice, Some(self.size)).unwrap_or(eye)))
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
            let eye = Eye::open_at(choice, self.size)?;
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

/// `driver WxH`.
fn camera_size(camera: &str) -> Option<(u32, u32)> {
    let (width, height) = camera.strip_prefix("driver ")?.split_once('x')?;
    let side = |text: &str| text.parse().ok().filter(|pixels| (1..=8192).contains(pixels));
    Some((side(width)?, side(height)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_has_a_size() {
        assert_eq!(camera_size("driver 256x128"), Some((256, 128)));
        for wrong in ["", "driver", "driver 256", "driver 0x128", "driver 256x128x3", "roof 256x128"] {
            assert_eq!(camera_size(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn what_computed_it_is_the_cpu_unless_the_recording_says_otherwise() {
        let of = |inference: Option<&str>| {
            let said = inference.map(|name| ("inference".to_owned(), name.to_owned()));
            RecordedEye::of(&said.into_iter().collect()).map(|eye| eye.compute)
        };
        assert_eq!(of(None).unwrap(), Compute::Cpu);
        assert_eq!(of(Some("cuda")).unwrap(), Compute::Cuda);
        let said = of(Some("abacus")).unwrap_err().to_string();
        assert_eq!(said, "provenance \"inference\" is \"abacus\"; expected cpu or cuda");
    }

    #[test]
    fn the_eye_is_found_by_its_digest() {
        let eye = |digest: &str| RecordedEye {
            name: "some".into(),
            digest: digest.into(),
            external: None,
            size: (32, 16),
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

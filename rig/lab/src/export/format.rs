//! As what a recording can be exported.

use std::path::Path;
use std::str::FromStr;

use base::failure::Usage;
use drivers::checkpoint::CheckpointChoice;
use drivers::film::Viewpoint;

/// As what a recording is exported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// Messages for viewers of robot logs.
    #[default]
    Mcap,
    /// An animated PNG.
    Apng,
    /// A GIF, by `ffmpeg`.
    Gif,
    /// An MP4 (H.264), by `ffmpeg`.
    Mp4,
    /// A story in OpenSCENARIO XML, with its map in OpenDRIVE beside it.
    OpenScenario,
    /// A trace of the ASAM Open Simulation Interface, in MCAP.
    Osi,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Mcap, Self::Apng, Self::Gif, Self::Mp4, Self::OpenScenario, Self::Osi];

    /// What it is called on a command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mcap => "mcap",
            Self::Apng => "apng",
            Self::Gif => "gif",
            Self::Mp4 => "mp4",
            Self::OpenScenario => "openscenario",
            Self::Osi => "osi",
        }
    }

    /// How its files end; an animated PNG is one to all who show PNGs.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Apng => "png",
            Self::OpenScenario => "xosc",
            Self::Osi => Self::Mcap.name(),
            Self::Mcap | Self::Gif | Self::Mp4 => self.name(),
        }
    }

    /// That of a file by its ending; messages for viewers, where that tells none.
    pub fn of_file(path: &Path) -> Self {
        let ending = path.extension().and_then(|ending| ending.to_str());
        Self::ALL.into_iter().find(|format| ending == Some(format.ending())).unwrap_or_default()
    }

    /// Refuses what it cannot show.
    pub fn check(self, camera: Viewpoint, checkpoints: &[CheckpointChoice]) -> Result<(), Usage> {
        if matches!(self, Self::OpenScenario | Self::Osi) && !checkpoints.is_empty() {
            let name = self.name();
            return Err(Usage(format!(
                "{name} holds no masks of networks; expected --checkpoint or --format {name}, not both"
            )));
        }
        if camera == Viewpoint::Driver {
            return Ok(());
        }
        if matches!(self, Self::Mcap | Self::OpenScenario | Self::Osi) {
            return Err(Usage("--camera is for moving pictures; expected --format apng, gif or mp4 with it".into()));
        }
        if !checkpoints.is_empty() {
            return Err(Usage(
                "networks see the driver's view; expected --checkpoint or another --camera, not both".into(),
            ));
        }
        Ok(())
    }
}

impl FromStr for Format {
    type Err = Usage;

    fn from_str(text: &str) -> Result<Self, Usage> {
        let named = Self::ALL.into_iter().find(|format| format.name() == text);
        named.ok_or_else(|| {
            let names = Self::ALL.map(Self::name);
            Usage(format!("no such format: {text:?}; expected one of {}", names.join(", ")))
        })
    }
}

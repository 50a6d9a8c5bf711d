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
    /// Pictures with panoptic and instance annotations as COCO has them, in a folder.
    Coco,
    /// Labels of ASAM OpenLABEL.
    OpenLabel,
    /// A bag of ROS 2: a folder with MCAP in it.
    Ros2,
    /// What the safety driver heard, as a WAV file.
    Wav,
}

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    /// A file that ends with this.
    File(&'static str),
    /// A folder.
    Folder,
}

/// What there is to know of a format.
struct Traits {
    format: Format,
    /// What it is called on a command line.
    name: &'static str,
    written: Written,
    /// It can hold what networks make of the pictures.
    has_masks: bool,
    /// It can be taken from other places than where the drivers sit.
    has_cameras: bool,
    /// It can hold what several cameras see.
    has_several: bool,
}

/// Every format. Where a file's ending fits several, the first of them is meant; an animated PNG ends as all who show
/// PNGs expect.
const TABLE: [Traits; 10] = [
    traits(Format::Mcap, "mcap", Written::File("mcap"), true, false, true),
    traits(Format::Apng, "apng", Written::File("png"), true, true, false),
    traits(Format::Gif, "gif", Written::File("gif"), true, true, false),
    traits(Format::Mp4, "mp4", Written::File("mp4"), true, true, false),
    traits(Format::OpenScenario, "openscenario", Written::File("xosc"), false, false, false),
    traits(Format::Osi, "osi", Written::File("mcap"), false, false, false),
    traits(Format::Coco, "coco", Written::Folder, false, false, true),
    traits(Format::OpenLabel, "openlabel", Written::File("json"), false, false, true),
    traits(Format::Ros2, "ros2", Written::Folder, true, false, true),
    traits(Format::Wav, "wav", Written::File("wav"), false, false, false),
];

const fn traits(
    format: Format,
    name: &'static str,
    written: Written,
    has_masks: bool,
    has_cameras: bool,
    has_several: bool,
) -> Traits {
    Traits { format, name, written, has_masks, has_cameras, has_several }
}

impl Format {
    /// What it is called on a command line.
    pub fn name(self) -> &'static str {
        self.traits().name
    }

    /// What it writes of a recording.
    pub fn written(self) -> Written {
        self.traits().written
    }

    fn traits(self) -> &'static Traits {
        // A test finds every format at its own place.
        &TABLE[self as usize]
    }

    /// That of a file by its ending; messages for viewers, where that tells none.
    pub fn of_file(path: &Path) -> Self {
        Self::by_ending(path).unwrap_or_default()
    }

    /// That of a file by its ending.
    pub fn by_ending(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?;
        let is_it = |traits: &&Traits| matches!(traits.written, Written::File(known) if known == ending);
        TABLE.iter().find(is_it).map(|traits| traits.format)
    }

    /// Refuses what it cannot show; `cameras` says whether others than the drivers' are asked for.
    pub fn check(self, camera: Viewpoint, checkpoints: &[CheckpointChoice], cameras: bool) -> Result<(), Usage> {
        let Traits { name, has_masks, has_cameras, has_several, .. } = self.traits();
        if !has_several && cameras {
            let those = TABLE.iter().filter(|traits| traits.has_several).map(|traits| traits.name);
            let those = those.collect::<Vec<_>>().join(", ");
            return Err(Usage(format!("{name} holds no pictures of several cameras; --cameras is for {those}")));
        }
        if !has_masks && !checkpoints.is_empty() {
            return Err(Usage(format!(
                "{name} holds no masks of networks; expected --checkpoint or --format {name}, not both"
            )));
        }
        if camera == Viewpoint::Driver {
            return Ok(());
        }
        if !has_cameras {
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
        let named = TABLE.iter().find(|traits| traits.name == text).map(|traits| traits.format);
        named.ok_or_else(|| {
            let names: Vec<&str> = TABLE.iter().map(|traits| traits.name).collect();
            Usage(format!("no such format: {text:?}; expected one of {}", names.join(", ")))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_is_found_by_its_name_and_at_its_place() {
        for (place, traits) in TABLE.iter().enumerate() {
            assert_eq!(
                (traits.format as usize, traits.name.parse::<Format>()),
                (place, Ok(traits.format)),
                "{}",
                traits.name
            );
        }
        let said = "pdf".parse::<Format>().expect_err("none").0;
        assert!(said.starts_with("no such format: \"pdf\"; expected one of mcap, apng, "), "{said}");
    }

    #[test]
    fn several_cameras_are_refused_where_there_is_no_room_for_them() {
        let said = |format: Format| format.check(Viewpoint::Driver, &[], true).map_err(|Usage(said)| said);
        let refused = "gif holds no pictures of several cameras; --cameras is for mcap, coco, openlabel, ros2";
        assert_eq!(said(Format::Gif), Err(refused.into()));
        assert!(said(Format::Osi).is_err() && said(Format::OpenScenario).is_err() && said(Format::Coco).is_ok());
    }

    #[test]
    fn an_ending_means_the_usual_format() {
        let of = |name: &str| Format::of_file(Path::new(name));
        assert_eq!(
            ["a.mcap", "a.png", "a.xosc", "a.json", "a.wav", "a", "a.txt"].map(of).map(Format::name),
            ["mcap", "apng", "openscenario", "openlabel", "wav", "mcap", "mcap"]
        );
    }
}

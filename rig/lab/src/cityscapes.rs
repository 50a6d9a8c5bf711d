//! Frames as files in the layout of Cityscapes ([`perception::cityscapes`]).

use std::fs;
use std::path::Path;

use anyhow::Context;
use base::{output, png};
use perception::cityscapes::{Kind, Place};
use perception::classes::TRAIN_ID_OF_TAG;
use render::Frame;

/// Writes all files of a frame below `dir`, where no other process writes, each in one step.
pub fn write(dir: &Path, place: &Place<'_>, frame: &Frame) -> anyhow::Result<()> {
    let size = (frame.width, frame.height);
    let files = [
        (Kind::Image, png::rgb(size, &frame.rgb)?),
        (Kind::LabelIds, png::grey(size, &frame.class_ids)?),
        (Kind::TrainIds, png::grey(size, &train_ids(&frame.class_ids))?),
        (Kind::InstanceIds, png::grey16(size, &instances(frame))?),
        (Kind::Color, png::tags(size, &frame.class_ids)?),
    ];
    for (kind, bytes) in files {
        let path = dir.join(place.path(kind));
        let folder = path.parent().unwrap_or(dir);
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
        output::write_claimed(&path, &bytes)?;
    }
    Ok(())
}

/// Train ids of tags.
pub fn train_ids(tags: &[u8]) -> Vec<u8> {
    tags.iter().map(|&tag| TRAIN_ID_OF_TAG[usize::from(tag)]).collect()
}

/// `tag * 1000 + n` for the n-th instance of the picture (by id), the tag alone for all else.
pub fn instances(frame: &Frame) -> Vec<u16> {
    let mut ids: Vec<u16> = frame.instance_ids.iter().copied().filter(|id| *id != 0).collect();
    ids.sort_unstable();
    ids.dedup();
    let number = |tag: u8, instance: u16| match ids.binary_search(&instance) {
        Ok(n) => u16::from(tag) * 1000 + n.min(999) as u16,
        Err(_) => u16::from(tag),
    };
    frame.class_ids.iter().zip(&frame.instance_ids).map(|(&tag, &instance)| number(tag, instance)).collect()
}

#[cfg(test)]
mod tests {
    use perception::cityscapes::sibling;

    use super::*;

    #[test]
    fn files_have_the_names_and_ids_that_trainers_expect() {
        let place = Place { split: "val", city: "city", scene: 3, frame: 12, camera: None };
        assert_eq!(place.path(Kind::Image), "leftImg8bit/val/city/city_000003_000012_leftImg8bit.png");
        assert_eq!(place.path(Kind::TrainIds), "gtFine/val/city/city_000003_000012_gtFine_labelTrainIds.png");
        let seen = Place { camera: Some("front_left"), ..place.clone() };
        let named = "gtFine/val/city-front-left/city-front-left_000003_000012_gtFine_color.png";
        assert_eq!(seen.path(Kind::Color), named);
        let frame = Frame {
            width: 4,
            height: 1,
            rgb: vec![0; 12],
            class_ids: vec![7, 4, 4, 10],
            instance_ids: vec![0, 31, 7, 31],
            ..Frame::default()
        };
        assert_eq!(instances(&frame), [7, 4001, 4000, 10001]);
        let dir = tempfile::tempdir().expect("a folder");
        write(dir.path(), &place, &frame).expect("written");
        let image = dir.path().join(place.path(Kind::Image));
        assert_eq!(sibling(&image, Kind::TrainIds), Some(dir.path().join(place.path(Kind::TrainIds))));
        for kind in Kind::ALL {
            assert!(dir.path().join(place.path(kind)).is_file(), "{kind:?}");
        }
    }
}

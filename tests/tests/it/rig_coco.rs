//! Annotations of COCO are what the renderer says of each pixel, and are made again byte for byte.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use render::actor_of_instance;
use serde_json::Value;
use tests::command::aeye;
use tests::files::contents;
use tests::recordings::recorded;

const OPTIONS: &str = "export --format coco --size 64x32 --last 1s";

fn table(folder: &Path, name: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.join(name)).unwrap()).unwrap()
}

fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key].as_array().unwrap_or_else(|| panic!("a list {key}"))
}

fn number(value: &Value, key: &str) -> u64 {
    value[key].as_u64().unwrap_or_else(|| panic!("a number {key} in {value}"))
}

/// Pixels and box (left, top, width, height) of a mask, told by whether each pixel is in it.
fn measured(mask: &[bool], width: usize) -> (u64, Vec<u64>) {
    let inside: Vec<(u64, u64)> =
        (0..mask.len()).filter(|at| mask[*at]).map(|at| ((at % width) as u64, (at / width) as u64)).collect();
    let (left, right) = (inside.iter().map(|p| p.0).min().unwrap(), inside.iter().map(|p| p.0).max().unwrap());
    let (top, bottom) = (inside.iter().map(|p| p.1).min().unwrap(), inside.iter().map(|p| p.1).max().unwrap());
    (inside.len() as u64, vec![left, top, right - left + 1, bottom - top + 1])
}

fn told(annotation: &Value) -> (u64, Vec<u64>) {
    let of_box = list(annotation, "bbox").iter().map(|side| side.as_u64().unwrap()).collect();
    (number(annotation, "area"), of_box)
}

/// A mask of runs down the columns, row by row.
fn decoded(mask: &Value) -> Vec<bool> {
    let size: Vec<usize> = list(mask, "size").iter().map(|side| side.as_u64().unwrap() as usize).collect();
    let (height, width) = (size[0], size[1]);
    let runs = list(mask, "counts").iter().map(|run| run.as_u64().unwrap() as usize).enumerate();
    let down: Vec<bool> = runs.flat_map(|(i, run)| vec![i % 2 == 1; run]).collect();
    assert_eq!(down.len(), width * height);
    (0..width * height).map(|at| down[at % width * height + at / width]).collect()
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn every_pixel_is_in_the_segment_of_its_class_and_instance() {
    let dir = tempfile::tempdir().unwrap();
    let (_, case) = recorded(dir.path());
    let out = dir.path().join("coco");
    assert_eq!(aeye(OPTIONS, &[&case], &out), (0, String::new()));
    let drawn = dir.path().join("drawn");
    assert_eq!(aeye("rerender --checkpoint truth --size 64x32 --last 1s", &[&case], &drawn).0, 0);
    let (panoptic, instances) = (table(&out, "panoptic.json"), table(&out, "instances.json"));
    assert_eq!((list(&panoptic, "categories").len(), list(&instances, "categories").len()), (23, 2));
    assert_eq!((list(&panoptic, "images").len(), list(&panoptic, "annotations").len()), (10, 10));
    let mut things = BTreeMap::new();
    for (image, annotation) in list(&panoptic, "images").iter().zip(list(&panoptic, "annotations")) {
        let name = annotation["file_name"].as_str().unwrap();
        assert_eq!(
            (image["id"].as_u64(), &image["file_name"]),
            (annotation["image_id"].as_u64(), &annotation["file_name"])
        );
        let picture = |folder: &str| base::png::read(&out.join(folder).join(name), 3).unwrap().1;
        let rendered = |folder: &str, samples| base::png::read(&drawn.join("a.case").join(folder).join(name), samples);
        assert!(picture("images") == rendered("rgb", 3).unwrap().1, "{name}");
        let (classes, colours) = (rendered("labels", 1).unwrap().1, picture("panoptic"));
        let ids: Vec<u64> =
            colours.chunks(3).map(|c| u64::from(c[0]) + (u64::from(c[1]) << 8) + (u64::from(c[2]) << 16)).collect();
        assert!(ids.iter().zip(&classes).all(|(id, class)| id >> 16 == u64::from(*class)), "{name}");
        let segments = list(annotation, "segments_info");
        let known: BTreeSet<u64> = segments.iter().map(|segment| number(segment, "id")).collect();
        assert_eq!(known, ids.iter().copied().filter(|id| *id != 0).collect(), "{name}");
        for segment in segments {
            let id = number(segment, "id");
            let mask: Vec<bool> = ids.iter().map(|of_pixel| *of_pixel == id).collect();
            assert_eq!(
                (told(segment), number(segment, "category_id")),
                (measured(&mask, 64), id >> 16),
                "{name}: {id}"
            );
            if [4, 10].contains(&(id >> 16)) {
                things.insert((number(image, "id"), id), mask);
            }
        }
    }
    assert!(things.len() >= 10, "only {} instances", things.len());
    let counted = list(&instances, "annotations");
    assert_eq!(counted.len(), things.len());
    for instance in counted {
        let id = number(instance, "segment_id");
        assert_eq!(number(instance, "track_id"), u64::from(actor_of_instance(id as u16)), "{instance}");
        let mask = decoded(&instance["segmentation"]);
        assert!(mask == things[&(number(instance, "image_id"), id)], "{instance}");
        assert_eq!(told(instance), measured(&mask, 64));
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn it_is_made_again_or_kept_and_takes_nobodys_place() {
    let dir = tempfile::tempdir().unwrap();
    let (recording, case) = recorded(dir.path());
    let at = |name: &str| dir.path().join(name);
    for name in ["first", "second"] {
        assert_eq!(aeye(OPTIONS, &[&case], &at(name)), (0, String::new()));
    }
    assert!(contents(&at("first")) == contents(&at("second")));
    let written = || fs::metadata(at("first/instances.json")).unwrap().modified().unwrap();
    let before = written();
    assert_eq!((aeye(OPTIONS, &[&case], &at("first")).0, written()), (0, before));
    // Several files, or those of a folder, go below.
    assert_eq!(aeye(OPTIONS, &[&recording, &case], &at("both")), (0, String::new()));
    for name in ["both/a/panoptic.json", "both/a.case/panoptic.json"] {
        assert!(at(name).is_file(), "{name}");
    }
    fs::create_dir(at("mine")).unwrap();
    fs::write(at("mine/panoptic.json"), "mine").unwrap();
    let there = contents(dir.path());
    for (options, out, expected, words) in [
        (OPTIONS, "mine", 1, "mine: exists already; expected a new or an empty folder"),
        ("export --format coco --size 32x16 --last 1s", "first", 1, "first: exists already; expected a new"),
        (OPTIONS, "a.mcap", 2, "a.mcap: coco writes a folder"),
        (OPTIONS, "new.json", 2, "new.json: coco writes a folder"),
        ("export --format coco --from 0.01s --to 0.02s", "new", 1, ""),
        ("export --format coco --checkpoint truth", "new", 2, "coco holds no masks of networks"),
        ("export --format coco --camera top", "new", 2, "--camera is for moving pictures"),
    ] {
        let (code, said) = aeye(options, &[&case], &at(out));
        assert!(code == expected && said.contains(words) && !said.contains('\n'), "{options} {out}: {code}, {said:?}");
        assert!(contents(dir.path()) == there, "{options} {out}: something was left or changed");
    }
}

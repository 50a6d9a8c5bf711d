//! Models made in code, read as a user's own, and what is refused.

pub(super) mod sketch;

use std::fs;
use std::path::Path;

use glam::Vec3;
use render::mesh::model::{Detail, Joint};
use render::models::Subject;
use tempfile::TempDir;

use super::load;
use sketch::{Sketch, boxed, car, glb, packed, parts, textured};

/// A folder with a list and files.
fn folder(list: &str, files: &[(&str, &[u8])]) -> TempDir {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("models.toml"), list).expect("written");
    for (name, bytes) in files {
        fs::write(dir.path().join(name), bytes).expect("written");
    }
    dir
}

fn refused(list: &str, files: &[(&str, &[u8])]) -> String {
    let dir = folder(list, files);
    let error = load(dir.path()).map(|_| ()).expect_err("refused");
    let said = format!("{error:#}");
    assert!(
        !said.contains('\n') && said.contains(dir.path().canonicalize().expect("it is there").to_str().expect("text")),
        "{said}"
    );
    said
}

const CAR: &str = "[[models]]\nfile = \"car.glb\"\nis = [\"car\", \"ego\"]\nlacquer = [\"paint\"]\nwheels = [\"fl\", \"fr\", \"rl\", \"rr\"]\n\
                   steered = [\"fl\", \"fr\"]\nlamps.brake = [\"tail\"]\n";

#[test]
fn a_car_fills_its_box_and_its_wheels_turn() {
    let dir = folder(CAR, &[("car.glb", &glb(&car()))]);
    let models = load(dir.path()).expect("models");
    for subject in ["car", "ego"].map(|name| Subject::named(name).expect("a name")) {
        let [figure] = models.of(subject) else { panic!("one figure of {subject:?}") };
        let model = figure.at(Detail::Fine);
        let [mut low, mut high] = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        for v in &model.at_rest().vertices {
            (low, high) = (low.min(Vec3::from(v.position)), high.max(Vec3::from(v.position)));
        }
        let size = Vec3::new(4.5, 1.85, 1.5);
        assert!((high - low - size).abs().max_element() < 1e-3 && low.z.abs() < 1e-3, "{low} {high}");
        assert!((low + high).truncate().length() < 1e-3, "{low} {high}");
        let rolling: Vec<f32> = model
            .parts
            .iter()
            .filter_map(|part| match part.joint {
                Some(Joint::Roll { radius_m }) => Some(radius_m),
                _ => None,
            })
            .collect();
        assert_eq!(rolling.len(), 4);
        assert!(rolling.iter().all(|radius_m| (0.28..0.4).contains(radius_m)), "{rolling:?}");
        let steering = model.parts.iter().filter(|part| part.joint == Some(Joint::Steer));
        assert!(steering.clone().count() == 2 && steering.clone().all(|part| part.pivot.x > 1.0), "in front");
    }
}

#[test]
fn a_digest_is_that_of_all_files() {
    let digest = |list: &str, car: &[u8]| {
        load(folder(list, &[("car.glb", car), ("other.txt", b"")]).path()).expect("models").id()
    };
    let usual = digest(CAR, &glb(&car()));
    assert_eq!(usual, digest(CAR, &glb(&car())), "wherever the folder is");
    assert_ne!(usual, digest(&format!("{CAR}\n"), &glb(&car())));
    let mut other = car();
    other.boxes[0].high[1] += 0.01;
    assert_ne!(usual, digest(CAR, &glb(&other)));
}

#[test]
fn lists_are_refused_in_a_sentence() {
    let car = glb(&car());
    for (from, to, said) in [
        ("is = [\"car\", \"ego\"]", "is = [\"cart\"]", "is \"cart\", expected one of ego, car,"),
        ("is = [\"car\", \"ego\"]", "is = []", "is nothing"),
        ("file = \"car.glb\"", "file = \"../car.glb\"", "no path below the folder"),
        ("file = \"car.glb\"", "file = \"none.glb\"", "\"none.glb\""),
        ("lacquer", "lacker", "unknown field `lacker`"),
        ("steered = [\"fl\", ", "steered = [\"wheel\", ", "steers \"wheel\""),
        ("steered = [\"fl\", ", "steered = [\"fl\", \"fl\", ", "has \"fl\" twice in steered"),
        ("wheels = [", "wheels = [\"fifth\", ", "has no node \"fifth\""),
        ("lamps.brake = [\"tail\"]", "lamps.brake = [\"stop\"]", "has no material \"stop\""),
        ("is = [", "yaw_deg = 90.0\nis = [", "would be stretched 6.04 times in length"),
        ("is = [", "yaw_deg = nan\nis = [", "expected -360 to 360"),
        ("is = [\"car\", \"ego\"]", "is = [\"pedestrian\"]", "and at most 0.3 m beyond"),
    ] {
        let message = refused(&CAR.replacen(from, to, 1), &[("car.glb", &car)]);
        assert!(message.contains(said), "{message}");
    }
    assert!(refused("", &[]).contains("lists 0 models"));
    let nowhere = load(Path::new("/nowhere")).expect_err("refused").to_string();
    assert!(nowhere.contains("/nowhere: expected a folder with models.toml"), "{nowhere}");
}

/// A file of which a part of the JSON is replaced.
fn changed(pointer: &str, value: serde_json::Value) -> Vec<u8> {
    let mut sketch = car();
    sketch.changes.push((pointer.to_owned(), value));
    glb(&sketch)
}

#[test]
fn files_are_refused_in_a_sentence() {
    use serde_json::json;
    let whole = glb(&car());
    let positions = "/meshes/0/primitives/0/attributes/POSITION";
    for (file, said) in [
        (whole[..whole.len() - 9].to_vec(), "is cut off"),
        (b"glTF".to_vec(), "is cut off: has 4 bytes, expected a header of 12"),
        ([&whole[..], b"more"].concat(), "and its header says"),
        (b"solid cube".to_vec(), "is no glTF 2.0 file, binary (.glb) or JSON"),
        (Vec::new(), "is no glTF 2.0 file, binary (.glb) or JSON"),
        (changed("/asset/version", json!("1.0")), "is glTF 1.0, expected 2.0"),
        (changed("/accessors/0/count", json!(4_000_000_000u64)), "has 4000000000 values"),
        (changed("/accessors/0/count", json!(900)), "reaches beyond its buffer view"),
        (changed("/bufferViews/0/byteLength", json!(1u64 << 40)), "reaches beyond its buffer"),
        (changed("/buffers/0/byteLength", json!(1u64 << 40)), "expected 1099511627776"),
        (changed("/buffers/0/uri", json!("../../etc/passwd")), "no path below the folder"),
        (changed("/buffers/0/uri", json!("http://a/b.bin")), "no path below the folder"),
        (changed(positions, json!(999)), "mesh 0 has an attribute at accessor 999"),
        (changed("/meshes/0/primitives/0/attributes", json!({})), "POSITION"),
        (changed("/meshes/0/primitives/0/mode", json!(1)), "is drawn as Lines, expected triangles"),
        (changed("/accessors/1/componentType", json!(5126)), "has no whole numbers"),
        (
            changed(
                "/accessors/0/sparse",
                json!({"count": 1, "indices": {"bufferView": 0, "componentType": 5123},
            "values": {"bufferView": 0}}),
            ),
            "accessor 0 is sparse",
        ),
        (changed("/nodes/0/children", json!([0])), "node 0 is one of more than"),
        (changed("/nodes/0/scale", json!([1.0, 1e30, 1.0])), "vertex 0 lies at"),
        (changed("/images", json!(vec![json!({"uri": "a.png"}); 300])), "has 300 images"),
        (changed("/scenes", json!([])), "index out of bounds"),
        (changed("/extensionsRequired", json!(["KHR_draco_mesh_compression"])), "unsupported extension"),
    ] {
        let message = refused(CAR, &[("car.glb", &file)]);
        assert!(message.contains(said) && message.contains("car.glb"), "{said}: {message}");
    }
    let with = |change: fn(&mut Sketch)| {
        let mut sketch = car();
        change(&mut sketch);
        refused(CAR, &[("car.glb", &glb(&sketch))])
    };
    assert!(with(|s| s.boxes[0].low[0] = f32::NAN).contains("vertex 4 lies at"));
    assert!(with(|s| s.far_index = true).contains("index 60000 is beyond its 24 vertices"));
    let flat = boxed([0.0; 3], [4.5, 0.0, 1.8]);
    assert!(refused(CAR_PLAIN, &[("car.glb", &glb(&flat))]).contains("expected a solid"));
}

/// Half of the picture is green, half is not there.
#[test]
fn textures_colour_vertices_and_masks_cut() {
    let (root, bin) = textured(1);
    let dir = folder(CAR_PLAIN, &[("car.glb", &packed(root.to_string().into_bytes(), bin))]);
    let models = load(dir.path()).expect("models");
    let mesh = models.of(Subject::named("car").expect("a name"))[0].at(Detail::Fine).at_rest();
    let corners: Vec<_> = mesh.all_triangles().flatten().map(|i| mesh.vertices[i as usize]).collect();
    assert!(corners.len() > 100, "{} corners", corners.len());
    let green = corners.iter().filter(|v| v.colour == [0, 200, 0]).count();
    assert!(green * 3 > corners.len(), "{green} of {}", corners.len());
    let high = corners.iter().map(|v| v.position[2]).fold(0.0, f32::max);
    assert!((high - 1.5).abs() < 1e-3, "what is left fills the box");
}

const CAR_PLAIN: &str = "[[models]]\nfile = \"car.glb\"\nis = [\"car\"]\n";

#[test]
fn large_files_are_read_and_too_large_ones_refused() {
    let mut large = boxed([0.0; 3], [1.8, 1.4, 4.5]);
    large.repeats = 3000;
    let dir = folder(CAR_PLAIN, &[("car.glb", &glb(&large))]);
    let models = load(dir.path()).expect("72,000 vertices");
    let car = models.of(Subject::named("car").expect("a name"))[0].at(Detail::Fine).at_rest();
    assert_eq!(car.all_triangles().count(), 36_000);
    large.repeats = 9000;
    let said = refused(CAR_PLAIN, &[("car.glb", &glb(&large))]);
    assert!(said.contains("expected at most 100000 triangles and 400000 vertices in all as car"), "{said}");
    large.repeats = 500;
    let tree = CAR_PLAIN.replace("[\"car\"]", "[\"tree\"]");
    let said = refused(&tree, &[("car.glb", &glb(&large))]);
    assert!(said.contains("expected at most 5000 triangles"), "{said}");
}

/// A file in another unit: so many times as large.
fn scaled((mut root, bin): (serde_json::Value, Vec<u8>), times: f32) -> Vec<u8> {
    for node in root["nodes"].as_array_mut().expect("a list") {
        node["scale"] = serde_json::json!(vec![times; 3]);
    }
    packed(root.to_string().into_bytes(), bin)
}

/// The triangles of a file as something.
fn corners_of(name: &str, file: &[u8]) -> Vec<Vec3> {
    let dir = folder(&CAR_PLAIN.replace("\"car\"", &format!("{name:?}")), &[("car.glb", file)]);
    let models = load(dir.path()).expect("models");
    let mesh = models.of(Subject::named(name).expect("a name"))[0].at(Detail::Fine).at_rest();
    mesh.all_triangles().flatten().map(|i| Vec3::from(mesh.vertices[i as usize].position)).collect()
}

#[test]
fn files_in_any_unit_are_the_same() {
    for name in ["car", "tree"] {
        let [metres, less, more] = [1.0, 1.0 / 128.0, 128.0].map(|times| corners_of(name, &scaled(textured(1), times)));
        assert!(
            metres.len() > 100 && less == metres && more == metres,
            "{name}: {} {} {}",
            metres.len(),
            less.len(),
            more.len()
        );
    }
    let dir = folder(CAR, &[("car.glb", &scaled(parts(&car()), 1.0 / 1024.0))]);
    let models = load(dir.path()).expect("models");
    let parts = &models.of(Subject::named("car").expect("a name"))[0].at(Detail::Fine).parts;
    let radii = parts.iter().filter_map(|part| match part.joint {
        Some(Joint::Roll { radius_m }) => Some(radius_m),
        _ => None,
    });
    assert!(
        radii.clone().count() == 4 && radii.clone().all(|m| (0.28..0.4).contains(&m)),
        "{:?}",
        radii.collect::<Vec<_>>()
    );
}

/// What is seen from both sides is two triangles, and so is each that shows more of a picture.
#[test]
fn no_model_has_more_triangles_than_is_said() {
    let double_sided = |repeats: u32| {
        let (mut root, bin) = textured(repeats);
        root["materials"][0]["doubleSided"] = true.into();
        root["materials"][0]["alphaMode"] = "OPAQUE".into();
        packed(root.to_string().into_bytes(), bin)
    };
    for (repeats, more) in [(20, true), (60, false), (100, false)] {
        let count = corners_of("tree", &double_sided(repeats)).len() / 3;
        let least = 24 * repeats as usize;
        assert!((least..=5000).contains(&count) && (count > least || !more), "{repeats}: {count}");
    }
    let tree = CAR_PLAIN.replace("[\"car\"]", "[\"tree\"]");
    let said = refused(&tree, &[("car.glb", &double_sided(250))]);
    assert!(said.contains("expected at most 5000 triangles"), "{said}");
}

/// Triangles that would show more of a picture are as many as there is room for, and no reason to refuse a file.
#[test]
fn pictures_make_no_file_too_large() {
    let (root, bin) = textured(150);
    let tree = CAR_PLAIN.replace("[\"car\"]", "[\"tree\"]");
    let dir = folder(&tree, &[("car.glb", &packed(root.to_string().into_bytes(), bin))]);
    assert!(load(dir.path()).is_ok());
}

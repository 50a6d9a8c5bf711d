//! glTF files of boxes.

use serde_json::{Value, json};

/// A box that a node of its own shows.
#[derive(Clone)]
pub(crate) struct Boxed {
    pub(crate) name: &'static str,
    pub(crate) material: usize,
    /// Corners in glTF's axes: x to the left, y up, z ahead.
    pub(crate) low: [f32; 3],
    pub(crate) high: [f32; 3],
}

/// What a file holds.
#[derive(Clone)]
pub(crate) struct Sketch {
    pub(crate) boxes: Vec<Boxed>,
    /// How often the triangles of each box are there.
    pub(crate) repeats: u32,
    /// Whether the last index is beyond all vertices.
    pub(crate) far_index: bool,
    /// Parts of the JSON that are another value.
    pub(crate) changes: Vec<(String, Value)>,
}

pub(crate) fn boxed(low: [f32; 3], high: [f32; 3]) -> Sketch {
    let boxes = vec![Boxed { name: "body", material: 0, low, high }];
    Sketch { boxes, repeats: 1, far_index: false, changes: Vec::new() }
}

/// A car of 4.2 m on four wheels that turn, with a tail lamp.
pub(crate) fn car() -> Sketch {
    let mut car = boxed([-0.85, 0.3, -2.1], [0.85, 1.45, 2.1]);
    let wheel = |name, x: f32, z: f32| Boxed {
        name,
        material: 1,
        low: [x - 0.1, 0.0, z - 0.32],
        high: [x + 0.1, 0.64, z + 0.32],
    };
    car.boxes.extend([
        wheel("fl", 0.75, 1.3),
        wheel("fr", -0.75, 1.3),
        wheel("rl", 0.75, -1.3),
        wheel("rr", -0.75, -1.3),
    ]);
    car.boxes.push(Boxed { name: "tail lamp", material: 2, low: [-0.8, 0.7, -2.12], high: [0.8, 0.85, -2.1] });
    car
}

/// Faces of a cube: its normal, and corners counter-clockwise from outside, of which each bit is an axis's high end.
const FACES: [([f32; 3], [u8; 4]); 6] = [
    ([1.0, 0.0, 0.0], [1, 3, 7, 5]),
    ([-1.0, 0.0, 0.0], [0, 4, 6, 2]),
    ([0.0, 1.0, 0.0], [2, 6, 7, 3]),
    ([0.0, -1.0, 0.0], [0, 1, 5, 4]),
    ([0.0, 0.0, 1.0], [4, 5, 7, 6]),
    ([0.0, 0.0, -1.0], [0, 2, 3, 1]),
];

/// The bytes of a binary file.
pub(crate) fn glb(sketch: &Sketch) -> Vec<u8> {
    let (root, bin) = parts(sketch);
    packed(root.to_string().into_bytes(), bin)
}

/// A box, so many times, whose faces have a picture that is green below and not there above.
pub(crate) fn textured(repeats: u32) -> (Value, Vec<u8>) {
    let (mut root, mut bin) = parts(&Sketch { repeats, ..boxed([0.0; 3], [1.8, 1.4, 4.5]) });
    let rgba: Vec<u8> = (0..8 * 8).flat_map(|i| if i < 32 { [9, 9, 200, 0] } else { [0, 200, 0, 255] }).collect();
    let mut picture = Vec::new();
    let mut encoder = png::Encoder::new(&mut picture, 8, 8);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&rgba)).expect("a picture");
    let faces = 6 * repeats;
    let coordinates: Vec<f32> = (0..faces).flat_map(|_| [0.0, 0.93, 1.0, 0.93, 1.0, 0.07, 0.0, 0.07f32]).collect();
    for bytes in [coordinates.iter().flat_map(|c| c.to_le_bytes()).collect(), picture] {
        bin.resize(bin.len().next_multiple_of(4), 0);
        let list = root["bufferViews"].as_array_mut().expect("a list");
        list.push(json!({"buffer": 0, "byteOffset": bin.len(), "byteLength": Vec::len(&bytes)}));
        bin.extend(bytes);
    }
    root["accessors"]
        .as_array_mut()
        .expect("a list")
        .push(json!({"bufferView": 2, "componentType": 5126, "count": 4 * faces, "type": "VEC2"}));
    root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(3);
    root["images"] = json!([{"bufferView": 3, "mimeType": "image/png"}]);
    root["textures"] = json!([{"source": 0}]);
    root["materials"][0] =
        json!({"name": "paint", "alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}});
    root["buffers"][0]["byteLength"] = json!(bin.len());
    (root, bin)
}

/// JSON and binary data of a file.
pub(crate) fn parts(sketch: &Sketch) -> (Value, Vec<u8>) {
    let (mut bin, mut views, mut accessors, mut meshes, mut nodes) = (Vec::new(), vec![], vec![], vec![], vec![]);
    for shape in &sketch.boxes {
        let (mut vertices, mut indices): (Vec<f32>, Vec<u32>) = Default::default();
        for _ in 0..sketch.repeats {
            for (normal, corners) in FACES {
                let first = vertices.len() as u32 / 6;
                for corner in corners {
                    vertices.extend((0..3).map(|i| if corner >> i & 1 == 1 { shape.high[i] } else { shape.low[i] }));
                    vertices.extend(normal);
                }
                indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
            }
        }
        if sketch.far_index {
            *indices.last_mut().expect("some") = 60_000;
        }
        let count = vertices.len() / 6;
        let at = views.len();
        views.push(json!({"buffer": 0, "byteOffset": bin.len(), "byteLength": 4 * vertices.len(), "byteStride": 24}));
        bin.extend(vertices.iter().flat_map(|v| v.to_le_bytes()));
        views.push(json!({"buffer": 0, "byteOffset": bin.len(), "byteLength": 4 * indices.len()}));
        bin.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
        let first = accessors.len();
        accessors.push(json!({"bufferView": at, "componentType": 5126, "count": count, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]}));
        accessors.push(json!({"bufferView": at + 1, "componentType": 5125, "count": indices.len(), "type": "SCALAR"}));
        accessors
            .push(json!({"bufferView": at, "byteOffset": 12, "componentType": 5126, "count": count, "type": "VEC3"}));
        let attributes = json!({"POSITION": first, "NORMAL": first + 2});
        meshes.push(
            json!({"primitives": [{"attributes": attributes, "indices": first + 1, "material": shape.material}]}),
        );
        nodes.push(json!({"mesh": meshes.len() - 1, "name": shape.name}));
    }
    let material = |name: &str, colour: [f32; 4]| json!({"name": name, "pbrMetallicRoughness": {"baseColorFactor": colour, "roughnessFactor": 0.5}});
    let materials = [
        material("paint", [0.8, 0.1, 0.1, 1.0]),
        material("tyre", [0.02, 0.02, 0.02, 1.0]),
        material("tail", [0.3, 0.0, 0.0, 1.0]),
    ];
    let all: Vec<usize> = (0..nodes.len()).collect();
    let mut root = json!({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": all}], "nodes": nodes, "meshes": meshes,
        "materials": materials, "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": bin.len()}]});
    for (pointer, value) in &sketch.changes {
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        root.pointer_mut(parent).expect("it is there")[key] = value.clone();
    }
    (root, bin)
}

/// JSON and binary data as one file.
pub(crate) fn packed(mut json: Vec<u8>, mut bin: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    bin.resize(bin.len().next_multiple_of(4), 0);
    let total = 12 + 8 + json.len() + 8 + bin.len();
    let mut file = b"glTF".to_vec();
    file.extend([2u32, total as u32, json.len() as u32].iter().flat_map(|n| n.to_le_bytes()));
    file.extend(b"JSON");
    file.extend(json);
    file.extend((bin.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(bin);
    file
}

//! Constants that stand in shaders too are the same there.

use crate::gpu::NEAR_M;
use crate::mesh::street::building::{CELL_M, style};
use crate::{SemanticTag as Tag, clouds, ground_textures::plan, leaves, light_map, mesh, rain, spray, wind};

/// What follows `const NAME = ` in a shader.
fn constant<'a>(shader: &'a str, name: &str) -> Option<&'a str> {
    shader.lines().find_map(|line| line.strip_prefix(&format!("const {name} = "))?.strip_suffix(';'))
}

#[test]
fn codes_are_those_of_the_shaders() {
    let asphalt: &[(&str, u8)] = &[
        ("OLDEST", mesh::CODE_OLDEST),
        ("COVERS", mesh::CODE_COVERS),
        ("PAINT", mesh::CODE_PAINT),
        ("GRATING", mesh::CODE_GRATING),
    ];
    // Bonds are in the bits below.
    let paving: &[(&str, u8)] =
        &[("BOND", mesh::CODE_KERBED - 1), ("KERBED", mesh::CODE_KERBED), ("KERB", mesh::CODE_KERB)];
    let surface: &[(&str, u8)] =
        &[("LIT", mesh::CODE_LIT), ("STREET_LAMP", mesh::CODE_STREET), ("RETRO", mesh::CODE_RETRO)];
    let wet: &[(&str, u8)] = &[
        ("ROAD_LINE", Tag::RoadLine as u8),
        ("SIDEWALK", Tag::SideWalk as u8),
        ("GROUND", Tag::Ground as u8),
        ("TERRAIN", Tag::Terrain as u8),
    ];
    let facade: &[(&str, u8)] = &[
        ("MATERIAL", style::MATERIAL),
        ("BRICK", style::BRICK),
        ("TIMBER", style::TIMBER),
        ("PANELS", style::PANELS),
        ("GLASS", style::GLASS),
        ("STONE", style::STONE),
        ("TILES", style::TILES),
        ("GARAGE", style::GARAGE),
        ("BANDS", style::BANDS),
        ("SHOP", style::SHOP),
        ("FRENCH", style::FRENCH),
        ("SHUTTERS", style::SHUTTERS),
        ("DOOR", style::DOOR),
        ("DOOR_COLUMNS", style::DOOR_COLUMNS),
    ];
    for (shader, codes) in [
        (include_str!("shaders/asphalt.wgsl"), asphalt),
        (include_str!("shaders/paving.wgsl"), paving),
        (include_str!("shaders/surface.wgsl"), surface),
        (include_str!("shaders/wet.wgsl"), wet),
        (include_str!("shaders/facade.wgsl"), facade),
    ] {
        for (name, code) in codes {
            assert_eq!(constant(shader, name), Some(format!("{code}u").as_str()), "{name}");
        }
    }
    // In the shader 0 is whatever has no name of its own.
    assert_eq!((style::PLASTER, mesh::CODE_SETTS), (0, 0));
}

#[test]
fn sizes_are_those_of_the_shaders() {
    let pair = |[x, y]: [f32; 2]| format!("vec2f({x:?}, {y:?})");
    let facade = include_str!("shaders/facade.wgsl");
    assert_eq!(constant(facade, "CELL_M"), Some(pair(CELL_M.to_array()).as_str()));
    let asphalt = include_str!("shaders/asphalt.wgsl");
    assert_eq!(constant(asphalt, "ASPHALT_M"), Some(format!("{:?}", plan::ASPHALT_M).as_str()));
    let paving = include_str!("shaders/paving.wgsl");
    assert_eq!(constant(paving, "PAVING_M"), Some(format!("{:?}", plan::PAVING_M).as_str()));
    let spray_shader = include_str!("shaders/spray.wgsl");
    assert_eq!(constant(spray_shader, "WIDE"), Some(format!("{:?}", spray::WIDE).as_str()));
    let scene = include_str!("shaders/scene.wgsl");
    assert_eq!(constant(scene, "WIND_DIRECTION"), Some(pair(wind::DIRECTION.to_array()).as_str()));
    assert_eq!(constant(scene, "WIND_WAVE"), Some(pair(wind::WAVE.to_array()).as_str()));
    assert_eq!(constant(scene, "NEAR_M"), Some(format!("{NEAR_M:?}").as_str()));
    assert_eq!(constant(scene, "LIGHT_MAP_RISE_M"), Some(format!("{:?}", 2.0 * light_map::HALF_RISE_M).as_str()));
    let [x, y, z] = rain::BOX_M.to_array();
    let rain_shader = include_str!("shaders/rain.wgsl");
    assert_eq!(constant(rain_shader, "BOX_M"), Some(format!("vec3f({x:?}, {y:?}, {z:?})").as_str()));
    for (name, scale) in ["COARSE_CLOUDS", "FINE_CLOUDS"].iter().zip(clouds::SCALES) {
        assert_eq!(constant(include_str!("shaders/sky.wgsl"), name), Some(format!("{scale:?}").as_str()));
    }
    // A texel is a byte there and a share here.
    let leaf: f32 =
        constant(include_str!("shaders/leaf.wgsl"), "LEAF").and_then(|it| it.parse().ok()).expect("a number");
    assert_eq!((leaf * 255.0).ceil() as u8, leaves::THRESHOLD);
}

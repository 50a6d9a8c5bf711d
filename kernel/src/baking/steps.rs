//! The order of baking: each step takes what earlier ones made.

use glam::Vec3;

use super::source::{BakeError, Source};
use super::{
    crosswalks, dressing, junctions, lanes, lights, priority, props, signs, stops, surfaces, terrain, walkways,
};
use crate::map_data::{Lane, MapData};
use crate::places::LaneGrid;

/// Bakes the text of an OpenDRIVE file; `name` goes into [`MapData::name`].
///
/// # Errors
/// When the text is not well-formed XML, or holds no lane to drive on.
pub fn bake(name: &str, xodr: &str) -> Result<MapData, BakeError> {
    let source = Source::read(xodr)?;
    let (source, lanes) = lanes::bake(source)?;
    let (lanes, junctions) = junctions::bake(&source, lanes);
    let grid = LaneGrid::new(&lanes);
    let governed = signs::governed(&source, &lanes);
    let crosswalks = crosswalks::bake(&source, &grid.over(&lanes), &junctions, &governed);
    let (junctions, light_groups, groups) = lights::groups(&lanes, junctions, &governed);
    let lanes = stops::bake(lanes, &crosswalks, &governed, &groups);
    let light_heads = lights::heads(&source, &grid.over(&lanes), &governed, &groups);
    let crosswalks = crosswalks::lit(crosswalks, &lanes, &junctions);
    let (walk_nodes, walk_edges) = walkways::bake(&source, &grid.over(&lanes), &crosswalks);
    let mut surfaces = surfaces::bake(&source, &lanes, &junctions, &crosswalks);
    // After the paint: who waits without a sign has no line on the road.
    let lanes = priority::bake(&source, lanes, &crosswalks);
    let bounds = bounds(&lanes);
    surfaces.push(terrain::bake(&lanes, bounds));
    let props = props::bake(&source, &grid.over(&lanes), &light_heads);
    let props = dressing::bake(&source, grid.over(&lanes), bounds, props);
    let name = name.to_owned();
    let mut map = MapData {
        name,
        digest: 0,
        lanes,
        junctions,
        light_groups,
        light_heads,
        crosswalks,
        walk_nodes,
        walk_edges,
        surfaces,
        props,
        bounds,
    };
    map.digest = map.content_digest();
    Ok(map)
}

/// Room around the lanes that belongs to the map, metres.
const MARGIN_M: f32 = 60.0;

fn bounds(lanes: &[Lane]) -> [Vec3; 2] {
    let mut low = Vec3::splat(f32::MAX);
    let mut high = Vec3::splat(f32::MIN);
    for p in lanes.iter().flat_map(|l| &l.points) {
        low = low.min(p.position);
        high = high.max(p.position);
    }
    let around = Vec3::new(MARGIN_M, MARGIN_M, 0.0);
    [low - around - Vec3::Z * 5.0, high + around + Vec3::Z * 40.0]
}

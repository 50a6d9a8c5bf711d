//! The order of baking: each step takes what earlier ones made.

use glam::Vec3;

use super::error::BakeError;
use super::limits::{CROSSINGS, CROWD, EXTENT_M};
use super::notes::{Notes, PassedOver};
use super::programme::Programmes;
use super::signs::Governed;
use super::source::Source;
use super::told::Told;
use super::{
    bus_stops, crosswalks, dressing, flat, gaps, junctions, lanes, lights, marks, priority, props, signs, speeds,
    stops, structures, surfaces, terrain, walkways,
};
use crate::map_data::{Crosswalk, Lane, LightGroupId, MapData};
use crate::places::LaneGrid;

/// A map, and what else its file says.
#[derive(Clone, Debug)]
pub struct Baked {
    /// What [`bake`] gives.
    pub map: MapData,
    /// What the file says that the map does not keep, for those who show it to people.
    pub told: Told,
    /// What was passed over on the way, by kind, the largest groups first.
    pub passed_over: Vec<PassedOver>,
}

/// Bakes the text of an OpenDRIVE file; `name` goes into [`MapData::name`].
///
/// # Errors
/// When the text is not well-formed XML, or holds no lane to drive on.
pub fn bake(name: &str, xodr: &str) -> Result<MapData, BakeError> {
    map(name, xodr, &mut Notes::unwanted()).map(|(map, _)| map)
}

/// As [`bake`], and tells what was passed over.
///
/// # Errors
/// As [`bake`].
pub fn bake_with_notes(name: &str, xodr: &str) -> Result<Baked, BakeError> {
    let mut notes = Notes::wanted();
    let (map, Rest { source, governed, named_props }) = map(name, xodr, &mut notes)?;
    let told = Told::of(&source, &map, &governed, named_props);
    Ok(Baked { map, told, passed_over: notes.finish() })
}

/// The signals of a text that bakes which are traffic lights: the id of each in the file, with its group.
pub(crate) fn lights_by_id(xodr: &str) -> Option<Vec<(String, LightGroupId)>> {
    let mut notes = Notes::unwanted();
    let (source, lanes) = lanes::bake(Source::read(xodr, &mut notes).ok()?, &mut notes).ok()?;
    let lanes = speeds::bake(&source, lanes, &mut notes);
    let grid = LaneGrid::new(&lanes);
    let (lanes, junctions) = junctions::bake(&source, lanes, &grid);
    let governed = signs::governed(&source, &lanes, &mut notes);
    let groups = lights::Groups::new(&source, &lanes, &junctions, &governed);
    let of = |(g, group): (&Governed, Option<LightGroupId>)| {
        Some((source.provenance.signals.get(g.signal)?.od_id.clone(), group?))
    };
    let mut ids: Vec<_> = governed.iter().zip(groups.each()).filter_map(of).collect();
    ids.sort();
    ids.dedup();
    Some(ids)
}

/// What is left of baking.
struct Rest {
    source: Source,
    governed: Vec<Governed>,
    /// Props that the file names: the first ones.
    named_props: usize,
}

fn map(name: &str, xodr: &str, notes: &mut Notes) -> Result<(MapData, Rest), BakeError> {
    let source = Source::read(xodr, notes)?;
    let (source, lanes) = lanes::bake(source, notes)?;
    let lanes = speeds::bake(&source, lanes, notes);
    let bounds = bounds(&lanes)?;
    let grid = LaneGrid::new(&lanes);
    sparse(&lanes, &grid)?;
    let (lanes, junctions) = junctions::bake(&source, lanes, &grid);
    let governed = signs::governed(&source, &lanes, notes);
    let crosswalks = crosswalks::bake(&source, &grid.over(&lanes), &junctions, &governed, notes);
    apart(&crosswalks, &lanes)?;
    let groups = lights::Groups::new(&source, &lanes, &junctions, &governed);
    let crossed = stops::Crossed::new(&crosswalks);
    let programmes = Programmes { lanes: &lanes, crosswalks: &crosswalks, crossed: &crossed, groups: &groups };
    let (junctions, light_groups) = programmes.bake(junctions);
    let lanes = stops::bake(lanes, &crossed, &governed, &groups);
    let bus_stops = bus_stops::bake(&source, &lanes, notes);
    let light_heads = lights::heads(&source, &grid.over(&lanes), &governed, &groups);
    let crosswalks = crosswalks::lit(crosswalks, &lanes, &junctions);
    let (walk_nodes, walk_edges) = walkways::bake(&source, &grid.over(&lanes), &crosswalks);
    let mut surfaces = surfaces::bake(&source, &lanes, &junctions, &crosswalks, notes);
    marks::note(&source, notes);
    // After the paint: who waits without a sign has no line on the road.
    let lanes = priority::bake(&source, lanes, &crossed, &governed);
    let structures = structures::Structures::new(&source, &lanes);
    let (footing, below) = structures.footing(&lanes);
    let land = terrain::Land::new(footing, below, flat::pools(&source), bounds);
    surfaces.push(land.bake());
    let mut props = props::bake(&source, &grid.over(&lanes), &light_heads, notes);
    props.extend(structures.bake(&source, &grid.over(&lanes), &land));
    let named_props = props.len();
    let props = dressing::bake(&source, grid.over(&lanes), bounds, props);
    let (name, origin_m) = (name.to_owned(), source.origin_m);
    let mut map = MapData {
        name,
        digest: 0,
        lanes,
        junctions,
        light_groups,
        light_heads,
        bus_stops,
        crosswalks,
        walk_nodes,
        walk_edges,
        surfaces,
        props,
        bounds,
        origin_m,
    };
    map.digest = map.content_digest();
    Ok((map, Rest { source, governed, named_props }))
}

/// Room around the lanes that belongs to the map, metres.
const MARGIN_M: f32 = 60.0;

/// Least and greatest corner of the map; refused where it is larger than any is, or far off its origin.
fn bounds(lanes: &[Lane]) -> Result<[Vec3; 2], BakeError> {
    let mut low = Vec3::splat(f32::MAX);
    let mut high = Vec3::splat(f32::MIN);
    for lane in lanes {
        for p in &lane.points {
            low = low.min(p.position);
            high = high.max(p.position);
        }
        if (high - low).max_element() > EXTENT_M {
            let reason = format!("expected a map of at most {EXTENT_M} m, but this lane lies farther from others");
            return Err(BakeError { place: format!("lane {}", lane.name), reason });
        }
    }
    if high.max(-low).max_element() > EXTENT_M {
        let reason = format!("expected lanes within {EXTENT_M} m of the middle of all roads, but they lie farther off");
        return Err(BakeError { place: "the whole file".to_owned(), reason });
    }
    let around = Vec3::new(MARGIN_M, MARGIN_M, 0.0);
    Ok([low - around - Vec3::Z * 5.0, high + around + Vec3::Z * 40.0])
}

/// Refuses lanes that lie on each other in great numbers: whatever asks about a place looks at all of them.
fn sparse(lanes: &[Lane], grid: &LaneGrid) -> Result<(), BakeError> {
    let Some((lane, crowd)) = grid.most_crowded().filter(|(_, crowd)| *crowd > CROWD) else { return Ok(()) };
    let reason =
        format!("expected at most {CROWD} stretches of lanes around one place, but around this lane {crowd} meet");
    Err(BakeError { place: format!("lane {}", lanes[lane as usize].name), reason })
}

/// Refuses crosswalks that lie on each other in great numbers, as [`sparse`] does lanes.
fn apart(crosswalks: &[Crosswalk], lanes: &[Lane]) -> Result<(), BakeError> {
    let most = gaps::most_crowded(crosswalks).filter(|(_, crowd)| *crowd > CROSSINGS);
    let Some((crosswalk, crowd)) = most else { return Ok(()) };
    let reason = format!("expected at most {CROSSINGS} crosswalks around one place, but on this lane {crowd} meet");
    let (lane, _) = crosswalks[crosswalk].lanes[0];
    Err(BakeError { place: format!("lane {}", lanes[lane as usize].name), reason })
}

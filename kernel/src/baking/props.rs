//! Static objects that a file names: signals, signs, and everything in its `<objects>`.

use glam::Vec3;

use super::catalogue::{Meaning, meaning};
use super::flat;
use super::notes::{Notes, Passed};
use super::rounding::{snap, snap3};
use super::shapes::{beside_lanes, footprint, least_rectangle, point};
use super::source::Source;
use crate::map_data::{
    FurnitureKind, LaneKind, LightHead, Prop, PropKind, SIGN_BUS_STOP, SIGN_LIMIT, SIGN_STOP, SIGN_YIELD,
};
use crate::ops;
use crate::places::Roads;

/// What claims to be larger is no object beside a road, metres.
const LARGEST_M: f32 = 500.0;

/// What the file names, and the poles of the lights.
pub(super) fn bake(source: &Source, roads: &Roads<'_>, light_heads: &[LightHead], notes: &mut Notes) -> Vec<Prop> {
    let mut props: Vec<Prop> = light_heads.iter().map(|h| pole(h.position, h.facing_rad, h.height_m)).collect();
    for signal in source.net.signals() {
        if let Some(variant) = sign(signal) {
            let position = beside_lanes(roads, ground_of(source, signal));
            let size = Vec3::new(0.08, 0.7, 2.6);
            props.push(Prop { kind: PropKind::Sign, position, heading_rad: snap(signal.heading), size, variant });
        }
    }
    for (index, object) in source.net.objects().iter().enumerate() {
        if flat::kind(object).is_some() {
            continue;
        }
        let mut pass = |why| notes.pass(Passed::Object, why, || said(object), || source.place_of_object(index));
        let Some((kind, named)) = kind(object) else {
            // Crosswalks are looked at elsewhere.
            if object.kind != xodr::ObjectType::Crosswalk {
                pass("stands for nothing here");
            }
            continue;
        };
        let (known, boxes) = (props.len(), boxes(&object.shape, kind, object.id.0 as u32));
        let has_shape = !boxes.is_empty();
        props.extend(boxes.into_iter().filter(|p| !is_on_lane(roads, p)).map(|p| furnished(p, named)));
        if props.len() == known {
            pass(if has_shape { "would stand on a driving lane" } else { "has no footprint, or no height" });
        }
    }
    props
}

fn pole(position: Vec3, heading_rad: f32, lamps_m: f32) -> Prop {
    Prop { kind: PropKind::SignalPole, position, heading_rad, size: Vec3::new(0.15, 0.15, lamps_m), variant: 0 }
}

fn sign(signal: &xodr::Signal) -> Option<u32> {
    match meaning(signal)? {
        Meaning::Stop => Some(SIGN_STOP),
        Meaning::Yield => Some(SIGN_YIELD),
        Meaning::BusStop => Some(SIGN_BUS_STOP),
        // What stands on it, in the unit of its country.
        Meaning::Limit(_) => signal.value.map(|value| SIGN_LIMIT + value as u32),
        Meaning::Light(_) | Meaning::Priority => None,
    }
}

/// The foot of a sign's post, on the road's surface.
fn ground_of(source: &Source, signal: &xodr::Signal) -> Vec3 {
    let board = point(signal.position);
    let road = source.net.road_position(signal.applies_at.first().copied().unwrap_or(signal.position));
    let height = road.and_then(|at| source.net.road_point(at)).map_or(board.z, |p| snap(p.z));
    Vec3::new(board.x, board.y, height)
}

/// An object in a note: those that are told apart by a number in their names are one.
fn said(object: &xodr::Object) -> String {
    let name = object.name.trim_end_matches(|c: char| c.is_ascii_digit() || "_-. ".contains(c));
    match object.kind {
        xodr::ObjectType::None | xodr::ObjectType::Unknown if !name.is_empty() => {
            format!("type {}, name {name}", object.kind)
        }
        kind => format!("type {kind}"),
    }
}

/// What an object is to us, by its type, else by its name; `None` for what does not stand up.
fn kind(object: &xodr::Object) -> Option<(PropKind, FurnitureKind)> {
    use xodr::ObjectType as T;
    let name = squeezed(&object.name);
    let plain = |kind| (kind, FurnitureKind::Other);
    // What a piece of furniture is by its name, whatever else that holds, as in `street bench`.
    let furniture = || by_name(&name).find(|(kind, _)| is_furniture(*kind));
    Some(match object.kind {
        T::Tree => plain(PropKind::Tree),
        T::Vegetation => plain(PropKind::Hedge),
        T::Building => plain(PropKind::Building),
        T::Barrier => furniture().unwrap_or(plain(PropKind::GuardRail)),
        T::Railing => plain(PropKind::GuardRail),
        T::SoundBarrier => plain(PropKind::Wall),
        T::StreetLamp => plain(PropKind::Lamp),
        T::Pole => furniture().unwrap_or((PropKind::Furniture, FurnitureKind::Post)),
        T::Obstacle => furniture().unwrap_or((
            PropKind::Furniture,
            if name.contains("post") { FurnitureKind::Post } else { FurnitureKind::Other },
        )),
        T::None | T::Unknown => by_name(&name).next()?,
        _ => return None,
    })
}

fn is_furniture(kind: PropKind) -> bool {
    matches!(kind, PropKind::Furniture | PropKind::Movable | PropKind::Sundry)
}

/// A name as it is looked up: in small letters, with nothing between words; a street is no tree.
fn squeezed(name: &str) -> String {
    let letters = name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase());
    letters.collect::<String>().replace("street", " ")
}

/// What a name may stand for, the likeliest first.
fn by_name(name: &str) -> impl Iterator<Item = (PropKind, FurnitureKind)> + '_ {
    use FurnitureKind as F;
    use PropKind as K;
    const NAMES: [(PropKind, FurnitureKind, &[&str]); 25] = [
        (K::ParkedCar, F::Other, &["parkedcar"]),
        (K::Tree, F::Other, &["tree"]),
        (K::Hedge, F::Other, &["hedge", "bush"]),
        (K::Building, F::Other, &["building", "house"]),
        (K::Fence, F::Other, &["fence"]),
        (K::Wall, F::Other, &["wall"]),
        (K::GuardRail, F::Other, &["rail"]),
        (K::Lamp, F::Other, &["lamp"]),
        (K::Furniture, F::Bench, &["bench"]),
        // A cabinet is no bin.
        (K::Furniture, F::Cabinet, &["cabinet", "switchbox"]),
        (K::Furniture, F::Post, &["bollard"]),
        (K::Furniture, F::Hydrant, &["hydrant"]),
        (K::Furniture, F::Planter, &["planter"]),
        (K::Furniture, F::BicycleStand, &["bicyclestand", "bicyclerack", "bikestand", "bikerack"]),
        (K::Movable, F::Dumpster, &["dumpster"]),
        (K::Movable, F::Bin, &["bin", "trash", "garbage"]),
        (K::Movable, F::Cone, &["cone"]),
        (K::Movable, F::Beacon, &["beacon"]),
        (K::Movable, F::Barricade, &["barricade"]),
        (K::Movable, F::Other, &["barrel", "pallet", "pram", "stroller"]),
        (K::Sundry, F::Stall, &["stall"]),
        (K::Sundry, F::Shelter, &["shelter", "busstop"]),
        (K::Sundry, F::Mailbox, &["postbox", "mailbox", "letterbox"]),
        (K::Sundry, F::Other, &["kiosk", "phonebox", "container", "billboard"]),
        (K::Sundry, F::Other, &["statue", "fountain", "swing", "slide", "climbing", "sandpit", "boat"]),
    ];
    let fits = |words: &[&str]| words.iter().any(|word| name.contains(word));
    NAMES.iter().filter(move |(.., words)| fits(words)).map(|&(kind, furniture, _)| (kind, furniture))
}

/// Street furniture with what it is; where its name does not say, its size does.
fn furnished(prop: Prop, named: FurnitureKind) -> Prop {
    let furniture = match prop.kind {
        PropKind::Furniture if named == FurnitureKind::Other => of_size(prop.size),
        kind if is_furniture(kind) => named,
        _ => return prop,
    };
    Prop { variant: furniture.variant(), ..prop }
}

/// What stands fast and has no name: slender ones are posts, long ones that one can sit on are benches, and those
/// that reach to one's chest are cabinets.
fn of_size(size: Vec3) -> FurnitureKind {
    let (long, short) = (size.x.max(size.y), size.x.min(size.y));
    let is = |m: f32, [low, high]: [f32; 2]| m > low && m < high;
    if long < 0.35 * size.z {
        FurnitureKind::Post
    } else if is(long, [1.1, 3.0]) && is(short, [0.3, 0.9]) && is(size.z, [0.4, 1.0]) {
        FurnitureKind::Bench
    } else if is(long, [0.3, 2.0]) && is(short, [0.2, 1.0]) && is(size.z, [0.7, 2.2]) {
        FurnitureKind::Cabinet
    } else {
        FurnitureKind::Other
    }
}

/// Boxes that fill a shape; none for one without a footprint or height.
fn boxes(shape: &xodr::Shape, kind: PropKind, variant: u32) -> Vec<Prop> {
    let prop = |position: Vec3, heading_rad: f32, size: Vec3| Prop {
        kind,
        position: snap3(position),
        heading_rad: snap(heading_rad),
        size: snap3(size),
        variant,
    };
    let found = match shape {
        xodr::Shape::Solid { position, heading, extent: Some(extent), .. } => {
            let size = match *extent {
                xodr::Extent::Box { length, width, height } => Vec3::new(length, width, height),
                xodr::Extent::Cylinder { radius, height } => Vec3::new(2.0 * radius, 2.0 * radius, height),
                _ => Vec3::ZERO,
            };
            vec![prop(point(*position), *heading, size)]
        }
        xodr::Shape::Outline { corners, closed, .. } => outline(corners, *closed, &prop),
        xodr::Shape::Sweep { sections, .. } => {
            let middle = |s: &xodr::Section| (point(s.left.base) + point(s.right.base)) / 2.0;
            let height = |s: &xodr::Section| s.left.top.z - s.left.base.z;
            sections.windows(2).map(|w| rail(middle(&w[0]), middle(&w[1]), height(&w[0]), &prop)).collect()
        }
        _ => Vec::new(),
    };
    found.into_iter().filter(|p| p.size.x > 0.05 && p.size.z > 0.1 && p.size.max_element() < LARGEST_M).collect()
}

fn outline(corners: &[xodr::Corner], closed: bool, prop: &dyn Fn(Vec3, f32, Vec3) -> Prop) -> Vec<Prop> {
    let base: Vec<Vec3> = corners.iter().map(|c| point(c.base)).collect();
    let height = corners.iter().map(|c| c.top.z - c.base.z).fold(0.0, f32::max);
    if !closed {
        return base.windows(2).map(|w| rail(w[0], w[1], height, prop)).collect();
    }
    let Some((center, along, half)) = least_rectangle(&base) else { return Vec::new() };
    vec![prop(center, ops::atan2(along.y, along.x), (half * 2.0).extend(height))]
}

/// A thin upright piece from `a` to `b`.
fn rail(a: Vec3, b: Vec3, height: f32, prop: &dyn Fn(Vec3, f32, Vec3) -> Prop) -> Prop {
    let along = (b - a).truncate();
    prop((a + b) / 2.0, ops::atan2(along.y, along.x), Vec3::new(along.length(), 0.2, height))
}

/// Whether any of a prop's footprint lies on a driving lane.
fn is_on_lane(roads: &Roads<'_>, prop: &Prop) -> bool {
    let reach_m = prop.size.truncate().length() / 2.0 + 0.1;
    roads.may_be_near(prop.position, LaneKind::Driving, reach_m)
        && footprint(prop, 1.0)
            .iter()
            .any(|&p| roads.at(p, LaneKind::Driving).iter().any(|l| roads.beyond_edge(l) < -0.1))
}

//! Models as large as what they stand for.

use glam::{Vec2, Vec3, Vec3A};
use kernel::map::{Prop, PropKind};
use kernel::scene::ActorKind;

use super::Subject;
use crate::SemanticTag;
use crate::mesh::model::{Joint, Model};
use crate::mesh::motion::Motion;
use crate::mesh::street::tree;
use crate::mesh::{CODE_LACQUER, CODE_STREET, Mesh, Vertex};

/// A model is stretched along one axis by up to so much more than along another.
pub const MOST_STRETCH: f32 = 1.5;
/// Who is not stretched may stand out of the box by this on each side, metres: what is seen is looked for within it.
const OVER_M: f32 = 0.3;

/// What decides on the scale.
enum Rule {
    /// Each axis by itself, within [`MOST_STRETCH`].
    Box,
    /// The height alone: limbs keep their shape.
    Height,
    /// The length alone: the box has a rider in it.
    Length,
}

/// The model with the middle of its footprint at the origin, scaled, and its size, metres. What stands in the street is of the usual
/// size: each of a map is made as large as it is from that.
pub(super) fn fitted(subject: Subject, model: Model) -> Result<(Model, Vec3), String> {
    let [low, high] = bounds(&model).ok_or("has no triangles")?;
    let own = high - low;
    if !(own.min_element() > 1e-6 && own.max_element() < 1e6) {
        let [x, y, z] = own.to_array();
        return Err(format!("is {x} long, {y} wide and {z} high; expected a solid with sides of 1e-6 to 1e6"));
    }
    let middle = (0.5 * (low + high)).truncate().extend(low.z);
    let moved = moved(model, -middle);
    let factor = if subject.stands_still() {
        Vec3::splat(1.0 / per_m(subject, own))
    } else {
        factor(&rule(subject, has_rider(&moved)), own, subject.usual_size_m())?
    };
    Ok((stretched(moved, factor), own * factor))
}

/// How many of a file's units are a metre, if a model so large is as large as usual.
pub fn per_m(subject: Subject, own: Vec3) -> f32 {
    let usual = subject.usual_size_m();
    match subject {
        // Models without a rider are not as high as the box.
        Subject::Actor(kind) if is_ridden(kind) => own.x / usual.x,
        _ => own.z / usual.z,
    }
}

/// The factors that make an object as large as one of a map is.
pub(super) fn stretch(subject: Subject, own: Vec3, wanted: Vec3) -> Result<Vec3, String> {
    match subject {
        // Crowns of maps are as wide as they are: those of models may be narrower than such a crown, or wider.
        Subject::Tree => {
            let up = wanted.z / own.z;
            let across = wanted.x / own.truncate().max_element();
            let across = across.clamp(up / MOST_STRETCH, up * MOST_STRETCH);
            Ok(Vec3::new(across, across, up))
        }
        Subject::Lamp => Ok(Vec3::splat(wanted.z / own.z)),
        _ => factor(&Rule::Box, own, wanted),
    }
}

fn rule(subject: Subject, has_rider: bool) -> Rule {
    match subject {
        Subject::Actor(ActorKind::Pedestrian | ActorKind::Child) => Rule::Height,
        Subject::Actor(kind) if is_ridden(kind) && !has_rider => Rule::Length,
        _ => Rule::Box,
    }
}

fn factor(rule: &Rule, own: Vec3, wanted: Vec3) -> Result<Vec3, String> {
    let each = wanted / own;
    let uniform = match rule {
        Rule::Box => {
            let most = each.max_element() / each.min_element();
            let [x, y, z] = (each / each.min_element()).to_array();
            let stretch = format!("would be stretched {x:.2} times in length, {y:.2} in width and {z:.2} in height");
            let expected = format!("to fill {wanted}; expected at most {MOST_STRETCH} times");
            return if most <= MOST_STRETCH { Ok(each) } else { Err(format!("{stretch} {expected}")) };
        }
        Rule::Height => each.z,
        Rule::Length => each.x,
    };
    let over = (own * uniform - wanted) * Vec3::new(0.5, 0.5, 1.0);
    if over.max_element() > OVER_M {
        let size = own * uniform;
        return Err(format!(
            "would be {size:.2} m large; expected {wanted} and at most {OVER_M} m beyond on each side"
        ));
    }
    Ok(Vec3::splat(uniform))
}

/// Corners of the box around it at rest.
fn bounds(model: &Model) -> Option<[Vec3; 2]> {
    let at = |(mesh, pose): (&Mesh, glam::Affine3A)| {
        let corners: Vec<Vec3A> =
            mesh.all_triangles().flatten().map(|i| mesh.vertices[i as usize].position.into()).collect();
        corners.into_iter().map(move |p| Vec3::from(pose.transform_point3a(p)))
    };
    let posed: Vec<_> = model.posed(&Motion::default()).collect();
    let all = posed.into_iter().flat_map(at);
    all.fold(None, |reach: Option<[Vec3; 2]>, p| Some(reach.map_or([p, p], |[low, high]| [low.min(p), high.max(p)])))
}

fn moved(mut model: Model, by: Vec3) -> Model {
    for part in model.parts.iter_mut().filter(|part| part.parent.is_none()) {
        part.pivot += by;
    }
    model
}

fn stretched(mut model: Model, factor: Vec3) -> Model {
    for part in &mut model.parts {
        part.pivot *= factor;
        if let Some(Joint::Roll { radius_m }) = &mut part.joint {
            *radius_m *= factor.z;
        }
        part.mesh.scale(factor);
    }
    model
}

/// Whether somebody sits on it.
pub(super) fn is_ridden(kind: ActorKind) -> bool {
    kind.is_pedalled() || kind.is_motorcycle()
}

fn is_rider(vertex: &Vertex) -> bool {
    vertex.tag == SemanticTag::Rider as u8
}

/// Whether a model has a rider.
pub(super) fn has_rider(model: &Model) -> bool {
    model.parts.iter().flat_map(|part| &part.mesh.vertices).any(is_rider)
}

/// The model under the rider of another.
pub(super) fn with_rider_of(mut model: Model, mut other: Model) -> Model {
    for part in &mut other.parts {
        part.mesh = riders_of(&part.mesh);
    }
    let first = model.parts.len();
    model.parts.extend(other.parts.into_iter().map(|mut part| {
        part.parent = part.parent.map(|parent| parent + first);
        part
    }));
    model
}

/// A mesh of the triangles that are a rider, and of their vertices alone: lamps that are not drawn would glow.
fn riders_of(mesh: &Mesh) -> Mesh {
    let mut riders = Mesh::default();
    let mut kept: Vec<Option<u32>> = vec![None; mesh.vertices.len()];
    for (list, all) in riders.triangles.iter_mut().zip(&mesh.triangles) {
        let of_rider = all.iter().filter(|corners| is_rider(&mesh.vertices[corners[0] as usize]));
        list.extend(of_rider.map(|corners| {
            corners.map(|i| {
                *kept[i as usize].get_or_insert_with(|| {
                    riders.vertices.push(mesh.vertices[i as usize]);
                    riders.vertices.len() as u32 - 1
                })
            })
        }));
    }
    riders
}

/// The middle of the box around the glass of a street lamp.
pub(super) fn glass(model: &Model) -> Option<Vec3> {
    let mesh = model.at_rest();
    let places = mesh.vertices.iter().filter(|v| v.code == CODE_STREET).map(|v| Vec3::from(v.position));
    let [low, high] = places.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)]);
    low.is_finite().then(|| 0.5 * (low + high))
}

/// What an object's place in the map says of its mesh: its class, and that wind moves trees. It has no lacquer.
pub(super) fn finish_object(mesh: &mut Mesh, object: &Prop) {
    let tag = match object.kind {
        PropKind::Furniture => Some(SemanticTag::Static),
        PropKind::Movable => Some(SemanticTag::Dynamic),
        PropKind::Sundry => Some(SemanticTag::Other),
        _ => None,
    };
    for vertex in &mut mesh.vertices {
        vertex.tag = tag.map_or(vertex.tag, |tag| tag as u8);
        vertex.code = if vertex.code == CODE_LACQUER { 0 } else { vertex.code };
    }
    if object.kind == PropKind::Tree {
        tree::sway(mesh, object.size.z);
    }
}

/// A lacquer where a model's paint is of a colour: white takes all of it.
pub(super) fn tinted(lacquer: [u8; 3], own: [u8; 3]) -> [u8; 3] {
    let shade = Vec2::new(f32::from(own[0].max(own[1]).max(own[2])), 255.0);
    lacquer.map(|c| (f32::from(c) * shade.x / shade.y).round() as u8)
}

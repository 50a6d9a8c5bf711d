//! From nodes and primitives of glTF to a model of the renderer: y up and z ahead become z up and x ahead.

use anyhow::{Context, anyhow, bail};
use glam::{Mat4, Quat, Vec2, Vec3};
use gltf::mesh::Mode;
use gltf::{Node, Primitive, Semantic};
use render::SemanticTag;
use render::mesh::model::{Joint, Model as Posed, Part, Swing};
use render::mesh::{Finish, Mesh};
use render::models::{Subject, per_m};

use super::document::Document;
use super::list::{Entry, Model};
use super::material::Material;
use super::texture_split::{Corner, split};

/// Nodes below one another, and of a file, at most.
const MOST_DEPTH: usize = 64;
const MOST_NODES: usize = 100_000;
/// Triangles of a file at most; those of two sides are two.
const MOST_TRIANGLES: usize = 100_000;
/// The same of what stands in the street, of which each one takes memory.
const MOST_STANDING_TRIANGLES: usize = 5_000;
/// Vertices of a file at most.
const MOST_VERTICES: usize = 400_000;
/// Triangles that show more of a texture: so many for each of a primitive, and more, and as many as a file may have in all.
const SPLIT_SHARE: usize = 2;
const SPLIT_ROOM: usize = 2000;
/// Wheels are no smaller than this, metres: those of a point would turn without end.
const LEAST_RADIUS_M: f32 = 1e-3;
/// Farther than this from the origin nothing lies, in the file's unit.
const FARTHEST: f32 = 1e6;

/// How far legs and arms swing, radians, and from which speed on, m/s.
const LEGS_RAD: f32 = 0.5;
const ARMS_RAD: f32 = 0.35;
const WALKS_MPS: f32 = 1.2;

/// What a node and those below it are.
#[derive(Clone, Copy)]
enum Role {
    Wheel { steers: bool },
    Leg { left: bool },
    Arm { left: bool },
}

/// What moves by itself.
struct Limb {
    role: Role,
    /// The node's place in the model.
    origin: Vec3,
    mesh: Mesh,
}

/// A file's nodes as they come.
struct Walk<'a> {
    document: &'a Document,
    said: &'a Model,
    body: Mesh,
    limbs: Vec<Limb>,
    subject: Subject,
    nodes: usize,
    triangles: usize,
    vertices: usize,
    /// What was found, with the limbs that it is of.
    surfaces: Vec<(Option<usize>, Surface, Material<'a>)>,
}

/// The file as a model of a subject, as large as the file has it.
pub(super) fn model(document: &Document, entry: &Entry, subject: Subject) -> anyhow::Result<Posed> {
    let said = &entry.said;
    check_names(document, said)?;
    let gltf = &document.gltf;
    let scene = gltf
        .default_scene()
        .or_else(|| gltf.scenes().next())
        .ok_or_else(|| anyhow!("has no scene, expected one with the model's nodes"))?;
    let (tag, body, limbs, surfaces) = (subject.tag(), Mesh::default(), Vec::new(), Vec::new());
    let mut walk = Walk { document, said, body, limbs, subject, nodes: 0, triangles: 0, vertices: 0, surfaces };
    let axes = Mat4::from_cols_array_2d(&[
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]);
    let frame = Mat4::from_quat(Quat::from_rotation_z(said.yaw_deg.to_radians())) * axes;
    for node in scene.nodes() {
        walk.node(&node, &frame, Below { limb: None, tag, depth: 0 })?;
    }
    let per_m = per_m(subject, walk.size());
    walk.paint(per_m);
    Ok(walk.posed(per_m))
}

fn most_triangles(subject: Subject) -> usize {
    if subject.stands_still() { MOST_STANDING_TRIANGLES } else { MOST_TRIANGLES }
}

fn check_names(document: &Document, said: &Model) -> anyhow::Result<()> {
    let nodes = [&said.wheels, &said.legs, &said.arms, &said.rider];
    let has_node = |name: &&String| document.gltf.nodes().any(|node| node.name() == Some(name));
    if let Some(absent) = nodes.into_iter().flatten().find(|name| !has_node(name)) {
        bail!("has no node {absent:?}");
    }
    let lamps = &said.lamps;
    let materials = [&said.lacquer, &lamps.head, &lamps.brake, &lamps.left, &lamps.right, &lamps.street];
    let has_material = |name: &&String| document.gltf.materials().any(|material| material.name() == Some(name));
    match materials.into_iter().flatten().find(|name| !has_material(name)) {
        Some(absent) => bail!("has no material {absent:?}"),
        None => Ok(()),
    }
}

/// What a node inherits.
#[derive(Clone, Copy)]
struct Below {
    limb: Option<usize>,
    tag: SemanticTag,
    depth: usize,
}

impl Walk<'_> {
    fn node(&mut self, node: &Node<'_>, parent: &Mat4, below: Below) -> anyhow::Result<()> {
        self.nodes += 1;
        if below.depth >= MOST_DEPTH || self.nodes > MOST_NODES {
            bail!(
                "node {} is one of more than {MOST_NODES}, more than {MOST_DEPTH} deep, or below itself",
                node.index()
            );
        }
        if node.skin().is_some() {
            bail!("node {} has a skin, expected a figure of rigid nodes", node.index());
        }
        let frame = *parent * Mat4::from_cols_array_2d(&node.transform().matrix());
        let name = node.name().unwrap_or_default();
        let is_rider = self.said.rider.iter().any(|rider| rider == name);
        let tag = if is_rider { SemanticTag::Rider } else { below.tag };
        let limb = self.role(name).map(|role| {
            self.limbs.push(Limb { role, origin: frame.w_axis.truncate(), mesh: Mesh::default() });
            self.limbs.len() - 1
        });
        let below = Below { limb: limb.or(below.limb), tag, depth: below.depth + 1 };
        for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
            let place = || {
                let mesh = node.mesh().map_or(0, |mesh| mesh.index());
                format!("mesh {mesh}, primitive {}", primitive.index())
            };
            self.primitive(&primitive, &frame, below).with_context(place)?;
        }
        node.children().try_for_each(|child| self.node(&child, &frame, below))
    }

    fn role(&self, name: &str) -> Option<Role> {
        let said = self.said;
        let side = |nodes: &[String]| nodes.iter().position(|node| node == name).map(|at| at == 0);
        if said.wheels.iter().any(|node| node == name) {
            return Some(Role::Wheel { steers: said.steered.iter().any(|node| node == name) });
        }
        let leg = side(&said.legs).map(|left| Role::Leg { left });
        leg.or_else(|| side(&said.arms).map(|left| Role::Arm { left }))
    }

    fn primitive(&mut self, primitive: &Primitive<'_>, frame: &Mat4, below: Below) -> anyhow::Result<()> {
        if primitive.mode() != Mode::Triangles {
            bail!("is drawn as {:?}, expected triangles", primitive.mode());
        }
        let material = Material::of(self.document, &primitive.material(), self.said, below.tag);
        let surface = Surface::read(self.document, primitive, frame, &material)?;
        self.triangles += surface.triangles.len() * material.sides().len();
        self.vertices += surface.corners.len();
        let (most, name) = (most_triangles(self.subject), self.subject.name());
        if self.triangles > most || self.vertices > MOST_VERTICES {
            bail!("is too much, expected at most {most} triangles and {MOST_VERTICES} vertices in all as {name}");
        }
        self.surfaces.push((below.limb, surface, material));
        Ok(())
    }

    /// Of the box around all triangles, in the file's unit.
    fn size(&self) -> Vec3 {
        let places = self.surfaces.iter().flat_map(|(_, surface, _)| surface.places());
        let [low, high] = bounds(places);
        (high - low).max(Vec3::ZERO)
    }

    /// Makes meshes of what was found. Triangles that show more of textures are as many as there is room for.
    fn paint(&mut self, per_m: f32) {
        let mut room = most_triangles(self.subject) - self.triangles;
        for (limb, surface, material) in core::mem::take(&mut self.surfaces) {
            let mesh = match limb {
                None => &mut self.body,
                Some(limb) => &mut self.limbs[limb].mesh,
            };
            surface.append_to(mesh, &material, per_m, &mut room);
        }
    }

    fn posed(self, per_m: f32) -> Posed {
        let mut model = Posed::rigid(self.body);
        for Limb { role, origin, mut mesh } in self.limbs {
            let swing = |amplitude_rad: f32, left: bool| Swing {
                axis: Vec3::Y,
                rest_rad: 0.0,
                amplitude_rad,
                lead_rad: if left { 0.0 } else { core::f32::consts::PI },
                full_speed_mps: WALKS_MPS,
            };
            let (pivot, joint) = match role {
                Role::Wheel { .. } => (middle(&mesh), None),
                Role::Leg { left } => (origin, Some(Joint::Swing(swing(LEGS_RAD, left)))),
                Role::Arm { left } => (origin, Some(Joint::Swing(swing(ARMS_RAD, !left)))),
            };
            for vertex in &mut mesh.vertices {
                vertex.position = (Vec3::from(vertex.position) - pivot).to_array();
            }
            let Role::Wheel { steers } = role else {
                model.add_part(Part { parent: None, pivot, joint, shown_mps: None, mesh });
                continue;
            };
            let least = (LEAST_RADIUS_M * per_m).max(f32::MIN_POSITIVE);
            let radius_m = mesh.vertices.iter().fold(least, |radius: f32, v| radius.max(v.position[2].abs()));
            let steer = steers.then_some(Joint::Steer);
            let hub =
                model.add_part(Part { parent: None, pivot, joint: steer, shown_mps: None, mesh: Mesh::default() });
            let (parent, joint) = (Some(hub), Some(Joint::Roll { radius_m }));
            model.add_part(Part { parent, pivot: Vec3::ZERO, joint, shown_mps: None, mesh });
        }
        model
    }
}

/// The middle of the box around a mesh.
fn middle(mesh: &Mesh) -> Vec3 {
    let [low, high] = bounds(mesh.vertices.iter().map(|v| Vec3::from(v.position)));
    if mesh.vertices.is_empty() { Vec3::ZERO } else { 0.5 * (low + high) }
}

/// Corners of the box around some places.
fn bounds(places: impl Iterator<Item = Vec3>) -> [Vec3; 2] {
    places.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
}

/// Triangles of one material.
struct Surface {
    corners: Vec<Corner>,
    triangles: Vec<[u32; 3]>,
}

impl Surface {
    fn read(
        document: &Document,
        primitive: &Primitive<'_>,
        frame: &Mat4,
        material: &Material<'_>,
    ) -> anyhow::Result<Self> {
        let accessor = |semantic: &Semantic| primitive.get(semantic).map(|accessor| accessor.index());
        let positions = accessor(&Semantic::Positions).ok_or_else(|| anyhow!("has no POSITION"))?;
        let positions: Vec<[f32; 3]> = document.vectors(positions).context("POSITION")?;
        let count = positions.len();
        let place = |p: &[f32; 3]| frame.transform_point3(Vec3::from(*p));
        let positions: Vec<Vec3> = positions.iter().map(place).collect();
        let is_near = |p: &Vec3| p.is_finite() && p.abs().max_element() < FARTHEST;
        if let Some(at) = positions.iter().position(|p| !is_near(p)) {
            bail!("vertex {at} lies at {}, expected numbers below {FARTHEST:e}", positions[at]);
        }
        let indices = match primitive.indices() {
            Some(indices) => document.numbers(indices.index()).context("indices")?,
            None => (0..count as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|index| **index as usize >= count) {
            bail!("index {index} is beyond its {count} vertices");
        }
        if !indices.len().is_multiple_of(3) {
            bail!("has {} indices, expected three for each triangle", indices.len());
        }
        let is_flipped = frame.determinant() < 0.0;
        let turned = |t: &[u32; 3]| if is_flipped { [t[0], t[2], t[1]] } else { *t };
        let triangles = indices.as_chunks::<3>().0.iter().map(turned).collect();
        let same = |what: &str, found: usize| {
            if found == count { Ok(()) } else { Err(anyhow!("{what} has {found} values for {count} vertices")) }
        };
        let normals =
            accessor(&Semantic::Normals).map(|index| document.vectors::<3>(index)).transpose().context("NORMAL")?;
        let coordinates = accessor(&Semantic::TexCoords(material.coordinates)).filter(|_| material.is_textured());
        let coordinates = coordinates.map(|index| document.vectors::<2>(index)).transpose().context("TEXCOORD")?;
        let colours =
            accessor(&Semantic::Colors(0)).map(|index| colours(document, index)).transpose().context("COLOR_0")?;
        same("NORMAL", normals.as_ref().map_or(count, Vec::len))?;
        same("TEXCOORD", coordinates.as_ref().map_or(count, Vec::len))?;
        same("COLOR_0", colours.as_ref().map_or(count, Vec::len))?;
        let upright = frame.inverse().transpose();
        let corner = |i: usize| Corner {
            position: positions[i],
            normal: normals
                .as_ref()
                .map_or(Vec3::ZERO, |n| upright.transform_vector3(Vec3::from(n[i])).normalize_or_zero()),
            at: coordinates.as_ref().map_or(Vec2::ZERO, |at| Vec2::from(at[i])),
            own: colours.as_ref().map_or([1.0; 4], |own| own[i]),
        };
        Ok(Self { corners: (0..count).map(corner).collect(), triangles }.with_normals())
    }

    /// The same with faces of their own where normals are not told.
    fn with_normals(self) -> Self {
        let is_told = |t: &&[u32; 3]| t.iter().all(|i| is_unit(self.corners[*i as usize].normal));
        if self.triangles.iter().all(|t| is_told(&t)) {
            return self;
        }
        let mut flat = Self { corners: self.corners.clone(), triangles: Vec::with_capacity(self.triangles.len()) };
        for triangle in &self.triangles {
            if is_told(&triangle) {
                flat.triangles.push(*triangle);
                continue;
            }
            let [a, b, c] = triangle.map(|i| self.corners[i as usize]);
            let normal = (b.position - a.position).cross(c.position - a.position).normalize_or(Vec3::Z);
            let first = flat.corners.len() as u32;
            flat.corners.extend([a, b, c].map(|corner| Corner { normal, ..corner }));
            flat.triangles.push([first, first + 1, first + 2]);
        }
        flat
    }

    /// Where the corners of its triangles are.
    fn places(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.triangles.iter().flatten().map(|i| self.corners[*i as usize].position)
    }

    fn append_to(self, mesh: &mut Mesh, material: &Material<'_>, per_m: f32, room: &mut usize) {
        let Self { mut corners, mut triangles } = self;
        let sides = material.sides();
        if material.is_textured() {
            let whole = triangles.len();
            let more = (SPLIT_SHARE * whole + SPLIT_ROOM).min(*room / sides.len());
            split(&mut corners, &mut triangles, (material, per_m), more);
            *room -= (triangles.len() - whole) * sides.len();
        }
        let colours: Vec<[f32; 4]> =
            corners.iter().map(|corner| material.colour(corner.at.to_array(), corner.own)).collect();
        let is_there = |t: &[u32; 3]| {
            let alpha = t.iter().map(|i| colours[*i as usize][3]).sum::<f32>() / 3.0;
            material.cutoff.is_none_or(|cutoff| alpha >= cutoff)
        };
        for &side in sides {
            // Vertices that no triangle has are left out.
            let mut kept: Vec<Option<u32>> = vec![None; corners.len()];
            for triangle in triangles.iter().filter(|t| is_there(t)) {
                let [a, b, c] = triangle.map(|i| {
                    let (corner, paint) = (&corners[i as usize], material.paint(colours[i as usize]));
                    *kept[i as usize]
                        .get_or_insert_with(|| mesh.vertex(paint, corner.position, side * corner.normal, Vec2::ZERO))
                });
                mesh.triangle(Finish::Plain, if side > 0.0 { [a, b, c] } else { [a, c, b] });
            }
        }
    }
}

fn is_unit(normal: Vec3) -> bool {
    (0.9..1.1).contains(&normal.length())
}

fn colours(document: &Document, index: usize) -> anyhow::Result<Vec<[f32; 4]>> {
    if document.components(index)? == 4 {
        return document.vectors::<4>(index);
    }
    Ok(document.vectors::<3>(index)?.into_iter().map(|[r, g, b]| [r, g, b, 1.0]).collect())
}

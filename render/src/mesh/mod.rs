//! Everything that can be seen, as triangles made in code.
//!
//! A mesh is plain data: positions, normals, paint and class. How meshes get into the world is told
//! by [`model`], so that another renderer can pose them on its own.

pub mod actor;
pub mod foliage;
pub mod gait;
pub mod look;
pub mod model;
pub mod motion;
pub mod people;
pub mod prop;
mod rings;
pub mod rows;
pub mod shape;
pub mod simplify;
mod skin;
pub mod skirt;
pub mod street;
pub mod variety;
pub mod vehicles;

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};

use crate::SemanticTag;

/// Which fragment shader paints a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// One colour; [`Vertex::param`] is its gloss.
    Plain = 0,
    /// Colour with grain; [`Vertex::param`] is the grain's strength, uv are metres.
    Grainy = 1,
    /// House front; uv are window columns and storeys, [`Vertex::code`] is its style.
    Facade = 2,
    /// Asphalt and the paint on it; [`Vertex::param`] is 0 at one edge of a lane and 255 at the other, uv are metres along a
    /// road and across it, [`Vertex::code`] is its age, [`CODE_PAINT`] or [`CODE_GRATING`].
    Asphalt = 3,
    /// Laid stones; uv are metres along a road and from its kerb, [`Vertex::code`] is how they are laid.
    Paving = 4,
    /// Grass; [`Vertex::param`] is how bare the soil is, uv are metres.
    Grass = 5,
    /// Leaves with air between them; [`Vertex::code`] is their [`foliage::Leaf`], [`Vertex::param`] how much light they
    /// let through, uv are sides of its picture.
    Leafy = 6,
}

/// Number of variants of [`Finish`].
pub const FINISHES: usize = 7;

impl Finish {
    /// All, in the order of their numbers.
    pub const ALL: [Self; FINISHES] =
        [Self::Plain, Self::Grainy, Self::Facade, Self::Asphalt, Self::Paving, Self::Grass, Self::Leafy];

    /// Whether one sees through its triangles in places: they hide nothing, and are drawn after what does.
    pub const fn has_holes(self) -> bool {
        matches!(self, Self::Leafy)
    }
}

/// [`Vertex::code`] of a lamp that shines.
pub const CODE_LIT: u8 = 255;
/// [`Vertex::code`] of a brake lamp, which shines while its car brakes.
pub const CODE_BRAKE: u8 = 254;
/// [`Vertex::code`] of an indicator on the left, which flashes.
pub const CODE_LEFT: u8 = 253;
/// [`Vertex::code`] of an indicator on the right.
pub const CODE_RIGHT: u8 = 252;
/// [`Vertex::code`] of a head lamp.
pub const CODE_HEAD: u8 = 251;
/// [`Vertex::code`] of the glass of a street lamp, which shines at night.
pub const CODE_STREET: u8 = 250;
/// [`Vertex::code`] of a brake lamp that is no tail lamp (UN regulation 48: S3).
pub const CODE_CENTRE_BRAKE: u8 = 249;
/// [`Vertex::code`] of the face of a sign, which sends the light of headlights back.
pub const CODE_RETRO: u8 = 248;
/// [`Vertex::code`] of what takes its vehicle's colour, in models of users: none is drawn.
pub const CODE_LACQUER: u8 = 247;
/// [`Vertex::code`] of paint on asphalt.
pub const CODE_PAINT: u8 = 64;
/// [`Vertex::code`] of the grating of a drain in the asphalt.
pub const CODE_GRATING: u8 = 65;
/// [`Vertex::code`] of asphalt of an age from 0 to 7; with [`CODE_COVERS`] it has manholes.
pub const CODE_OLDEST: u8 = 7;
/// See [`CODE_OLDEST`].
pub const CODE_COVERS: u8 = 8;
/// [`Vertex::code`] of setts; of small stones, flags and slabs it is this and up to 3 more.
pub const CODE_SETTS: u8 = 0;
/// [`Vertex::code`] of laid stones with a kerb at their edge is this and that of the stones.
pub const CODE_KERBED: u8 = 4;
/// [`Vertex::code`] of a kerb.
pub const CODE_KERB: u8 = 8;

/// A vertex as the GPU reads it, 32 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Vertex {
    /// Position, metres.
    pub position: [f32; 3],
    /// Unit normal in 127ths.
    pub normal: [i8; 3],
    /// How far wind moves it, in 127ths of [`crate::wind::REACH_M`].
    pub sway: i8,
    /// Red, green and blue (sRGB).
    pub colour: [u8; 3],
    /// What it means depends on the [`Finish`].
    pub param: u8,
    /// Class: id of a [`SemanticTag`].
    pub tag: u8,
    /// One of the `CODE_*` constants, or the style of a house front.
    pub code: u8,
    /// Instance, as in [`crate::Frame::instance_ids`].
    pub instance: u16,
    /// Coordinates on the surface; their unit depends on the [`Finish`].
    pub uv: [f32; 2],
}

/// How a surface is painted and classed.
#[derive(Clone, Copy, Debug)]
pub struct Paint {
    /// Class.
    pub tag: SemanticTag,
    /// Red, green and blue (sRGB).
    pub colour: [u8; 3],
    /// Shader.
    pub finish: Finish,
    /// See [`Vertex::param`].
    pub param: u8,
    /// See [`Vertex::code`].
    pub code: u8,
}

impl Paint {
    /// One dull colour.
    pub const fn plain(tag: SemanticTag, colour: [u8; 3]) -> Self {
        Self { tag, colour, finish: Finish::Plain, param: 0, code: 0 }
    }

    /// Glossy like lacquer (about 100) or glass (255).
    pub const fn glossy(self, gloss: u8) -> Self {
        Self { param: gloss, ..self }
    }

    /// With grain of a strength from 0 to 255.
    pub const fn grainy(self, strength: u8) -> Self {
        Self { finish: Finish::Grainy, param: strength, ..self }
    }

    /// With a code.
    pub const fn coded(self, code: u8) -> Self {
        Self { code, ..self }
    }

    /// In another colour.
    pub const fn colour(self, colour: [u8; 3]) -> Self {
        Self { colour, ..self }
    }

    /// Brighter (above 1) or darker.
    pub fn shaded(self, factor: f32) -> Self {
        Self { colour: self.colour.map(|c| (f32::from(c) * factor).clamp(0.0, 255.0) as u8), ..self }
    }
}

/// Triangles, sorted by finish. The vertices of a triangle share their tag, code and instance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices.
    pub vertices: Vec<Vertex>,
    /// Corners of the triangles of each [`Finish`], counter-clockwise seen from outside.
    pub triangles: [Vec<[u32; 3]>; FINISHES],
}

impl Mesh {
    /// Makes it larger or smaller by a factor along each axis.
    pub fn scale(&mut self, factor: Vec3) {
        for vertex in &mut self.vertices {
            vertex.position = (Vec3::from(vertex.position) * factor).to_array();
            let normal = Vec3::from(vertex.normal.map(f32::from)) / factor;
            vertex.normal = (normal.normalize_or_zero() * 127.0).round().to_array().map(|n| n as i8);
        }
    }

    /// Appends a vertex and gives its index.
    pub fn vertex(&mut self, paint: Paint, position: Vec3, normal: Vec3, uv: Vec2) -> u32 {
        let n = (normal * 127.0).round();
        self.vertices.push(Vertex {
            position: position.to_array(),
            normal: [n.x as i8, n.y as i8, n.z as i8],
            sway: 0,
            colour: paint.colour,
            param: paint.param,
            tag: paint.tag as u8,
            code: paint.code,
            instance: 0,
            uv: uv.to_array(),
        });
        self.vertices.len() as u32 - 1
    }

    /// Appends a triangle over existing vertices.
    pub fn triangle(&mut self, finish: Finish, corners: [u32; 3]) {
        self.triangles[finish as usize].push(corners);
    }

    /// Appends another mesh, moved.
    pub fn append(&mut self, other: &Mesh, offset: Vec3) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(other.vertices.iter().map(|v| {
            let position = (Vec3::from_array(v.position) + offset).to_array();
            Vertex { position, ..*v }
        }));
        for (mine, theirs) in self.triangles.iter_mut().zip(&other.triangles) {
            mine.extend(theirs.iter().map(|t| t.map(|i| i + first)));
        }
    }

    /// Lets wind move what lies above `still_m`, fully at `full_m` and above.
    pub fn sway_between(&mut self, still_m: f32, full_m: f32) {
        for v in &mut self.vertices {
            let share = ((v.position[2] - still_m) / (full_m - still_m)).clamp(0.0, 1.0);
            v.sway = (share * share * 127.0) as i8;
        }
    }

    /// Triangles of all finishes.
    pub fn all_triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.triangles.iter().flatten().copied()
    }

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.triangles.iter().all(Vec::is_empty)
    }
}

//! A piece of street furniture to be made, and what many are made of.

use glam::Vec3;

use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::{Mesh, Paint};

pub(super) const IRON: [u8; 3] = [52, 54, 58];
pub(super) const STEEL: [u8; 3] = [132, 136, 138];
pub(super) const WOOD: [u8; 3] = [140, 100, 64];
pub(super) const WHITE: [u8; 3] = [226, 226, 220];
pub(super) const GLASS: [u8; 3] = [150, 172, 178];

/// What a piece is made in: its class, its box and how finely.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub(super) tag: SemanticTag,
    pub(super) size: Vec3,
    pub(super) detail: Detail,
}

/// Corners of a rectangle, anticlockwise from above.
pub(super) const RECTANGLE: [(f32, f32); 4] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];

impl Piece {
    pub(super) fn paint(&self, colour: [u8; 3]) -> Paint {
        Paint::plain(self.tag, colour)
    }

    /// Half its extent on the ground.
    pub(super) fn half(&self) -> Vec3 {
        Vec3::new(0.5 * self.size.x, 0.5 * self.size.y, 0.0)
    }

    pub(super) fn is_fine(&self) -> bool {
        self.detail == Detail::Fine
    }

    pub(super) fn is_rough(&self) -> bool {
        self.detail == Detail::Rough
    }

    pub(super) fn sides(&self) -> u32 {
        if self.is_fine() { 10 } else { 5 }
    }

    /// A point in its box by shares: of half its length and width from the middle, of its height from the ground.
    pub(super) fn at(&self, x: f32, y: f32, z: f32) -> Vec3 {
        Vec3::new(x, y, z) * Vec3::new(0.5 * self.size.x, 0.5 * self.size.y, self.size.z)
    }

    /// The rectangle that takes such a share of its length and width, at a share of its height.
    pub(super) fn ring(&self, share: f32, z: f32) -> [Vec3; 4] {
        RECTANGLE.map(|(x, y)| self.at(share * x, share * y, z))
    }
}

/// Makes what is longer than wide, turned where its box is not.
pub(super) fn lengthwise(piece: &Piece, make: impl Fn(&Piece) -> Mesh) -> Mesh {
    if piece.size.x >= piece.size.y {
        return make(piece);
    }
    let mut mesh = make(&Piece { size: Vec3::new(piece.size.y, piece.size.x, piece.size.z), ..*piece });
    for vertex in &mut mesh.vertices {
        let ([x, y, z], [nx, ny, nz]) = (vertex.position, vertex.normal);
        (vertex.position, vertex.normal) = ([-y, x, z], [-ny, nx, nz]);
    }
    mesh
}

//! Houses: walls with windows and doors, shop fronts, roofs of several shapes, and what stands out from them.

mod design;
mod outline;
mod roof;
mod street;

use glam::{Vec2, Vec3};

pub use self::design::style;
use self::design::{Design, Kind};
pub(crate) use self::outline::CELL_M;
use self::outline::{NO_WINDOWS, TAG, corners, rim};
use self::street::Front;
use crate::mesh::model::Detail;
use crate::mesh::{Mesh, Paint};

/// A house that fills a box of `size` metres; its front looks along the x axis.
pub fn building(variant: u32, size: Vec3, detail: Detail) -> Mesh {
    let design = Design::new(variant, size);
    let mut mesh = Mesh::default();
    let columns = walls(&mut mesh, &design);
    if detail != Detail::Rough && design.kind != Kind::Garage {
        plinth(&mut mesh, &design);
    }
    roof::roof(&mut mesh, &design, detail);
    street::adorn(&mut mesh, &design, Front::new(&design, columns), detail);
    mesh
}

/// The wall that looks at the street, along the x axis, and the one behind.
const STREET_FRONT: usize = 1;
const BACK: usize = 3;

/// The four walls; u counts window columns, v storeys. Doors and shops are on the side of the street. Gives the columns there.
fn walls(mesh: &mut Mesh, design: &Design) -> f32 {
    let Design { wall, size, .. } = *design;
    let (floor, roof) = (corners(size, 0.0, 0.0), corners(size, 0.0, design.eaves_m));
    let mut front_columns = 1.0;
    for i in 0..4 {
        let j = (i + 1) % 4;
        let length_m = (floor[j] - floor[i]).length();
        let is_blind = match i {
            STREET_FRONT => false,
            BACK => design.kind == Kind::Garage,
            _ => design.is_walled_in || design.kind == Kind::Garage,
        };
        let (least, code) = match i {
            STREET_FRONT if design.kind == Kind::Garage => (1.0, wall.code | style::DOOR),
            STREET_FRONT if design.kind == Kind::Tower => (1.0, wall.code | style::DOOR),
            STREET_FRONT => (f32::from(style::DOOR_COLUMNS), wall.code | style::DOOR),
            _ => (1.0, wall.code & !(style::SHOP | style::FRENCH)),
        };
        let columns = (length_m / CELL_M.x).floor().max(least);
        if i == STREET_FRONT {
            front_columns = columns;
        }
        let ground = if is_blind { NO_WINDOWS } else { 0.0 };
        let uv = [(0.0, 0.0), (columns, 0.0), (columns, design.storeys), (0.0, design.storeys)]
            .map(|(u, v)| Vec2::new(u, v + ground));
        mesh.quad_uv(wall.coded(code), [floor[i], floor[j], roof[j], roof[i]], uv);
    }
    front_columns
}

/// The dark foot of the walls.
fn plinth(mesh: &mut Mesh, design: &Design) {
    let stone = Paint::plain(TAG, design.wall.colour).shaded(0.62);
    let (size, top) = (design.size, 0.32);
    mesh.walls(stone, &corners(size, 0.05, 0.0), &corners(size, 0.05, top));
    rim(mesh, stone, size, [0.05, 0.0], top);
}

#[cfg(test)]
mod tests;

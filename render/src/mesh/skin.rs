//! Curved panels: surfaces whose normals bend over their edges, so that few triangles look round.

use glam::{Vec2, Vec3};

use super::{Mesh, Paint};

/// A surface through rows of points, looking to the left of the way along a row seen from the way from row to row; `paint`
/// tells the paint of a column. Normals are means of those around, larger faces counting more.
pub(super) fn skin(mesh: &mut Mesh, paint: impl Fn(usize) -> Paint, rows: &[Vec<Vec3>]) {
    let columns = rows[0].len();
    let mut normals = vec![vec![Vec3::ZERO; columns]; rows.len()];
    for i in 1..rows.len() {
        for j in 1..columns {
            let (down, across) = (rows[i][j - 1] - rows[i - 1][j], rows[i][j] - rows[i - 1][j - 1]);
            let normal = down.cross(across);
            for (row, column) in [(i - 1, j - 1), (i - 1, j), (i, j - 1), (i, j)] {
                normals[row][column] += normal;
            }
        }
    }
    let first = mesh.vertices.len() as u32;
    for (row, normals) in rows.iter().zip(&normals) {
        for (column, (&p, n)) in row.iter().zip(normals).enumerate() {
            mesh.vertex(paint(column), p, n.normalize_or_zero(), Vec2::new(p.x, p.y + p.z));
        }
    }
    let (finish, width) = (paint(0).finish, columns as u32);
    for i in 1..rows.len() as u32 {
        for j in 1..width {
            let (b, c) = (first + i * width + j - 1, first + i * width + j);
            let (a, d) = (b - width, c - width);
            mesh.triangle(finish, [a, b, c]);
            mesh.triangle(finish, [a, c, d]);
        }
    }
}

/// A flat convex polygon, corners counter-clockwise seen from outside, that is lit as if it were bent by `bow` radians a
/// metre away from its middle.
pub(super) fn bowed(mesh: &mut Mesh, paint: Paint, corners: &[Vec3], bow: f32) {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
    let middle = corners.iter().sum::<Vec3>() / corners.len() as f32;
    let first = mesh.vertices.len() as u32;
    for &corner in corners {
        let bent = (normal + (corner - middle) * bow).normalize_or_zero();
        mesh.vertex(paint, corner, bent, Vec2::new(corner.x, corner.y + corner.z));
    }
    for i in 2..corners.len() as u32 {
        mesh.triangle(paint.finish, [first, first + i - 1, first + i]);
    }
}

/// A thin board from `a` to `b` on a surface that looks along `normal`.
pub(super) fn strip(mesh: &mut Mesh, paint: Paint, a: Vec3, b: Vec3, normal: Vec3, width_m: f32) {
    let aside = normal.cross(b - a).normalize_or_zero() * (0.5 * width_m);
    mesh.polygon(paint, &[a - aside, b - aside, b + aside, a + aside]);
}

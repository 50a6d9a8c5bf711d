//! Fewer triangles for the same shape: vertices that no plane and no outline needs are drawn into a
//! neighbour (half-edge collapse; Hoppe et al. 1993 name it, the plane test is ours).

use std::collections::BTreeMap;

use glam::Vec3;

use super::{Finish, Mesh, Vertex};

/// Triangles around a vertex at most in meshes that may be anything.
const MOST_AROUND: usize = 32;

/// A mesh whose surface lies within `error_m` of the given one, usually of far fewer triangles.
/// Triangles of different finishes stay apart; vertices that agree in all but their place on the
/// surface are joined, and on asphalt and laid stones those that agree in that too.
pub fn simplified(mesh: &Mesh, error_m: f32) -> Mesh {
    let is_laid = |finish: usize| [Finish::Asphalt, Finish::Paving].iter().any(|laid| *laid as usize == finish);
    collapsed(mesh, error_m, is_laid, None)
}

/// As [`simplified`], of a mesh whose colours are those of its vertices: they stay apart by colour, and are drawn only into those
/// that differ by at most so much of 255 in red, green and blue.
pub fn simplified_in_colour(mesh: &Mesh, error_m: f32, differ: u8) -> Mesh {
    collapsed(mesh, error_m, |_| true, Some(differ))
}

fn collapsed(mesh: &Mesh, error_m: f32, is_laid: impl Fn(usize) -> bool, differ: Option<u8>) -> Mesh {
    let mut simpler = Mesh::default();
    for (finish, triangles) in mesh.triangles.iter().enumerate() {
        let mut surface = Welded::new(mesh, triangles, is_laid(finish));
        if let Some(differ) = differ {
            (surface.differ, surface.most_around) = (differ, MOST_AROUND);
        }
        surface.collapse_all(error_m);
        surface.append_to(&mut simpler, finish);
    }
    simpler
}

/// One finish of a mesh with shared vertices.
struct Welded {
    vertices: Vec<Vertex>,
    triangles: Vec<[u32; 3]>,
    /// Triangles around each vertex.
    around: Vec<Vec<u32>>,
    /// How far the surface around each vertex has moved so far, metres.
    moved_m: Vec<f32>,
    /// Vertices whose surroundings have changed since they were looked at.
    waiting: Vec<bool>,
    /// By how much colours of vertices that are joined may differ.
    differ: u8,
    /// Vertices with more triangles around them stay: each neighbour of each is looked at.
    most_around: usize,
}

impl Welded {
    /// With `is_laid`, what differs in where it lies on its road stays apart.
    fn new(mesh: &Mesh, triangles: &[[u32; 3]], is_laid: bool) -> Self {
        let mut index = BTreeMap::new();
        let mut welded = Self {
            vertices: Vec::new(),
            triangles: Vec::new(),
            around: Vec::new(),
            moved_m: Vec::new(),
            waiting: Vec::new(),
            differ: u8::MAX,
            most_around: usize::MAX,
        };
        for triangle in triangles {
            let corners = triangle.map(|i| {
                let v = mesh.vertices[i as usize];
                let laid = is_laid.then(|| (v.uv.map(f32::to_bits), v.colour, v.param));
                let key = (v.position.map(f32::to_bits), v.normal, v.code, laid);
                *index.entry(key).or_insert_with(|| {
                    welded.vertices.push(v);
                    welded.vertices.len() as u32 - 1
                })
            });
            welded.triangles.push(corners);
        }
        welded.around = vec![Vec::new(); welded.vertices.len()];
        welded.moved_m = vec![0.0; welded.vertices.len()];
        welded.waiting = vec![true; welded.vertices.len()];
        for (t, corners) in (0..).zip(&welded.triangles) {
            for &corner in corners {
                welded.around[corner as usize].push(t);
            }
        }
        welded
    }

    fn at(&self, vertex: u32) -> Vec3 {
        Vec3::from_array(self.vertices[vertex as usize].position)
    }

    fn collapse_all(&mut self, error_m: f32) {
        let mut changed = true;
        while changed {
            changed = false;
            for vertex in 0..self.vertices.len() {
                if std::mem::take(&mut self.waiting[vertex]) {
                    changed |= self.collapse(vertex as u32, error_m);
                }
            }
        }
    }

    /// Draws a vertex into one of its neighbours, if one will do.
    fn collapse(&mut self, vertex: u32, error_m: f32) -> bool {
        let around = &self.around[vertex as usize];
        if around.len() > self.most_around {
            return false;
        }
        let neighbours: Vec<u32> =
            around.iter().flat_map(|&t| self.triangles[t as usize]).filter(|&n| n != vertex).collect();
        let best = neighbours
            .iter()
            .filter_map(|&to| self.cost(vertex, to, &neighbours).map(|cost| (cost, to)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match best {
            Some((cost, to)) if self.moved_m[vertex as usize] + cost < error_m => {
                self.draw_into(vertex, to, cost);
                for neighbour in neighbours {
                    self.waiting[neighbour as usize] = true;
                }
                true
            }
            _ => false,
        }
    }

    /// By how much the surface moves when `vertex` is drawn into `to`; `None` where it would fold.
    /// `neighbours` holds the other two corners of each triangle around the vertex.
    fn cost(&self, vertex: u32, to: u32, neighbours: &[u32]) -> Option<f32> {
        let (from, target) = (self.at(vertex), self.at(to));
        let [old, new] = [vertex, to].map(|v| self.vertices[v as usize].colour);
        if (0..3).any(|i| old[i].abs_diff(new[i]) > self.differ) {
            return None;
        }
        let mut cost = self.outline_cost(vertex, to, neighbours)?;
        for &t in &self.around[vertex as usize] {
            let corners = self.triangles[t as usize];
            if corners.contains(&to) {
                continue;
            }
            let old = normal(corners.map(|c| self.at(c)));
            let new = normal(corners.map(|c| if c == vertex { target } else { self.at(c) }));
            if new.dot(old) < 0.9 * new.length() * old.length() || new.length() < 1e-6 {
                return None;
            }
            cost = cost.max((target - from).dot(old.normalize()).abs());
        }
        Some(cost)
    }

    /// A vertex of the outline may only move along it: how far it lies off the new edge.
    fn outline_cost(&self, vertex: u32, to: u32, neighbours: &[u32]) -> Option<f32> {
        let once = |n: u32| neighbours.iter().filter(|&&other| other == n).count() == 1;
        let rim: Vec<u32> = neighbours.iter().copied().filter(|&n| once(n)).collect();
        match rim.as_slice() {
            [] => Some(0.0),
            &[a, b] if to == a || to == b => {
                let (start, end) = (self.at(a), self.at(b));
                let off = self.at(vertex) - start;
                let along = (end - start).normalize_or_zero();
                (off.dot(along) > 0.0 && off.dot(along) < start.distance(end))
                    .then(|| off.reject_from_normalized(along).length())
            }
            _ => None,
        }
    }

    fn draw_into(&mut self, vertex: u32, to: u32, cost: f32) {
        for t in std::mem::take(&mut self.around[vertex as usize]) {
            let corners = self.triangles[t as usize];
            if corners.contains(&to) {
                for &corner in corners.iter().filter(|&&c| c != vertex) {
                    self.around[corner as usize].retain(|&other| other != t);
                }
                self.triangles[t as usize] = [0; 3];
            } else {
                self.triangles[t as usize] = corners.map(|c| if c == vertex { to } else { c });
                self.around[to as usize].push(t);
            }
        }
        let moved = self.moved_m[vertex as usize] + cost;
        self.moved_m[to as usize] = self.moved_m[to as usize].max(moved);
    }

    /// Appends what is left of the triangles, with the vertices they need.
    fn append_to(&self, mesh: &mut Mesh, finish: usize) {
        let mut index: BTreeMap<u32, u32> = BTreeMap::new();
        for corners in self.triangles.iter().filter(|c| c[0] != c[1]) {
            let kept = corners.map(|c| {
                *index.entry(c).or_insert_with(|| {
                    mesh.vertices.push(self.vertices[c as usize]);
                    mesh.vertices.len() as u32 - 1
                })
            });
            mesh.triangles[finish].push(kept);
        }
    }
}

fn normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::SemanticTag;
    use crate::mesh::Paint;

    /// A strip of quads along a line of points, 4 m wide.
    fn strip(points: &[(f32, f32)]) -> Mesh {
        let paint = Paint::plain(SemanticTag::Road, [90; 3]);
        let mut mesh = Mesh::default();
        for pair in points.windows(2) {
            let [(x0, y0), (x1, y1)] = [pair[0], pair[1]];
            let corners = [(x0, y0), (x1, y1), (x1, y1 + 4.0), (x0, y0 + 4.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
            mesh.quad_uv(paint, corners, corners.map(|p| Vec2::new(p.x, p.y)));
        }
        mesh
    }

    fn area(mesh: &Mesh) -> f32 {
        let at = |i: u32| Vec3::from_array(mesh.vertices[i as usize].position);
        mesh.all_triangles().map(|t| 0.5 * normal(t.map(at)).z).sum()
    }

    #[test]
    fn a_straight_strip_becomes_two_triangles() {
        let points: Vec<(f32, f32)> = (0..50).map(|i| (i as f32, 0.5 * i as f32)).collect();
        let (full, simple) = (strip(&points), simplified(&strip(&points), 0.003));
        assert_eq!(simple.all_triangles().count(), 2);
        assert!((area(&simple) - area(&full)).abs() < 0.1);
    }

    #[test]
    fn a_bend_keeps_its_shape_within_the_error() {
        let points: Vec<(f32, f32)> = (0..60).map(|i| (i as f32, 0.005 * (i * i) as f32)).collect();
        let (full, simple) = (strip(&points), simplified(&strip(&points), 0.05));
        let (before, after) = (full.all_triangles().count(), simple.all_triangles().count());
        assert!(after > 10 && after * 2 < before, "{before} to {after}");
        assert!((area(&simple) - area(&full)).abs() < 0.05 * 60.0);
    }
}

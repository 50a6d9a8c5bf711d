//! Triangles in a tree of boxes, and the nearest one along a ray.

use glam::{DVec2, DVec3};

use super::air::Air;

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Label {
    /// Id of its class in CARLA's view.
    pub class: u8,
    /// Who it is; 0 for who has no number.
    pub instance: u16,
}

/// A triangle with its label.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Corners.
    pub corners: [DVec3; 3],
    /// What it shows.
    pub label: Label,
    /// Of leaves which picture shows them, and where in it the corners are.
    pub leaf: Option<(u8, [DVec2; 3])>,
}

enum Node {
    Leaf { low: DVec3, high: DVec3, from: usize, to: usize },
    Inner { low: DVec3, high: DVec3, children: [usize; 2] },
}

/// Triangles sorted into boxes.
pub struct Bvh {
    triangles: Vec<Triangle>,
    nodes: Vec<Node>,
    air: Air,
}

const LEAF: usize = 6;

impl Bvh {
    /// Sorts triangles by halving along the longest side.
    pub fn new(triangles: Vec<Triangle>) -> Self {
        let count = triangles.len();
        let mut bvh = Self { triangles, nodes: Vec::new(), air: Air::new() };
        bvh.split(0, count);
        bvh
    }

    fn split(&mut self, from: usize, to: usize) -> usize {
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        for corner in self.triangles[from..to].iter().flat_map(|t| t.corners) {
            (low, high) = (low.min(corner), high.max(corner));
        }
        let index = self.nodes.len();
        self.nodes.push(Node::Leaf { low, high, from, to });
        if to - from > LEAF {
            let size = high - low;
            let axis = if size.x > size.y.max(size.z) {
                0
            } else if size.y > size.z {
                1
            } else {
                2
            };
            let middle = (from + to) / 2;
            let place = |t: &Triangle| t.corners[0][axis] + t.corners[1][axis] + t.corners[2][axis];
            let sorted = &mut self.triangles[from..to];
            sorted.select_nth_unstable_by(middle - from, |a, b| place(a).total_cmp(&place(b)));
            let children = [self.split(from, middle), self.split(middle, to)];
            self.nodes[index] = Node::Inner { low, high, children };
        }
        index
    }

    /// Distance (in lengths of `direction`) and label of the first triangle that a ray meets, from
    /// either side.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<(f64, Label)> {
        let inverse = direction.recip();
        let mut nearest: Option<(f64, Label)> = None;
        let mut stack = vec![0];
        while let Some(index) = stack.pop() {
            let limit = nearest.map_or(f64::INFINITY, |(t, _)| t);
            match &self.nodes[index] {
                Node::Inner { low, high, children } if meets(*low, *high, origin, inverse, limit) => {
                    stack.extend(children)
                }
                Node::Leaf { low, high, from, to } if meets(*low, *high, origin, inverse, limit) => {
                    for triangle in &self.triangles[*from..*to] {
                        let hit = intersect(triangle, origin, direction)
                            .filter(|&(t, _)| nearest.is_none_or(|(n, _)| t < n))
                            .filter(|&(_, at)| !self.is_air(triangle, at));
                        nearest = hit.map(|(t, _)| (t, triangle.label)).or(nearest);
                    }
                }
                _ => {}
            }
        }
        nearest
    }

    /// Whether there is no leaf at a place of a triangle, given by the shares of its second and third corner.
    fn is_air(&self, triangle: &Triangle, at: DVec2) -> bool {
        triangle.leaf.is_some_and(|(leaf, [a, b, c])| self.air.is_at(leaf, a + at.x * (b - a) + at.y * (c - a)))
    }
}

/// Slab test.
fn meets(low: DVec3, high: DVec3, origin: DVec3, inverse: DVec3, limit: f64) -> bool {
    let (a, b) = ((low - origin) * inverse, (high - origin) * inverse);
    let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    enter <= leave && leave > 0.0 && enter < limit
}

/// Distance, and shares of the second and third corner (Moeller and Trumbore 1997).
fn intersect(triangle: &Triangle, origin: DVec3, direction: DVec3) -> Option<(f64, DVec2)> {
    let [a, b, c] = triangle.corners;
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let det = ab.dot(p);
    if det.abs() < 1e-14 {
        return None;
    }
    let s = (origin - a) / det;
    let u = s.dot(p);
    let q = s.cross(ab);
    let v = direction.dot(q);
    let t = ac.dot(q);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.1).then_some((t, DVec2::new(u, v)))
}

//! One number over everything that a map is.

use glam::Vec3;
use xxhash_rust::xxh3::xxh3_128;

use super::{Lane, RoadNetwork, StopKind};

/// xxh3-128 over a canonical layout: fields in their order, numbers little-endian and of fixed
/// width, floats as their bits, lists and texts with their length before them.
pub(super) fn of(map: &RoadNetwork) -> u128 {
    let mut b = Bytes(Vec::new());
    b.list(&map.lanes, lane);
    b.list(&map.junctions, |b, j| {
        b.text(&j.name).list(&j.lanes, |b, &l| b.int(l)).list(&j.light_groups, |b, &g| b.int(g)).point(j.center)
    });
    b.list(&map.light_groups, |b, g| b.int(g.junction).int(g.place));
    b.list(&map.light_heads, |b, h| b.int(h.group).point(h.position).float(h.facing_rad).float(h.height_m));
    b.list(&map.crosswalks, |b, c| {
        b.point(c.ends[0]).point(c.ends[1]).float(c.half_width_m);
        b.list(&c.lanes, |b, &(l, s)| b.int(l).float(s)).maybe(c.junction)
    });
    b.list(&map.walk_nodes, |b, n| b.point(n.position).list(&n.edges, |b, &e| b.int(e)));
    b.list(&map.walk_edges, |b, e| {
        b.int(e.nodes[0]).int(e.nodes[1]).list(&e.points, |b, &p| b.point(p));
        b.float(e.half_width_m).float(e.length_m).maybe(e.crosswalk).maybe(e.beside)
    });
    b.list(&map.surfaces, |b, s| {
        b.int(s.kind as u32).list(&s.positions, |b, &p| b.point(p));
        b.list(&s.triangles, |b, t| b.int(t[0]).int(t[1]).int(t[2]))
    });
    b.list(&map.props, |b, p| b.int(p.kind as u32).point(p.position).float(p.heading_rad).point(p.size).int(p.variant));
    b.point(map.bounds[0]).point(map.bounds[1]);
    xxh3_128(&b.0)
}

fn lane<'a>(b: &'a mut Bytes, l: &Lane) -> &'a mut Bytes {
    b.int(l.kind as u32).text(&l.name);
    b.list(&l.points, |b, p| b.point(p.position).float(p.heading_rad).float(p.half_width_m).float(p.s_m));
    b.float(l.length_m).list(&l.successors, |b, &i| b.int(i)).list(&l.predecessors, |b, &i| b.int(i));
    b.maybe(l.left).maybe(l.right).float(l.speed_limit_mps).maybe(l.junction).int(l.turn as u32);
    let (kind, group) = match l.stop.map(|s| s.kind) {
        None => (0, 0),
        Some(StopKind::Light(group)) => (1, group),
        Some(StopKind::Stop) => (2, 0),
        Some(StopKind::Yield) => (3, 0),
    };
    b.int(kind).int(group).float(l.stop.map_or(0.0, |s| s.s_m));
    b.list(&l.conflicts, |b, c| b.int(c.lane).float(c.from_m).float(c.to_m).int(u32::from(c.other_first)))
}

struct Bytes(Vec<u8>);

impl Bytes {
    fn int(&mut self, value: u32) -> &mut Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    fn float(&mut self, value: f32) -> &mut Self {
        self.int(value.to_bits())
    }

    fn point(&mut self, p: Vec3) -> &mut Self {
        self.float(p.x).float(p.y).float(p.z)
    }

    fn maybe(&mut self, value: Option<u32>) -> &mut Self {
        self.int(value.unwrap_or(u32::MAX))
    }

    fn text(&mut self, text: &str) -> &mut Self {
        self.int(text.len() as u32).0.extend(text.bytes());
        self
    }

    fn list<T>(&mut self, items: &[T], write: impl for<'a> Fn(&'a mut Self, &T) -> &'a mut Self) -> &mut Self {
        self.int(items.len() as u32);
        for item in items {
            write(self, item);
        }
        self
    }
}

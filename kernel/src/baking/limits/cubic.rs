//! Profiles along a road: cubics, each from its start to the next one's.

use std::ops::Range;

use roxmltree::Node;

use super::constants::RECORDS;
use super::numbers::number;
use super::place::refused;
use crate::baking::error::BakeError;

/// `a + b ds + c ds^2 + d ds^3` from its start on.
#[derive(Clone, Copy, Debug, Default)]
struct Cubic {
    start: f64,
    coefficients: [f64; 4],
}

/// Cubics in the order of their starts.
#[derive(Debug, Default)]
pub struct Profile<'a> {
    cubics: Vec<(Cubic, Node<'a, 'a>)>,
}

impl<'a> Profile<'a> {
    /// Those below `parent` with some tag; `start` is the name of the attribute that says where one starts.
    pub fn read(parent: Node<'a, 'a>, tag: &str, start: &str) -> Result<Self, BakeError> {
        let nodes: Vec<_> = parent.children().filter(|n| n.has_tag_name(tag)).collect();
        if nodes.len() > RECORDS {
            let reason = format!("expected at most {RECORDS} records <{tag}>, but there are {}", nodes.len());
            return Err(refused(parent, reason));
        }
        let mut cubics: Vec<_> = nodes.into_iter().map(|node| (Cubic::read(node, start), node)).collect();
        cubics.sort_by(|a, b| a.0.start.total_cmp(&b.0.start));
        Ok(Self { cubics })
    }

    /// How many records it has.
    pub fn len(&self) -> usize {
        self.cubics.len()
    }

    /// Whether it has one value over a stretch.
    pub fn is_constant(&self, over: &Range<f64>) -> bool {
        let mut active = self.active(over);
        let first = active
            .next()
            .is_none_or(|(cubic, _, stretch)| stretch.start <= over.start && cubic.coefficients[1..] == [0.0; 3]);
        first && active.next().is_none()
    }

    /// The value farthest from 0 in a stretch, or, of what cannot be negative, the greatest; refused beyond `most`.
    pub fn within(&self, over: &Range<f64>, most: f64, what: &str, unit: &str, signed: bool) -> Result<f64, BakeError> {
        let mut peak = 0.0_f64;
        for (cubic, node, stretch) in self.active(over) {
            let (lowest, highest) = cubic.range(&stretch);
            let value = if signed { highest.max(-lowest) } else { highest };
            if value > most {
                let (from, to) = (stretch.start, stretch.end);
                let reason =
                    format!("expected {what} of at most {most} {unit}, but between {from} m and {to} m it is {value}");
                return Err(refused(node, reason));
            }
            peak = peak.max(value);
        }
        Ok(peak)
    }

    /// The cubics that hold somewhere in a stretch, and where.
    fn active(&self, over: &Range<f64>) -> impl Iterator<Item = (Cubic, Node<'a, 'a>, Range<f64>)> {
        let ends = self.cubics.iter().skip(1).map(|c| c.0.start).chain([f64::INFINITY]);
        let stretches = self
            .cubics
            .iter()
            .zip(ends)
            .map(|((cubic, node), end)| (*cubic, *node, cubic.start.max(over.start)..end.min(over.end)));
        // At the end of the stretch there is a point, at which one that starts there holds.
        stretches.filter(|(_, _, s)| s.start < s.end || (s.start == over.end && s.end == over.end))
    }
}

impl Cubic {
    fn read(node: Node<'_, '_>, start: &str) -> Self {
        let of = |name| number(node, name).unwrap_or(0.0);
        Self { start: of(start), coefficients: ["a", "b", "c", "d"].map(of) }
    }

    fn at(&self, s: f64) -> f64 {
        let [a, b, c, d] = self.coefficients;
        let ds = s - self.start;
        a + b * ds + c * ds * ds + d * ds * ds * ds
    }

    /// Its least and greatest value in a stretch: at the ends, or where it turns.
    fn range(&self, over: &Range<f64>) -> (f64, f64) {
        let [_, b, c, d] = self.coefficients;
        // The roots of b + 2 c ds + 3 d ds^2; where it is no parabola, that of a line.
        let root = (c * c - 3.0 * b * d).max(0.0).sqrt();
        let turns = [(-c - root) / (3.0 * d), (-c + root) / (3.0 * d), -b / (2.0 * c)].map(|ds| ds + self.start);
        let inside = turns.into_iter().filter(|s| over.contains(s));
        let values = inside.chain([over.start, over.end]).map(|s| self.at(s));
        values.fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)))
    }
}

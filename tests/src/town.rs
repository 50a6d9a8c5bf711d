//! A town of any size as OpenDRIVE: streets in a grid that meet at junctions, with sidewalks and zebras.

use std::fmt::Write;

use crate::roads::geometry;

/// From the middle of a junction to the mouths of its streets, metres.
const SETBACK_M: f64 = 12.0;
/// From a street's mouth to the middle of its zebra, metres.
const ZEBRA_M: f64 = 3.6;
const LANE_M: f64 = 3.5;
const SIDEWALK_M: f64 = 2.5;
/// East, north, west, south as steps in the grid.
const WAYS: [(i64, i64); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// A grid of junctions, `pitch_m` apart.
pub struct Town {
    /// Junctions from west to east, 2 or more.
    pub columns: usize,
    /// Junctions from south to north, 2 or more.
    pub rows: usize,
    /// Metres between junctions.
    pub pitch_m: f64,
}

/// A street as seen from a junction.
struct Arm {
    road: usize,
    /// Whether the street begins at the junction.
    begins: bool,
    way: usize,
}

impl Town {
    /// The whole file.
    pub fn text(&self) -> String {
        let mut text = String::from("<?xml version=\"1.0\"?>\n<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>\n");
        let mut junctions = String::new();
        for node in 0..self.columns * self.rows {
            [0, 1].iter().filter_map(|way| Some((*way, self.beyond(node, *way)?))).for_each(|(way, other)| {
                text += &self.street(node, way, other);
            });
            let (inside, junction) = self.junction(node);
            text += &inside;
            junctions += &junction;
        }
        text + &junctions + "</OpenDRIVE>\n"
    }

    fn place(&self, node: usize) -> (i64, i64) {
        ((node % self.columns) as i64, (node / self.columns) as i64)
    }

    /// The next junction that way.
    fn beyond(&self, node: usize, way: usize) -> Option<usize> {
        let ((x, y), (dx, dy)) = (self.place(node), WAYS[way]);
        let (x, y) = (x + dx, y + dy);
        let inside = (0..self.columns as i64).contains(&x) && (0..self.rows as i64).contains(&y);
        inside.then_some(y as usize * self.columns + x as usize)
    }

    fn junction_id(node: usize) -> usize {
        20 * node + 3
    }

    /// The street that leaves a junction to the east or the north.
    fn street_id(node: usize, way: usize) -> usize {
        20 * node + 1 + way
    }

    /// A place on the way out of a junction, and the heading there.
    fn mouth(&self, node: usize, way: usize) -> [f64; 3] {
        let ((x, y), (dx, dy)) = (self.place(node), WAYS[way]);
        let at = |n: i64, d: i64| n as f64 * self.pitch_m + d as f64 * SETBACK_M;
        [at(x, dx), at(y, dy), heading(way)]
    }

    fn street(&self, node: usize, way: usize, other: usize) -> String {
        let (id, length) = (Self::street_id(node, way), self.pitch_m - 2.0 * SETBACK_M);
        let plan = geometry(0.0, self.mouth(node, way), length, "<line/>");
        let end =
            |tag: &str, node| format!("<{tag} elementType=\"junction\" elementId=\"{}\"/>", Self::junction_id(node));
        let both = [lane(2, "sidewalk", SIDEWALK_M), lane(1, "driving", LANE_M)].concat();
        let right = [lane(-1, "driving", LANE_M), lane(-2, "sidewalk", SIDEWALK_M)].concat();
        let mark = "<roadMark sOffset=\"0\" type=\"broken\" width=\"0.12\"/>";
        format!(
            "<road id=\"{id}\" length=\"{length}\" junction=\"-1\"><link>{}{}</link><planView>{plan}</planView><lanes>\
             <laneSection s=\"0\"><left>{both}</left><center><lane id=\"0\" type=\"none\">{mark}</lane></center>\
             <right>{right}</right></laneSection></lanes><objects>{}{}</objects></road>\n",
            end("predecessor", node),
            end("successor", other),
            zebra(id, 0, ZEBRA_M),
            zebra(id, 1, length - ZEBRA_M),
        )
    }

    fn arms(&self, node: usize) -> Vec<Arm> {
        let arm = |way: usize| {
            let other = self.beyond(node, way)?;
            let begins = way < 2;
            let road = if begins { Self::street_id(node, way) } else { Self::street_id(other, way - 2) };
            Some(Arm { road, begins, way })
        };
        (0..4).filter_map(arm).collect()
    }

    /// The ways through a junction, and the junction.
    fn junction(&self, node: usize) -> (String, String) {
        let (arms, id) = (self.arms(node), Self::junction_id(node));
        let (mut roads, mut joins) = (String::new(), String::new());
        let pairs = arms.iter().flat_map(|a| arms.iter().filter(|b| a.way != b.way).map(move |b| (a, b)));
        for (k, (from, to)) in pairs.enumerate() {
            let road = id + 1 + k;
            roads += &self.way_through(node, road, from, to);
            write!(
                joins,
                "<connection id=\"{k}\" incomingRoad=\"{}\" connectingRoad=\"{road}\" contactPoint=\"start\">\
                 <laneLink from=\"{}\" to=\"-1\"/></connection>",
                from.road,
                if from.begins { 1 } else { -1 }
            )
            .expect("writing to a string");
        }
        (roads, format!("<junction id=\"{id}\" name=\"\" type=\"default\">{joins}</junction>\n"))
    }

    fn way_through(&self, node: usize, id: usize, from: &Arm, to: &Arm) -> String {
        let [x, y, out] = self.mouth(node, from.way);
        let (radius, quarter) = (SETBACK_M, std::f64::consts::FRAC_PI_2);
        let (length, shape) = match (to.way + 4 - from.way) % 4 {
            2 => (2.0 * SETBACK_M, "<line/>".to_owned()),
            turn => {
                let curvature = if turn == 3 { 1.0 / radius } else { -1.0 / radius };
                (quarter * radius, format!("<arc curvature=\"{curvature}\"/>"))
            }
        };
        let plan = geometry(0.0, [x, y, out + 2.0 * quarter], length, &shape);
        let contact = |arm: &Arm| if arm.begins { "start" } else { "end" };
        let end = |tag: &str, arm: &Arm| {
            let (road, contact) = (arm.road, contact(arm));
            format!("<{tag} elementType=\"road\" elementId=\"{road}\" contactPoint=\"{contact}\"/>")
        };
        let (before, after) = (if from.begins { 1 } else { -1 }, if to.begins { -1 } else { 1 });
        let link = format!("<link><predecessor id=\"{before}\"/><successor id=\"{after}\"/></link>");
        let lane = format!("<lane id=\"-1\" type=\"driving\">{link}{}</lane>", width(LANE_M));
        format!(
            "<road id=\"{id}\" length=\"{length}\" junction=\"{}\"><link>{}{}</link><planView>{plan}</planView><lanes>\
             <laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center><right>{lane}</right></laneSection>\
             </lanes></road>\n",
            Self::junction_id(node),
            end("predecessor", from),
            end("successor", to),
        )
    }
}

fn heading(way: usize) -> f64 {
    way as f64 * std::f64::consts::FRAC_PI_2
}

fn width(m: f64) -> String {
    format!("<width sOffset=\"0\" a=\"{m}\" b=\"0\" c=\"0\" d=\"0\"/>")
}

fn lane(id: i32, kind: &str, m: f64) -> String {
    format!("<lane id=\"{id}\" type=\"{kind}\">{}</lane>", width(m))
}

fn zebra(road: usize, number: usize, s: f64) -> String {
    let corners = [(-2.0, -LANE_M), (2.0, -LANE_M), (2.0, LANE_M), (-2.0, LANE_M)].iter().enumerate();
    let corner = |(k, (ds, t)): (usize, &(f64, f64))| {
        format!("<cornerRoad id=\"{k}\" s=\"{}\" t=\"{t}\" dz=\"0\" height=\"0\"/>", s + ds)
    };
    format!(
        "<object id=\"{}\" type=\"crosswalk\" name=\"zebra\" s=\"{s}\" t=\"0\" zOffset=\"0\" hdg=\"0\" \
         orientation=\"none\" length=\"4\" width=\"7\"><outlines><outline id=\"0\" closed=\"true\">{}</outline>\
         </outlines></object>",
        2 * road + number,
        corners.map(corner).collect::<String>()
    )
}

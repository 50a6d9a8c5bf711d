//! Texts of roundabouts: a ring of one lane with two-way arms, tangential enough for a bus.
#![allow(dead_code, reason = "each test file uses some of it")]

use std::f64::consts::TAU;
use std::fmt;

/// Widths of the lane that goes round, and of those of the arms, metres.
const RING_LANE_M: f64 = 5.0;
const ARM_LANE_M: f64 = 3.5;
/// Radius of the ways in and out at their left edge, as seen with traffic on the right, metres; less where there is no room.
const CORNER_M: f64 = 16.0;
/// Radius of the middle of a way in or out, below which no bus gets round it, metres.
const LEAST_CORNER_M: f64 = 8.0;
/// Ring between two arms, along its left edge, metres.
const BETWEEN_M: f64 = 2.0;
/// Distance of the sign before the ring from the way in, and from the lane, metres.
const SIGN_BEFORE_M: f64 = 1.0;
const SIGN_ASIDE_M: f64 = 1.0;
/// Speed limits, km/h.
const ARM_KMH: u32 = 50;
const RING_KMH: u32 = 30;
/// First ids of roads: the ring behind each arm, the arms, and the ways past them, out of the ring, and into it.
const RING: u32 = 100;
const ARM: u32 = 200;
const PAST: u32 = 300;
const OUT: u32 = 400;
const IN: u32 = 500;
/// First id of junctions: one at each arm.
const JUNCTION: u32 = 900;

/// A roundabout with its arms at equal angles, driven round to the left where traffic keeps to the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roundabout {
    /// Radius of the middle of the lane that goes round, metres.
    pub radius_m: f64,
    /// Two-way roads that lead to it.
    pub arms: u32,
    /// Length of each, metres; their outer ends are dead ends.
    pub arm_m: f64,
    /// Whether a sign tells those who come in to give way.
    pub signs: bool,
    /// Whether traffic keeps to the left: everything is mirrored.
    pub left_hand: bool,
}

impl Default for Roundabout {
    fn default() -> Self {
        Self { radius_m: 25.0, arms: 4, arm_m: 200.0, signs: true, left_hand: false }
    }
}

impl fmt::Display for Roundabout {
    /// As in `roundabout 18 m, 3 arms, left, no signs`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hand = if self.left_hand { ", left" } else { "" };
        let signs = if self.signs { "" } else { ", no signs" };
        write!(f, "roundabout {} m, {} arms{hand}{signs}", self.radius_m, self.arms)
    }
}

/// Where a road begins, and how it goes on; as seen with traffic on the right.
#[derive(Clone, Copy)]
struct Course {
    x_m: f64,
    y_m: f64,
    heading_rad: f64,
    length_m: f64,
    /// Positive to the left, 1/m.
    curvature: f64,
}

/// A lane of a road, as seen with traffic on the right.
struct Lane {
    id: i32,
    /// The lanes at the road's start and end that it is joined to.
    links: [Option<i32>; 2],
    /// Widths there, metres.
    widths_m: [f64; 2],
}

/// A road of the file.
struct Road {
    id: u32,
    junction: Option<u32>,
    limit_kmh: u32,
    course: Course,
    /// Elements that tell of what it is joined to.
    links: String,
    /// From the left to the right.
    lanes: Vec<Lane>,
    /// Its element with signals, if any.
    signals: String,
}

impl Roundabout {
    /// Whether a bus gets round it: a small one has no room for many arms.
    pub fn is_drivable(&self) -> bool {
        self.corner_m() - RING_LANE_M / 2.0 >= LEAST_CORNER_M
    }

    /// The text of a file that holds it and nothing else.
    pub fn open_drive(&self) -> String {
        let roads = |arm| {
            let roads = [self.ring(arm), self.arm(arm), self.past(arm), self.way_out(arm), self.way_in(arm)];
            roads.map(|road| self.road(&road)).concat()
        };
        let roads: String = (0..self.arms).map(roads).collect();
        let junctions: String = (0..self.arms).map(|arm| self.junction(arm)).collect();
        format!(
            "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\" name=\"{self}\"/>{roads}{junctions}\
             </OpenDRIVE>"
        )
    }

    /// 1 with traffic on the right; -1 on the left, where everything is mirrored.
    fn side(&self) -> i32 {
        if self.left_hand { -1 } else { 1 }
    }

    /// Radius of the ring's left edge, along which its roads are drawn, metres.
    fn edge_m(&self) -> f64 {
        self.radius_m - RING_LANE_M / 2.0
    }

    /// Angle between two arms, radians.
    fn sector_rad(&self) -> f64 {
        TAU / f64::from(self.arms)
    }

    /// Direction of an arm from the middle, radians.
    fn arm_rad(&self, arm: u32) -> f64 {
        self.sector_rad() * f64::from(arm)
    }

    /// Radius of the left edge of the ways in and out, metres: circles that touch the ring's edge from outside and the
    /// middle of an arm.
    fn corner_m(&self) -> f64 {
        let widest_rad = (self.sector_rad() - BETWEEN_M / self.edge_m()) / 2.0;
        let sin = libm::sin(widest_rad.min(TAU / 8.0));
        CORNER_M.min(self.edge_m() * sin / (1.0 - sin))
    }

    /// Angle between an arm and where the ways in and out touch the ring, radians.
    fn opening_rad(&self) -> f64 {
        libm::asin(self.corner_m() / (self.edge_m() + self.corner_m()))
    }

    /// A piece of the ring that begins at an angle and goes on for another.
    fn around(&self, from_rad: f64, by_rad: f64) -> Course {
        let edge_m = self.edge_m();
        Course {
            x_m: edge_m * libm::cos(from_rad),
            y_m: edge_m * libm::sin(from_rad),
            heading_rad: from_rad + TAU / 4.0,
            length_m: edge_m * by_rad,
            curvature: 1.0 / edge_m,
        }
    }

    /// An arm from where the ways in and out touch it.
    fn outwards(&self, arm: u32) -> Course {
        let between_m = self.edge_m() + self.corner_m();
        let from_m = libm::sqrt(between_m * between_m - self.corner_m() * self.corner_m());
        let heading_rad = self.arm_rad(arm);
        let (x_m, y_m) = (from_m * libm::cos(heading_rad), from_m * libm::sin(heading_rad));
        Course { x_m, y_m, heading_rad, length_m: self.arm_m, curvature: 0.0 }
    }

    /// A bend to the right between ring and arm, from where another course begins.
    fn corner(&self, from: Course) -> Course {
        let length_m = self.corner_m() * (TAU / 4.0 - self.opening_rad());
        Course { length_m, curvature: -1.0 / self.corner_m(), ..from }
    }

    /// The ring road that leads to an arm.
    fn before(&self, arm: u32) -> u32 {
        RING + (arm + self.arms - 1) % self.arms
    }

    /// The ring from an arm to the next one.
    fn ring(&self, arm: u32) -> Road {
        let from_rad = self.arm_rad(arm) + self.opening_rad();
        let course = self.around(from_rad, self.sector_rad() - 2.0 * self.opening_rad());
        let links =
            joined("predecessor", JUNCTION + arm, "") + &joined("successor", JUNCTION + (arm + 1) % self.arms, "");
        Road { junction: None, ..one_way(RING + arm, arm, course, links, -1, [RING_LANE_M; 2]) }
    }

    /// The ring past an arm.
    fn past(&self, arm: u32) -> Road {
        let course = self.around(self.arm_rad(arm) - self.opening_rad(), 2.0 * self.opening_rad());
        let links = joined("predecessor", self.before(arm), "end") + &joined("successor", RING + arm, "start");
        one_way(PAST + arm, arm, course, links, -1, [RING_LANE_M; 2])
    }

    /// The way from the ring to an arm.
    fn way_out(&self, arm: u32) -> Road {
        let course = self.corner(self.around(self.arm_rad(arm) - self.opening_rad(), 0.0));
        let links = joined("predecessor", self.before(arm), "end") + &joined("successor", ARM + arm, "start");
        one_way(OUT + arm, arm, course, links, -1, [RING_LANE_M, ARM_LANE_M])
    }

    /// The way from an arm to the ring.
    fn way_in(&self, arm: u32) -> Road {
        let from = Course { heading_rad: self.arm_rad(arm) + TAU / 2.0, ..self.outwards(arm) };
        let links = joined("predecessor", ARM + arm, "start") + &joined("successor", RING + arm, "start");
        one_way(IN + arm, arm, self.corner(from), links, 1, [ARM_LANE_M, RING_LANE_M])
    }

    /// A road outwards with a lane in each direction.
    fn arm(&self, arm: u32) -> Road {
        let lane = |id| Lane { id, links: [Some(-1), None], widths_m: [ARM_LANE_M; 2] };
        Road {
            id: ARM + arm,
            junction: None,
            limit_kmh: ARM_KMH,
            course: self.outwards(arm),
            links: joined("predecessor", JUNCTION + arm, ""),
            lanes: vec![lane(1), lane(-1)],
            signals: if self.signs { self.sign(arm) } else { String::new() },
        }
    }

    /// The sign to give way, for the lane that leads to an arm's start.
    fn sign(&self, arm: u32) -> String {
        let lane = self.side();
        let t_m = f64::from(lane) * (ARM_LANE_M + SIGN_ASIDE_M);
        format!(
            "<signals><signal id=\"{arm}\" s=\"{SIGN_BEFORE_M}\" t=\"{t_m}\" zOffset=\"2\" orientation=\"-\" \
             dynamic=\"no\" country=\"DE\" type=\"205\" subtype=\"-1\"><validity fromLane=\"{lane}\" toLane=\"{lane}\"/>\
             </signal></signals>"
        )
    }

    /// What leads where at an arm.
    fn junction(&self, arm: u32) -> String {
        let ways = [(self.before(arm), -1, PAST), (self.before(arm), -1, OUT), (ARM + arm, 1, IN)];
        let connection = |(from, lane, inside): (u32, i32, u32)| {
            format!(
                "<connection id=\"{inside}\" incomingRoad=\"{from}\" connectingRoad=\"{}\" contactPoint=\"start\">\
                 <laneLink from=\"{}\" to=\"{}\"/></connection>",
                inside + arm,
                lane * self.side(),
                -self.side()
            )
        };
        let connections = ways.map(connection).concat();
        format!("<junction id=\"{}\" name=\"arm {arm}\" type=\"default\">{connections}</junction>", JUNCTION + arm)
    }

    /// Writes a road, on the side of traffic.
    fn road(&self, road: &Road) -> String {
        let (id, kmh, links, signals) = (road.id, road.limit_kmh, &road.links, &road.signals);
        let junction = road.junction.map_or(String::from("-1"), |id| id.to_string());
        let rule = if self.left_hand { "LHT" } else { "RHT" };
        let side = f64::from(self.side());
        let Course { x_m, y_m, heading_rad, length_m, curvature } = road.course;
        let (y_m, heading_rad, curvature) = (y_m * side, heading_rad * side, curvature * side);
        let shape = if curvature == 0.0 { "<line/>".into() } else { format!("<arc curvature=\"{curvature}\"/>") };
        let lanes = |beside: &str, sign: i32| {
            let there = road.lanes.iter().filter(|lane| lane.id * self.side() * sign > 0);
            let lanes: String = there.map(|lane| self.lane(lane, length_m)).collect();
            if lanes.is_empty() { lanes } else { format!("<{beside}>{lanes}</{beside}>") }
        };
        format!(
            "<road id=\"{id}\" length=\"{length_m}\" junction=\"{junction}\" rule=\"{rule}\"><link>{links}</link>\
             <type s=\"0\" type=\"town\"><speed max=\"{kmh}\" unit=\"km/h\"/></type><planView><geometry s=\"0\" \
             x=\"{x_m}\" y=\"{y_m}\" hdg=\"{heading_rad}\" length=\"{length_m}\">{shape}</geometry></planView>\
             <lanes><laneSection s=\"0\">{}<center><lane id=\"0\" type=\"none\"/></center>{}</laneSection></lanes>\
             {signals}</road>",
            lanes("left", 1),
            lanes("right", -1),
        )
    }

    /// Writes a lane, on the side of traffic; its width does not change at its ends, so that its middle has no kink there.
    fn lane(&self, lane: &Lane, length_m: f64) -> String {
        let [from, to] = lane.links.map(|id| id.map(|id| id * self.side()));
        let link = |end: &str, id: Option<i32>| id.map_or(String::new(), |id| format!("<{end} id=\"{id}\"/>"));
        let (predecessor, successor) = (link("predecessor", from), link("successor", to));
        let [from_m, to_m] = lane.widths_m;
        let c = 3.0 * (to_m - from_m) / (length_m * length_m);
        let d = -2.0 * c / (3.0 * length_m);
        format!(
            "<lane id=\"{}\" type=\"driving\"><link>{predecessor}{successor}</link>\
             <width sOffset=\"0\" a=\"{from_m}\" b=\"0\" c=\"{c}\" d=\"{d}\"/></lane>",
            lane.id * self.side()
        )
    }
}

/// A road inside the junction of an arm, with one lane, which follows the lane `follows`.
fn one_way(id: u32, arm: u32, course: Course, links: String, follows: i32, widths_m: [f64; 2]) -> Road {
    Road {
        id,
        junction: Some(JUNCTION + arm),
        limit_kmh: RING_KMH,
        course,
        links,
        lanes: vec![Lane { id: -1, links: [Some(follows), Some(-1)], widths_m }],
        signals: String::new(),
    }
}

/// Tells what is at an end of a road: another one at its `contact`, or a junction without one.
fn joined(end: &str, id: u32, contact: &str) -> String {
    if contact.is_empty() {
        return format!("<{end} elementType=\"junction\" elementId=\"{id}\"/>");
    }
    format!("<{end} elementType=\"road\" elementId=\"{id}\" contactPoint=\"{contact}\"/>")
}

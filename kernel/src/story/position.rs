//! Places in the words of a text, and how what is between them is measured.

use super::spot::Spot;

/// Index of somebody among all who play.
pub type RoleId = usize;

/// A place in the words of the text. Headings are absolute unless they are turned against that of the road or role.
#[derive(Clone, Debug, PartialEq)]
pub enum Position {
    /// Metres in the coordinates of the map's file.
    World {
        /// East and north.
        at_m: [f64; 2],
        /// Height; nothing for that of the road.
        z_m: Option<f64>,
        /// Heading; nothing where the file does not say.
        heading_rad: Option<f32>,
        /// Where the text says so, bytes from its beginning.
        at: usize,
    },
    /// On a lane.
    Lane {
        /// OpenDRIVE id of the road.
        road: String,
        /// OpenDRIVE id of the lane.
        lane: i32,
        /// Along the road's reference line, metres.
        s_m: f64,
        /// To the left of the lane's middle, seen along the reference line, metres.
        offset_m: f64,
        /// How it faces.
        facing: Facing,
        /// Where the text says so, bytes from its beginning.
        at: usize,
    },
    /// On a road.
    Road {
        /// OpenDRIVE id of the road.
        road: String,
        /// Along its reference line, metres.
        s_m: f64,
        /// To the left of that, metres.
        t_m: f64,
        /// How it faces.
        facing: Facing,
        /// Where the text says so, bytes from its beginning.
        at: usize,
    },
    /// On a route.
    Route {
        /// Places that it leads through.
        via: Vec<Position>,
        /// From the first of them on along it, metres.
        s_m: f32,
        /// OpenDRIVE id of the lane of the road there; 0 for the reference line.
        lane: i32,
        /// To the left of that, seen along the reference line, metres.
        offset_m: f32,
        /// How it faces.
        facing: Facing,
        /// Where the text says so, bytes from its beginning.
        at: usize,
    },
    /// Found on the map.
    Known(Spot),
    /// So far from a role, along the axes of the world or of the role, metres.
    Beside {
        /// The role.
        role: RoleId,
        /// Along and to the left, metres.
        by_m: [f32; 2],
        /// Along the role's axes, not east and north.
        own_axes: bool,
        /// How it faces.
        facing: Facing,
    },
    /// So far from a role along the line of its road and to the left of that, metres.
    BesideRoad {
        /// The role.
        role: RoleId,
        /// Along and to the left, metres.
        by_m: [f32; 2],
        /// How it faces.
        facing: Facing,
    },
    /// So many lanes to the left of a role and so far ahead of it.
    BesideLane {
        /// The role.
        role: RoleId,
        /// Lanes to the left, seen from the role.
        lanes: i32,
        /// Ahead along the lane, metres.
        ahead_m: f32,
        /// To the left of the lane's middle, metres.
        offset_m: f32,
        /// How it faces.
        facing: Facing,
    },
}

/// How somebody faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Facing {
    /// Counter-clockwise from east, radians.
    Absolute(f32),
    /// Counter-clockwise from how traffic, the road or the role does, radians.
    Relative(f32),
}

/// How a distance is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measure {
    /// Between outlines, not between middles.
    pub free: bool,
    /// Along what.
    pub along: Along,
}

/// Along what a distance is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// The straight line.
    Straight,
    /// The heading of who measures, or its road.
    Forward,
    /// Across that.
    Sideways,
}

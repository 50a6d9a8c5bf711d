//! The limits themselves. The largest real maps tried stay below a tenth of most.

/// Bytes of a file.
pub const FILE_BYTES: usize = 64 << 20;
/// Elements and texts between them.
pub const NODES: u32 = 4_000_000;
/// Attributes of one element, which the parser compares with each other.
pub const ATTRIBUTES: usize = 256;
/// Bytes of an id or a name, which every lane and object keeps.
pub const NAME_BYTES: usize = 1_000;

/// Roads of a map.
pub const ROADS: usize = 50_000;
/// Length of a road, metres.
pub const ROAD_M: f64 = 100_000.0;
/// Length of all roads together, and of all their geometry, metres.
pub const ALL_ROADS_M: f64 = 1_000_000.0;
/// Records of one kind in one place: geometry, elevation, widths of a lane and the like.
pub const RECORDS: usize = 10_000;
/// Lane sections of a road.
pub const SECTIONS: usize = 2_000;
/// Lanes of a section.
pub const LANES: usize = 100;
/// Points on the centre lines of all lanes.
pub const LANE_POINTS: f64 = 3_000_000.0;
/// Entries of lanes in the squares of a grid over the map.
pub const SQUARES: f64 = 2e7;
/// Stretches of lanes that meet in one square.
pub const CROWD: usize = 4_000;
/// Crosswalks that meet in one square: where a junction has the most of them, a dozen do.
pub const CROSSINGS: usize = 500;
/// Pairs of stretches in the same squares, of all squares.
pub const PAIRS: f64 = 2e8;

/// Marks along the border of a lane.
pub const MARKS: usize = 1_000;
/// Lines of a mark.
pub const MARK_LINES: usize = 100;
/// Dashes of all marks.
pub const DASHES: f64 = 500_000.0;

/// Objects of a map, repeated ones each time.
pub const OBJECTS: f64 = 100_000.0;
/// Places a metre apart below all objects, each of which is looked at.
pub const COVERED: f64 = 3e6;
/// Bytes of text that repeated objects copy.
pub const COPIED_BYTES: f64 = (64 << 20) as f64;
/// Length of a piece of a bridge or tunnel, metres: short enough for boxes to follow bends and slopes.
pub const PIECE_M: f32 = 4.0;
/// Signals of a map.
pub const SIGNALS: usize = 50_000;
/// Junctions of a map.
pub const JUNCTIONS: usize = 20_000;
/// Roads inside a junction, each of which may cross each other one.
pub const JUNCTION_ROADS: usize = 400;
/// Connections of a junction.
pub const CONNECTIONS: usize = 2_000;
/// Controllers of signals.
pub const CONTROLLERS: usize = 20_000;
/// Lane links of a connection, priorities and controllers of a junction, and signals of a controller.
pub const LINKS: usize = 1_000;

/// Steps of computing of what grows with the product of two numbers: stations of a lane times
/// records along it, dashes times stations, objects times the lanes beside them.
pub const STEPS: f64 = 3e9;

/// Where a road is in the coordinates of the file, metres east and north: grids of countries write the number of a zone
/// before the easting (32691000).
pub const PLACE_M: f64 = 1e8;
/// Any other coordinate, metres: beyond, 32 bits tell places apart by more than half a metre.
pub const COORDINATE_M: f64 = 1e7;
/// The side of a map, and how far it reaches from its origin, metres: whoever drives off it is still well within the
/// 1,000 km that a keyframe holds.
pub const EXTENT_M: f32 = 300_000.0;
/// Height of a road, metres.
pub const HEIGHT_M: f64 = 10_000.0;
/// Width of a lane, metres.
pub const WIDTH_M: f64 = 200.0;
/// Distance of a lane's border from its road's reference line, metres.
pub const ASIDE_M: f64 = 1_000.0;
/// Tilt of a road, radians.
pub const TILT_RAD: f64 = 1.6;
/// An angle, radians.
pub const ANGLE_RAD: f64 = 1e6;
/// How far one geometry may turn, radians: a ramp of a car park turns ten times.
pub const TURN_RAD: f64 = 200.0;
/// Any other number.
pub const NUMBER: f64 = 1e15;

/// From one place on a road to the next there are at most this many metres: lanes are drawn across what is between
/// them. Roads are torn by centimetres, poorly made ones by metres.
pub const GAP_M: f64 = 100.0;

/// A sign shows less than this, whatever its unit.
pub const SHOWN: f64 = 1_000.0;

//! What a story would have somebody do.

use super::position::{Measure, Position, RoleId};
use super::setting::{Environment, Light};

/// What somebody does.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Is at a place from now on.
    Teleport(Position),
    /// Changes its speed.
    Speed(Dynamics, SpeedTarget),
    /// Changes its speed again and again.
    SpeedProfile(SpeedProfile),
    /// Keeps a gap to somebody.
    Gap(Gap),
    /// Arrives when somebody else does.
    Meet(Box<Meeting>),
    /// Changes to another lane.
    LaneChange(Dynamics, LaneTarget, f32),
    /// Moves within its lane, or beyond: to so far to the left of its middle, metres, of its own or of a role's.
    LaneOffset(Dynamics, f32, Option<RoleId>),
    /// Follows a line.
    Follow(Path),
    /// Goes a way through some places.
    Route(Vec<Position>),
    /// Goes to a place, and is done there.
    Acquire(Position),
    /// Moves across its lane to a distance from somebody.
    Abreast(Abreast),
    /// Opens or shuts a front door.
    Door(Door),
    /// Leaves the ego car to its drivers.
    HandOver,
    /// Leaves the map.
    Leave,
    /// Comes onto the map, and stands.
    Enter(Position),
    /// Holds a light.
    Light(Light),
    /// Puts a programme into a phase.
    Programme(usize, usize),
    /// Changes the weather.
    Environment(Environment),
}

/// Which speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpeedTarget {
    /// Metres a second.
    Absolute(f32),
    /// So much faster than a role, m/s; `true` as long as the event lasts.
    Faster(RoleId, f32, bool),
    /// So many times as fast as a role.
    Times(RoleId, f32, bool),
}

/// A front door that is opened or shut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Door {
    /// The one on the left.
    pub is_left: bool,
    /// How far open it is in the end, [0, 1].
    pub open: f32,
    /// How long that takes, ticks.
    pub takes_ticks: u32,
}

/// How hard somebody changes its speed at most, and how fast it becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// m/s².
    pub acceleration_mps2: f32,
    /// m/s², positive.
    pub deceleration_mps2: f32,
    /// m/s.
    pub most_mps: f32,
}

/// Speeds, one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedProfile {
    /// Each speed, m/s, and how long the even change to it takes, seconds; nothing where it is as hard as may be.
    pub entries: Vec<(f32, Option<f32>)>,
    /// How hard that is.
    pub limits: Limits,
}

/// A gap to somebody.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// To whom.
    pub role: RoleId,
    /// How wide it shall be.
    pub wanted: GapWidth,
    /// How it is measured.
    pub measure: Measure,
    /// On which side of the other.
    pub side: GapSide,
    /// Goes on when it is so wide.
    pub goes_on: bool,
    /// How hard it may be changed.
    pub limits: Limits,
}

/// A distance across the lane from somebody.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Abreast {
    /// From whom.
    pub role: RoleId,
    /// How far, metres; nothing for as far as it is.
    pub wanted_m: Option<f32>,
    /// Between outlines, not between middles.
    pub free: bool,
    /// On the left of the other, as who moves faces; nothing for the side where it is.
    pub is_left: Option<bool>,
    /// Greatest acceleration across the lane, m/s².
    pub most_mps2: f32,
}

impl Abreast {
    /// How who moves there changes its place on its lane.
    pub fn dynamics(&self) -> Dynamics {
        Dynamics { shape: Shape::Sinusoidal, takes: Takes::Rate(self.most_mps2) }
    }
}

/// How wide a gap shall be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GapWidth {
    /// Metres.
    Way(f32),
    /// Seconds that who keeps it needs for it.
    Time(f32),
}

/// On which side of the other who keeps a gap is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GapSide {
    /// Where it is already.
    Any,
    /// Behind it.
    Behind,
    /// Before it.
    Ahead,
}

/// Two who arrive at the same time.
#[derive(Clone, Debug, PartialEq)]
pub struct Meeting {
    /// By whom the time is told.
    pub with: RoleId,
    /// Where that arrives, and how near to it counts, metres.
    pub theirs: (Position, f32),
    /// Where who plays arrives, and how near to it counts, metres.
    pub own: (Position, f32),
    /// How fast it is then; nothing where that does not matter.
    pub last: Option<SpeedTarget>,
}

/// Which lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaneTarget {
    /// OpenDRIVE id of a lane of the same road.
    Absolute(i32),
    /// So many lanes to the left of a role's, seen from that.
    Relative(RoleId, i32),
}

/// How something changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// The course of it.
    pub shape: Shape,
    /// How long it takes.
    pub takes: Takes,
}

/// The course of a change from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Even.
    Linear,
    /// With level ends, 3 x² - 2 x³.
    Cubic,
    /// With level ends, half of a cosine.
    Sinusoidal,
    /// At once.
    Step,
}

/// How long a change takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Takes {
    /// Seconds.
    Time(f32),
    /// Metres on the way.
    Distance(f32),
    /// Units a second, on average.
    Rate(f32),
}

/// A line to follow.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Its corners; each has a time, seconds from the beginning, or none has.
    pub corners: Vec<(Position, Option<f32>)>,
    /// Times count from the start of the run, not of the action.
    pub absolute: bool,
    /// Times decide how fast it is followed; else the speed of who follows does.
    pub timed: bool,
    /// The line begins so far from its first corner, metres.
    pub from_m: f32,
    /// Headings of corners are kept; else who follows faces along the line.
    pub headings: bool,
}

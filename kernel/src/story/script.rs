//! What a story says: who plays, how it begins, and what happens when. Times are ticks, angles radians; places are told
//! in the words of the text and found on a map by [`Stage`](super::Stage).

use crate::actor::ActorKind;
use crate::time::Tick;

pub use super::setting::{Environment, Light, Programme};
use super::spot::Spot;

/// Index of a role in [`Script::cast`].
pub type RoleId = usize;

/// Everything that a text says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Script {
    /// Who plays, the ego car among them.
    pub cast: Vec<Role>,
    /// What is done before the first tick, in this order.
    pub init: Vec<(RoleId, Action)>,
    /// Lights that are held from the first tick on.
    pub lights: Vec<Light>,
    /// Programmes of lights.
    pub programmes: Vec<Programme>,
    /// What the weather is, as far as the text says.
    pub environment: Environment,
    /// What happens.
    pub acts: Vec<Act>,
    /// Ends the whole story.
    pub stop: Trigger,
}

impl Script {
    /// The role of the ego car.
    pub fn ego(&self) -> RoleId {
        self.cast.iter().position(|role| role.kind.is_none()).unwrap_or_default()
    }

    /// What the ego car does in events, in their order.
    pub fn ego_actions(&self) -> impl Iterator<Item = &Action> {
        let ego = self.ego();
        let groups = self.acts.iter().flat_map(|act| &act.groups);
        let done = groups
            .flat_map(|group| group.events.iter().flat_map(move |event| event.actions.iter().map(move |a| (group, a))));
        done.filter_map(move |(group, (_, doer, action))| match doer {
            Doer::Each => group.actors.contains(&ego).then_some(action),
            Doer::Role(role) => (*role == ego).then_some(action),
            Doer::World => None,
        })
    }

    /// The way that events tell the ego car to go, if they do.
    pub fn ego_way(&self) -> Option<&Action> {
        self.ego_actions().find(|action| matches!(action, Action::Route(_) | Action::Acquire(_) | Action::Follow(_)))
    }
}

/// Somebody who plays.
#[derive(Clone, Debug, PartialEq)]
pub struct Role {
    /// Its name in the text.
    pub name: String,
    /// What it is; nothing for the ego car.
    pub kind: Option<ActorKind>,
    /// Fastest it goes, m/s.
    pub most_mps: f32,
    /// Where the text tells it, bytes from its beginning.
    pub at: usize,
}

/// An act: it begins by its trigger, and its groups play at the same time.
#[derive(Clone, Debug, PartialEq)]
pub struct Act {
    /// Its name.
    pub name: String,
    /// Those who play together.
    pub groups: Vec<Group>,
    /// Begins it; without conditions it begins at once.
    pub start: Trigger,
    /// Ends it.
    pub stop: Trigger,
}

/// Those who do the same things.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Its name.
    pub name: String,
    /// How many times it plays.
    pub most: u16,
    /// Who plays.
    pub actors: Vec<RoleId>,
    /// What they do, of all manoeuvres.
    pub events: Vec<Event>,
}

/// What somebody does when something happens.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Its name.
    pub name: String,
    /// Which manoeuvre of its group it is in, and the name of that.
    pub manoeuvre: (usize, String),
    /// What becomes of others of the manoeuvre.
    pub priority: Priority,
    /// How many times it happens.
    pub most: u16,
    /// Begins it.
    pub start: Trigger,
    /// What is done: the name of the action, and by whom.
    pub actions: Vec<(String, Doer, Action)>,
}

/// By whom something is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doer {
    /// Each who plays in the group.
    Each,
    /// This one.
    Role(RoleId),
    /// By nobody: it is done to the world.
    World,
}

/// What an event that begins does to others of its manoeuvre that go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Priority {
    /// It ends them.
    Override,
    /// It does not happen.
    Skip,
    /// Nothing.
    Parallel,
}

/// Holds when all conditions of one of its groups do.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trigger {
    /// The groups.
    pub groups: Vec<Vec<Condition>>,
}

/// A condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// It counts so long after it was met.
    pub delay_ticks: Tick,
    /// Which change of what it says counts.
    pub edge: Edge,
    /// What it says.
    pub when: When,
}

/// Which change of a condition counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// That it holds.
    None,
    /// That it begins to hold.
    Rising,
    /// That it ends to hold.
    Falling,
    /// Both.
    Either,
}

/// How two numbers compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// More.
    Greater,
    /// As much or more.
    GreaterOrEqual,
    /// Less.
    Less,
    /// As much or less.
    LessOrEqual,
    /// As much, within a hundredth; of times, within half a tick.
    Equal,
    /// Not as much.
    NotEqual,
}

/// What a condition says.
#[derive(Clone, Debug, PartialEq)]
pub enum When {
    /// Seconds since the start.
    Time(Rule, f32),
    /// An element of the story is in a state, or just came there.
    Element {
        /// What it is.
        kind: ElementKind,
        /// Its name, after those of some elements above it: `Group::Manoeuvre::Event`.
        path: String,
        /// The state or change.
        state: ElementState,
        /// Where the text says so, bytes from its beginning.
        at: usize,
    },
    /// A light shows something.
    Light(Light),
    /// A programme is in a phase.
    Programme(usize, usize),
    /// Something of one or all of some roles.
    Role {
        /// All of them, or any.
        all: bool,
        /// The roles.
        roles: Vec<RoleId>,
        /// What of each.
        what: OfRole,
    },
}

/// What a condition says of a role.
#[derive(Clone, Debug, PartialEq)]
pub enum OfRole {
    /// Its speed, m/s.
    Speed(Rule, f32),
    /// How much faster it is than another, m/s.
    RelativeSpeed(Rule, f32, RoleId),
    /// Its acceleration along its way, m/s².
    Acceleration(Rule, f32),
    /// It has stood so long.
    Stands(Tick),
    /// It has come so far, metres.
    Travelled(f32),
    /// It is so near to a place, metres.
    Reaches(Position, f32),
    /// Distance to a place, metres.
    Distance(Rule, f32, Measure, Position),
    /// Distance to a role, metres.
    RelativeDistance(Rule, f32, Measure, RoleId),
    /// Time until it is where another is now, s.
    Headway(Rule, f32, Measure, RoleId),
    /// Time until it meets another if both go on, s.
    TimeToCollision(Rule, f32, Measure, RoleId),
    /// It touches another, or anybody.
    Collides(Option<RoleId>),
    /// It has stood where its road ends so long.
    EndOfRoad(Tick),
    /// It has been beside the road so long.
    OffRoad(Tick),
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

/// Kinds of elements of a story.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ElementKind {
    /// An act.
    Act,
    /// A group that plays together.
    Group,
    /// A manoeuvre: all its events.
    Manoeuvre,
    /// An event.
    Event,
    /// An action of an event.
    Action,
}

impl ElementKind {
    /// What the standard calls it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Act => "act",
            Self::Group => "maneuverGroup",
            Self::Manoeuvre => "maneuver",
            Self::Event => "event",
            Self::Action => "action",
        }
    }
}

/// A state of an element, or a change of that in the tick before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementState {
    /// It waits for its trigger.
    Standby,
    /// It goes on.
    Running,
    /// It will not happen any more.
    Complete,
    /// It just began.
    Started,
    /// It just came to its end.
    Ended,
    /// It was just ended by others.
    Stopped,
    /// It would have begun, but was skipped.
    Skipped,
}

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
    /// Opens or shuts a front door.
    Door(Door),
    /// Leaves the ego car to its drivers.
    HandOver,
    /// Leaves the map.
    Leave,
    /// Holds a light.
    Light(Light),
    /// Puts a programme into a phase.
    Programme(usize, usize),
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

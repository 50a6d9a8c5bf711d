//! What a story says: who plays, how it begins, and what happens when. Times are ticks, angles radians; places are told
//! in the words of the text and found on a map by [`Stage`](super::Stage).

use crate::actor::ActorKind;
use crate::time::Tick;

pub use super::action::{
    Abreast, Action, Door, Dynamics, Gap, GapSide, GapWidth, LaneTarget, Limits, Meeting, Path, Shape, SpeedProfile,
    SpeedTarget, Takes,
};
pub use super::position::{Along, Facing, Measure, Position, RoleId};
pub use super::setting::{Environment, Light, Programme};

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

    /// Who comes onto the map in events; the ego car is there from the beginning.
    pub fn entrances(&self) -> impl Iterator<Item = RoleId> {
        let ego = self.ego();
        let events = self.acts.iter().flat_map(|act| &act.groups).flat_map(|group| &group.events);
        events.flat_map(|event| &event.actions).filter_map(move |(_, doer, action)| match (doer, action) {
            (Doer::Role(role), Action::Enter(_)) if *role != ego => Some(*role),
            _ => None,
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
    /// What it is was guessed by the name of its entry: its catalog is not there.
    pub guessed: bool,
    /// Fastest it goes, m/s.
    pub most_mps: f32,
    /// Where the text tells it, bytes from its beginning.
    pub at: usize,
}

/// An act: it begins by its trigger, and its groups play at the same time.
#[derive(Clone, Debug, PartialEq)]
pub struct Act {
    /// The name of its story.
    pub story: String,
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

impl Rule {
    /// Whether a number compares so with another; both are equal that are as near to each other.
    pub fn holds(self, value: f32, than: f32, near: f32) -> bool {
        match self {
            Self::Greater => value > than,
            Self::GreaterOrEqual => value >= than,
            Self::Less => value < than,
            Self::LessOrEqual => value <= than,
            Self::Equal => (value - than).abs() <= near,
            Self::NotEqual => (value - than).abs() > near,
        }
    }
}

/// What a condition says.
#[derive(Clone, Debug, PartialEq)]
pub enum When {
    /// What is so, or is not, all the time.
    Always(bool),
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

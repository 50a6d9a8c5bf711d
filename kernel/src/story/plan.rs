//! The script with everything numbered.

use std::ops::Range;

use super::script::{self, Action, Condition, Doer, ElementKind, Position, Priority, RoleId, Script};
use super::state::{Change, Mark, Met, Progress, StoryState};

/// A trigger whose conditions are numbered through the script.
#[derive(Clone, Debug, Default)]
pub struct Trigger {
    pub groups: Vec<Vec<(usize, Condition)>>,
}

impl Trigger {
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    pub fn forget(&self, met: &mut [Met]) {
        self.groups.iter().flatten().for_each(|(number, _)| met[*number] = Met::default());
    }
}

/// An act, and which groups are its own.
#[derive(Clone, Debug)]
pub struct ActPlan {
    pub name: String,
    pub groups: Range<usize>,
    pub start: Trigger,
    pub stop: Trigger,
}

/// A group, and which events are its own.
#[derive(Clone, Debug)]
pub struct GroupPlan {
    pub name: String,
    pub most: u16,
    pub events: Range<usize>,
}

/// An event, and which deeds are its own.
#[derive(Clone, Debug)]
pub struct EventPlan {
    pub name: String,
    pub manoeuvre: (usize, String),
    pub priority: Priority,
    pub most: u16,
    pub start: Trigger,
    pub deeds: Range<usize>,
}

/// What one role does in an event.
#[derive(Clone, Debug)]
pub struct DeedPlan {
    pub name: String,
    /// Who does it; nobody where it is done to the world.
    pub role: Option<RoleId>,
    pub action: Action,
    /// Of a line that is followed, where its corners are along it, metres.
    pub stations_m: Vec<f32>,
}

/// The script with everything numbered.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    pub ego: RoleId,
    /// The story drives the ego car until an event hands it over.
    pub carries_ego: bool,
    pub acts: Vec<ActPlan>,
    pub groups: Vec<GroupPlan>,
    pub events: Vec<EventPlan>,
    pub deeds: Vec<DeedPlan>,
    pub stop: Trigger,
    pub conditions: usize,
}

impl Plan {
    pub fn of(script: &Script) -> Self {
        let ego = script.ego();
        let mut plan = Self { ego, ..Self::default() };
        plan.stop = plan.numbered(&script.stop);
        for act in &script.acts {
            let first = plan.groups.len();
            act.groups.iter().for_each(|group| plan.add_group(group));
            let (groups, start) = (first..plan.groups.len(), plan.numbered(&act.start));
            let stop = plan.numbered(&act.stop);
            plan.acts.push(ActPlan { name: act.name.clone(), groups, start, stop });
        }
        plan.carries_ego = script.ego_actions().any(|action| *action == Action::HandOver);
        plan
    }

    fn numbered(&mut self, trigger: &script::Trigger) -> Trigger {
        let mut number = |condition: &Condition| {
            self.conditions += 1;
            (self.conditions - 1, condition.clone())
        };
        Trigger { groups: trigger.groups.iter().map(|group| group.iter().map(&mut number).collect()).collect() }
    }

    fn add_group(&mut self, group: &script::Group) {
        let first = self.events.len();
        for event in &group.events {
            let from = self.deeds.len();
            for (name, of, action) in &event.actions {
                let doers = match of {
                    Doer::Each => group.actors.iter().map(|role| Some(*role)).collect(),
                    Doer::Role(role) => vec![Some(*role)],
                    Doer::World => vec![None],
                };
                self.deeds.extend(doers.into_iter().map(|role| DeedPlan {
                    name: name.clone(),
                    role,
                    action: action.clone(),
                    stations_m: match action {
                        Action::Follow(path) => stations_m(path.corners.iter().map(|(place, _)| place)),
                        _ => Vec::new(),
                    },
                }));
            }
            let (deeds, start) = (from..self.deeds.len(), self.numbered(&event.start));
            let script::Event { name, manoeuvre, priority, most, .. } = event.clone();
            self.events.push(EventPlan { name, manoeuvre, priority, most, start, deeds });
        }
        self.groups.push(GroupPlan { name: group.name.clone(), most: group.most, events: first..self.events.len() });
    }

    /// The marks of all elements of a kind and a name; of a manoeuvre those of its events.
    pub fn marks(&self, state: &StoryState, kind: ElementKind, name: &str) -> Vec<Mark> {
        // A reference may name the elements above it as well.
        let name = name.rsplit("::").next().unwrap_or(name);
        let of = |names: Vec<&str>, marks: Vec<Mark>| -> Vec<Mark> {
            names.into_iter().zip(marks).filter(|(other, _)| *other == name).map(|(_, mark)| mark).collect()
        };
        match kind {
            ElementKind::Act => of(self.acts.iter().map(|act| &*act.name).collect(), state.acts.clone()),
            ElementKind::Group => of(self.groups.iter().map(|group| &*group.name).collect(), state.groups.clone()),
            ElementKind::Event => of(self.events.iter().map(|event| &*event.name).collect(), state.events.clone()),
            ElementKind::Action => {
                of(self.deeds.iter().map(|deed| &*deed.name).collect(), state.deeds.iter().map(|d| d.mark).collect())
            }
            ElementKind::Manoeuvre => self.manoeuvres(state, name),
        }
    }

    /// A manoeuvre goes on as long as one of its events does, and is over when all are.
    fn manoeuvres(&self, state: &StoryState, name: &str) -> Vec<Mark> {
        let of_group = |group: &GroupPlan| {
            let events = group.events.clone().filter(|event| self.events[*event].manoeuvre.1 == name);
            let marks: Vec<Mark> = events.map(|event| state.events[event]).collect();
            let last = marks.iter().max_by_key(|mark| mark.at).copied()?;
            let over = marks.iter().all(Mark::is_complete);
            let first = marks.iter().filter(|mark| mark.change != Change::None).count() == 1;
            let begins = last.change == Change::Started && first;
            let change = match last.change {
                Change::Started if !begins => Change::None,
                Change::Ended | Change::Skipped | Change::Stopped if !over => Change::None,
                change => change,
            };
            let begun = marks.iter().any(|mark| mark.change != Change::None);
            let progress = if over { Progress::Complete } else { Progress::Running };
            Some(Mark { progress: if begun { progress } else { Progress::Standby }, change, ..last })
        };
        self.groups.iter().filter_map(of_group).collect()
    }
}

/// Where the corners of a line are along it, metres.
pub fn stations_m<'a>(corners: impl Iterator<Item = &'a Position>) -> Vec<f32> {
    let (mut at_m, mut before) = (0.0, None);
    let station = |place: &Position| {
        if let Position::Known(spot) = place {
            at_m += before.replace(spot.plan()).map_or(0.0, |before: glam::Vec2| before.distance(spot.plan()));
        }
        at_m
    };
    corners.map(station).collect()
}

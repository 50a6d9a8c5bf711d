//! The script with everything numbered.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use glam::Vec2;

use super::script::{self, Action, Condition, Doer, ElementKind, Position, Priority, RoleId, Script, When};
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

    /// Its conditions count anew; what they were is known, so that who rises has to fall before.
    pub fn rearm(&self, met: &mut [Met]) {
        self.groups.iter().flatten().for_each(|(number, _)| met[*number].since = None);
    }
}

/// An act, and which groups are its own.
#[derive(Clone, Debug)]
pub struct ActPlan {
    pub groups: Range<usize>,
    pub start: Trigger,
    pub stop: Trigger,
}

/// A group, and which events are its own.
#[derive(Clone, Debug)]
pub struct GroupPlan {
    pub most: u16,
    pub events: Range<usize>,
}

/// An event, and which deeds are its own.
#[derive(Clone, Debug)]
pub struct EventPlan {
    /// The number of its manoeuvre in the group.
    pub manoeuvre: usize,
    pub priority: Priority,
    pub most: u16,
    pub start: Trigger,
    pub deeds: Range<usize>,
}

/// What one role does in an event.
#[derive(Clone, Debug)]
pub struct DeedPlan {
    /// Who does it; nobody where it is done to the world.
    pub role: Option<RoleId>,
    pub action: Arc<Action>,
    /// Of a line that is followed, where its corners are along it, metres.
    pub stations_m: Arc<[f32]>,
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
    /// Those of them that change the weather.
    pub weather: Vec<usize>,
    pub stop: Trigger,
    pub conditions: usize,
    /// What conditions on elements refer to.
    referred: BTreeMap<usize, Vec<Element>>,
}

/// Most elements of one name that a condition refers to, and most elements and parts of them that all conditions do: they are looked
/// at in every tick.
const NAMESAKES: usize = 100;
const REFERRED: usize = 100_000;

/// An element by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Element {
    Act(usize),
    Group(usize),
    /// The group that plays it, the first of its events and how many they are.
    Manoeuvre(usize, usize, usize),
    Event(usize),
    /// What its actors do, one deed each.
    Action(usize, usize),
}

impl Element {
    /// How many others tell what it has come to.
    fn parts(&self) -> usize {
        match self {
            Self::Action(_, count) | Self::Manoeuvre(_, _, count) => *count,
            Self::Act(_) | Self::Group(_) | Self::Event(_) => 1,
        }
    }
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
            plan.acts.push(ActPlan { groups, start, stop });
        }
        plan.carries_ego = script.ego_actions().any(|action| *action == Action::HandOver);
        plan.refer(script);
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
            for (_, of, action) in &event.actions {
                let stations_m: Arc<[f32]> = match action {
                    Action::Follow(path) => stations_m(path.corners.iter().map(|(place, _)| known(place))).into(),
                    _ => Arc::default(),
                };
                let action = Arc::new(action.clone());
                let deed = |role| DeedPlan { role, action: action.clone(), stations_m: stations_m.clone() };
                if matches!(*action, Action::Environment(_)) {
                    self.weather.push(self.deeds.len());
                }
                self.deeds.extend(doers(group, *of).map(deed));
            }
            let (deeds, start) = (from..self.deeds.len(), self.numbered(&event.start));
            let script::Event { priority, most, .. } = *event;
            self.events.push(EventPlan { manoeuvre: event.manoeuvre.0, priority, most, start, deeds });
        }
        self.groups.push(GroupPlan { most: group.most, events: first..self.events.len() });
    }

    /// The marks of the elements that a condition refers to; of a manoeuvre one for each group that plays it.
    pub fn marks(&self, state: &StoryState, condition: usize) -> impl Iterator<Item = Mark> {
        let of = |element: &Element| match *element {
            Element::Act(act) => state.acts[act],
            Element::Group(group) => state.groups[group],
            Element::Event(event) => state.events[event],
            Element::Action(first, count) => {
                let deeds = state.deeds[first..first + count].iter().map(|deed| deed.mark);
                together(Mark::NEW, deeds)
            }
            // It has no trigger of its own: it begins with its group.
            Element::Manoeuvre(group, first, count) => {
                together(state.groups[group], state.events[first..first + count].iter().copied())
            }
        };
        self.referred.get(&condition).into_iter().flatten().map(of)
    }

    /// Finds what conditions refer to.
    fn refer(&mut self, script: &Script) {
        let elements = Elements::of(script);
        let mut triggers: Vec<&Trigger> = vec![&self.stop];
        triggers.extend(self.acts.iter().flat_map(|act| [&act.start, &act.stop]));
        triggers.extend(self.events.iter().map(|event| &event.start));
        for (number, condition) in triggers.into_iter().flat_map(|trigger| trigger.groups.iter().flatten()) {
            if let When::Element { kind, path, .. } = &condition.when {
                self.referred.insert(*number, elements.named(*kind, path));
            }
        }
    }
}

/// What has parts goes on as long as one of them does, and is over when all are; before they begin it is as its whole.
fn together(whole: Mark, parts: impl Iterator<Item = Mark>) -> Mark {
    let marks: Vec<Mark> = parts.collect();
    let Some(last) = marks.iter().max_by_key(|mark| mark.at).copied() else { return whole };
    let over = marks.iter().all(Mark::is_complete);
    let begun = marks.iter().map(|mark| mark.began).chain([whole.began]);
    let began = begun.filter(|at| *at > 0).min().unwrap_or_default();
    let change = match last.change {
        Change::Ended | Change::Skipped | Change::Stopped if !over => Change::None,
        change => change,
    };
    let progress = match began {
        _ if over => Progress::Complete,
        0 => Progress::Standby,
        _ => Progress::Running,
    };
    Mark { progress, change, began, ..last }
}

/// The first condition that refers to what is not there, or to too much: where the text has it, and what is wrong.
pub fn dangling(script: &Script) -> Option<(usize, String)> {
    let elements = Elements::of(script);
    let acts = script.acts.iter().flat_map(|act| [&act.start, &act.stop]);
    let events = script.acts.iter().flat_map(|act| &act.groups).flat_map(|group| &group.events);
    let triggers = [&script.stop].into_iter().chain(acts).chain(events.map(|event| &event.start));
    let mut referred = 0;
    triggers.flat_map(|trigger| trigger.groups.iter().flatten()).find_map(|condition| {
        let When::Element { kind, path, at, .. } = &condition.when else { return None };
        let named = elements.named(*kind, path);
        let (what, count) = (format!("{} {path:?}", kind.name()), named.len());
        referred += named.iter().map(Element::parts).sum::<usize>();
        match count {
            0 => Some((*at, format!("there is no {what}"))),
            _ if referred > REFERRED => {
                Some((*at, format!("expected conditions that refer to at most {REFERRED} elements and parts of them")))
            }
            1..=NAMESAKES => None,
            _ => Some((*at, format!("there are {count} elements {what}, expected at most {NAMESAKES}"))),
        }
    })
}

/// The elements of a script by their kinds and names.
struct Elements<'a> {
    named: BTreeMap<(ElementKind, &'a str), Vec<Named<'a>>>,
}

impl<'a> Elements<'a> {
    fn of(script: &'a Script) -> Self {
        let mut named: BTreeMap<_, Vec<_>> = BTreeMap::new();
        for element in elements(script) {
            let (kind, path, _) = &element;
            named.entry((*kind, path[path.len() - 1])).or_default().push(element);
        }
        Self { named }
    }

    /// Those of a kind that a path ends at; it may leave out names from the beginning on.
    fn named(&self, kind: ElementKind, path: &str) -> Vec<Element> {
        let path: Vec<&str> = path.split("::").collect();
        let all = self.named.get(&(kind, path[path.len() - 1]));
        all.into_iter().flatten().filter(|(_, at, _)| at.ends_with(&path)).map(|(.., element)| *element).collect()
    }
}

/// An element, its kind, and the names of those above it and its own, from the story on.
type Named<'a> = (ElementKind, Vec<&'a str>, Element);

/// All elements of a script.
fn elements(script: &Script) -> Vec<Named<'_>> {
    let (mut found, mut last) = (Vec::new(), None);
    let (mut groups, mut events, mut deeds) = (0, 0, 0);
    for (number, act) in script.acts.iter().enumerate() {
        found.push((ElementKind::Act, vec![&*act.story, &*act.name], Element::Act(number)));
        for group in &act.groups {
            let at = vec![&*act.story, &*act.name, &*group.name];
            found.push((ElementKind::Group, at.clone(), Element::Group(groups)));
            for event in &group.events {
                let at = [&at[..], &[&*event.manoeuvre.1]].concat();
                let manoeuvre = (groups, event.manoeuvre.0);
                if last.replace(manoeuvre) != Some(manoeuvre) {
                    // Its events follow each other.
                    let count = group.events.iter().filter(|other| other.manoeuvre.0 == manoeuvre.1).count();
                    found.push((ElementKind::Manoeuvre, at.clone(), Element::Manoeuvre(groups, events, count)));
                }
                let at = [&at[..], &[&*event.name]].concat();
                found.push((ElementKind::Event, at.clone(), Element::Event(events)));
                for (name, of, _) in &event.actions {
                    let count = doers(group, *of).count();
                    if count > 0 {
                        let action = Element::Action(deeds, count);
                        found.push((ElementKind::Action, [&at[..], &[&**name]].concat(), action));
                    }
                    deeds += count;
                }
                events += 1;
            }
            groups += 1;
        }
    }
    found
}

/// Who does an action of a group's event; nobody where it is done to the world.
fn doers(group: &script::Group, of: Doer) -> impl Iterator<Item = Option<RoleId>> {
    let each = group.actors.iter().map(|role| Some(*role)).filter(move |_| of == Doer::Each);
    let one = match of {
        Doer::Each => None,
        Doer::Role(role) => Some(Some(role)),
        Doer::World => Some(None),
    };
    each.chain(one)
}

/// Where a place is, seen from above, if that is known.
fn known(place: &Position) -> Option<Vec2> {
    if let Position::Known(spot) = place { Some(spot.plan()) } else { None }
}

/// Where the corners of a line are along it, metres.
pub fn stations_m(corners: impl Iterator<Item = Option<Vec2>>) -> Vec<f32> {
    let (mut at_m, mut before) = (0.0, None);
    let station = |corner: Option<Vec2>| {
        if let Some(corner) = corner {
            at_m += before.replace(corner).map_or(0.0, |before: Vec2| before.distance(corner));
        }
        at_m
    };
    corners.map(station).collect()
}

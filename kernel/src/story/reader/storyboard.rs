//! What happens: how it begins, acts, groups, manoeuvres and events.

use crate::story::error::StoryError;
use crate::story::script::{
    Act, Action, Doer, Environment, Event, Group, Light, Position, Priority, RoleId, Shape, SpeedTarget, Takes, Trigger,
};

use super::document::Element;
use super::names::Names;
use super::vary;
use super::{actions, conditions, environment};

const ACTIONS: usize = 100;

const PRIORITIES: &[(&str, Priority)] = &[
    ("overwrite", Priority::Override),
    ("override", Priority::Override),
    ("skip", Priority::Skip),
    ("parallel", Priority::Parallel),
];

/// What is so from the first tick on.
#[derive(Default)]
pub struct Beginning {
    pub actions: Vec<(RoleId, Action)>,
    pub lights: Vec<Light>,
    pub environment: Environment,
}

impl Beginning {
    /// What is so at once, and what takes time, which is an act of its own without a name.
    fn split(mut self) -> (Self, Option<Act>) {
        let (lasting, at_once) = std::mem::take(&mut self.actions).into_iter().partition(|(_, action)| lasts(action));
        self.actions = at_once;
        let groups: Vec<Group> = lasting.into_iter().map(opening).collect();
        let (start, stop) = (Trigger::default(), Trigger::default());
        let act = (!groups.is_empty()).then(|| Act { story: String::new(), name: String::new(), groups, start, stop });
        (self, act)
    }
}

/// Whether an action takes time.
fn lasts(action: &Action) -> bool {
    match action {
        Action::Speed(_, SpeedTarget::Faster(.., true) | SpeedTarget::Times(.., true)) => true,
        Action::Speed(dynamics, _) => {
            let none = matches!(dynamics.takes, Takes::Time(takes) | Takes::Distance(takes) if takes <= 0.0);
            dynamics.shape != Shape::Step && !none
        }
        Action::LaneOffset(dynamics, _, None) => dynamics.shape != Shape::Step,
        Action::LaneChange(..) | Action::LaneOffset(_, _, Some(_)) | Action::Abreast(_) => true,
        Action::SpeedProfile(_) | Action::Gap(_) | Action::Meet(_) | Action::Follow(_) => true,
        _ => false,
    }
}

fn opening((role, action): (RoleId, Action)) -> Group {
    let event = Event {
        name: String::new(),
        manoeuvre: (0, String::new()),
        priority: Priority::Parallel,
        most: 1,
        start: Trigger::default(),
        actions: vec![(String::new(), Doer::Each, action)],
    };
    Group { name: String::new(), most: 1, actors: vec![role], events: vec![event] }
}

/// What happens.
pub struct Board {
    pub init: Beginning,
    pub acts: Vec<Act>,
    pub stop: Trigger,
}

pub fn read(board: Element<'_>, names: &Names<'_>) -> Result<Board, StoryError> {
    let begins = match board.child("Init") {
        Some(init) => self::init(init.need("Actions")?, names)?,
        None => Beginning::default(),
    };
    let (init, opening) = begins.split();
    let mut acts: Vec<Act> = opening.into_iter().collect();
    for story in board.all("Story") {
        vary::pass_parameters(story)?;
        let name = story.given("name")?.unwrap_or_default();
        for act in story.all("Act") {
            acts.push(Act { story: name.clone(), ..self::act(act, names)? });
        }
    }
    Ok(Board { init, acts, stop: conditions::trigger(board.child("StopTrigger"), names)? })
}

fn init(actions: Element<'_>, names: &Names<'_>) -> Result<Beginning, StoryError> {
    let mut init = Beginning::default();
    for global in actions.all("GlobalAction") {
        if let Some(environment) = global.child("EnvironmentAction") {
            init.environment = environment::read(environment)?;
            continue;
        }
        match actions::global(global, names)? {
            (Doer::Role(role), action) => init.actions.push((role, action)),
            (_, Action::Light(light)) => init.lights.push(light),
            _ => return Err(global.wrong("a programme of lights is put into a phase in events only")),
        }
    }
    for private in actions.all("Private") {
        let role = names.role(private, "entityRef")?;
        for action in private.all("PrivateAction") {
            let read = actions::private(action, names)?;
            // What takes time is a group and an event of its own.
            action.spend(read.as_ref().map_or(1, |action| if lasts(action) { 2 + parts(action) } else { 1 }))?;
            init.actions.extend(read.map(|action| (role, action)));
        }
    }
    let is_placed = |role: RoleId| {
        init.actions.iter().any(|(of, a)| *of == role && matches!(a, Action::Teleport(_) | Action::Enter(_)))
    };
    // Who is told a line alone begins at its beginning.
    let first = init.actions.iter().filter_map(|(role, action)| match action {
        Action::Follow(path) if !is_placed(*role) => Some((*role, Action::Teleport(path.corners.first()?.0.clone()))),
        _ => None,
    });
    let first: Vec<_> = first.collect();
    init.actions.splice(0..0, first);
    Ok(init)
}

fn act(act: Element<'_>, names: &Names<'_>) -> Result<Act, StoryError> {
    act.spend(1)?;
    let mut groups = Vec::new();
    for group in act.all("ManeuverGroup") {
        groups.push(self::group(group, names)?);
    }
    Ok(Act {
        story: String::new(),
        name: act.given("name")?.unwrap_or_default(),
        groups,
        start: conditions::trigger(act.child("StartTrigger"), names)?,
        stop: conditions::trigger(act.child("StopTrigger"), names)?,
    })
}

fn times(element: Element<'_>) -> Result<u16, StoryError> {
    if element.given("maximumExecutionCount")?.is_none() {
        return Ok(1);
    }
    let count = element.number("maximumExecutionCount")?;
    if (1.0..=1e9).contains(&count) {
        return Ok(count.min(60_000.0) as u16);
    }
    Err(element.wrong(format!("maximumExecutionCount of <{}> is {count}, expected 1 or more", element.tag())))
}

fn group(group: Element<'_>, names: &Names<'_>) -> Result<Group, StoryError> {
    let actors = group.need("Actors")?;
    if actors.switch("selectTriggeringEntities")?.unwrap_or(false) {
        return Err(actors.wrong("selectTriggeringEntities of <Actors> is true, which is not supported"));
    }
    let roles = actors.all("EntityRef").map(|entity| names.role(entity, "entityRef"));
    let roles = roles.collect::<Result<Vec<_>, _>>()?;
    group.spend(1)?;
    if let Some(at) = (1..roles.len()).find(|at| roles[..*at].contains(&roles[*at])) {
        return Err(actors.wrong(format!("<Actors> names {:?} twice", names.cast[roles[at]].name)));
    }
    let mut events = Vec::new();
    for (number, manoeuvre) in group.all("Maneuver").enumerate() {
        vary::pass_parameters(manoeuvre)?;
        let name = manoeuvre.given("name")?.unwrap_or_default();
        for event in manoeuvre.all("Event") {
            let read = self::event(event, (number, name.clone()), names)?;
            event
                .spend(1 + roles.len().max(1) * read.actions.iter().map(|(.., action)| parts(action)).sum::<usize>())?;
            events.push(read);
        }
    }
    Ok(Group { name: group.given("name")?.unwrap_or_default(), most: times(group)?, actors: roles, events })
}

/// How many parts of keyframes one who does it makes of an action.
fn parts(action: &Action) -> usize {
    let moves = |(place, _): &&(Position, Option<f32>)| {
        matches!(place, Position::Beside { .. } | Position::BesideRoad { .. } | Position::BesideLane { .. })
    };
    match action {
        Action::Follow(path) if path.corners.iter().any(|corner| moves(&corner)) => path.corners.len(),
        _ => 1,
    }
}

fn event(event: Element<'_>, manoeuvre: (usize, String), names: &Names<'_>) -> Result<Event, StoryError> {
    let mut actions = Vec::new();
    for action in event.all("Action") {
        if actions.len() == ACTIONS {
            return Err(action.wrong(format!("expected at most {ACTIONS} actions of an event")));
        }
        let name = action.given("name")?.unwrap_or_default();
        let kind = action.choice()?;
        match kind.tag() {
            "PrivateAction" => actions.extend(actions::private(kind, names)?.map(|done| (name, Doer::Each, done))),
            "GlobalAction" => {
                let (doer, done) = actions::global(kind, names)?;
                actions.push((name, doer, done));
            }
            "UserDefinedAction" => {}
            _ => return Err(kind.unsupported()),
        }
    }
    Ok(Event {
        name: event.given("name")?.unwrap_or_default(),
        manoeuvre,
        priority: event.word("priority", PRIORITIES)?,
        most: times(event)?,
        start: conditions::trigger(event.child("StartTrigger"), names)?,
        actions,
    })
}

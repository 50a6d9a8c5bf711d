//! Whether what begins and ends elements holds.

use crate::map::RoadNetwork;
use crate::signals;
use crate::time::{TICK_HZ, TICK_S, Tick};

use super::actor::StoryActor;
use super::facts::Outline;
use super::plan::{Plan, Trigger};
use super::relative;
use super::script::{Condition, Edge, ElementState, Light, OfRole, RoleId, Rule, Script, When};
use super::spot::Spot;
use super::state::{Change, Mark, Met, Progress, StoryState};

/// As near as this two numbers are equal.
const EQUAL: f32 = 0.01;

/// What conditions look at: all as it was at the end of the tick before.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    pub script: &'a Script,
    pub plan: &'a Plan,
    pub network: &'a RoadNetwork,
    pub before: &'a StoryState,
    /// The tick that is computed.
    pub tick: Tick,
    /// The seed of the run.
    pub seed: u64,
    /// Roles that the ego car touches.
    pub touching: &'a [RoleId],
}

impl Seen<'_> {
    /// Whether a trigger is met; remembers what its conditions were. One without conditions is never met.
    pub fn is_met(&self, trigger: &Trigger, met: &mut [Met]) -> bool {
        let mut is_met = false;
        for group in &trigger.groups {
            // Every condition is looked at, so that each knows what it was.
            let holds =
                group.iter().fold(true, |all, (number, of)| self.condition(*number, of, &mut met[*number]) && all);
            is_met |= holds;
        }
        is_met
    }

    fn condition(&self, number: usize, condition: &Condition, met: &mut Met) -> bool {
        let holds = self.holds(number, &condition.when);
        let before = met.held.replace(holds);
        // Of roles nothing is known before; of all else that it was not so yet.
        let unknown = if matches!(condition.when, When::Role { .. }) { holds } else { false };
        let held = before.unwrap_or(unknown);
        let is_met = match condition.edge {
            Edge::None => holds,
            Edge::Rising => holds && !held,
            Edge::Falling => !holds && held,
            Edge::Either => holds != held,
        };
        if condition.delay_ticks == 0 {
            return is_met;
        }
        if is_met && met.since.is_none() {
            met.since = Some(self.tick);
        }
        met.since.is_some_and(|since| self.tick >= since.saturating_add(condition.delay_ticks))
    }

    fn holds(&self, number: usize, when: &When) -> bool {
        match when {
            When::Always(holds) => *holds,
            When::Time(rule, than) => rule.holds(self.tick as f32 / TICK_HZ as f32, *than, 0.5 * TICK_S),
            When::Element { state, .. } => self.element(number, *state),
            When::Light(light) => self.shows(light),
            When::Programme(number, phase) => usize::from(self.before.cycles[*number].phase) == *phase,
            When::Role { all, roles, what } => {
                let mut each = roles.iter().map(|role| self.of_role(*role, what));
                if *all { each.all(|holds| holds) } else { each.any(|holds| holds) }
            }
        }
    }

    fn shows(&self, light: &Light) -> bool {
        let tick = self.tick.saturating_sub(1);
        let shown = |group| signals::shown(self.network, self.seed, &self.before.lights, group, tick).0;
        light.groups.first().is_some_and(|group| shown(*group) == light.phase)
    }

    fn element(&self, condition: usize, state: ElementState) -> bool {
        let just = |mark: &Mark, change: Change| mark.change == change && mark.at.saturating_add(1) == self.tick;
        let is = |mark: &Mark| match state {
            ElementState::Standby => mark.progress == Progress::Standby,
            ElementState::Running => mark.runs(),
            ElementState::Complete => mark.is_complete(),
            ElementState::Started => mark.began > 0 && mark.began.checked_add(1) == Some(self.tick),
            ElementState::Ended => just(mark, Change::Ended),
            ElementState::Stopped => just(mark, Change::Stopped),
            ElementState::Skipped => just(mark, Change::Skipped),
        };
        self.plan.marks(self.before, condition).any(|mark| is(&mark))
    }

    fn actor(&self, role: RoleId) -> &StoryActor {
        &self.before.actors[role]
    }

    fn outline(&self, role: RoleId) -> Outline {
        Outline::of(self.actor(role), &self.script.cast[role])
    }

    fn spot(&self, place: &super::script::Position) -> Option<Spot> {
        relative::spot(self.network, self.before, place)
    }

    fn of_role(&self, role: RoleId, what: &OfRole) -> bool {
        let actor = self.actor(role);
        if actor.gone {
            return false;
        }
        let is = |rule: Rule, value: f32, than: f32| rule.holds(value, than, EQUAL);
        let is_some = |rule: Rule, value: Option<f32>, than: f32| value.is_some_and(|value| is(rule, value, than));
        let there = |other: RoleId| !self.actor(other).gone;
        match what {
            OfRole::Speed(rule, than) => is(*rule, actor.speed_mps, *than),
            OfRole::RelativeSpeed(rule, than, other) => {
                there(*other) && is(*rule, actor.speed_mps - self.actor(*other).speed_mps, *than)
            }
            OfRole::Acceleration(rule, than) => is(*rule, actor.acceleration_mps2, *than),
            OfRole::Stands(ticks) => actor.stood_ticks > 0 && Tick::from(actor.stood_ticks) >= *ticks,
            OfRole::EndOfRoad(ticks) => actor.at_end_ticks > 0 && Tick::from(actor.at_end_ticks) >= *ticks,
            OfRole::OffRoad(ticks) => actor.off_road_ticks > 0 && Tick::from(actor.off_road_ticks) >= *ticks,
            OfRole::Travelled(least_m) => actor.travelled_m >= *least_m,
            OfRole::Reaches(place, tolerance_m) => {
                self.spot(place).is_some_and(|spot| spot.plan().distance(actor.spot.plan()) <= *tolerance_m)
            }
            OfRole::Distance(rule, than, measure, place) => {
                let spot = self.spot(place);
                let distance_m = spot.map(|s| self.outline(role).distance_m(&Outline::point(s.plan()), *measure));
                is_some(*rule, distance_m, *than)
            }
            OfRole::RelativeDistance(rule, than, measure, other) => {
                there(*other) && is(*rule, self.outline(role).distance_m(&self.outline(*other), *measure), *than)
            }
            OfRole::Headway(rule, than, measure, other) => {
                let headway_s = self.outline(role).headway_s(&self.outline(*other), *measure);
                there(*other) && is_some(*rule, headway_s, *than)
            }
            OfRole::TimeToCollision(rule, than, measure, other) => {
                let time_s = self.outline(role).time_to_collision_s(&self.outline(*other), *measure);
                there(*other) && is_some(*rule, time_s, *than)
            }
            OfRole::Collides(other) => {
                let others = 0..self.script.cast.len();
                let mut met = others.filter(|o| *o != role && other.is_none_or(|other| other == *o) && there(*o));
                met.any(|other| self.touch(role, other))
            }
        }
    }

    /// Whether two touch; what the ego car touches physics tells.
    fn touch(&self, one: RoleId, other: RoleId) -> bool {
        let ego = self.plan.ego;
        if one == ego || other == ego {
            return self.touching.contains(if one == ego { &other } else { &one });
        }
        self.outline(one).touches(&self.outline(other))
    }
}

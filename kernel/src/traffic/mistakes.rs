//! Mistakes of people at the wheel: when they begin, what is done meanwhile, and when they are over.
//!
//! Each is drawn where it can happen and from nothing but the seed, the driver and the occasion: the moment at which a light
//! turns red, the approach to a stop sign, a second. Rates: [`HazardRates`]; sources: docs/hazards.md.

use crate::events::EventKind;
use crate::map_data::LaneId;
use crate::rng::{Stream, below, unit};
use crate::time::{TICK_S, Tick, seconds};

use super::barge::PULL_OUT_MPS2;
use super::drive::View;
use super::junction::{self, Signal, YELLOW_BRAKE_MPS2};
use super::lapse::Lapse;
use super::manoeuvre::Manoeuvre;
use super::passage::Told;
use super::plan::{Line, Plan, braking_needed};
use super::rates::HazardRates;
use super::step::LINE_MARGIN_M;
use super::traits::Driver;
use super::vehicle::{DECIDE_TICKS, Vehicle};

/// Whoever would be at the line this long after the light has turned red may run it, s.
const RUN_S: f32 = 2.0;
/// Slower than this nobody begins to run a light, nor goes on with it, m/s.
const RUN_LEAST_MPS: f32 = 4.0;
const RUNS_ON_MPS: f32 = 1.0;
/// Half of the acceleration with which others speed up before a light, m/s².
const SPEEDING_UP_MPS2: f32 = 0.8;
/// So near to its line a stop sign is rolled over, metres: at about 9 km/h.
const ROLL_M: f32 = 1.5;
/// Hard braking for no reason, of cars and of long vehicles, m/s².
const HARD_MPS2: f32 = 7.0;
const LONG_HARD_MPS2: f32 = 6.0;
/// It lasts so long, ticks.
const HARD_TICKS: u8 = 60;
/// Slower than this nobody brakes for no reason, m/s.
const HARD_LEAST_MPS: f32 = 5.0;
/// Time headway of tailgaters, s.
const TAILGATE_S: f32 = 0.5;
/// Most braking before a halt at the kerb, m/s².
const HALT_MPS2: f32 = 1.5;
/// Speeds from which a driver halts, m/s.
const HALT_FROM_MPS: [f32; 2] = [3.0, 15.0];
/// The way ahead on which no junction or crosswalk is, metres, or more where it comes to a stand later.
const HALT_CLEAR_M: f32 = 60.0;
/// Nor so far behind, nor beyond where it stands, metres.
const HALT_BEHIND_M: f32 = 15.0;
/// Least and most time of a halt, tenths of a second.
const HALTS_DS: [u8; 2] = [40, 120];
/// Ticks in a tenth of a second.
const DS_TICKS: Tick = 6;
/// What can be drawn at a second, as keys of random numbers.
const BRAKES: u64 = 1;
const CUTS_IN: u64 = 2;
const HALTS: u64 = 3;
/// And of a driver.
const TAILGATES: u64 = 64;

impl HazardRates {
    /// Gives the driver of a vehicle the habits that the rates ask for.
    pub(super) fn form(&self, seed: u64, vehicle: &Vehicle, driver: &mut Driver) {
        let tailgates = unit(seed, Stream::Trait, u64::from(vehicle.id), TAILGATES) < self.tailgaters;
        if tailgates && !vehicle.kind.is_pedalled() {
            driver.headway_s = TAILGATE_S;
        }
        driver.reaction_ticks = self.reaction_ticks(seed, vehicle.id);
    }
}

/// Which mistakes began, from the states before and after a tick.
pub(super) fn tell(before: &[Vehicle], after: &[Vehicle], told: &mut Vec<Told>) {
    let changed = before.iter().zip(after).filter(|(was, is)| was.lapse != is.lapse);
    told.extend(changed.filter_map(|(_, is)| {
        let kind = match is.lapse {
            Lapse::RunsRed => EventKind::HazardRedLight,
            Lapse::Rolls => EventKind::HazardRollingStop,
            Lapse::BrakesHard => EventKind::HazardBraking,
            Lapse::CutsIn => EventKind::HazardCutIn,
            Lapse::PullsOut => EventKind::HazardPullOut,
            Lapse::None
            | Lapse::Parks
            | Lapse::Halts
            | Lapse::Crashed
            | Lapse::Calls
            | Lapse::Boards
            | Lapse::Departs => {
                return None;
            }
        };
        Some((kind, u32::from(is.id)))
    }));
}

/// Whether an event is a mistake that began.
pub(super) fn is_mistake(kind: EventKind) -> bool {
    use EventKind::{HazardBraking, HazardCutIn, HazardPullOut, HazardRedLight, HazardRollingStop};
    matches!(kind, HazardRedLight | HazardRollingStop | HazardBraking | HazardCutIn | HazardPullOut)
}

impl View<'_> {
    /// Begins a mistake, goes on with it, or ends it.
    pub(super) fn err(&self, index: usize, plan: &Plan, next: &mut Vehicle) {
        match next.lapse {
            Lapse::None => self.begin(index, plan, next),
            Lapse::BrakesHard => {
                next.lapse_left = next.lapse_left.saturating_sub(DECIDE_TICKS);
                end_if(next.lapse_left == 0, next);
            }
            Lapse::RunsRed => {
                let goes = plan.line.is_some_and(|_| next.speed_mps >= RUNS_ON_MPS);
                end_if(!goes, next);
            }
            Lapse::Rolls => end_if(plan.line.is_none() || next.speed_mps < 0.3, next),
            Lapse::CutsIn => end_if(next.manoeuvre == Manoeuvre::Keep, next),
            Lapse::Parks if next.speed_mps < 0.1 => {
                let [least, most] = HALTS_DS;
                let drawn = below(self.seed, Stream::Lapse, u64::from(next.id), self.tick, u32::from(most - least));
                (next.lapse, next.lapse_left) = (Lapse::Halts, least + drawn as u8);
            }
            Lapse::PullsOut => end_if((next.offset_m - self.likes_m(index)).abs() < 0.3, next),
            Lapse::Parks | Lapse::Halts | Lapse::Crashed | Lapse::Calls | Lapse::Boards | Lapse::Departs => {}
        }
    }

    fn begin(&self, index: usize, plan: &Plan, next: &mut Vehicle) {
        if self.rates.red_light_runners > 0.0
            && let Some(line) = &plan.line
            && let Some(red_at) = self.meets_red(plan, line, next)
            && unit(self.seed, Stream::Lapse, u64::from(next.id), red_at) < self.rates.red_light_runners
            && self.has_room_beyond(index, plan, line)
        {
            next.lapse = Lapse::RunsRed;
            next.flags |= Vehicle::GRANTED;
        }
        if next.is_due(self.tick, seconds(1)) {
            self.begin_at_any_time(index, plan, next);
        }
    }

    /// What begins by the hour, drawn once a second where it can happen.
    fn begin_at_any_time(&self, index: usize, plan: &Plan, next: &mut Vehicle) {
        let rates = self.rates;
        if self.draws(BRAKES, rates.hard_brakings_per_h, next) && self.can_brake_hard(next) {
            (next.lapse, next.lapse_left) = (Lapse::BrakesHard, HARD_TICKS);
        } else if self.draws(CUTS_IN, rates.cut_ins_per_h, next) {
            // Which lane to take is looked up after this vehicle has moved (`move_over`).
            next.lapse = if self.cut_in(index, plan).is_some() { Lapse::CutsIn } else { Lapse::None };
        } else if self.draws(HALTS, rates.pull_outs_per_h, next) && self.can_halt(plan, next) {
            next.lapse = Lapse::Parks;
        }
    }

    /// Whether something that happens so often in an hour happens in this second.
    fn draws(&self, what: u64, per_h: f32, next: &Vehicle) -> bool {
        per_h > 0.0 && unit(self.seed, Stream::Lapse, what << 32 | u64::from(next.id), self.tick) < per_h / 3600.0
    }

    /// When the light turns red before which a vehicle could stop and at whose line it would be a moment later, if it is
    /// the first there.
    pub(super) fn meets_red(&self, plan: &Plan, line: &Line, next: &Vehicle) -> Option<Tick> {
        let signal = junction::signal(self.map, self.lights, next, self.steps_of(plan), line);
        let Signal::Closing(left) = signal else { return None };
        let v = next.speed_mps;
        let red_s = left as f32 * TICK_S;
        // Who speeds up may be there before that.
        let limit_mps = self.map.lanes[next.lane as usize].speed_limit_mps.max(v);
        let most_m = (v * red_s + SPEEDING_UP_MPS2 * red_s * red_s).min(limit_mps * red_s);
        let first = plan.leader.is_none_or(|leader| leader.gap_m > line.ahead_m);
        let meets = line.ahead_m > most_m && line.ahead_m < v * (red_s + RUN_S) && v > RUN_LEAST_MPS && !line.passed;
        let could_stop = braking_needed(v, line.ahead_m) < YELLOW_BRAKE_MPS2;
        (meets && first && could_stop && !next.kind.is_pedalled()).then_some(self.tick + left)
    }

    pub(super) fn has_room_beyond(&self, index: usize, plan: &Plan, line: &Line) -> bool {
        let known = (self.map, self.ways, self.lists, self.vehicles);
        junction::has_room(known, plan, line, self.steps_of(plan), index, &self.drivers[index], f32::MAX)
    }

    /// Whether a vehicle rolls over the line of the stop sign before it. It then counts as one that has halted.
    pub(super) fn rolls(&self, line: &Line, approach: LaneId, next: &mut Vehicle) -> bool {
        let near = line.hold_m < LINE_MARGIN_M + ROLL_M && next.speed_mps > 0.3 && next.flags & Vehicle::HALTED == 0;
        let rolls = near && next.lapse == Lapse::None && self.would_roll(approach, next);
        if rolls {
            next.lapse = Lapse::Rolls;
        }
        rolls
    }

    /// Whether a driver rolls over the line at the end of a lane on this journey.
    pub(super) fn would_roll(&self, approach: LaneId, next: &Vehicle) -> bool {
        let share = self.rates.rolling_stops;
        let occasion = u64::from(next.trips) << 32 | u64::from(approach);
        share > 0.0 && unit(self.seed, Stream::Lapse, u64::from(next.id), occasion) < share
    }

    /// Whether a vehicle drives as those do who brake for no reason.
    pub(super) fn can_brake_hard(&self, next: &Vehicle) -> bool {
        !next.kind.is_pedalled() && next.speed_mps > HARD_LEAST_MPS
    }

    /// Whether a vehicle can halt at the kerb.
    pub(super) fn can_halt(&self, plan: &Plan, next: &Vehicle) -> bool {
        let [least, most] = HALT_FROM_MPS;
        let steps = self.steps_of(plan);
        let ways = &self.ways.lanes;
        let stops_m = next.speed_mps * next.speed_mps / (2.0 * HALT_MPS2) + HALT_BEHIND_M;
        let clear_m = stops_m.max(HALT_CLEAR_M);
        let mut near = steps.iter().take_while(|step| step.start_m < clear_m);
        let ahead = |m: f32| (-HALT_BEHIND_M..clear_m).contains(&m);
        let clear = near.all(|step| {
            let way = &ways[step.lane as usize];
            way.zone.is_none() && !way.crosswalks.iter().any(|c| ahead(step.start_m + c.near_m))
        });
        let lane = &self.map.lanes[next.lane as usize];
        let kerb = if self.ways.kerb > 0 { lane.left } else { lane.right };
        let drives = next.kind.is_car_or_heavier()
            && !next.kind.is_heavy()
            && (least..most).contains(&next.speed_mps)
            && next.late_ticks == 0;
        drives
            && clear
            && kerb.is_none()
            && next.manoeuvre == Manoeuvre::Keep
            && plan.dead_end_m.is_none_or(|m| m > clear_m)
    }

    /// Where across its lane a vehicle halts at the kerb, metres to the left of the middle.
    pub(super) fn kerb_m(&self, index: usize) -> Option<f32> {
        let vehicle = &self.vehicles[index];
        let lane = &self.map.lanes[vehicle.lane as usize];
        let room_m = lane.at(vehicle.s_m).half_width_m - self.drivers[index].size_m.y * 0.5;
        vehicle.lapse.is_to_kerb().then(|| f32::from(self.ways.kerb) * room_m.max(0.0))
    }

    /// The greatest acceleration that a mistake allows, m/s².
    pub(super) fn lapse_mps2(&self, next: &Vehicle) -> f32 {
        match next.lapse {
            Lapse::BrakesHard if next.kind.size_m().x > 5.0 => -LONG_HARD_MPS2,
            Lapse::BrakesHard => -HARD_MPS2,
            Lapse::Parks => -HALT_MPS2,
            _ => f32::MAX,
        }
    }

    /// The next state of a vehicle that crashed or halts at the kerb.
    pub(super) fn stand_aside(&self, index: usize, next: &mut Vehicle) {
        next.speed_mps = 0.0;
        next.flags |= Vehicle::BRAKING;
        if next.lapse == Lapse::Crashed {
            next.stuck_s = next.stuck_s.saturating_add(u8::from(self.tick.is_multiple_of(seconds(1))));
            return;
        }
        if next.lapse == Lapse::Boards {
            return self.board(index, next);
        }
        if next.is_due(self.tick, DS_TICKS) {
            next.lapse_left = next.lapse_left.saturating_sub(1);
            if next.lapse_left == 0 && self.can_pull_out(index, PULL_OUT_MPS2) {
                next.lapse = Lapse::PullsOut;
            }
        }
    }
}

fn end_if(over: bool, next: &mut Vehicle) {
    if over {
        (next.lapse, next.lapse_left) = (Lapse::None, 0);
    }
}

//! How fast somebody who plays goes.

use crate::geometry::direction;
use crate::ops;
use crate::time::TICK_S;

use super::cues::Seen;
use super::deeds;
use super::facts::Outline;
use super::script::{
    Action, Dynamics, Gap, GapSide, GapWidth, Limits, Meeting, Position, RoleId, Shape, SpeedProfile, SpeedTarget,
    Takes,
};
use super::spot::Spot;
use super::state::{Change, Deed, StoryState};
use super::{lanes, relative};

/// How fast a gap becomes what it shall be, 1/s: it comes there without passing it.
const CLOSES_PER_S: f32 = 1.0;
/// A speed is what it shall be after about so long, where limits let it, seconds.
const SETTLES_S: f32 = 0.3;
/// A gap is as wide as it shall be within this, and speeds are the same, metres and m/s.
const THERE_M: f32 = 0.1;
const SAME_MPS: f32 = 0.1;
/// Two who are to meet change their speed at most so, m/s².
const MEETS: Limits = Limits { acceleration_mps2: 10.0, deceleration_mps2: 10.0, most_mps: 100.0 };
/// Nobody can be late by less, seconds: the last ticks go as they are.
const LAST_S: f32 = 0.2;
/// A place ahead is looked for along the lanes up to here, metres; beyond it is told by the straight line.
const AHEAD_M: f32 = 1000.0;

/// How far a change of the speed has come, [0, 1].
fn share(deed: &Deed, seen: &Seen<'_>) -> f32 {
    let gone_s = since_s(deed, seen);
    // Half a tick before the end is the end.
    if gone_s + 0.5 * TICK_S >= deed.takes { 1.0 } else { (gone_s / deed.takes).clamp(0.0, 1.0) }
}

/// How far a move across the lane has come, [0, 1].
pub fn share_aside(deed: &Deed, dynamics: Dynamics, seen: &Seen<'_>) -> f32 {
    match dynamics.takes {
        Takes::Distance(_) if deed.gone_m >= deed.takes => 1.0,
        Takes::Distance(_) => (deed.gone_m / deed.takes).clamp(0.0, 1.0),
        Takes::Time(_) | Takes::Rate(_) => share(deed, seen),
    }
}

/// The course of a change, by the share of it that is over.
pub fn course(shape: Shape, share: f32) -> f32 {
    match shape {
        Shape::Linear => share,
        Shape::Cubic => share * share * (3.0 - 2.0 * share),
        Shape::Sinusoidal => 0.5 - 0.5 * ops::cos(core::f32::consts::PI * share),
        Shape::Step => 1.0,
    }
}

/// Seconds since a deed began, at the end of the tick that is computed.
pub fn since_s(deed: &Deed, seen: &Seen<'_>) -> f32 {
    (seen.tick + 1).saturating_sub(deed.mark.at) as f32 * TICK_S
}

/// Sets the speed of a role for this tick, as the deed says that decides it.
pub fn set(state: &mut StoryState, role: RoleId, seen: &Seen<'_>) {
    let Some(number) = state.actors[role].speed_by.map(|deed| deed as usize) else { return };
    let deed = &state.deeds[number];
    let (speed_mps, over) = match &*seen.plan.deeds[number].action {
        Action::Speed(dynamics, target) => changed(&mut state.deeds[number], *dynamics, *target, seen),
        Action::SpeedProfile(profile) => along(profile, deed.from, since_s(deed, seen)),
        Action::Gap(gap) => keeping(state, role, gap, seen),
        Action::Meet(meeting) => meeting_in_time(state, role, meeting, seen),
        _ => return,
    };
    let most_mps = seen.script.cast[role].most_mps;
    state.actors[role].speed_mps = speed_mps.clamp(-most_mps, most_mps);
    state.actors[role].ended_mps = 0.0;
    if over {
        deeds::end(state, number, Change::Ended, seen.tick);
    }
}

fn changed(deed: &mut Deed, dynamics: Dynamics, target: SpeedTarget, seen: &Seen<'_>) -> (f32, bool) {
    let goes_on = matches!(target, SpeedTarget::Faster(.., true) | SpeedTarget::Times(.., true));
    if goes_on {
        deed.to = wanted_mps(target, seen);
    }
    let share = share(deed, seen);
    let speed_mps = deed.from + (deed.to - deed.from) * course(dynamics.shape, share);
    (speed_mps, share >= 1.0 && !goes_on)
}

fn wanted_mps(target: SpeedTarget, seen: &Seen<'_>) -> f32 {
    deeds::speed_of(target, |role| seen.before.actors[role].speed_mps)
}

/// The speed so long after a profile began at another, and whether it is over.
fn along(profile: &SpeedProfile, from_mps: f32, since_s: f32) -> (f32, bool) {
    let limits = profile.limits;
    let (mut before_mps, mut left_s) = (from_mps, since_s);
    for (to_mps, takes_s) in &profile.entries {
        let change_mps = to_mps.min(limits.most_mps) - before_mps;
        let hardest_mps2 = if change_mps > 0.0 { limits.acceleration_mps2 } else { limits.deceleration_mps2 };
        let takes_s = takes_s.unwrap_or(change_mps.abs() / hardest_mps2);
        if left_s + 0.5 * TICK_S < takes_s {
            return (before_mps + change_mps * (left_s / takes_s), false);
        }
        (before_mps, left_s) = (before_mps + change_mps, left_s - takes_s);
    }
    (before_mps, true)
}

/// The speed after a tick of an acceleration that is asked for; nobody goes backwards for it.
fn sped_up(speed_mps: f32, asked_mps2: f32, limits: Limits) -> f32 {
    let mps2 = asked_mps2.clamp(-limits.deceleration_mps2, limits.acceleration_mps2);
    (speed_mps + mps2 * TICK_S).clamp(0.0, limits.most_mps.max(0.0))
}

fn keeping(state: &StoryState, role: RoleId, gap: &Gap, seen: &Seen<'_>) -> (f32, bool) {
    let outline = |role: RoleId| Outline::of(&seen.before.actors[role], &seen.script.cast[role]);
    let (own, other) = (outline(role), outline(gap.role));
    let speed_mps = state.actors[role].speed_mps;
    if seen.before.actors[gap.role].gone {
        return (speed_mps, true);
    }
    let was_behind = own.forward.dot(other.middle - own.middle) >= 0.0;
    let is_behind = match gap.side {
        GapSide::Any => was_behind,
        GapSide::Behind => true,
        GapSide::Ahead => false,
    };
    // On the other side of it than it shall be, the gap is below zero.
    let on_side = if is_behind == was_behind { 1.0 } else { -1.0 };
    let wanted_m = match gap.wanted {
        GapWidth::Way(metres) => metres,
        // Of who is behind, since it needs the time.
        GapWidth::Time(seconds) if is_behind => seconds * speed_mps.max(0.0),
        GapWidth::Time(seconds) => seconds * other.velocity_mps.dot(own.forward).max(0.0),
    };
    let too_wide_m = own.distance_m(&other, gap.measure) * on_side - wanted_m;
    let their_mps = other.velocity_mps.dot(own.forward);
    let slower_mps = their_mps - speed_mps;
    if !gap.goes_on && too_wide_m.abs() < THERE_M && slower_mps.abs() < SAME_MPS {
        // Both go on as fast as each other.
        return (their_mps.max(0.0), true);
    }
    let to_m = if is_behind { too_wide_m } else { -too_wide_m };
    // So fast towards it that half of the braking that is allowed ends it there.
    let braking_mps2 = 0.5 * gap.limits.deceleration_mps2.min(gap.limits.acceleration_mps2);
    let towards_mps = (CLOSES_PER_S * to_m.abs()).min(ops::sqrt(2.0 * braking_mps2 * to_m.abs())) * to_m.signum();
    (sped_up(speed_mps, (slower_mps + towards_mps) / SETTLES_S, gap.limits), false)
}

/// So fast that both arrive at the same time: with an even acceleration, or with one that changes evenly where the last speed is
/// told, too.
fn meeting_in_time(state: &StoryState, role: RoleId, meeting: &Meeting, seen: &Seen<'_>) -> (f32, bool) {
    let speed_mps = state.actors[role].speed_mps;
    let last_mps = meeting.last.map(|last| wanted_mps(last, seen));
    let their_mps = seen.before.actors[meeting.with].speed_mps;
    let ways = way_m(meeting.with, &meeting.theirs.0, seen).zip(way_m(role, &meeting.own.0, seen));
    let Some((their_m, own_m)) = ways else { return (speed_mps, true) };
    if their_m <= meeting.theirs.1 || own_m <= meeting.own.1 {
        return (last_mps.unwrap_or(speed_mps), true);
    }
    let time_s = their_m / their_mps.max(0.1);
    if time_s < LAST_S {
        return (speed_mps, false);
    }
    let mean_mps = own_m / time_s;
    let asked_mps2 = match last_mps {
        None => 2.0 * (mean_mps - speed_mps) / time_s,
        Some(last_mps) => (6.0 * mean_mps - 4.0 * speed_mps - 2.0 * last_mps) / time_s,
    };
    (sped_up(speed_mps, asked_mps2, MEETS), false)
}

/// The way of a role to a place ahead, metres: along its line or its lanes, or straight; negative for a place behind it.
fn way_m(role: RoleId, place: &Position, seen: &Seen<'_>) -> Option<f32> {
    let actor = &seen.before.actors[role];
    let to = relative::spot(seen.network, seen.before, place)?;
    if let Some(way_m) = line_way_m(role, &to, seen) {
        return Some(way_m);
    }
    let by_lanes =
        actor.spot.on.zip(to.on).and_then(|(from, to)| lanes::ahead_m(seen.network, from, to, &actor.route, AHEAD_M));
    let way = to.plan() - actor.spot.plan();
    let ahead = way.dot(direction(actor.spot.heading_rad)) >= 0.0;
    Some(by_lanes.unwrap_or(if ahead { way.length() } else { -way.length() }))
}

/// The same along the line that a role follows at its own speed.
fn line_way_m(role: RoleId, to: &Spot, seen: &Seen<'_>) -> Option<f32> {
    let number = seen.before.actors[role].way_by? as usize;
    let Action::Follow(path) = &*seen.plan.deeds[number].action else { return None };
    let deed = &seen.before.deeds[number];
    let known = |place: &Position| if let Position::Known(spot) = place { Some(*spot) } else { None };
    let corners: Vec<_> = if deed.line.is_empty() {
        path.corners.iter().filter_map(|(place, _)| known(place)).collect()
    } else {
        deed.line.clone()
    };
    let (mut nearest, mut station_m) = ((f32::MAX, 0.0), 0.0);
    for pair in corners.windows(2) {
        let (from, along) = (pair[0].plan(), pair[1].plan() - pair[0].plan());
        let length_m = along.length();
        let on_m = (to.plan() - from).dot(along.normalize_or_zero()).clamp(0.0, length_m);
        let off_m = (to.plan() - from - along.normalize_or_zero() * on_m).length();
        if off_m < nearest.0 {
            nearest = (off_m, station_m + on_m);
        }
        station_m += length_m;
    }
    (!path.timed && corners.len() > 1).then_some(nearest.1 - deed.gone_m)
}

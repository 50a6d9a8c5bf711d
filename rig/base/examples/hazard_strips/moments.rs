//! Which moments of a drive may show a hazard: its events, or what those do who follow somebody.

use kernel::events::EventKind;
use kernel::scene::{ActorScene, lamps};

use super::drive::{Film, SCENE_HZ};
use super::shots::{PICTURES, Shot, Trace};

/// Who follows keeps this much aside at most, metres.
const LANE_M: f32 = 1.0;
/// How long somebody follows too close, s.
const FOLLOWS_S: f32 = 4.0;
/// Who drives slower than this does not count as close or late, m/s.
const DRIVES_MPS: f32 = 7.0;
/// Who rolls over a stop line is at least so fast soon after it, m/s.
const ROLLS_MPS: f32 = 3.0;

/// A moment that may show a hazard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Number of the scene.
    pub at: usize,
    /// Whose mistake it is.
    pub who: u32,
    /// Whom the one who makes it follows.
    pub ahead: Option<u32>,
}

/// All moments of a drive that may show the hazard.
pub fn of(shot: &Shot, film: &Film) -> Vec<Moment> {
    match shot.trace {
        Trace::Event(kind) => {
            let events = film.events.iter().filter(|(_, event)| event.kind == kind);
            let moments = events.map(|&(at, event)| Moment { at, who: event.actor, ahead: None });
            moments.filter(|moment| kind != EventKind::HazardRollingStop || rolls_on(shot, film, moment)).collect()
        }
        Trace::Close => followers(film, |film, at, who, ahead| {
            let steps = (FOLLOWS_S * SCENE_HZ) as usize;
            (at..=at + steps).step_by(5).all(|at| headway_s(film, at, who, ahead).is_some_and(|s| s < 0.7))
        }),
        Trace::Late => followers(film, |film, at, who, ahead| {
            let brakes = |at: usize, id: u32| film.actor(at, id).is_some_and(|a| a.lamps & lamps::BRAKE != 0);
            let follows = |at: usize| headway_s(film, at, who, ahead).is_some_and(|s| s < 2.0);
            let late = (at..at + SCENE_HZ as usize).all(|at| follows(at) && brakes(at, ahead) && !brakes(at, who));
            at > 0 && !brakes(at - 1, ahead) && late && (1..15).any(|more| brakes(at + SCENE_HZ as usize + more, who))
        }),
    }
}

/// Whether somebody still drives in the last picture: who gives way to others at once does not show that he did not halt.
fn rolls_on(shot: &Shot, film: &Film, moment: &Moment) -> bool {
    let last = film.after(moment.at, shot.times_s[PICTURES - 1]).and_then(|at| film.actor(at, moment.who));
    last.is_some_and(|actor| actor.speed_mps > ROLLS_MPS)
}

/// Moments at which somebody follows another as `shows` says, half a second apart at least.
fn followers(film: &Film, shows: impl Fn(&Film, usize, u32, u32) -> bool) -> Vec<Moment> {
    let mut found: Vec<Moment> = Vec::new();
    let last = film.scenes.len().saturating_sub((FOLLOWS_S * SCENE_HZ) as usize + 1);
    for at in 0..last {
        for actor in film.scenes[at].actors.iter().filter(|actor| actor.speed_mps > DRIVES_MPS) {
            let Some(ahead) = leader(film, at, actor) else { continue };
            let known = found.iter().rev().any(|m| m.who == actor.id && at - m.at < 5);
            if !known && shows(film, at, actor.id, ahead) {
                found.push(Moment { at, who: actor.id, ahead: Some(ahead) });
            }
        }
    }
    found
}

/// Whom somebody follows within 25 m.
fn leader(film: &Film, at: usize, actor: &ActorScene) -> Option<u32> {
    let others = film.scenes[at].actors.iter().filter(|o| o.id != actor.id && o.kind.is_car_or_heavier());
    let ahead = others.filter_map(|other| Some((gap_m(actor, other).filter(|gap_m| *gap_m < 25.0)?, other.id)));
    ahead.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, id)| id)
}

/// Room between somebody and another who drives before it in its lane, metres.
fn gap_m(actor: &ActorScene, other: &ActorScene) -> Option<f32> {
    let [x, y] = [glam::Vec3::X, glam::Vec3::Y].map(|axis| actor.rotation * axis);
    let to = other.position - actor.position;
    let beside = to.dot(y).abs() > LANE_M || (other.rotation * glam::Vec3::X).dot(x) < 0.97;
    let gap_m = to.dot(x) - 0.5 * (actor.kind.size_m().x + other.kind.size_m().x);
    (!beside && gap_m > 0.0).then_some(gap_m)
}

/// Time headway between two, s, if the one drives behind the other.
fn headway_s(film: &Film, at: usize, who: u32, ahead: u32) -> Option<f32> {
    let (actor, other) = (film.actor(at, who)?, film.actor(at, ahead)?);
    let drives = actor.speed_mps > 0.5 * DRIVES_MPS;
    Some(gap_m(actor, other)? / actor.speed_mps).filter(|_| drives)
}

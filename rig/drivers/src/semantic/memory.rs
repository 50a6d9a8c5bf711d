//! What the driver remembers of the HUD and of where to stand.

use kernel::map::Turn;
use kernel::ops;
use kernel::signals::LightPhase;
use kernel::time::TICK_S;

use super::arc::Point;
use super::moved::Moved;
use crate::readout::{self, Readout};

/// Distance between two remembered points of the route, metres.
const TRAIL_STEP_M: f32 = 0.4;
/// Half of the stretch of the trail that is averaged, metres; evens out the steps of the arrow.
const TRAIL_AVERAGE_M: f32 = 1.6;
/// How long others are let pass after they were last seen to come, seconds.
const PATIENCE_S: f32 = 1.2;

/// Share of a look at which what stands in the way seems farther than before: a row of pixels farther up is soon the old
/// one again.
const FARTHER_SHARE: f32 = 0.15;
/// Looks without what stands in the way that are needed to forget it: so many for each look that showed it, and at most.
const BELIEF_PER_LOOK: u32 = 2;
const MOST_BELIEF: u32 = 8;

/// The places that the arrow pointed to, carried along while the car moves.
#[derive(Clone, Debug, Default)]
pub struct Trail {
    points: Vec<Point>,
    driven_m: f32,
}

impl Trail {
    /// Carries the trail along and adds the place that the arrow points to now.
    pub fn extend(&mut self, moved: Moved, arrow: Point) {
        self.points.iter_mut().for_each(|p| *p = moved.shift(*p));
        self.points.retain(|p| p.0 > 0.0);
        self.driven_m += moved.forward_m;
        if self.driven_m >= TRAIL_STEP_M || self.points.is_empty() {
            self.driven_m = 0.0;
            self.points.push(arrow);
        }
    }

    /// The middle of the remembered places about `distance_m` away; `None` where there are none.
    pub fn point_at(&self, distance_m: f32) -> Option<Point> {
        let near = |p: &&Point| (ops::hypot(p.0, p.1) - distance_m).abs() < TRAIL_AVERAGE_M;
        let near: Vec<&Point> = self.points.iter().filter(near).collect();
        let n = near.len() as f32;
        let sum = near.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0, sum.1 + p.1));
        (n > 2.0).then(|| (sum.0 / n, sum.1 / n))
    }
}

/// A step of a distance that was driven comes where it was expected, within this, metres.
const NEAR_STEP_M: f32 = 4.0;

/// A distance that is shown in steps, counted down in between.
#[derive(Clone, Copy, Debug, Default)]
struct Countdown {
    shown_m: u16,
    left_m: f32,
}

impl Countdown {
    /// Metres, by what is shown now and what was driven since: right after a step it is known, before the first one it is
    /// taken to be as near as it can be.
    fn read(&mut self, shown_m: u16, moved: Moved) -> f32 {
        let next_m = shown_m + readout::step_m(shown_m);
        if shown_m != self.shown_m {
            let is_driven = next_m == self.shown_m && self.left_m - f32::from(next_m) < NEAR_STEP_M;
            self.left_m = f32::from(if is_driven { next_m } else { shown_m });
        }
        self.shown_m = shown_m;
        self.left_m = (self.left_m - moved.forward_m).clamp(f32::from(shown_m), f32::from(next_m));
        self.left_m
    }
}

/// What the HUD says, with distances as the driver takes them to be.
#[derive(Clone, Copy, Debug)]
pub struct Dash {
    /// Speed and limit, m/s.
    pub speed_mps: f32,
    pub limit_mps: f32,
    /// The next light, and metres to its stop line.
    pub light: Option<LightPhase>,
    pub light_m: f32,
    /// The way at the next junction, and metres to it: 0 inside, infinite where none is shown.
    pub turn: Turn,
    pub junction_m: f32,
    /// The car has turned so far that way inside of it, radians.
    pub turned_rad: f32,
    /// Bearing of the route, degrees, positive to the right.
    pub bearing_deg: i16,
}

/// Nothing is shown, and the car stands.
impl Default for Dash {
    fn default() -> Self {
        let (speed_mps, limit_mps, light_m, turned_rad, bearing_deg) = (0.0, 0.0, 0.0, 0.0, 0);
        let (light, turn, junction_m) = (None, Turn::Straight, f32::INFINITY);
        Self { speed_mps, limit_mps, light, light_m, turn, junction_m, turned_rad, bearing_deg }
    }
}

/// Reads the HUD.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reading {
    light: Countdown,
    junction: Countdown,
    turn: Option<Turn>,
    turned_rad: f32,
}

impl Reading {
    /// What the HUD says now, after the car has moved.
    pub fn read(&mut self, hud: &Readout, moved: Moved) -> Dash {
        let junction_m = hud.junction_m.map_or(f32::INFINITY, |shown_m| self.junction.read(shown_m, moved));
        let to_its_side_rad = if hud.turn == Turn::Right { -moved.turned_rad } else { moved.turned_rad };
        let goes_on = junction_m == 0.0 && self.turn == Some(hud.turn);
        self.turned_rad = if goes_on { self.turned_rad + to_its_side_rad } else { 0.0 };
        self.turn = Some(hud.turn);
        Dash {
            speed_mps: hud.speed_mps(),
            limit_mps: hud.limit_mps(),
            light: hud.light,
            light_m: self.light.read(hud.light_m, moved),
            turn: hud.turn,
            junction_m,
            turned_rad: self.turned_rad,
            bearing_deg: hud.bearing_deg,
        }
    }
}

/// A place to wait at, kept for a moment after its reason was last seen.
#[derive(Clone, Copy, Debug, Default)]
pub struct Patience {
    stop_in_m: f32,
    left_s: f32,
}

impl Patience {
    /// Metres to the place to wait at: the one that is seen now, or the remembered one.
    pub fn keep(&mut self, seen_m: Option<f32>, moved: Moved) -> Option<f32> {
        self.left_s -= TICK_S;
        self.stop_in_m -= moved.forward_m;
        if let Some(stop_in_m) = seen_m {
            *self = Self { stop_in_m, left_s: PATIENCE_S };
        }
        (self.left_s > 0.0).then_some(self.stop_in_m)
    }
}

/// What is in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ahead {
    /// Metres from the front of the car to where it must stand because of it.
    pub stop_in_m: f32,
    /// So fast it gets away, and the place to stand with it, m/s.
    pub leads_mps: f32,
}

impl Ahead {
    /// Who stands.
    pub fn standing(stop_in_m: f32) -> Self {
        Self { stop_in_m, leads_mps: 0.0 }
    }

    /// The one that asks for the slower speed.
    pub fn nearer(self, other: Self) -> Self {
        if other.stop_in_m < self.stop_in_m { other } else { self }
    }
}

/// The room before what stands in the way, carried along between looks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Room {
    ahead: Option<Ahead>,
    /// So many looks that do not show it are needed to forget it.
    belief: u32,
}

impl Room {
    /// Carries the room along while the car moves.
    pub fn carry(&mut self, moved: Moved) {
        if let Some(ahead) = &mut self.ahead {
            ahead.stop_in_m += ahead.leads_mps * TICK_S - moved.forward_m;
        }
    }

    /// Takes in what a new mask shows: less room is believed at once, more of it little by little; what was seen again
    /// and again is not forgotten at once.
    pub fn look(&mut self, seen: Option<Ahead>) {
        let Some(seen) = seen else {
            self.belief = self.belief.saturating_sub(1);
            self.ahead = self.ahead.filter(|_| self.belief > 0);
            return;
        };
        let known_m = self.ahead.map_or(seen.stop_in_m, |known| known.stop_in_m);
        let share = if seen.stop_in_m < known_m { 1.0 } else { FARTHER_SHARE };
        self.ahead = Some(Ahead { stop_in_m: known_m + share * (seen.stop_in_m - known_m), ..seen });
        self.belief = (self.belief + BELIEF_PER_LOOK).min(MOST_BELIEF);
    }

    /// Metres to where the car must stand; `None` where nothing is in the way.
    pub fn stop_in_m(&self) -> Option<f32> {
        self.ahead.map(|ahead| ahead.stop_in_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STILL: Moved = Moved { forward_m: 0.0, turned_rad: 0.0 };

    #[test]
    fn a_trail_stays_where_it_was_laid() {
        let mut trail = Trail::default();
        let forward = Moved { forward_m: 0.1, turned_rad: 0.0 };
        (0..120).for_each(|_| trail.extend(forward, (12.0, 1.0)));
        let (x, y) = trail.point_at(6.0).expect("laid");
        assert!((x - 6.0).abs() < 0.6 && (y - 1.0).abs() < 1e-3, "{x} {y}");
        assert_eq!(Trail::default().point_at(6.0), None);
    }

    #[test]
    fn a_distance_in_steps_is_counted_down() {
        let (mut countdown, mut distance_m, mut worst_m) = (Countdown::default(), 57.0_f32, 0.0_f32);
        while distance_m > 0.5 {
            distance_m -= 0.1;
            let read_m =
                countdown.read(readout::shown_m(distance_m as u16), Moved { forward_m: 0.103, turned_rad: 0.0 });
            // Before the first step it is as near as it can be.
            let is_known = distance_m < 50.0;
            worst_m = if is_known { worst_m.max((read_m - distance_m).abs()) } else { worst_m };
            assert!(is_known || read_m == 50.0, "{read_m} of {distance_m}");
        }
        assert!(worst_m < 0.5, "{worst_m}");
        assert_eq!(countdown.read(80, STILL), 80.0, "the next one");
        // A step that comes long before it was expected is no step of the way that was driven.
        let mut another = Countdown { shown_m: 50, left_m: 58.0 };
        assert_eq!(another.read(40, STILL), 40.0);
        assert_eq!(Countdown { shown_m: 50, left_m: 52.0 }.read(40, STILL), 50.0);
    }

    #[test]
    fn patience_ends() {
        let mut patience = Patience::default();
        let forward = Moved { forward_m: 0.1, turned_rad: 0.0 };
        assert_eq!(patience.keep(None, forward), None);
        assert_eq!(patience.keep(Some(5.0), forward), Some(5.0));
        let kept: Vec<f32> = (0..200).map_while(|_| patience.keep(None, forward)).collect();
        assert!((kept[9] - 4.0).abs() < 1e-4 && (kept.len() as f32 * TICK_S - PATIENCE_S).abs() < 0.05, "{kept:?}");
    }

    #[test]
    fn what_stands_in_the_way_does_not_jump_away() {
        let mut room = Room::default();
        let forward = Moved { forward_m: 0.1, turned_rad: 0.0 };
        let drive = |room: &mut Room, seen_m: Option<f32>| {
            room.look(seen_m.map(Ahead::standing));
            (0..6).for_each(|_| room.carry(forward));
            room.stop_in_m()
        };
        // Seen once and never again: gone with the second look without it.
        assert!(drive(&mut room, Some(30.0)).is_some() && drive(&mut room, None).is_some());
        assert_eq!(drive(&mut room, None), None);
        // Seen for long, then farther, then not at all for less than the belief.
        (0..10).for_each(|_| assert!(drive(&mut room, Some(30.0)).is_some()));
        let known_m = room.stop_in_m().expect("it is believed");
        let farther_m = drive(&mut room, Some(known_m + 15.0)).expect("it is seen");
        assert!(farther_m < known_m + 3.0, "{known_m}, then {farther_m}");
        (1..MOST_BELIEF).for_each(|_| assert!(drive(&mut room, None).is_some()));
        assert_eq!(drive(&mut room, None), None);
        // Nearer is believed at once.
        for seen_m in [30.0, 8.0] {
            let known_m = drive(&mut room, Some(seen_m)).expect("it is seen");
            assert!((known_m - (seen_m - 0.6)).abs() < 1e-3, "{known_m} of {seen_m}");
        }
    }
}

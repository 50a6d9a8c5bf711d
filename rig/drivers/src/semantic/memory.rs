//! What the driver remembers: where the arrow pointed before, and how vehicles moved.

use kernel::map::Turn;
use kernel::ops;
use kernel::signals::LightPhase;
use kernel::time::TICK_S;

use super::arc::{Arc, Point};
use super::moved::Moved;
use super::sight::{self, Contact};
use crate::readout::{self, Readout};

/// Distance between two remembered points of the route, metres.
const TRAIL_STEP_M: f32 = 0.4;
/// Half of the stretch of the trail that is averaged, metres; evens out the steps of the arrow.
const TRAIL_AVERAGE_M: f32 = 1.6;
/// Share of a new measurement in a velocity; half of it where the depth is known no better than this, metres; and most that
/// it changes, m/s.
const NEW_SHARE: f32 = 0.3;
const KNOWN_DEPTH_M: f32 = 2.0;
const MOST_CHANGE_MPS: f32 = 6.0;
/// Gap that splits contacts into two vehicles, metres, and its growth with distance.
const GAP_M: f32 = 1.2;
const GAP_PER_M: f32 = 0.08;
/// Looks after which the velocity of a vehicle is believed.
const BELIEVED_AFTER: u32 = 4;
/// Who left the picture at its side is believed to go on for this long, seconds.
const REMEMBERED_S: f32 = 3.0;

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
    /// Bearing of the route, degrees, positive to the right.
    pub bearing_deg: i16,
}

/// Reads the HUD.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reading {
    light: Countdown,
    junction: Countdown,
}

impl Reading {
    /// What the HUD says now, after the car has moved.
    pub fn read(&mut self, hud: &Readout, moved: Moved) -> Dash {
        let junction_m = hud.junction_m.map(|shown_m| self.junction.read(shown_m, moved));
        Dash {
            speed_mps: hud.speed_mps(),
            limit_mps: hud.limit_mps(),
            light: hud.light,
            light_m: self.light.read(hud.light_m, moved),
            turn: hud.turn,
            junction_m: junction_m.unwrap_or(f32::INFINITY),
            bearing_deg: hud.bearing_deg,
        }
    }
}

/// Somebody who was seen more than once.
#[derive(Clone, Copy, Debug)]
pub struct Track {
    /// Its nearest point.
    pub at: Point,
    /// Velocity over ground, m/s.
    pub velocity_mps: Point,
    looks: u32,
    /// For so long it has been out of the picture, seconds.
    unseen_s: f32,
}

impl Track {
    /// Where it will be if it goes on like this.
    pub fn after(&self, t_s: f32) -> Point {
        (self.at.0 + t_s * self.velocity_mps.0, self.at.1 + t_s * self.velocity_mps.1)
    }

    /// What a new look makes of it: how far away it is, is known no better than the rows of pixels tell, so what is within
    /// a row is where it was expected.
    fn seen_again(&self, blob: &Blob, dt_s: f32) -> Self {
        let at = blob.nearest_to(self.after(dt_s));
        let mix = |old_mps: f32, share: f32, moved_m: f32| {
            old_mps + (share * (moved_m / dt_s - old_mps)).clamp(-MOST_CHANGE_MPS, MOST_CHANGE_MPS)
        };
        // Who is new may do anything; of those who are known, a row of pixels says little.
        let known_share = NEW_SHARE / (1.0 + blob.depth_error_m / KNOWN_DEPTH_M);
        let share = NEW_SHARE.min(known_share.max(2.0 / (self.looks + 1) as f32));
        let along_mps = mix(self.velocity_mps.0, share, at.0 - self.at.0);
        let velocity_mps = (along_mps, mix(self.velocity_mps.1, share, at.1 - self.at.1));
        Self { at, velocity_mps, looks: self.looks + 1, unseen_s: 0.0 }
    }

    /// The same, if it has gone on unseen beside the picture.
    fn beside(&self, dt_s: f32) -> Option<Self> {
        let gone_on = Self { at: self.after(dt_s), unseen_s: self.unseen_s + dt_s, ..*self };
        let is_believed = self.looks >= BELIEVED_AFTER && gone_on.unseen_s < REMEMBERED_S;
        (is_believed && !sight::is_in_picture(gone_on.at)).then_some(gone_on)
    }
}

/// The vehicles in sight, or the people.
#[derive(Clone, Debug, Default)]
pub struct Tracks {
    tracks: Vec<Track>,
    since_look_s: f32,
}

impl Tracks {
    /// Carries all tracks along while the car moves.
    pub fn carry(&mut self, moved: Moved) {
        self.since_look_s += TICK_S;
        for track in &mut self.tracks {
            track.at = moved.shift(track.at);
            track.velocity_mps = moved.turn(track.velocity_mps);
        }
    }

    /// Matches a new mask's contacts of vehicles, or of people, with what is known.
    pub fn look<'a>(&mut self, contacts: impl IntoIterator<Item = &'a Contact>) {
        let dt_s = self.since_look_s.max(TICK_S);
        self.since_look_s = 0.0;
        let known = std::mem::take(&mut self.tracks);
        let mut found = vec![false; known.len()];
        for blob in blobs(contacts) {
            let off = |t: &Track| blob.off_m(t.after(dt_s));
            let nearest = known.iter().enumerate().min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
            let same = nearest.filter(|(_, t)| off(t) < 2.0 + 0.1 * blob.at.0);
            self.tracks.push(match same {
                Some((index, t)) => {
                    found[index] = true;
                    t.seen_again(&blob, dt_s)
                }
                None => Track { at: blob.at, velocity_mps: (0.0, 0.0), looks: 0, unseen_s: 0.0 },
            });
        }
        let missed = known.iter().zip(found).filter(|(_, found)| !found).map(|(track, _)| track);
        self.tracks.extend(missed.filter_map(|track| track.beside(dt_s)));
    }

    /// How fast the vehicle of a contact drives ahead along an arc, m/s; 0 where its movement is not known yet.
    pub fn leads_mps(&self, contact: &Contact, arc: Arc) -> f32 {
        let off = |t: &Track| ops::hypot(t.at.0 - contact.x_m, t.at.1 - contact.y_m);
        let nearest = self.tracks.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        let same = nearest.filter(|t| off(t) < 2.0 + contact.depth_error_m && t.looks >= BELIEVED_AFTER);
        same.map_or(0.0, |t| {
            let (s_m, _) = arc.project(t.at.0, t.at.1);
            let (_, _, heading_rad) = arc.at(s_m);
            (t.velocity_mps.0 * ops::cos(heading_rad) + t.velocity_mps.1 * ops::sin(heading_rad)).max(0.0)
        })
    }

    /// Those whose movement is known and faster than `least_mps`.
    pub fn moving(&self, least_mps: f32) -> impl Iterator<Item = &Track> {
        let speed = |t: &Track| ops::hypot(t.velocity_mps.0, t.velocity_mps.1);
        self.tracks.iter().filter(move |t| t.looks >= BELIEVED_AFTER && speed(t) > least_mps)
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

/// A vehicle or a group of people in a mask.
struct Blob {
    /// Its nearest distance, the middle of its width.
    at: Point,
    /// As [`Contact::depth_error_m`], at its nearest.
    depth_error_m: f32,
    /// The contact that was added last, and how far to the left the first one is.
    last: Contact,
    left_m: f32,
}

impl Blob {
    fn of(contact: &Contact) -> Self {
        let at = (contact.x_m, contact.y_m);
        Self { at, depth_error_m: contact.depth_error_m, last: *contact, left_m: contact.y_m }
    }

    /// Whether a contact, farther right than the others, belongs to it.
    fn borders(&self, contact: &Contact) -> bool {
        let gap_m = GAP_M + GAP_PER_M * contact.x_m;
        (self.last.x_m - contact.x_m).abs() < 2.0 * gap_m && (self.last.y_m - contact.y_m).abs() < gap_m
    }

    fn add(&mut self, contact: &Contact) {
        if contact.x_m < self.at.0 {
            (self.at.0, self.depth_error_m) = (contact.x_m, contact.depth_error_m);
        }
        self.at.1 = 0.5 * (self.left_m + contact.y_m);
        self.last = *contact;
    }

    /// Where it is if it is as near to a point as the rows of pixels leave open: somewhere on the ray on which it is seen.
    fn nearest_to(&self, (x_m, _): Point) -> Point {
        sight::on_ray(self.at, x_m.clamp(self.at.0 - self.depth_error_m, self.at.0 + self.depth_error_m))
    }

    /// Distance to a point, beyond what the rows of pixels leave open.
    fn off_m(&self, at: Point) -> f32 {
        let nearest = self.nearest_to(at);
        ops::hypot(nearest.0 - at.0, nearest.1 - at.1)
    }
}

/// One for each vehicle or group of people, of contacts from left to right.
fn blobs<'a>(contacts: impl IntoIterator<Item = &'a Contact>) -> Vec<Blob> {
    let mut blobs: Vec<Blob> = Vec::new();
    for contact in contacts {
        match blobs.iter_mut().find(|blob| blob.borders(contact)) {
            Some(blob) => blob.add(contact),
            None => blobs.push(Blob::of(contact)),
        }
    }
    blobs
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

    #[test]
    fn who_leaves_the_picture_at_its_side_is_expected_to_go_on_and_who_vanishes_in_it_is_not() {
        let seen_for_s = |y_m: fn(f32) -> f32| {
            let mut tracks = Tracks::default();
            let mut look = |contacts: &[Contact]| {
                tracks.look(contacts);
                (0..6).for_each(|_| tracks.carry(STILL));
                tracks.moving(1.5).map(|track| track.at).next()
            };
            for tenths in 0..15 {
                look(&[Contact {
                    x_m: 12.0,
                    depth_error_m: 0.0,
                    y_m: y_m(0.1 * tenths as f32),
                    is_person: false,
                    on_road: true,
                }]);
            }
            let unseen: Vec<Point> = (0..60).map_while(|_| look(&[])).collect();
            (unseen.len(), unseen.last().copied())
        };
        // To the left at 5 m/s, out of the picture at once.
        let (looks, last) = seen_for_s(|t_s| 2.4 + 5.0 * t_s);
        assert!((28..=30).contains(&looks), "{looks}");
        assert!(last.is_some_and(|(x_m, y_m)| (x_m - 12.0).abs() < 0.5 && (y_m - 24.0).abs() < 1.5), "{last:?}");
        assert_eq!(seen_for_s(|t_s| -4.0 + 5.0 * t_s).0, 0, "in the middle of the picture");
    }

    #[test]
    fn velocities_are_over_ground() {
        let mut tracks = Tracks::default();
        let moved = Moved { forward_m: 0.1, turned_rad: 0.0 };
        // The car drives at 6 m/s; a vehicle crosses from the left at 4 m/s, another one stands.
        for look in 0..30 {
            let contact =
                |x_m: f32, y_m: f32| Contact { x_m, depth_error_m: 0.0, y_m, is_person: false, on_road: true };
            let away = 40.0 - 0.6 * look as f32;
            let crossing = 12.0 - 0.4 * look as f32;
            tracks.look(&[contact(away, crossing + 0.5), contact(away, crossing), contact(away + 2.0, -9.0)]);
            (0..6).for_each(|_| tracks.carry(moved));
        }
        let moving: Vec<_> = tracks.moving(1.5).collect();
        assert_eq!(moving.len(), 1);
        let (vx, vy) = moving[0].velocity_mps;
        assert!(vx.abs() < 0.5 && (vy + 4.0).abs() < 0.5, "{vx} {vy}");
        assert_eq!(STILL.shift((3.0, 4.0)), (3.0, 4.0));
    }
}

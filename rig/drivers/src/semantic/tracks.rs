//! How others move, by where they were seen before.

use kernel::ops;
use kernel::time::TICK_S;

use super::arc::{Arc, Point};
use super::moved::Moved;
use super::sight::{self, Contact};

/// Share of a new measurement in a velocity; half of it where the depth is known no better than this, metres; and most that
/// it changes, m/s.
const NEW_SHARE: f32 = 0.3;
const KNOWN_DEPTH_M: f32 = 2.0;
const MOST_CHANGE_MPS: f32 = 6.0;
/// An edge that seems faster than the rest by more than this is not the one that was seen before, m/s.
const OTHER_EDGE_MPS: f32 = 8.0;
/// Who shows no edge that was seen before is believed to go on across, unless what is seen moves less than this share of that.
const STAYS_SHARE: f32 = 0.3;
/// Gap that splits contacts into two vehicles, metres, and its growth with distance.
const GAP_M: f32 = 1.2;
const GAP_PER_M: f32 = 0.08;
/// Looks after which the velocity of a vehicle is believed.
const BELIEVED_AFTER: u32 = 4;
/// Who left the picture at its side is believed to go on for this long, seconds.
const REMEMBERED_S: f32 = 3.0;
/// For so long it is known where somebody was seen, and looks tell about a speed that are so far apart, seconds.
const SEEN_S: f32 = 3.0;
const LEAST_APART_S: f32 = 0.3;

/// Where somebody was seen.
#[derive(Clone, Copy, Debug)]
struct Seen {
    at: Point,
    /// As [`Contact::depth_error_m`].
    depth_error_m: f32,
    ago_s: f32,
}

/// Somebody who was seen more than once.
#[derive(Clone, Debug)]
pub struct Track {
    /// Its nearest point.
    pub at: Point,
    /// Velocity over ground, m/s.
    pub velocity_mps: Point,
    /// Its left and right edge, where they are in the picture.
    edges: [Option<Point>; 2],
    looks: u32,
    /// For so long it has been out of the picture, seconds.
    unseen_s: f32,
    /// Where it was seen in the last [`SEEN_S`], the newest last.
    seen: Vec<Seen>,
}

impl Track {
    fn new(blob: &Blob) -> Self {
        let (edges, seen) = (blob.edges(), vec![blob.seen()]);
        Self { at: blob.at, velocity_mps: (0.0, 0.0), edges, looks: 0, unseen_s: 0.0, seen }
    }

    /// How fast it is, m/s over ground.
    pub fn speed_mps(&self) -> f32 {
        ops::hypot(self.velocity_mps.0, self.velocity_mps.1)
    }

    /// How fast it may have come towards the car, at most, by the rows of pixels in which it was seen, m/s over ground: where
    /// it is not in the picture, as fast as it came before.
    pub fn approaches_at_most_mps(&self) -> f32 {
        let Some(now) = self.seen.last().filter(|_| self.unseen_s == 0.0) else { return -self.velocity_mps.0 };
        let bound_mps = |old: &Seen| {
            let nearer_m = old.at.0 + old.depth_error_m - (now.at.0 - now.depth_error_m);
            nearer_m / (old.ago_s - now.ago_s)
        };
        let older = self.seen.iter().filter(|old| old.ago_s - now.ago_s > LEAST_APART_S);
        older.map(bound_mps).fold(f32::INFINITY, f32::min).max(0.0)
    }

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
        let edges = blob.edges().map(|edge| edge.map(|edge| sight::on_ray(edge, edge.0 + at.0 - blob.at.0)));
        let to_left_m = self.to_left_m(&edges, dt_s).unwrap_or_else(|| {
            let (middle_m, expected_m) = (at.1 - self.at.1, self.velocity_mps.1 * dt_s);
            if middle_m.abs() < STAYS_SHARE * expected_m.abs() { middle_m } else { expected_m }
        });
        let velocity_mps = (along_mps, mix(self.velocity_mps.1, share, to_left_m));
        let seen = self.seen.iter().copied().chain([blob.seen()]).collect();
        Self { at, velocity_mps, edges, looks: self.looks + 1, unseen_s: 0.0, seen }
    }

    /// How far its edges have moved to the left, metres; unknown where none is seen again. The middle of what is seen moves as
    /// well when the picture cuts more of it, when more of it comes into view, and when it merges with others.
    fn to_left_m(&self, edges: &[Option<Point>; 2], dt_s: f32) -> Option<f32> {
        let moved_m = self.edges.iter().zip(edges).filter_map(|(old, new)| Some(new.as_ref()?.1 - old.as_ref()?.1));
        let is_same = |moved_m: &f32| (moved_m / dt_s - self.velocity_mps.1).abs() < OTHER_EDGE_MPS;
        let same: Vec<f32> = moved_m.filter(is_same).collect();
        (!same.is_empty()).then(|| same.iter().sum::<f32>() / same.len() as f32)
    }

    /// The same, if it has gone on unseen beside the picture.
    fn beside(self, dt_s: f32) -> Option<Self> {
        let gone_on = Self { at: self.after(dt_s), unseen_s: self.unseen_s + dt_s, ..self };
        let is_believed = gone_on.looks >= BELIEVED_AFTER && gone_on.unseen_s < REMEMBERED_S;
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
            track.edges.iter_mut().flatten().for_each(|edge| *edge = moved.shift(*edge));
            for seen in &mut track.seen {
                seen.at = moved.shift(seen.at);
                seen.ago_s += TICK_S;
            }
            track.seen.retain(|seen| seen.ago_s < SEEN_S);
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
                None => Track::new(&blob),
            });
        }
        let missed = known.into_iter().zip(found).filter(|(_, found)| !found).map(|(track, _)| track);
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

    /// Those whose movement is known.
    pub fn known(&self) -> impl Iterator<Item = &Track> {
        self.tracks.iter().filter(|track| track.looks >= BELIEVED_AFTER)
    }

    /// Those of them who are faster than `least_mps`.
    pub fn moving(&self, least_mps: f32) -> impl Iterator<Item = &Track> {
        self.known().filter(move |track| track.speed_mps() > least_mps)
    }
}

/// A vehicle or a group of people in a mask.
struct Blob {
    /// Its nearest distance, the middle of its width.
    at: Point,
    /// As [`Contact::depth_error_m`], at its nearest.
    depth_error_m: f32,
    /// Its contacts farthest to the left and to the right.
    first: Contact,
    last: Contact,
}

impl Blob {
    fn of(contact: &Contact) -> Self {
        let at = (contact.x_m, contact.y_m);
        Self { at, depth_error_m: contact.depth_error_m, first: *contact, last: *contact }
    }

    fn seen(&self) -> Seen {
        Seen { at: self.at, depth_error_m: self.depth_error_m, ago_s: 0.0 }
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
        self.at.1 = 0.5 * (self.first.y_m + contact.y_m);
        self.last = *contact;
    }

    /// Its left and right edge as far as they are in the picture: where the lower edge of that cuts both, as they are seen
    /// there.
    fn edges(&self) -> [Option<Point>; 2] {
        let edges = [&self.first, &self.last].map(|edge| Some(edge).filter(|c| sight::is_in_picture((c.x_m, c.y_m))));
        let whole = edges.map(|edge| edge.filter(|edge| !edge.is_cut));
        let known = if whole.iter().any(Option::is_some) { whole } else { edges };
        known.map(|edge| edge.map(|edge| (edge.x_m, edge.y_m)))
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
    fn who_leaves_the_picture_at_its_side_is_expected_to_go_on_and_who_vanishes_in_it_is_not() {
        let seen_for_s = |y_m: fn(f32) -> f32| {
            let mut tracks = Tracks::default();
            let mut look = |contacts: &[Contact]| {
                tracks.look(contacts);
                (0..6).for_each(|_| tracks.carry(STILL));
                tracks.moving(1.5).map(|track| track.at).next()
            };
            for tenths in 0..15 {
                look(&[Contact::of_car((12.0, y_m(0.1 * tenths as f32)))]);
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
            let contact = |x_m: f32, y_m: f32| Contact::of_car((x_m, y_m));
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

    /// The greatest speed across that is believed of what is seen in each look, a tenth of a second apart, while the car drives
    /// at 6 m/s.
    fn fastest_across_mps(looks: impl Iterator<Item = Vec<Contact>>) -> f32 {
        let (mut tracks, mut fastest_mps) = (Tracks::default(), 0.0_f32);
        for contacts in looks {
            tracks.look(&contacts);
            fastest_mps = tracks.known().map(|track| track.velocity_mps.1.abs()).fold(fastest_mps, f32::max);
            (0..6).for_each(|_| tracks.carry(Moved { forward_m: 0.1, turned_rad: 0.0 }));
        }
        fastest_mps
    }

    /// Contacts of a vehicle's rear as far as the picture shows it, from left to right.
    fn rear(x_m: f32, right_m: f32) -> impl Iterator<Item = Contact> {
        let across = (0..=18).rev().map(move |i| Contact::of_car((x_m, right_m + 0.1 * i as f32)));
        across.filter(|contact| sight::is_in_front((contact.x_m, contact.y_m)))
    }

    #[test]
    fn parked_cars_that_leave_the_picture_or_merge_in_it_do_not_move() {
        let passed = |look: i32| rear(30.0 - 0.6 * look as f32, -4.2).collect();
        let leaving_mps = fastest_across_mps((0..48).map(passed));
        let row = |look: i32| {
            let nearest = rear(20.0 - 0.2 * look as f32, -4.2);
            // The one behind it seems to belong to it in every third look.
            let behind = rear(21.0 - 0.2 * look as f32, -2.0 + if look % 3 == 0 { 0.2 } else { 2.2 });
            behind.chain(nearest).collect()
        };
        let merging_mps = fastest_across_mps((0..40).map(row));
        assert!(leaving_mps < 0.5 && merging_mps < 1.5, "{leaving_mps} {merging_mps} m/s");
    }

    /// A bin between the car and its picture's side, whose edge seemed to be that of who drove by behind it.
    #[test]
    fn who_shows_no_edge_is_not_believed_to_move_for_ever() {
        let mut tracks = Tracks::default();
        let cut = |y_m: f32| Contact { is_cut: true, ..Contact::of_car((6.5, y_m)) };
        for look in 0..60 {
            match look {
                0..10 => tracks.look(&[Contact::of_car((6.5, 3.9 - 0.6 * (9 - look) as f32))]),
                _ => tracks.look(&[cut(4.1), cut(3.8)]),
            }
            (0..6).for_each(|_| tracks.carry(STILL));
            let is_moving = tracks.moving(1.5).next().is_some();
            assert!(if look < 10 { look < 8 || is_moving } else { look < 30 || !is_moving }, "{look}: {tracks:?}");
        }
    }

    #[test]
    fn who_comes_into_the_picture_from_its_side_is_seen_to_move() {
        // 12 m in front of the car, which drives towards its way.
        let across = |look: i32| rear(24.0 - 0.6 * look as f32, -16.0 + 0.5 * look as f32).collect();
        let mps = fastest_across_mps((0..24).map(across));
        assert!((4.0..6.0).contains(&mps), "{mps} m/s");
    }

    /// It pushes in from the right right before the car, nearer than the picture shows the ground.
    #[test]
    fn who_is_cut_by_the_lower_edge_is_seen_to_come_across() {
        let mut tracks = Tracks::default();
        for look in 0..12 {
            let left_m = -3.0 + 0.25 * look as f32;
            let cut = |i: i32| Contact { is_cut: true, ..Contact::of_car((5.5, left_m - 0.1 * i as f32)) };
            let contacts: Vec<Contact> = (0..20).map(cut).collect();
            tracks.look(contacts.iter().filter(|c| sight::is_in_front((c.x_m, c.y_m))));
            (0..6).for_each(|_| tracks.carry(STILL));
        }
        let mps = tracks.known().map(|track| track.velocity_mps.1).fold(0.0, f32::max);
        assert!((1.5..3.5).contains(&mps), "{mps} m/s");
    }
}

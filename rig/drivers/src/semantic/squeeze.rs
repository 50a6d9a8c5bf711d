//! A way out of stand-offs: after a while before something that stands in the way, at a walking pace along an arc beside it.

use kernel::ego::FRONT_M;
use kernel::ops;
use kernel::time::TICK_S;

use super::arc::{Arc, HALF_WIDTH_M, Point, SHARPEST};
use super::flank;
use super::moved::Moved;
use super::sight::{self, Contact, Ground, Sight};
use super::tracks::Tracks;

/// So long the car stands before it tries, seconds.
const WAITED_S: f32 = 30.0;
/// Its speed then, m/s, and how far it goes like this, metres: until it is back in its lane.
pub const SQUEEZING_MPS: f32 = 0.9;
const FARTHEST_M: f32 = 14.0;
/// Arcs that are tried on each side of straight ahead.
const TRIED: i16 = 40;
/// A way that is driven is kept as if turning away from it were so much of turning away from the wanted one.
const STEADY: f32 = 0.5;
/// Room beside vehicles and people, metres; less beside those whom the car already stands next to.
const BESIDE_VEHICLE_M: f32 = 0.3;
const BESIDE_WALKER_M: f32 = 0.6;
const NEXT_TO_M: f32 = 0.1;
/// Beside what is nearer than this to the car's flanks, and to the way of its front so far ahead, metres, it drives the slower,
/// the less room there is: so fast, m/s, where there is none, and so much faster for each metre, m/s.
const NARROW_M: f32 = 0.5;
const NARROW_AHEAD_M: f32 = 2.0;
const NARROW_MPS: f32 = 0.8;
const NARROW_PER_S: f32 = 4.0;
/// Arcs sharper than this turn to a side, and than this so much that the car's flank sweeps over what is beside it, 1/m.
const TURNS_TO: f32 = 0.01;
const SWEEPS: f32 = 0.06;
/// Room before the car that makes an arc a way by, metres.
const FREE_M: f32 = 5.5;
/// Who moves faster than this, within this distance, is let pass first, m/s and metres.
const MOVING_MPS: f32 = 0.5;
const LET_PASS_M: f32 = 15.0;

/// Who was not looked at for so long may have gone, seconds.
const FORGOTTEN_S: f32 = 45.0;
/// Who moves is this near to where it was seen, metres.
const ONE_BODY_M: f32 = 3.0;
/// Who leaves the picture of a car that creeps less than this has driven off, metres.
const CREPT_M: f32 = 0.1;
/// What would be so far inside the car by now has moved since it was seen, metres: what is told of places is no better.
const INSIDE_M: f32 = 0.2;

/// Where somebody's lowest part is, the nearest place where what the picture cuts may be, the ground that is hidden, and how
/// long ago that was seen.
#[derive(Clone, Copy, Debug)]
struct Spot {
    at: Point,
    nearest: Option<Point>,
    hides: Point,
    is_person: bool,
    unseen_s: f32,
}

impl Spot {
    fn of(contact: &Contact) -> Self {
        let hides = (contact.x_m, contact.y_m);
        Self { at: contact.lowest(), nearest: contact.nearest(), hides, is_person: contact.is_person, unseen_s: 0.0 }
    }

    /// What is below the picture beside the car.
    fn below(at: Point) -> Self {
        Self { at, nearest: None, hides: at, is_person: false, unseen_s: 0.0 }
    }

    /// Carries it along while the car moves.
    fn carry(&mut self, moved: Moved) {
        (self.at, self.hides) = (moved.shift(self.at), moved.shift(self.hides));
        self.nearest = self.nearest.map(|at| moved.shift(at));
    }

    /// Whether the car is by now where it was.
    fn is_inside(&self) -> bool {
        (INSIDE_M..FRONT_M - INSIDE_M).contains(&self.at.0) && self.at.1.abs() < HALF_WIDTH_M - INSIDE_M
    }

    /// Metres before the front of the car along an arc until it would touch it; none if it would not. A turn towards what
    /// the picture cuts has to clear all of that.
    fn touches_m(&self, arc: Arc) -> Option<f32> {
        self.touches_at_m(self.at, arc).into_iter().chain(self.touches_cut_m(arc, TURNS_TO)).reduce(f32::min)
    }

    /// The same of what the picture cuts, for an arc that turns towards it more sharply than `turns_to`.
    fn touches_cut_m(&self, arc: Arc, turns_to: f32) -> Option<f32> {
        let turned_to = self.nearest.filter(|at| arc.curvature * at.1.signum() > turns_to);
        turned_to.and_then(|at| self.touches_at_m(at, arc))
    }

    fn touches_at_m(&self, at: Point, arc: Arc) -> Option<f32> {
        let beside_m = if self.is_person { BESIDE_WALKER_M } else { BESIDE_VEHICLE_M };
        let (s_m, room_m) = room_m(arc, at);
        let least_m = if s_m < FRONT_M { NEXT_TO_M } else { beside_m };
        (at.0 > 0.0 && room_m < least_m).then_some((s_m - FRONT_M).max(0.0))
    }

    /// How fast the car drives by on an arc, m/s.
    fn narrow_mps(&self, arc: Arc) -> f32 {
        let (s_m, room_m) = room_m(arc, self.at);
        let is_beside = !self.is_person && self.at.0 > 0.0 && s_m < FRONT_M + NARROW_AHEAD_M && room_m < NARROW_M;
        if is_beside { NARROW_MPS + NARROW_PER_S * room_m.max(0.0) } else { f32::INFINITY }
    }
}

/// Metres along an arc to a place, and of room between that and the car.
fn room_m(arc: Arc, at: Point) -> (f32, f32) {
    let (s_m, left_m) = arc.project(at.0, at.1);
    (s_m, left_m.abs() - if s_m < FRONT_M { HALF_WIDTH_M } else { arc.swept_m(left_m) })
}

/// A way beside what stands there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    /// The arc that leads by.
    pub arc: Arc,
    /// Metres that are free before the front of the car.
    pub free_m: f32,
}

/// How long the car has stood, and its way by, once it has one.
#[derive(Clone, Debug, Default)]
pub struct Squeeze {
    stood_s: f32,
    way: Option<Way>,
    driven_m: f32,
    since_look_m: f32,
    /// What the last mask showed and what of that goes on below it, what one showed before the car crept so far since, and
    /// what left the picture meanwhile.
    seen: Vec<Spot>,
    flanks: Vec<Spot>,
    before: Vec<Spot>,
    crept_m: f32,
    gone: Vec<Spot>,
}

impl Squeeze {
    /// The way that is to be driven now.
    pub fn way(&self) -> Option<Way> {
        self.way
    }

    /// Carries what is known along while the car moves; `waits` for something that stands in its way.
    pub fn carry(&mut self, moved: Moved, waits: bool) {
        let known = [&mut self.seen, &mut self.flanks, &mut self.before, &mut self.gone];
        known.into_iter().flatten().for_each(|spot| spot.carry(moved));
        self.gone.iter_mut().for_each(|spot| spot.unseen_s += TICK_S);
        self.gone.retain(|spot| spot.at.0 > 0.0 && spot.unseen_s < FORGOTTEN_S);
        if let Some(left) = self.gone.iter().find(|spot| spot.is_inside()).map(|spot| spot.at) {
            self.gone.retain(|spot| !is_of(left, spot));
        }
        self.since_look_m += moved.forward_m;
        self.driven_m += moved.forward_m;
        if let Some(way) = &mut self.way {
            way.free_m -= moved.forward_m;
        } else {
            // Who backs off makes room to go on at once.
            let backs_off = moved.forward_m < 0.0;
            let stands = waits && moved.forward_m == 0.0;
            self.stood_s += if stands { TICK_S } else { 0.0 };
            self.stood_s = if stands || backs_off { self.stood_s } else { 0.0 };
            self.driven_m = 0.0;
        }
        if self.driven_m > FARTHEST_M {
            (self.stood_s, self.way, self.driven_m) = (0.0, None, 0.0);
        }
    }

    /// Takes in a mask: the way beside what it shows that turns least from the wanted one.
    pub fn look(&mut self, sight: &Sight<'_>, contacts: &[Contact], others: &[&Tracks], wanted: Arc) {
        self.seen = contacts.iter().map(Spot::of).collect();
        self.flanks = flank::below_picture(contacts).into_iter().map(Spot::below).collect();
        let crept_m = std::mem::take(&mut self.since_look_m);
        self.crept_m += crept_m;
        // Who leaves the picture of a car that stands has driven off.
        if self.crept_m > CREPT_M {
            self.gone.extend(self.before.drain(..).filter(|spot| is_hidden(sight, spot.hides)));
        }
        if crept_m == 0.0 || self.crept_m > CREPT_M {
            (self.before, self.crept_m) = (self.seen.clone(), 0.0);
        }
        let moving = || others.iter().flat_map(|others| others.moving(MOVING_MPS)).map(|track| track.at);
        self.gone.retain(|spot| moving().all(|at| !is_of(at, spot)));
        if self.stood_s < WAITED_S {
            return;
        }
        let is_near = |at: Point| at.0 > 0.0 && ops::hypot(at.0, at.1) < LET_PASS_M;
        self.way = if moving().any(is_near) {
            self.way.map(|way| Way { free_m: 0.0, ..way })
        } else {
            self.best(sight, wanted)
        };
    }

    /// Metres before the front of the car along an arc until it would touch what is not in the picture, or sweep over what
    /// that cuts; none if it would not.
    pub fn beside_m(&self, arc: Arc) -> Option<f32> {
        let swept = self.seen.iter().filter_map(|spot| spot.touches_cut_m(arc, SWEEPS));
        self.unseen().filter_map(|spot| spot.touches_m(arc)).chain(swept).reduce(f32::min)
    }

    /// How fast the car drives along an arc beside what stands next to it, seen or no more, m/s.
    pub fn narrow_mps(&self, arc: Arc) -> f32 {
        let known = self.seen.iter().chain(&self.flanks).chain(&self.gone);
        known.map(|spot| spot.narrow_mps(arc)).fold(f32::INFINITY, f32::min)
    }

    fn best(&self, sight: &Sight<'_>, wanted: Arc) -> Option<Way> {
        let arcs = (-TRIED..=TRIED).map(|step| Arc { curvature: SHARPEST * f32::from(step) / f32::from(TRIED) });
        let ways = arcs.map(|arc| Way { arc, free_m: self.free_m(arc) });
        let present = self.way.map_or(wanted, |way| way.arc);
        let off = |way: &Way, arc: Arc| (way.arc.curvature - arc.curvature).abs();
        let turns = |way: &Way| off(way, wanted) + STEADY * off(way, present);
        let open = ways.filter(|way| way.free_m >= FREE_M && is_road(sight, way.arc));
        open.min_by(|a, b| turns(a).total_cmp(&turns(b)))
    }

    /// Metres before the front of the car along an arc until it would touch something.
    fn free_m(&self, arc: Arc) -> f32 {
        self.seen.iter().chain(self.unseen()).filter_map(|spot| spot.touches_m(arc)).fold(f32::INFINITY, f32::min)
    }

    /// What left the picture, and what is before the car below it: a flank may have ended where the car is by now.
    fn unseen(&self) -> impl Iterator<Item = &Spot> {
        self.gone.iter().chain(self.flanks.iter().filter(|spot| spot.at.0 > FRONT_M))
    }
}

/// Whether what is somewhere may be what was seen.
fn is_of(at: Point, spot: &Spot) -> bool {
    ops::hypot(at.0 - spot.at.0, at.1 - spot.at.1) < ONE_BODY_M
}

fn is_hidden(sight: &Sight<'_>, at: Point) -> bool {
    sight.ground(at.0, at.1) == Ground::Unseen
}

/// Whether the middle of the car's front goes where the ground is seen or right below the picture, and its sides on the road
/// as far as they are seen.
fn is_road(sight: &Sight<'_>, arc: Arc) -> bool {
    let stays = |s_m: f32| {
        let is_before = sight::is_in_front(arc.beside(s_m, 0.0));
        is_before
            && [-HALF_WIDTH_M, HALF_WIDTH_M].into_iter().all(|left_m| {
                let (x_m, y_m) = arc.beside(s_m, left_m);
                sight.ground(x_m, y_m) != Ground::Other
            })
    };
    (0..=4).all(|metre| stays(FRONT_M + f32::from(metre as u8)))
}

#[cfg(test)]
mod tests {
    use kernel::ego;
    use render::SemanticTag;

    use super::*;
    use crate::MaskView;

    const WIDTH: usize = 256;
    const HEIGHT: usize = 128;
    const STRAIGHT: Arc = Arc { curvature: 0.0 };
    const STILL: Moved = Moved { forward_m: 0.0, turned_rad: 0.0 };

    fn on_asphalt<T>(act: impl FnOnce(&Sight<'_>) -> T) -> T {
        let ids = vec![SemanticTag::Road as u8; WIDTH * HEIGHT];
        act(&Sight::new(MaskView { width: WIDTH, height: HEIGHT, ids: &ids }, 0.0))
    }

    fn contact(at: Point, is_person: bool) -> Contact {
        Contact { is_person, ..Contact::of_car(at) }
    }

    fn vehicle_rear(x_m: f32, right_m: f32, left_m: f32) -> Vec<Contact> {
        let steps = ((left_m - right_m) / 0.1) as usize;
        (0..=steps).map(|i| contact((x_m, right_m + 0.1 * i as f32), false)).collect()
    }

    /// What is found after so long before some contacts.
    fn after_s(contacts: &[Contact], waited_s: f32) -> Option<Way> {
        let mut squeeze = Squeeze::default();
        (0..(waited_s / TICK_S) as usize).for_each(|_| squeeze.carry(STILL, true));
        on_asphalt(|sight| squeeze.look(sight, contacts, &[], STRAIGHT));
        squeeze.way()
    }

    #[test]
    fn it_leads_by_on_the_side_that_is_free_but_not_at_once() {
        let beside = |side: f32| {
            let rear = vehicle_rear(8.0, -3.0, -0.5);
            rear.into_iter().map(|c| Contact { y_m: side * c.y_m, ..c }).collect::<Vec<_>>()
        };
        assert_eq!(after_s(&beside(1.0), WAITED_S - 1.0), None);
        let [left, right] = [1.0, -1.0].map(|side| after_s(&beside(side), WAITED_S + 1.0).expect("there is a way"));
        assert!(left.arc.curvature > 0.01 && right.arc.curvature < -0.01, "{left:?} {right:?}");
        assert_eq!(after_s(&vehicle_rear(6.5, -8.0, 8.0), WAITED_S + 1.0), None, "from side to side");
    }

    #[test]
    fn who_has_backed_off_after_waiting_goes_by_at_once() {
        let after = |moved: Moved| {
            let mut squeeze = Squeeze::default();
            (0..1860).for_each(|_| squeeze.carry(STILL, true));
            (0..60).for_each(|_| squeeze.carry(moved, true));
            on_asphalt(|sight| squeeze.look(sight, &vehicle_rear(8.0, -3.0, -0.5), &[], STRAIGHT));
            squeeze.way().is_some()
        };
        assert!(after(Moved { forward_m: -0.01, turned_rad: 0.0 }));
        assert!(!after(Moved { forward_m: 0.01, turned_rad: 0.0 }), "who drives on has not waited");
    }

    /// What stands there is nearer to the left edge than to the right one, and seems the other way round later.
    #[test]
    fn it_keeps_to_its_side() {
        let mut squeeze = Squeeze::default();
        (0..1860).for_each(|_| squeeze.carry(STILL, true));
        let mut side = |right_m: f32, left_m: f32| {
            on_asphalt(|sight| squeeze.look(sight, &vehicle_rear(9.0, right_m, left_m), &[], STRAIGHT));
            squeeze.way().expect("there is a way").arc.curvature.signum()
        };
        assert_eq!([side(-1.0, 0.6), side(-0.7, 0.8), side(-0.2, 3.0)], [1.0, 1.0, -1.0]);
    }

    #[test]
    fn it_leads_past_somebody_at_the_kerb_who_waits() {
        let way = after_s(&[contact((9.0, -2.2), true)], WAITED_S + 1.0).expect("there is room");
        assert!(way.arc.curvature.abs() < 0.02, "{way:?}");
        let way = after_s(&[contact((9.0, -1.2), true)], WAITED_S + 1.0).expect("there is room on the left");
        assert!(way.arc.curvature > 0.005, "{way:?}");
    }

    #[test]
    fn it_lets_pass_who_moves() {
        let mut vehicles = Tracks::default();
        for look in 0..10 {
            vehicles.look(&[contact((12.0 - 0.4 * look as f32, 3.0), false)]);
            (0..6).for_each(|_| vehicles.carry(STILL));
        }
        let mut squeeze = Squeeze::default();
        (0..2400).for_each(|_| squeeze.carry(STILL, true));
        on_asphalt(|sight| squeeze.look(sight, &vehicle_rear(8.0, -3.0, -0.5), &[&vehicles], STRAIGHT));
        assert_eq!(squeeze.way(), None);
    }

    /// A lorry stands in the way, 9 m long: most of its side is beside the picture while the car drives past.
    #[test]
    fn it_does_not_touch_what_it_no_longer_sees() {
        let lorry: Vec<Point> = {
            let rear = vehicle_rear(7.6, -2.8, -0.3).into_iter().map(|c| (c.x_m, c.y_m));
            rear.chain((0..=90).map(|i| (7.6 + 0.1 * i as f32, -0.3))).collect()
        };
        let (mut squeeze, mut points, mut driven_m) = (Squeeze::default(), lorry, 0.0);
        (0..1860).for_each(|_| squeeze.carry(STILL, true));
        for tick in 0..900 {
            if tick % 6 == 0 {
                on_asphalt(|sight| {
                    let seen = points.iter().filter(|at| !is_hidden(sight, **at));
                    let contacts: Vec<Contact> = seen.map(|at| contact(*at, false)).collect();
                    squeeze.look(sight, &contacts, &[], STRAIGHT);
                });
            }
            let way = squeeze.way().filter(|way| way.free_m > 0.2);
            let moved = way.map_or(STILL, |way| Moved::along(way.arc, SQUEEZING_MPS));
            driven_m += moved.forward_m;
            points.iter_mut().for_each(|at| *at = moved.shift(*at));
            squeeze.carry(moved, true);
            let rear_m = FRONT_M - ego::SIZE_M.x;
            let is_hit = |at: &&Point| (rear_m..FRONT_M).contains(&at.0) && at.1.abs() < HALF_WIDTH_M;
            assert_eq!(points.iter().find(is_hit), None, "after {driven_m} m");
        }
        assert!(driven_m > 10.0, "{driven_m} m");
    }

    /// What was seen at the picture's edge after the car crept a metre, and is not seen any more.
    fn left_behind(contact: Contact, others: &[&Tracks]) -> Squeeze {
        let mut squeeze = Squeeze::default();
        on_asphalt(|sight| squeeze.look(sight, &[contact], others, STRAIGHT));
        squeeze.carry(Moved { forward_m: 1.0, turned_rad: 0.0 }, true);
        on_asphalt(|sight| squeeze.look(sight, &[], others, STRAIGHT));
        squeeze
    }

    #[test]
    fn what_left_the_picture_beside_the_car_is_in_the_way_of_a_turn_until_it_is_forgotten() {
        let mut squeeze = left_behind(Contact::of_car((6.2, 2.2)), &[]);
        let left = Arc { curvature: 0.15 };
        assert!(squeeze.beside_m(left).is_some_and(|m| m < 2.0), "{:?}", squeeze.beside_m(left));
        assert_eq!([STRAIGHT, Arc { curvature: -0.15 }].map(|arc| squeeze.beside_m(arc)), [None; 2]);
        (0..(FORGOTTEN_S / TICK_S) as usize + 2).for_each(|_| squeeze.carry(STILL, true));
        assert_eq!(squeeze.beside_m(left), None);
    }

    #[test]
    fn it_creeps_by_what_is_next_to_it_in_sight_or_not() {
        let beside = |room_m: f32| left_behind(Contact::of_car((6.2, HALF_WIDTH_M + room_m)), &[]).narrow_mps(STRAIGHT);
        let [none, near, some, wide] = [0.0, 0.6, 0.9, 1.4].map(beside);
        // The bumper is nearer than the ground that it hides.
        assert!(none == NARROW_MPS && (1.0..2.5).contains(&near) && near < some, "{none} {near} {some}");
        assert_eq!(wide, f32::INFINITY);
        let mut squeeze = Squeeze::default();
        on_asphalt(|sight| squeeze.look(sight, &[Contact::of_car((FRONT_M + 5.0, 1.2))], &[], STRAIGHT));
        assert_eq!(squeeze.narrow_mps(STRAIGHT), f32::INFINITY, "not there yet");
    }

    /// The flank of a vehicle beside the car hides the ground beyond it.
    #[test]
    fn what_the_picture_cuts_may_come_nearer() {
        let at = |is_cut: bool| Contact { is_cut, ..Contact::of_car((4.2, 2.6)) };
        let left = Arc { curvature: 0.1 };
        let touches = |is_cut: bool| Spot::of(&at(is_cut)).touches_m(left);
        assert!(touches(true).is_some() && touches(false).is_none(), "{:?} {:?}", touches(true), touches(false));
    }

    /// A car stands on the inner side of a sharp turn, so near that its wheels are below the picture.
    #[test]
    fn a_sharp_turn_waits_for_what_the_picture_cuts_and_a_wide_one_drives_by() {
        let mut squeeze = Squeeze::default();
        let cut = Contact { is_cut: true, ..Contact::of_car((5.5, 2.6)) };
        on_asphalt(|sight| squeeze.look(sight, &[cut], &[], STRAIGHT));
        let waits = |curvature: f32| squeeze.beside_m(Arc { curvature }).is_some();
        assert_eq!([0.12, 0.03, 0.0, -0.12].map(waits), [true, false, false, false]);
    }

    /// A car that stands askew: its near corner is below the picture, in the line of the flank that is seen.
    #[test]
    fn it_goes_round_the_corner_of_a_flank_below_the_picture() {
        let mut squeeze = Squeeze::default();
        let flank: Vec<Contact> = (0..=20)
            .map(|i| Contact { is_cut: i == 0, ..Contact::of_car((5.55 + 0.12 * i as f32, 1.5 + 0.03 * i as f32)) })
            .collect();
        on_asphalt(|sight| squeeze.look(sight, &flank, &[], STRAIGHT));
        assert!(squeeze.beside_m(STRAIGHT).is_some() && squeeze.narrow_mps(STRAIGHT) < 1.5);
        assert_eq!(squeeze.beside_m(Arc { curvature: -0.1 }), None);
    }

    #[test]
    fn who_drives_off_is_not_remembered_where_it_stood() {
        let mut driving = Tracks::default();
        for look in 0..10 {
            driving.look(&[Contact::of_car((5.2 + 0.1 * look as f32, 2.0))]);
            (0..6).for_each(|_| driving.carry(STILL));
        }
        assert_eq!(left_behind(Contact::of_car((6.2, 2.2)), &[&driving]).beside_m(Arc { curvature: 0.15 }), None);
    }

    /// Oncoming cars pass a car that stands before a narrow place, and moves by a hand's breadth now and then.
    #[test]
    fn who_drives_by_a_car_that_hardly_moves_is_not_remembered() {
        let passes_while = |crept_m: f32| {
            let mut squeeze = Squeeze::default();
            for look in 0..40 {
                let contacts = if look % 4 < 2 { vec![Contact::of_car((6.2, 2.2))] } else { Vec::new() };
                on_asphalt(|sight| squeeze.look(sight, &contacts, &[], STRAIGHT));
                let is_moving = look % 4 == 1;
                squeeze.carry(if is_moving { Moved { forward_m: crept_m, turned_rad: 0.0 } } else { STILL }, true);
            }
            squeeze.beside_m(Arc { curvature: 0.15 }).is_some()
        };
        assert_eq!([0.03, 1.0].map(passes_while), [false, true]);
    }

    /// A vehicle's flank left the picture while both moved, and the car drives on over where it was.
    #[test]
    fn what_the_car_drives_over_is_not_remembered() {
        let left = Arc { curvature: 0.15 };
        let behind = |y_m: f32| {
            let mut squeeze = left_behind(Contact::of_car((6.2, y_m)), &[]);
            let was = squeeze.beside_m(left).is_some();
            (0..150).for_each(|_| squeeze.carry(Moved { forward_m: 0.01, turned_rad: 0.0 }, true));
            (was, squeeze.beside_m(left).is_some())
        };
        assert_eq!([behind(0.6), behind(HALF_WIDTH_M + 0.2)], [(true, false), (true, true)]);
    }

    /// The lower edge of a bumper hides ground that is farther away.
    #[test]
    fn bumpers_are_nearer_than_the_ground_that_they_hide_and_those_of_lorries_nearer_still() {
        let camera = render::Camera::driver(2, 1).position;
        let at = |height_m: f32, is_person: bool| {
            Spot::of(&Contact { height_m, is_person, ..Contact::of_car((camera.x + 6.0, 3.0)) }).at
        };
        let (car, lorry) = (at(1.4, false), at(2.8, false));
        assert!((car.0 - camera.x - 5.2).abs() < 1e-3 && (car.1 - 2.6).abs() < 1e-3, "{car:?}");
        assert!((lorry.0 - camera.x - 4.6).abs() < 1e-3, "{lorry:?}");
        assert_eq!(at(1.7, true), (camera.x + 6.0, 3.0), "feet are on the ground");
    }

    /// Nothing is known of what lies beside the picture: the pavement, perhaps.
    #[test]
    fn it_does_not_turn_out_of_its_picture() {
        on_asphalt(|sight| {
            assert!([0.0, 0.1, -0.1].into_iter().all(|curvature| is_road(sight, Arc { curvature })));
            assert!(!is_road(sight, Arc { curvature: SHARPEST }) && !is_road(sight, Arc { curvature: -SHARPEST }));
        });
    }
}

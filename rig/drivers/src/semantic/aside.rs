//! Beside what stands next to its way, or comes along it, the car keeps aside within its lane.

use kernel::ego::FRONT_M;

use super::arc::{Arc, HALF_WIDTH_M};
use super::sight::{Contact, Ground, Sight};
use super::tracks::Tracks;

/// Room that is kept to vehicles where there is some, metres, and most that is gone aside for it: the car stays in its lane.
const ROOM_M: f32 = 0.6;
const MOST_M: f32 = 0.5;
/// Who reaches so far into the car's way is in it, and waited for, metres; so far before them nobody is gone aside for.
const IN_THE_WAY_M: f32 = 0.4;
const BEFORE_THEM_M: f32 = 1.5;
/// Who is nearer than this is looked at, metres along the way.
const NEAR_M: f32 = 14.0;
/// The way that it takes at least to get aside, metres.
const WITHIN_M: f32 = 6.0;
/// Half of the width that has to be asphalt, metres.
const HALF_TRACK_M: f32 = 1.0;
/// Who drives ahead faster than this is followed, m/s.
const DRIVES_MPS: f32 = 0.5;

/// Where the car goes.
#[derive(Clone, Copy, Debug)]
pub struct Course {
    /// Where arrow and lane lead.
    pub wanted: Arc,
    /// The same, aside of what is near.
    pub steered: Arc,
}

impl Course {
    /// With nobody to go aside for.
    pub fn straight_on(wanted: Arc) -> Self {
        Self { wanted, steered: wanted }
    }

    /// Along an arc, aside of those whom the mask shows next to it, if there is asphalt.
    pub fn aside(sight: &Sight<'_>, wanted: Arc, contacts: &[Contact], vehicles: &Tracks) -> Self {
        let beside = contacts.iter().filter(|contact| !contact.is_person).map(|contact| {
            let (s_m, left_m) = wanted.project(contact.x_m, contact.y_m);
            (contact, s_m, left_m)
        });
        let near: Vec<_> = beside.filter(|(_, s_m, _)| (FRONT_M..NEAR_M).contains(s_m)).collect();
        let is_in_the_way = |left_m: f32| left_m.abs() < HALF_WIDTH_M - IN_THE_WAY_M;
        let blocked_m = near.iter().filter(|(.., left_m)| is_in_the_way(*left_m)).map(|(_, s_m, _)| *s_m);
        let to_m = blocked_m.reduce(f32::min).map_or(NEAR_M, |s_m| s_m - BEFORE_THEM_M);
        let narrow = near.iter().filter(|(contact, s_m, left_m)| {
            let is_followed = || vehicles.leads_mps(contact, wanted) > DRIVES_MPS;
            *s_m < to_m && left_m.abs() < wanted.swept_m(*left_m) + ROOM_M && !is_followed()
        });
        // Metres that are missing on either side, and where.
        let mut missing = [(0.0_f32, NEAR_M); 2];
        for (_, s_m, left_m) in narrow {
            let missing_m = wanted.swept_m(*left_m) + ROOM_M - left_m.abs();
            let side = &mut missing[usize::from(*left_m < 0.0)];
            *side = if missing_m > side.0 { (missing_m, *s_m) } else { *side };
        }
        let [left, right] = missing;
        let shift_m = right.0.min(MOST_M) - left.0.min(MOST_M);
        let s_m = if left.0 > right.0 { left.1 } else { right.1 }.max(WITHIN_M);
        let is_road = |left_m: f32| {
            let (x_m, y_m) = wanted.beside(s_m, left_m);
            sight.ground(x_m, y_m) != Ground::Other
        };
        if shift_m == 0.0 || !is_road(shift_m + HALF_TRACK_M.copysign(shift_m)) {
            return Self::straight_on(wanted);
        }
        let (x_m, y_m) = wanted.beside(s_m, shift_m);
        Self { wanted, steered: Arc::to(x_m, y_m) }
    }

    /// The arc on which it comes by a place so far ahead.
    pub fn by(&self, x_m: f32) -> Arc {
        if x_m < NEAR_M { self.steered } else { self.wanted }
    }
}

#[cfg(test)]
mod tests {
    use render::SemanticTag;

    use super::*;
    use crate::MaskView;
    use crate::semantic::moved::Moved;

    const AHEAD: Arc = Arc { curvature: 0.0 };

    /// Metres to the left of straight ahead after `s_m`, with these contacts and the ground of one tag.
    fn left_at_m(s_m: f32, places: &[(f32, f32)], tag: SemanticTag, vehicles: &Tracks) -> f32 {
        let ids = vec![tag as u8; 256 * 128];
        let sight = Sight::new(MaskView { width: 256, height: 128, ids: &ids }, 0.0);
        let contacts: Vec<Contact> = places.iter().map(|at| Contact::of_car(*at)).collect();
        Course::aside(&sight, AHEAD, &contacts, vehicles).by(s_m).at(s_m).1
    }

    #[test]
    fn it_leaves_room_to_a_door_and_to_who_waits_beside_its_way() {
        let at_8_m = |places: &[(f32, f32)]| left_at_m(8.0, places, SemanticTag::Road, &Tracks::default());
        let door = (8.0, -HALF_WIDTH_M - 0.2);
        assert!((at_8_m(&[door]) - 0.4).abs() < 0.05, "{}", at_8_m(&[door]));
        assert!((at_8_m(&[(8.0, HALF_WIDTH_M)]) + MOST_M).abs() < 0.05, "not out of its lane");
        // With as little room on both sides, far enough away, and far ahead.
        assert!(at_8_m(&[door, (8.0, HALF_WIDTH_M + 0.2)]).abs() < 1e-3);
        assert_eq!([(8.0, -1.7), (20.0, -1.1)].map(|at| at_8_m(&[at])), [0.0; 2]);
        assert_eq!(left_at_m(20.0, &[door], SemanticTag::Road, &Tracks::default()), 0.0, "back in the lane");
        assert_eq!(left_at_m(8.0, &[door], SemanticTag::SideWalk, &Tracks::default()), 0.0, "no asphalt");
    }

    #[test]
    fn it_goes_aside_neither_behind_who_is_in_its_way_nor_to_pass_who_drives_ahead() {
        let mut bicycle = Tracks::default();
        for look in 0..10 {
            bicycle.look(&[Contact::of_car((6.0 + 0.3 * look as f32, -1.1))]);
            (0..6).for_each(|_| bicycle.carry(Moved { forward_m: 0.0, turned_rad: 0.0 }));
        }
        assert_eq!(left_at_m(8.0, &[(8.7, -1.1)], SemanticTag::Road, &bicycle), 0.0);
        assert!(left_at_m(8.0, &[(8.7, -1.1)], SemanticTag::Road, &Tracks::default()) > 0.2);
        let rear: Vec<(f32, f32)> = (0..=18).map(|i| (9.0, -0.6 + 0.1 * f32::from(i as u8))).collect();
        assert_eq!(left_at_m(8.0, &rear, SemanticTag::Road, &Tracks::default()), 0.0);
    }
}

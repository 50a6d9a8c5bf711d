//! How people keep off vehicles: on the road they go round what stands there, at the kerb they step back from what sweeps
//! over it.

use glam::{Vec2, Vec3};

use super::company::Near;
use super::hazard::Hazard;
use super::outline::{self, Outline};
use super::slack;
use super::walk::Streets;
use super::walker::Walker;

/// Whoever waits steps back from vehicles that come by within this of their sides, metres.
const SWEPT_M: f32 = 0.4;
/// And the farther the longer a vehicle is: by so much for each metre beyond a car's half length.
const TAIL: f32 = 0.15;
/// From those that are there within this time, s.
const SWEEP_S: f32 = 0.8;
/// Nothing farther away than this sweeps over a place, metres.
const SWEEPS_M: f32 = 20.0;
/// Between an outline and a vehicle there is so much, metres.
const OFF_VEHICLES_M: f32 = 0.1;
/// The same from those that move, of whoever is on the road already.
const OFF_MOVING_M: f32 = 0.0;
/// Nobody steps to where one that moves is in so many seconds.
const ROLLS_S: f32 = 0.2;
/// Whoever goes round one keeps off by so much more, metres.
const ROUND_M: f32 = 0.1;
/// Whoever comes by this near a vehicle does not drift back towards it, metres.
const BESIDE_M: f32 = 0.1;
/// What is this far ahead is right before somebody, metres.
const TOE_M: f32 = 0.6;
/// A step along one may lead nearer by so little, metres.
const ALONG_M: f32 = 1e-4;

impl Streets<'_> {
    /// The ego car, loose actors, doors and vehicles of which a part is within `reach_m` of a place.
    fn vehicles_near(&self, place: Vec3, reach_m: f32) -> impl Iterator<Item = &Hazard> {
        self.hazards.reaching(place, reach_m).filter(move |h| !h.walker && h.is_level_with(place.z))
    }

    /// The vehicle nearest before a walker who goes along `direction`, and how far that may step towards it, metres; less than
    /// nothing if it stands right before.
    pub(super) fn before(&self, index: usize, direction: Vec2) -> Option<(&Hazard, f32)> {
        let here = self.bodies[index].position;
        let outline = Outline::of(&self.bodies[index]);
        let toe_m = TOE_M + outline.half.length();
        let toe = here.truncate() + direction.normalize_or_zero() * toe_m;
        // Nobody stops early before what comes.
        let gap_m = |block: &Hazard| if block.stands() { OFF_VEHICLES_M + ROUND_M } else { OFF_MOVING_M };
        let off_m =
            |block: &Hazard| block.nearest_from(toe).length().min(block.after(ROLLS_S).nearest_from(toe).length());
        let room_m = |block: &Hazard| off_m(block) - outline.radius_m - gap_m(block);
        let near = self.vehicles_near(here, toe_m + outline.radius_m + OFF_VEHICLES_M + ROUND_M + BESIDE_M);
        let found = near.map(|block| (block, room_m(block))).filter(|(_, room_m)| *room_m < BESIDE_M);
        found.min_by(|(_, a), (_, b)| a.total_cmp(b))
    }

    /// The part of a step that leaves others room, and keeps off the vehicles that it is `hindered` by: it goes along what is in
    /// its way.
    pub(super) fn free_step(&self, index: usize, near: &[Near], step: Vec2, hindered: bool) -> Vec2 {
        let mut part = step;
        if hindered {
            let outline = Outline::of(&self.bodies[index]);
            let off_m = outline.radius_m + OFF_VEHICLES_M;
            let reach_m = off_m + outline.half.length() + step.length();
            for block in self.vehicles_near(self.bodies[index].position, reach_m) {
                let to = block.nearest_from_any(outline.places());
                let away_m = to.length();
                let toward_m = if away_m > 0.0 { part.dot(to) / away_m } else { 0.0 };
                if toward_m > 0.0 && away_m - toward_m < off_m {
                    part -= to / away_m * toward_m;
                }
            }
        }
        if slack::is_free(near, part) { part } else { slack::free_part(near, part) }
    }

    /// Whether somebody who becomes `then` comes nearer to a vehicle that is within reach.
    pub(super) fn runs_into_vehicle(&self, index: usize, then: &Outline) -> bool {
        let outline = Outline::of(&self.bodies[index]);
        let off_m = outline.radius_m + OFF_VEHICLES_M;
        let nearer = |block: &Hazard| {
            let then_m = block.nearest_from_any(then.places()).length();
            then_m < off_m && then_m < block.nearest_from_any(outline.places()).length() - ALONG_M
        };
        let moved_m = outline.middle.distance(then.middle);
        let moves = moved_m > 0.0 || then.half != outline.half;
        let reach_m = off_m + outline.half.length() + moved_m;
        moves && self.vehicles_near(self.bodies[index].position, reach_m).any(nearer)
    }

    /// Turns somebody towards a direction, as far as others leave the room for it.
    pub(super) fn turn(&self, index: usize, near: &[Near], step: Vec2, toward: Vec2, next: &mut Walker) {
        let heading = next.heading;
        self.face(toward, next);
        // Those who are round need no room for it.
        if self.bodies[index].kind.is_wheeled_on_foot() && next.heading != heading {
            next.heading = if self.may_turn(index, near, step, next) { next.heading } else { heading };
        }
    }

    fn may_turn(&self, index: usize, near: &[Near], step: Vec2, next: &Walker) -> bool {
        let was = Outline::of(&self.bodies[index]);
        let is = was.moved(step, next);
        slack::may_turn(near, step, was.half, is.half) && !self.runs_into_vehicle(index, &is)
    }

    /// The direction away from a vehicle that is about to sweep over where somebody stands; zero where
    /// none is. The tail of a long one swings out of its lane.
    pub(super) fn swept_from(&self, index: usize) -> Vec2 {
        let place = self.bodies[index].position;
        let here = place.truncate();
        let half_m = outline::half_m(self.bodies[index].kind);
        let sweeps = |block: &&Hazard| {
            let offset = here - block.position.truncate();
            let ahead_m = block.velocity.length() * SWEEP_S;
            let aside_m = block.half.y + SWEPT_M + half_m + TAIL * (block.half.x - 2.5).max(0.0);
            let at = block.turned(offset).abs();
            ahead_m > 0.3 && at.x < block.half.x + ahead_m && at.y < aside_m
        };
        let swept = nearest(here, self.vehicles_near(place, SWEEPS_M).filter(sweeps));
        swept.map_or(Vec2::ZERO, |block| {
            let left = block.forward.perp();
            left * (here - block.position.truncate()).dot(left).signum()
        })
    }
}

/// The one nearest to a place.
fn nearest<'a>(place: Vec2, blocks: impl Iterator<Item = &'a Hazard>) -> Option<&'a Hazard> {
    let away = |block: &Hazard| block.nearest_from(place).length_squared();
    blocks.min_by(|a, b| away(a).total_cmp(&away(b)))
}

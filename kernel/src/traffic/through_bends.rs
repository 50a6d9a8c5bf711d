//! Which of two long vehicles goes first through a bend that is too narrow for both.

use super::bends::{Bend, COMES_M, Coming};
use super::drive::View;
use super::lapse::Lapse;
use super::plan::{braking_needed, stopping_speed};
use super::step::{LINE_MARGIN_M, Step};
use super::vehicle::Vehicle;

/// Who stands no farther than this before a bend is about to enter it, metres.
const AT_BEND_M: f32 = 3.0;
/// Braking before a bend, m/s², and time in which that speed is taken up, s.
const BRAKE_MPS2: f32 = 1.2;
const ADAPT_S: f32 = 0.3;
/// Nobody brakes harder for it than this many times what the way asks for.
const HARDEST: f32 = 1.2;
/// Who would have to brake harder than this goes first, m/s².
const COMMITTED_MPS2: f32 = 3.0;

/// Who goes first: who is in the bend, then who cannot wait before it, then who is nearer; of equals the least id.
type Rank = (f32, u16);
const INSIDE_M: f32 = -1.0;

impl View<'_> {
    /// The greatest acceleration that bends leave a long vehicle before which another goes through them, m/s².
    pub(super) fn heed_bends(&self, index: usize, steps: &[Step], next: &Vehicle) -> f32 {
        let Some((bend_m, _)) = self.bend_to_wait_at(index, steps, next) else { return f32::MAX };
        let stop_m = bend_m - LINE_MARGIN_M;
        let hardest_mps2 = HARDEST * braking_needed(next.speed_mps, stop_m).max(BRAKE_MPS2);
        ((stopping_speed(stop_m, BRAKE_MPS2) - next.speed_mps) / ADAPT_S).max(-hardest_mps2)
    }

    /// The nearest bend through which another goes first: the way there, metres, and the other.
    pub(super) fn bend_to_wait_at(&self, index: usize, steps: &[Step], me: &Vehicle) -> Option<(f32, usize)> {
        if !self.drivers[index].is_long() {
            return None;
        }
        let ahead = self.bends_ahead(steps).filter(|(bend_m, _)| *bend_m > 0.0).filter_map(|(bend_m, bend)| {
            let mine = rank(me, bend_m, bend.is_close);
            let first = self.goes_first(index, bend, mine)?;
            Some((bend_m, first))
        });
        ahead.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Another that is in a bend right behind a junction or comes to it, where a long vehicle could not wait between.
    pub(super) fn comes_out_of_bend(&self, index: usize, beyond: &[Step]) -> Option<usize> {
        let mut close = self.bends_ahead(beyond).filter(|(_, bend)| bend.is_close && self.drivers[index].is_long());
        // Who waits for a grant goes after whoever comes.
        close.find_map(|(_, bend)| self.goes_first(index, bend, (f32::MAX, 0)))
    }

    /// The bends on the way, and how far each is from the middle of the vehicle, metres.
    fn bends_ahead<'a>(&'a self, steps: &'a [Step]) -> impl Iterator<Item = (f32, &'a Bend)> {
        steps.iter().flat_map(|step| {
            let bends = self.ways.lanes[step.lane as usize].bends.iter();
            // Nobody passes what lies before where it joins the lane.
            let bends = bends.filter(|bend| step.from_m <= 0.0 || bend.here[1] >= step.from_m);
            bends.map(|bend| (step.start_m + bend.here[0], bend))
        })
    }

    /// Another long vehicle that goes through a bend before one of a rank.
    fn goes_first(&self, index: usize, bend: &Bend, mine: Rank) -> Option<usize> {
        let is_other = |other: usize| other != index && self.drivers[other].is_long();
        let first_on = |coming: &Coming| {
            let driving = self.lists.on(coming.lane).iter().map(|entry| (entry.vehicle as usize, entry.s_m));
            let mut others = driving.filter(|(other, s_m)| is_other(*other) && *s_m < coming.bend[1]);
            others.find(|(other, s_m)| {
                let bend_m = coming.bend[0] - s_m;
                let rank = rank(&self.vehicles[*other], bend_m, bend.there_is_close);
                self.comes(*other, coming, bend_m) && rank < mine
            })
        };
        let driving = bend.there.iter().find_map(first_on).map(|(other, _)| other);
        driving.or_else(|| {
            // Who halts in it stands in no list.
            let halts = |v: &Vehicle| matches!(v.lapse, Lapse::Halts | Lapse::Boards);
            let is_on = |v: &Vehicle, c: &Coming| v.lane == c.lane && (c.bend[0]..c.bend[1]).contains(&v.s_m);
            let inside = |v: &Vehicle| halts(v) && bend.there.iter().any(|coming| is_on(v, coming));
            (0..self.vehicles.len()).find(|other| is_other(*other) && inside(&self.vehicles[*other]))
        })
    }

    /// Whether somebody on a lane that leads to a bend is about to come through it.
    fn comes(&self, index: usize, coming: &Coming, bend_m: f32) -> bool {
        let vehicle = &self.vehicles[index];
        if coming.before_junction {
            return vehicle.flags & Vehicle::GRANTED != 0;
        }
        bend_m < COMES_M && (vehicle.speed_mps > 0.5 || bend_m < AT_BEND_M)
    }
}

/// `is_close`: the vehicle could wait only with its tail in a junction, where it counts once it is in there or may be.
fn rank(vehicle: &Vehicle, bend_m: f32, is_close: bool) -> Rank {
    let enters = is_close && vehicle.flags & (Vehicle::GRANTED | Vehicle::CROSSING) != 0;
    let rank_m = match bend_m {
        ..=0.0 => INSIDE_M,
        _ if enters || braking_needed(vehicle.speed_mps, bend_m) > COMMITTED_MPS2 => 0.0,
        _ => bend_m,
    };
    (rank_m, vehicle.id)
}

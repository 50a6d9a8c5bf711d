//! How a group keeps together: those who follow walk beside who leads, and who leads waits for those behind. In a crowd
//! everybody looks after themselves.

use super::company::Near;
use super::turns::end_node;
use super::walk::Streets;
use super::walker::{Walker, WalkerMode};

/// From one to the next side by side, and one after the other, metres (Moussaïd et al. 2010: about 0.8 m).
const BESIDE_M: f32 = 0.75;
const BEHIND_M: f32 = 0.95;
/// Who is away from the own place by so much takes it up again within this time, s.
const CLOSE_S: f32 = 1.5;
/// Who follows goes up to so many times as fast as the group to catch up.
const CATCH_UP: f32 = 1.3;
/// Who is farther away than this is waited for, as long as it is nearer than that, metres, at these shares of the pace.
const LAG_M: f32 = 2.5;
const FAR_M: f32 = 6.0;
const LOST_M: f32 = 40.0;
const SLOW: f32 = 0.6;
const AMBLE: f32 = 0.2;
/// Who follows turns round when it is so far ahead of who goes the other way, metres.
const TURN_M: f32 = 4.0;
/// With more people than that in sight, those of the group among them, it falls apart.
const CROWD: usize = 4;

/// What somebody does for the others of the group.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Together {
    /// The speed to go at, m/s.
    pub speed_mps: Option<f32>,
    /// Where to walk, metres to the left of the way.
    pub aside_m: Option<f32>,
    /// To turn round.
    pub back: bool,
}

impl Streets<'_> {
    /// What somebody who walks at a pace does for the group.
    pub(super) fn together(&self, index: usize, near: &[Near], walker: &Walker, pace_mps: f32) -> Together {
        let on_crosswalk = self.map.walk_edges[walker.edge as usize].crosswalk.is_some();
        if self.groups.is_alone(index) || near.len() > CROWD {
            return Together::default();
        }
        let Some(leader) = self.groups.leader(index) else {
            let share = if on_crosswalk { 1.0 } else { self.waits_for(index) };
            return Together { speed_mps: Some(pace_mps * share), ..Together::default() };
        };
        let led = &self.walkers[leader];
        if !self.crowd.has(leader) || led.mode == WalkerMode::Jaywalk {
            return Together::default();
        }
        if led.edge == walker.edge && led.forward == walker.forward {
            return self.beside(index, walker, led, pace_mps);
        }
        let away_m = self.bodies[index].position.distance(self.bodies[leader].position);
        let back = !on_crosswalk && self.left_behind(walker, led, away_m);
        let comes = end_node(self.map, led) == start_node(self, walker);
        let share = if back || away_m < LAG_M {
            1.0
        } else if comes && !on_crosswalk {
            AMBLE
        } else {
            CATCH_UP
        };
        Together { speed_mps: Some(pace_mps * share), aside_m: None, back }
    }

    /// The share of the pace at which who leads goes for those behind.
    fn waits_for(&self, index: usize) -> f32 {
        let here = self.bodies[index].position;
        let ahead = self.bodies[index].velocity_mps;
        let lag_m = |i: usize| {
            let to = self.bodies[i].position - here;
            let (away_m, is_ahead) = (to.length(), to.dot(ahead) > 0.0);
            if is_ahead || away_m > LOST_M { 0.0 } else { away_m }
        };
        let lag_m = self.groups.followers(index).filter(|i| self.crowd.has(*i)).map(lag_m).fold(0.0, f32::max);
        match lag_m {
            m if m > FAR_M => AMBLE,
            m if m > LAG_M => SLOW,
            _ => 1.0,
        }
    }

    /// Takes the own place beside or behind who leads along the same way.
    fn beside(&self, index: usize, walker: &Walker, led: &Walker, pace_mps: f32) -> Together {
        let half_m = self.map.walk_edges[walker.edge as usize].half_width_m;
        let rank = f32::from(self.groups.rank(index));
        // The first to the side with more room, the second to the other one, if there is room.
        let inner = if led.offset_m > 0.0 { -1.0 } else { 1.0 };
        let aside_m = led.offset_m + BESIDE_M * if rank < 2.0 { inner } else { -inner };
        let has_room = rank < 3.0 && aside_m.abs() <= half_m;
        let behind_m = if has_room { 0.0 } else { rank.min(2.0) * BEHIND_M };
        let direction = if walker.forward { 1.0 } else { -1.0 };
        let gap_m = (led.s_m - walker.s_m) * direction - behind_m;
        // Nobody stops on the road for another.
        let least_mps = if self.map.walk_edges[walker.edge as usize].crosswalk.is_some() { pace_mps } else { 0.0 };
        let speed_mps = (led.speed_mps + gap_m / CLOSE_S).clamp(least_mps, pace_mps * CATCH_UP);
        let aside_m = if has_room { aside_m } else { led.offset_m };
        Together { speed_mps: Some(speed_mps), aside_m: Some(aside_m).filter(|_| gap_m < FAR_M), back: false }
    }

    /// Whether who leads has gone the other way.
    fn left_behind(&self, walker: &Walker, led: &Walker, away_m: f32) -> bool {
        if away_m < TURN_M {
            return false;
        }
        if led.edge == walker.edge {
            let direction = if walker.forward { 1.0 } else { -1.0 };
            return (led.s_m - walker.s_m) * direction < -TURN_M;
        }
        let [start, end] = [start_node(self, walker), end_node(self.map, walker)];
        let nodes = self.map.walk_edges[led.edge as usize].nodes;
        nodes.contains(&start) && !nodes.contains(&end) && end_node(self.map, led) != start
    }
}

fn start_node(streets: &Streets<'_>, walker: &Walker) -> u32 {
    streets.map.walk_edges[walker.edge as usize].nodes[usize::from(!walker.forward)]
}

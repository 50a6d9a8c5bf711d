//! What a driver's hands are to feel: a function of what the car and the road do, without any device.

use kernel::events::{Event, EventKind};

/// Shares of the limit that the effects have at most; together they are all of it.
const ROAD_SHARE: f32 = 0.3;
const SPRING_SHARE: f32 = 0.2;
const JOLT_SHARE: f32 = 0.3;
const RUMBLE_SHARE: f32 = 0.2;
/// The road pulls at the front wheels with all its share from this torque about their steering axes on, N m.
const ROAD_FULL_NM: f32 = 150.0;
/// The wheel pulls towards its centre, to be still in nobody's hands, with this part of the spring's share at standstill, and with all
/// of it from this speed on, m/s.
const SPRING_AT_REST: f32 = 0.3;
const SPRING_FULL_MPS: f32 = 15.0;
/// A collision shakes the wheel to and fro for so long, ticks; at this speed, m/s, with all its share.
const JOLT_TICKS: u32 = 24;
const JOLT_SIDE_TICKS: u32 = 4;
const JOLT_FULL_MPS: f32 = 8.0;
/// A wheel that leaves the road, as over a kerb, rumbles for so long, ticks; at this speed, m/s, with
/// all its share.
const RUMBLE_TICKS: u32 = 36;
const RUMBLE_FULL_MPS: f32 = 5.0;
/// Steps of an effect, so that devices are not told of differences that nobody feels.
const STEPS: f32 = 128.0;

/// What a device is to do, fractions of its greatest force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effects {
    /// How hard it pulls towards its centre, [0, 1].
    pub spring: f32,
    /// A push to the side, [-1, 1], positive to the right.
    pub push: f32,
    /// How hard it rumbles, [0, 1].
    pub rumble: f32,
}

#[cfg(test)]
impl Effects {
    /// The greatest force of all of them at once.
    pub fn sum(&self) -> f32 {
        self.spring + self.push.abs() + self.rumble
    }
}

/// What the car did in a tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Driven<'a> {
    pub speed_mps: f32,
    /// Of the road on the front wheels, N m, positive to the right.
    pub aligning_torque_nm: f32,
    pub events: &'a [Event],
}

/// What goes on after a collision or beside the road.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Feel {
    jolt: Fading,
    rumble: Fading,
}

#[derive(Clone, Debug, Default, PartialEq)]
struct Fading {
    ticks_left: u32,
    strength: f32,
}

impl Fading {
    fn begin(&mut self, ticks: u32, strength: f32) {
        *self = Self { ticks_left: ticks, strength };
    }

    /// Goes on by a tick: ticks that were left, and the strength.
    fn tick(&mut self) -> Option<(u32, f32)> {
        let left = self.ticks_left;
        self.ticks_left = left.saturating_sub(1);
        (left > 0).then_some((left, self.strength))
    }
}

impl Feel {
    /// The effects of a tick in which the car drove so. The limit is the greatest force that is allowed, [0, 1].
    pub fn tick(&mut self, driven: &Driven<'_>, limit: f32) -> Effects {
        let fast = |full_mps: f32| fraction(driven.speed_mps.abs() / full_mps);
        for event in driven.events {
            match event.kind {
                EventKind::CollisionActor | EventKind::CollisionScenery => {
                    self.jolt.begin(JOLT_TICKS, fraction(event.speed_mps.abs() / JOLT_FULL_MPS));
                }
                EventKind::OffRoad => self.rumble.begin(RUMBLE_TICKS, 1.0),
                _ => {}
            }
        }
        let spring = SPRING_AT_REST + (1.0 - SPRING_AT_REST) * fast(SPRING_FULL_MPS);
        let jolt = self.jolt.tick().map_or(0.0, |(left, strength)| {
            let side = if (left / JOLT_SIDE_TICKS).is_multiple_of(2) { 1.0 } else { -1.0 };
            side * strength * left as f32 / JOLT_TICKS as f32
        });
        let rumble = self.rumble.tick().map_or(0.0, |(_, strength)| strength * fast(RUMBLE_FULL_MPS));
        let road = fraction(driven.aligning_torque_nm.abs() / ROAD_FULL_NM).copysign(driven.aligning_torque_nm);
        let limit = fraction(limit);
        Effects {
            spring: step(limit * SPRING_SHARE * spring),
            push: step(limit * (ROAD_SHARE * road + JOLT_SHARE * jolt)),
            rumble: step(limit * RUMBLE_SHARE * rumble),
        }
    }

    /// The car does not drive: whatever went on is over.
    pub fn rest(&mut self) -> Effects {
        *self = Self::default();
        Effects::default()
    }
}

/// Into [0, 1]; what is no number is 0.
fn fraction(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) }
}

/// The next step towards 0.
fn step(value: f32) -> f32 {
    (value * STEPS).trunc() / STEPS
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn event(kind: EventKind, speed_mps: f32) -> Event {
        Event { kind, actor: 0, speed_mps }
    }

    /// Driven without any torque.
    fn at(speed_mps: f32, events: &[Event]) -> Driven<'_> {
        Driven { speed_mps, aligning_torque_nm: 0.0, events }
    }

    #[test]
    fn the_wheel_is_heavier_at_speed() {
        let springs = [0.0, 5.0, 10.0, 15.0, 30.0].map(|speed| Feel::default().tick(&at(speed, &[]), 1.0).spring);
        assert!(springs.is_sorted() && springs[0] > 0.05 && springs[3] == springs[4], "{springs:?}");
    }

    #[test]
    fn the_road_pulls_the_way_its_torque_does_up_to_its_share() {
        let push = |torque_nm: f32, limit: f32| {
            Feel::default().tick(&Driven { aligning_torque_nm: torque_nm, ..at(20.0, &[]) }, limit).push
        };
        let pushes = [-400.0, -75.0, 0.0, 75.0, 400.0, f32::INFINITY].map(|torque_nm| push(torque_nm, 1.0));
        assert!(pushes.is_sorted() && pushes[0] < 0.0 && pushes[2] == 0.0, "{pushes:?}");
        assert!((pushes[3] - 0.5 * ROAD_SHARE).abs() <= 1.0 / STEPS && pushes[4] <= ROAD_SHARE, "{pushes:?}");
        assert_eq!((pushes[5], push(f32::NAN, 1.0)), (pushes[4], 0.0));
        assert!(push(75.0, 0.5) <= 0.5 * pushes[3] + 1.0 / STEPS);
    }

    #[test]
    fn a_collision_shakes_both_ways_and_fades() {
        let mut feel = Feel::default();
        let hit = [event(EventKind::CollisionActor, 12.0)];
        let pushes: Vec<f32> =
            (0..40).map(|i| feel.tick(&at(5.0, if i == 0 { &hit } else { &[] }), 1.0).push).collect();
        assert!(pushes[0].abs() > 0.25 && pushes.iter().any(|p| *p > 0.1) && pushes.iter().any(|p| *p < -0.1));
        assert!(pushes[JOLT_TICKS as usize..].iter().all(|p| *p == 0.0), "{pushes:?}");
        assert_eq!(Feel::default().tick(&at(5.0, &[event(EventKind::Speeding, 12.0)]), 1.0).push, 0.0);
    }

    #[test]
    fn a_kerb_rumbles_while_the_car_moves() {
        let kerb = [event(EventKind::OffRoad, 9.0)];
        let mut feel = Feel::default();
        assert!(feel.tick(&at(9.0, &kerb), 1.0).rumble > 0.15);
        assert_eq!(feel.tick(&at(0.0, &[]), 1.0).rumble, 0.0);
        assert!(feel.tick(&at(9.0, &[]), 1.0).rumble > 0.15);
        assert_eq!((feel.rest(), feel.tick(&at(9.0, &[]), 1.0).rumble), (Effects::default(), 0.0));
    }

    fn kinds() -> impl Strategy<Value = EventKind> {
        use EventKind::*;
        prop::sample::select(vec![CollisionActor, CollisionScenery, OffRoad, RedLight, Ended])
    }

    proptest! {
        #[test]
        fn the_force_never_passes_the_limit(
            limit in 0.0f32..=1.0,
            ticks in prop::collection::vec(
                (any::<[f32; 2]>(), prop::collection::vec((kinds(), any::<f32>()), 0..3)),
                1..60,
            ),
        ) {
            let mut feel = Feel::default();
            for ([speed_mps, aligning_torque_nm], events) in ticks {
                let events: Vec<Event> = events.into_iter().map(|(kind, speed)| event(kind, speed)).collect();
                let driven = Driven { speed_mps, aligning_torque_nm, events: &events };
                let effects = feel.tick(&driven, limit);
                prop_assert!(effects.sum() <= limit, "{effects:?} of {limit}");
                prop_assert!(effects.spring >= 0.0 && effects.rumble >= 0.0);
                prop_assert_eq!(Feel::default().tick(&driven, 0.0).sum(), 0.0);
            }
        }
    }
}

//! Limiting cases by hand, and any others against a simulation in small steps.

use glam::Vec2;
use proptest::prelude::*;

use super::*;

fn mover(x: f32, y: f32, heading_rad: f32, speed_mps: f32) -> Mover {
    let half = Vec2::new(2.0, 1.0);
    Mover { footprint: Footprint { centre: Vec2::new(x, y), forward: Vec2::from_angle(heading_rad), half }, speed_mps }
}

/// The ego car at the origin, heading along x.
fn ego(speed_mps: f32) -> Mover {
    mover(0.0, 0.0, 0.0, speed_mps)
}

fn near(got: Option<f64>, expected: f64) {
    assert!(got.is_some_and(|got| (got - expected).abs() < 1e-4), "{got:?}, expected {expected}");
}

const LEFT: f32 = std::f32::consts::FRAC_PI_2;

#[test]
fn head_on_both_speeds_close_the_gap() {
    let encounter = Encounter::of(&ego(10.0), &mover(64.0, 0.0, 2.0 * LEFT, 10.0));
    near(encounter.time_to_collision_s(), 60.0 / 20.0);
    assert_eq!(encounter.post_encroachment_s(), None, "the same way, not one that crosses");
    assert_eq!(encounter.required_deceleration_mps2(), None, "who stands is hit as well");
    let beside = Encounter::of(&ego(10.0), &mover(64.0, 2.1, 2.0 * LEFT, 10.0));
    assert_eq!((beside.time_to_collision_s(), beside.required_deceleration_mps2()), (None, None));
}

#[test]
fn following_needs_the_difference_of_speeds() {
    assert_eq!(Encounter::of(&ego(10.0), &mover(14.0, 0.0, 0.0, 10.0)).time_to_collision_s(), None);
    let closing = Encounter::of(&ego(15.0), &mover(29.0, 0.0, 0.0, 10.0));
    near(closing.time_to_collision_s(), 25.0 / 5.0);
    near(closing.required_deceleration_mps2(), 5.0 * 5.0 / (2.0 * 25.0));
    let standing = Encounter::of(&ego(15.0), &mover(34.0, 0.0, 0.0, 0.0));
    near(standing.time_to_collision_s(), 2.0);
    near(standing.required_deceleration_mps2(), 15.0 * 15.0 / (2.0 * 30.0));
    let behind = Encounter::of(&ego(10.0), &mover(-14.0, 0.0, 0.0, 20.0));
    near(behind.time_to_collision_s(), 1.0);
    assert_eq!(behind.required_deceleration_mps2(), None, "braking does not help");
}

#[test]
fn crossing_at_a_right_angle_has_the_times_of_the_shared_square() {
    // The ego car is in the square from (20 - 1 - 2) / 10 to (20 + 1 + 2) / 10 s, the other from 5.7 to 6.3 s.
    let crossing = Encounter::of(&ego(10.0), &mover(20.0, -60.0, LEFT, 10.0));
    near(crossing.post_encroachment_s(), 5.7 - 2.3);
    assert_eq!((crossing.time_to_collision_s(), crossing.required_deceleration_mps2()), (None, None));
    let late = Encounter::of(&ego(10.0), &mover(60.0, -20.0, LEFT, 10.0));
    near(late.post_encroachment_s(), 5.7 - 2.3);
    let course = Encounter::of(&ego(10.0), &mover(20.0, -20.0, LEFT, 10.0));
    near(course.time_to_collision_s(), 1.7);
    near(course.post_encroachment_s(), 0.0);
    // To have driven no more than 17 m at 2.3 s, when the other has left: 23 m - 17 m = b 2.3^2 / 2.
    near(course.required_deceleration_mps2(), 12.0 / (2.3 * 2.3));
    let parked = Encounter::of(&ego(10.0), &mover(20.0, 0.0, LEFT, 0.0));
    assert_eq!(parked.post_encroachment_s(), None, "it is there all the time");
    near(Encounter::of(&ego(0.0), &mover(0.0, -23.0, LEFT, 10.0)).time_to_collision_s(), 2.0);
}

#[test]
fn who_touches_collides_now() {
    let touching = Encounter::of(&ego(10.0), &mover(3.0, 1.0, 0.5, 3.0));
    assert_eq!(touching.time_to_collision_s(), Some(0.0));
    assert_eq!(touching.required_deceleration_mps2(), None);
    assert_eq!(Encounter::of(&ego(5.0), &mover(500.0, 0.0, 0.0, 0.0)).time_to_collision_s(), None, "the horizon");
}

const STEP_S: f64 = 0.01;

/// With more room, metres on each side.
fn grown(mover: &Mover, metres: f32) -> Mover {
    let Footprint { half, .. } = mover.footprint;
    Mover { footprint: Footprint { half: half + metres, ..mover.footprint }, ..*mover }
}

fn moved(mover: &Mover, metres: f64) -> Footprint {
    let Footprint { centre, forward, .. } = mover.footprint;
    Footprint { centre: centre + metres as f32 * forward, ..mover.footprint }
}

/// The first time at which the boxes overlap, by moving them in small steps.
fn first_contact_s(ego: &Mover, other: &Mover, braking_mps2: f64) -> Option<f64> {
    let speed = f64::from(ego.speed_mps);
    let mut times = (0..=(HORIZON_S / STEP_S) as u32).map(|step| f64::from(step) * STEP_S);
    let driven = |t: f64| {
        let t = if braking_mps2 > 0.0 { t.min(speed / braking_mps2) } else { t };
        speed * t - 0.5 * braking_mps2 * t * t
    };
    times.find(|t| moved(ego, driven(*t)).overlaps(&moved(other, f64::from(other.speed_mps) * t)))
}

/// The least time between any two places that overlap, by moving both in small steps.
fn least_gap_s(ego: &Mover, other: &Mover) -> Option<f64> {
    let times = || (0..=100).map(|step| f64::from(step) * 0.1);
    let places = |mover: &Mover| times().map(|t| (t, moved(mover, f64::from(mover.speed_mps) * t))).collect::<Vec<_>>();
    let (egos, others) = (places(ego), places(other));
    let pairs = egos.iter().flat_map(|a| others.iter().map(move |b| (a, b)));
    let gaps = pairs.filter(|(a, b)| a.1.overlaps(&b.1)).map(|(a, b)| (a.0 - b.0).abs());
    gaps.min_by(f64::total_cmp)
}

prop_compose! {
    fn any_other()(x in -40f32..80.0, y in -40f32..40.0, heading in -3.2f32..3.2, speed in 0f32..20.0) -> Mover {
        mover(x, y, heading, speed)
    }
}

proptest! {
    #[test]
    fn the_time_to_collision_is_that_of_a_simulation(other in any_other(), speed in 0f32..20.0) {
        let ego = ego(speed);
        let exact = Encounter::of(&ego, &other).time_to_collision_s();
        if let Some(stepped) = first_contact_s(&ego, &grown(&other, -1e-3), 0.0) {
            prop_assert!(exact.is_some_and(|exact| exact < stepped + 1e-4), "{:?}, but {} s", exact, stepped);
        }
        if let Some(exact) = exact {
            let after = |mover: &Mover| moved(mover, f64::from(mover.speed_mps) * exact);
            prop_assert!(after(&ego).overlaps(&after(&grown(&other, 1e-2))), "no contact at {} s", exact);
        }
    }

    #[test]
    fn the_required_deceleration_is_just_enough(other in any_other(), speed in 1f32..20.0) {
        let ego = ego(speed);
        let Some(required) = Encounter::of(&ego, &other).required_deceleration_mps2() else { return Ok(()) };
        prop_assert!(required > 0.0 && required <= MAX_DECELERATION_MPS2);
        if required < MAX_DECELERATION_MPS2 {
            let slim = first_contact_s(&ego, &grown(&other, -0.05), 1.01 * required);
            prop_assert_eq!(slim, None, "it is too little");
            let fat = first_contact_s(&ego, &grown(&other, 0.4), 0.97 * required);
            prop_assert!(fat.is_some(), "less is enough");
        }
    }

    #[test]
    fn the_encroachment_time_is_that_of_all_pairs_of_places(other in any_other(), speed in 1f32..20.0) {
        let ego = ego(speed);
        let exact = Encounter::of(&ego, &other).post_encroachment_s();
        if !ego.crosses(&other) {
            prop_assert_eq!(exact, None);
            return Ok(());
        }
        if let Some(stepped) = least_gap_s(&ego, &grown(&other, -1e-3)) {
            prop_assert!(exact.is_some_and(|exact| exact < stepped + 1e-4), "{:?}, but {} s", exact, stepped);
        }
        if let Some(exact) = exact {
            // Half a step of both moves them by at most 2 m against each other.
            let fat = least_gap_s(&ego, &grown(&other, 2.01));
            prop_assert!(fat.is_some_and(|fat| fat < exact + 0.1 + 1e-4), "{} s, but {:?}", exact, fat);
        }
    }

    #[test]
    fn swapping_both_changes_no_time(other in any_other(), speed in 1f32..20.0) {
        let ego = ego(speed);
        let (one, two) = (Encounter::of(&ego, &other), Encounter::of(&other, &ego));
        let same = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => (a - b).abs() < 1e-3,
            (a, b) => a.or(b).is_none_or(|only| only > HORIZON_S - 1e-3),
        };
        prop_assert!(same(one.time_to_collision_s(), two.time_to_collision_s()));
        prop_assert!(same(one.post_encroachment_s(), two.post_encroachment_s()));
    }
}

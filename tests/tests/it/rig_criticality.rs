//! The criticality of a case is that of its world, moved on by hand.

use glam::{Vec2, Vec3};
use kernel::Scenario;
use kernel::scene::{ActorScene, SceneSnapshot};
use kernel::time::{TICK_HZ, Tick};
use measures::Criticality;
use measures::criticality::{HORIZON_S, Sample};
use replay::{Case, Recording, Replayer};
use tests::recordings::{TAKEOVER, WITH_TAKEOVER, record};
use tests::scenes::{Scene, busy_city};

/// Corners of a box on the ground, and how far it moves in a second.
struct Moving {
    corners: [Vec2; 4],
    velocity: Vec2,
}

impl Moving {
    fn new(middle: Vec3, rotation: glam::Quat, size: Vec3, speed_mps: f32) -> Self {
        let forward = (rotation * Vec3::X).truncate().normalize();
        let (along, across) = (forward * size.x / 2.0, forward.perp() * size.y / 2.0);
        let middle = middle.truncate();
        let corners =
            [middle + along + across, middle - along + across, middle - along - across, middle + along - across];
        Self { corners, velocity: speed_mps * forward }
    }

    fn after(&self, seconds: f32) -> [Vec2; 4] {
        self.corners.map(|corner| corner + seconds * self.velocity)
    }
}

/// Whether a corner of one lies in the other, or their sides cross.
fn touch(a: &[Vec2; 4], b: &[Vec2; 4]) -> bool {
    let sides = |box_: &[Vec2; 4]| [0, 1, 2, 3].map(|i| (box_[i], box_[(i + 1) % 4]));
    let left_of = |(from, to): (Vec2, Vec2), p: Vec2| (to - from).perp_dot(p - from);
    let holds = |box_: &[Vec2; 4], p: Vec2| sides(box_).iter().all(|side| left_of(*side, p) >= 0.0);
    let cross = |one: (Vec2, Vec2), other: (Vec2, Vec2)| {
        left_of(one, other.0) * left_of(one, other.1) < 0.0 && left_of(other, one.0) * left_of(other, one.1) < 0.0
    };
    a.iter().any(|p| holds(b, *p))
        || b.iter().any(|p| holds(a, *p))
        || sides(a).iter().any(|one| sides(b).iter().any(|other| cross(*one, *other)))
}

const STEP_S: f32 = 0.02;

/// The first contact of the ego car with anyone when all go on straight.
fn stepped_ttc_s(scene: &SceneSnapshot) -> Option<f32> {
    // Seen from the car, as small numbers are exact; on the ground, over which the body leans.
    let ego = scene.ego;
    let middle = ego.rotation * kernel::ego::CENTRE_M.with_z(0.0);
    let car = Moving::new(middle, ego.rotation, kernel::ego::SIZE_M, ego.speed_mps);
    let relative = |a: &ActorScene| Moving::new(a.position - ego.position, a.rotation, a.kind.size_m(), a.speed_mps);
    let others: Vec<Moving> = scene.actors.iter().map(relative).collect();
    let steps = (HORIZON_S as f32 / STEP_S) as u32;
    let mut times = (0..=steps).map(|step| step as f32 * STEP_S);
    times.find(|t| others.iter().any(|other| touch(&car.after(*t), &other.after(*t))))
}

#[test]
fn the_trace_of_a_case_is_that_of_boxes_moved_on_by_hand() {
    let seeds = 7..11;
    let met: u32 = seeds.map(|seed| compare_with_boxes(&with_seed(busy_city(), seed))).sum();
    assert!(met > 5, "only {met} samples have a collision course: nothing was compared");
}

fn with_seed(scene: Scene, seed: u64) -> Scene {
    Scene { scenario: Scenario { seed, ..scene.scenario }, ..scene }
}

/// Compares the samples of a case; gives how many have a collision course.
fn compare_with_boxes(scene: &Scene) -> u32 {
    let recording = Recording::from_bytes(&record(scene, TAKEOVER + 60, WITH_TAKEOVER)).unwrap();
    assert_eq!(Criticality::of_case(recording.log(), &scene.network).unwrap(), None, "a recording");
    let window = Case::window(recording.log()).expect("an intervention");
    let case = Case::cut(&recording, &scene.network, window.clone()).unwrap();
    let criticality = Criticality::of_case(case.log(), &scene.network).unwrap().expect("a case");
    assert_eq!(Criticality::of_case(case.log(), &scene.network).unwrap().as_ref(), Some(&criticality));

    let samples = &criticality.samples;
    let ticks: Vec<Tick> = samples.iter().map(|sample| sample.tick).collect();
    assert_eq!(ticks, (*window.start()..=case.log().last_tick()).step_by(6).collect::<Vec<_>>());
    let mut replayer = Replayer::new(case.log(), scene.network.clone()).unwrap();
    let mut met = 0;
    for sample in samples {
        replayer.seek(sample.tick).unwrap();
        let stepped = stepped_ttc_s(&replayer.world().scene());
        let exact = sample.ttc_s.as_ref().map(|worst| worst.value as f32);
        // A contact shorter than a step may be missed by the steps, never by the exact time.
        let agree = match (exact, stepped) {
            (Some(exact), Some(stepped)) => exact <= stepped + 1e-3,
            (_, None) => true,
            (None, Some(_)) => false,
        };
        assert!(agree, "tick {}: {exact:?}, by hand {stepped:?}", sample.tick);
        met += u32::from(exact.zip(stepped).is_some_and(|(exact, stepped)| stepped - exact < 2.0 * STEP_S));
    }
    let least = |of: fn(&Sample) -> Option<f64>| samples.iter().filter_map(of).min_by(f64::total_cmp);
    let ttc = least(|sample| sample.ttc_s.as_ref().map(|worst| worst.value));
    assert_eq!(criticality.extremes.min_ttc_s.as_ref().map(|extreme| extreme.value), ttc);
    let pret = least(|sample| sample.pret_s.as_ref().map(|worst| worst.value));
    assert_eq!(criticality.extremes.min_pret_s.as_ref().map(|extreme| extreme.value), pret);
    let held_s = ticks.len() as f64 * 6.0 / f64::from(TICK_HZ);
    assert!(
        criticality.extremes.pet_s.iter().all(|pet| (0.0..held_s).contains(&pet.value) && window.start() <= &pet.tick)
    );
    met
}

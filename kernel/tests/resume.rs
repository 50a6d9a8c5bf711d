//! Keyframes hold everything: resuming, cloning and perturbing.

mod common;

use common::{on_ring, ring, script};
use kernel::state::StateHash;
use kernel::time::KEYFRAME_TICKS;
use kernel::world::PARTS;
use kernel::{Controls, Keyframe, TickInput, World};
use proptest::prelude::*;

/// Steps both worlds with the same input and names the first field that differs.
fn in_lockstep(original: &mut World, other: &mut World, input: &TickInput, what: &str) -> Option<Keyframe> {
    let (left, right) = (original.step(input), other.step(input));
    if left.hash != right.hash {
        let difference = original.difference(other).map(|field| field.to_string());
        panic!("{what} differs at tick {}: {}", left.tick, difference.unwrap_or_default());
    }
    assert_eq!(left, right, "{what} at tick {}", left.tick);
    left.keyframe
}

#[test]
fn worlds_resumed_from_every_keyframe_stay_identical() {
    let (scenario, network) = (on_ring(3), ring());
    let mut original = World::new(&scenario, &network).expect("the scenario fits");
    let first = original.initial_keyframe();
    let mut others = vec![World::resume(&scenario, &network, &first).expect("it resumes")];
    let mut keyframes = 0;
    let mut collisions = 0;
    for _ in 0..7_200 {
        let input = script::input(&original);
        let mut keyframe = None;
        let before = original.clone();
        for other in &mut others {
            original = before.clone();
            let at = other.tick();
            keyframe = in_lockstep(&mut original, other, &input, &format!("the world resumed (now at tick {at})"));
        }
        collisions += original.last_events().iter().filter(|event| event.actor > 0).count();
        if let Some(keyframe) = keyframe {
            keyframes += 1;
            assert!(keyframe.bytes.len() < 5_000);
            let resumed = World::resume(&scenario, &network, &keyframe).expect("it resumes");
            assert_eq!(resumed.hash(), original.hash());
            others.truncate(1);
            others.push(resumed);
        }
    }
    assert!(keyframes >= 9, "{keyframes} keyframes");
    assert!(collisions >= 3, "{collisions} collisions with actors");
}

fn driven(ticks: u64) -> (World, Keyframe) {
    let (scenario, network) = (on_ring(5), ring());
    let mut world = World::new(&scenario, &network).expect("the scenario fits");
    let mut last = world.initial_keyframe();
    for _ in 0..ticks {
        last = world.step(&script::input(&world)).keyframe.unwrap_or(last);
    }
    (world, last)
}

#[test]
fn every_byte_of_a_keyframe_is_hashed_restored_and_named() {
    let (world, keyframe) = driven(2_500);
    let resume = |keyframe: &Keyframe| World::resume(world.scenario(), world.network(), keyframe);
    let original = resume(&keyframe).expect("it resumes");
    let mut accepted = 0;
    for at in 0..keyframe.bytes.len() {
        let mut changed = keyframe.clone();
        changed.bytes[at] ^= 1;
        let Ok(other) = resume(&changed) else { continue };
        accepted += 1;
        assert_ne!(other.hash(), original.hash(), "byte {at} is not hashed");
        assert_eq!(other.initial_keyframe(), changed, "byte {at} is not restored");
        let parts = original.part_hashes().iter().zip(other.part_hashes()).filter(|(a, b)| **a != *b).count();
        assert_eq!(parts, 1, "byte {at} belongs to one part");
        let named = original.difference(&other).expect("a difference has a name");
        let told = keyframe.difference(&changed).expect("both are readable").expect("they differ");
        assert_eq!(named, told);
        assert!(PARTS.contains(&named.part.as_str()));
        assert!(named.part != "vehicles" || named.actor.is_some(), "{named}");
    }
    assert!(accepted > keyframe.bytes.len() / 2, "{accepted} of {}", keyframe.bytes.len());
}

#[test]
fn a_forged_keyframe_never_panics() {
    let (world, keyframe) = driven(2_500);
    let input = TickInput { semantic: Controls::from_fractions(0.1, 0.9, 0.0), ..Default::default() };
    for at in 0..keyframe.bytes.len() {
        for bit in [1, 6, 7] {
            let mut forged = keyframe.clone();
            forged.bytes[at] ^= 1 << bit;
            let Ok(mut other) = World::resume(world.scenario(), world.network(), &forged) else { continue };
            for _ in 0..4 {
                other.step(&input);
            }
            other.scene();
            other.hud();
            other.route_ahead(100.0);
        }
    }
}

#[test]
fn a_truncated_or_mismatched_keyframe_is_refused_in_one_sentence() {
    let (world, keyframe) = driven(KEYFRAME_TICKS + 100);
    for length in 0..keyframe.bytes.len() {
        let cut = Keyframe { tick: keyframe.tick, bytes: keyframe.bytes[..length].to_vec() };
        let error = World::resume(world.scenario(), world.network(), &cut).err().expect("it is refused");
        assert!(error.to_string().starts_with(&format!("keyframe of tick {KEYFRAME_TICKS}: ")), "{error}");
    }
    let late = Keyframe { tick: KEYFRAME_TICKS + 1, ..keyframe };
    let error = World::resume(world.scenario(), world.network(), &late).err().expect("it is refused");
    let expected = format!("keyframe of tick {}: its state is that of tick {KEYFRAME_TICKS}", KEYFRAME_TICKS + 1);
    assert_eq!(error.to_string(), expected);
}

fn controls() -> impl Strategy<Value = Controls> {
    (any::<i16>(), any::<u16>(), any::<u16>(), 0..=Controls::ALL_FLAGS).prop_map(|(steer, throttle, brake, flags)| {
        Controls { steer, throttle, brake: if flags & 4 == 0 { brake / 8 } else { brake }, flags }
    })
}

/// Controls that are held for some ticks each.
fn drives() -> impl Strategy<Value = Vec<(TickInput, u16)>> {
    let input = (controls(), controls(), 0..4u8).prop_map(|(semantic, safety, calm)| TickInput {
        semantic,
        safety: if calm > 0 { Controls::default() } else { safety },
    });
    prop::collection::vec((input, 20..200u16), 4..10)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn any_drive_keeps_every_invariant(drive in drives(), seed in 0..50u64, back in 1..300usize) {
        let (scenario, network) = (on_ring(seed), ring());
        let mut world = World::new(&scenario, &network).expect("the scenario fits");
        let mut log: Vec<(TickInput, StateHash)> = Vec::new();
        let mut saved: Option<(World, usize)> = None;
        let mut keyframe = (world.initial_keyframe(), 0);
        for (input, ticks) in drive {
            for _ in 0..ticks {
                if log.len().is_multiple_of(back) {
                    saved = Some((world.clone(), log.len()));
                }
                let output = world.step(&input);
                if let Some(taken) = output.keyframe.clone() {
                    keyframe = (taken, log.len() + 1);
                }
                log.push((input, output.hash));
                check(&world, &input, &output)?;
            }
        }
        let (mut rolled_back, from) = saved.expect("the first tick saves one");
        let mut resumed = World::resume(&scenario, &network, &keyframe.0).expect("it resumes");
        for (input, hash) in &log[from..] {
            prop_assert_eq!(rolled_back.step(input).hash, *hash);
        }
        for (input, hash) in &log[keyframe.1..] {
            prop_assert_eq!(resumed.step(input).hash, *hash);
        }
    }
}

/// What holds after every tick.
fn check(world: &World, input: &TickInput, output: &kernel::TickOutput) -> Result<(), TestCaseError> {
    let (rules, applied) = (world.scenario().rules, output.applied.controls);
    prop_assert_eq!(world.hash(), output.hash);
    let scene = world.scene();
    prop_assert!(scene.ego.position.is_finite() && scene.ego.rotation.is_finite() && scene.ego.speed_mps.abs() < 100.0);
    for actor in &scene.actors {
        prop_assert!(actor.position.is_finite() && actor.rotation.is_finite(), "actor {}", actor.id);
    }
    if input.safety.brake_fraction() > rules.brake_threshold {
        prop_assert!(applied.brake >= input.safety.brake, "the safety brake acts");
        prop_assert!(
            applied.throttle == 0 || applied.throttle == input.safety.throttle,
            "the semantic throttle is cut"
        );
    }
    if input.safety.steer_fraction().abs() > rules.steer_threshold {
        prop_assert_eq!(applied.steer, input.safety.steer);
    }
    Ok(())
}

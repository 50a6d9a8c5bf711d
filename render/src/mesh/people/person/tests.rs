//! What is asked of people as they are drawn.

use std::collections::BTreeSet;

use kernel::scene::ActorKind;

use super::*;
use crate::mesh::actor::{actor_model, sheltered_model};
use crate::mesh::motion::Motion;

const KINDS: [ActorKind; 2] = [ActorKind::Pedestrian, ActorKind::Child];

/// Limbs, hats and bags may stand out of the box by this, metres; umbrellas by more.
const OVER_M: f32 = 0.18;
const UMBRELLA_M: f32 = 0.4;
/// Nothing may be outside the sphere by which actors are culled: around the box and so much larger, metres.
const AROUND_M: f32 = 0.4;

fn variants() -> impl Iterator<Item = u32> {
    (0..200).map(|i| i * 331)
}

fn corners(model: &Model, motion: &Motion) -> Vec<Vec3> {
    let posed = model.posed(motion);
    posed.flat_map(|(mesh, pose)| mesh.vertices.iter().map(move |v| pose.transform_point3(v.position.into()))).collect()
}

fn at(phase_rad: f32, speed_mps: f32) -> Motion {
    Motion { phase_rad, speed_mps, ..Motion::default() }
}

/// How far a body reaches in a direction, metres.
fn reach_m(corners: &[Vec3], direction: Vec3) -> f32 {
    corners.iter().map(|p| p.dot(direction)).fold(f32::MIN, f32::max)
}

#[test]
fn everybody_who_stands_fits_the_box() {
    for (kind, variant) in KINDS.into_iter().flat_map(|kind| variants().map(move |v| (kind, v))) {
        for (detail, umbrella) in Detail::ALL.into_iter().flat_map(|detail| [(detail, false), (detail, true)]) {
            let size = kind.size_m();
            let corners = corners(&sheltered_model(kind, variant, detail, umbrella), &Motion::default());
            let most = corners.iter().fold(Vec3::ZERO, |m, p| m.max(Vec3::new(p.x.abs(), p.y.abs(), p.z)));
            let over = (most - size * Vec3::new(0.5, 0.5, 1.0)).max_element();
            let far_m = corners.iter().map(|p| p.distance(Vec3::Z * 0.5 * size.z)).fold(0.0, f32::max);
            assert!(far_m < 0.5 * size.length() + AROUND_M, "{kind:?} {variant} {detail:?} {umbrella}: {far_m} m");
            let may = if umbrella { UMBRELLA_M } else { OVER_M };
            assert!(over < may && most.z > 0.85 * size.z, "{kind:?} {variant} {detail:?} {umbrella}: {most}");
        }
    }
}

#[test]
fn people_differ_in_outline() {
    for (kind, heights, widths) in [(ActorKind::Pedestrian, 25, 15), (ActorKind::Child, 18, 7)] {
        let (mut tall, mut wide) = (BTreeSet::new(), BTreeSet::new());
        for variant in variants() {
            let corners = corners(&actor_model(kind, variant, Detail::Fine), &Motion::default());
            tall.insert((100.0 * reach_m(&corners, Vec3::Z)) as u32);
            wide.insert((100.0 * (reach_m(&corners, Vec3::Y) + reach_m(&corners, Vec3::NEG_Y))) as u32);
        }
        assert!(tall.len() >= heights && wide.len() >= widths, "{kind:?}: {} cm {} cm", tall.len(), wide.len());
    }
}

#[test]
fn many_are_dressed_in_dark_and_few_in_vests() {
    let outfits: Vec<Outfit> = (0..2000).map(|v| Outfit::of(&mut Variety::of(v), false)).collect();
    let share = |is: fn(&Outfit) -> bool| outfits.iter().filter(|o| is(o)).count() as f32 / outfits.len() as f32;
    let (dark, vests) = (share(Outfit::is_dark), share(|o| o.vest.is_some()));
    assert!((0.25..0.5).contains(&dark), "{dark} wear dark all over");
    assert!((0.03..0.08).contains(&vests), "{vests} wear vests");
    assert!((0.1..0.25).contains(&share(|o| o.carried == Carried::Backpack)));
    assert!((0.03..0.2).contains(&share(|o| o.carried == Carried::Stick)));
}

#[test]
fn levels_of_detail_have_the_same_outline() {
    let steps = [-1.0f32, 0.0, 1.0];
    let all = steps.into_iter().flat_map(|x| steps.into_iter().flat_map(move |y| steps.map(|z| Vec3::new(x, y, z))));
    let directions: Vec<Vec3> = all.filter(|d| *d != Vec3::ZERO).map(Vec3::normalize).collect();
    for (kind, variant) in KINDS.into_iter().flat_map(|kind| variants().map(move |v| (kind, v))) {
        let umbrella = kind == ActorKind::Pedestrian && variant % 3 == 0;
        let models = Detail::ALL.map(|detail| sheltered_model(kind, variant, detail, umbrella));
        for motion in [at(0.0, 0.0), at(0.7, 1.3), at(2.4, 1.3), at(4.0, 3.2)] {
            let outlines = [0, 1, 2].map(|i: usize| corners(&models[i], &motion));
            for (detail, &direction) in
                [Detail::Coarse, Detail::Rough].iter().flat_map(|d| directions.iter().map(move |v| (d, v)))
            {
                let off = reach_m(&outlines[0], direction) - reach_m(&outlines[*detail as usize], direction);
                assert!(off.abs() < detail.error_m(), "{kind:?} {variant} {detail:?} {motion:?} {direction}: {off}");
            }
        }
    }
}

#[test]
fn who_stands_stands_still_and_who_moves_treads_the_ground() {
    for (kind, variant) in KINDS.into_iter().flat_map(|kind| variants().map(move |v| (kind, v))) {
        let model = actor_model(kind, variant, Detail::Fine);
        assert_eq!(corners(&model, &at(0.0, 0.0)), corners(&model, &at(2.0, 0.0)));
        // Sticks are for who walks upright and slowly.
        if kind == ActorKind::Pedestrian && Outfit::of(&mut Variety::of(variant), false).carried == Carried::Stick {
            continue;
        }
        for (i, speed) in (0..16).flat_map(|i| [0.0, 0.6, 1.4, 3.0].map(|speed| (i, speed))) {
            let lowest_m = -reach_m(&corners(&model, &at(0.4 * i as f32, speed)), Vec3::NEG_Z);
            assert!(lowest_m.abs() < 0.05, "{kind:?} {variant} at {speed} m/s, {i}: {lowest_m}");
        }
    }
}

#[test]
fn feet_stay_where_they_tread() {
    // The foot on the ground goes back as fast as the hips go forward: half a stride of 1.45 m from step to step.
    let model = actor_model(ActorKind::Pedestrian, 331, Detail::Fine);
    let left = |phase: f32| {
        // After hips, trunk, thigh and shin.
        model.pose(&at(phase, 1.3))[4].translation.x
    };
    let way_m = left(-0.9) - left(0.9);
    let gone_m = 1.45 * 1.8 / core::f32::consts::TAU;
    assert!((way_m - gone_m).abs() < 0.15 * gone_m, "{way_m} of {gone_m}");
}

#[test]
fn runners_lean_forward() {
    let head_m = |speed: f32| {
        let model = actor_model(ActorKind::Pedestrian, 7, Detail::Fine);
        let corners = corners(&model, &at(1.0, speed));
        corners.iter().max_by(|a, b| a.z.total_cmp(&b.z)).map_or(0.0, |p| p.x)
    };
    assert!(head_m(3.2) > head_m(1.3) + 0.05 && head_m(1.3) > head_m(0.0));
}

#[test]
fn all_of_a_walker_is_of_class_pedestrian() {
    for (variant, detail) in variants().flat_map(|v| Detail::ALL.map(|detail| (v, detail))) {
        for model in [walker(variant, detail, true), walker(variant, detail, false), child(variant, detail)] {
            let tag = SemanticTag::Pedestrian as u8;
            assert!(model.parts.iter().flat_map(|part| &part.mesh.vertices).all(|v| v.tag == tag));
        }
    }
}

#[test]
fn umbrellas_are_up_in_rain_only() {
    let up = |rain_pct: f32| variants().filter(|&v| has_umbrella_up(v, rain_pct)).count();
    assert_eq!(up(0.0), 0);
    assert!(up(15.0) > 20 && up(15.0) < up(60.0) && up(60.0) < 180, "{} {}", up(15.0), up(60.0));
}

#[test]
fn people_have_few_triangles() {
    let triangles = |model: &Model| model.parts.iter().map(|part| part.mesh.all_triangles().count()).sum::<usize>();
    for (detail, mean) in Detail::ALL.into_iter().zip([1080, 424, 114]) {
        let all: usize = variants().map(|v| triangles(&walker(v, detail, false))).sum();
        assert!(all < 200 * mean, "{detail:?}: {}", all / 200);
    }
}

//! Which model each kind of actor has.

use std::sync::OnceLock;

use kernel::map::FurnitureKind;
use kernel::scene::ActorKind;

use super::model::{Detail, Model};
use super::people::person;
use super::street::furniture;
use super::vehicles::{bus, car, emergency, lorry, motorcycle, tram, two_wheeler, van, wheeled};
use crate::SemanticTag;

/// The model of an actor in dry weather; vehicles have people in them at their finest.
pub fn actor_model(kind: ActorKind, variant: u32, detail: Detail) -> Model {
    sheltered_model(kind, variant, detail, false)
}

/// Whether an actor is under an umbrella in rain of so many percent of a cloudburst.
pub fn has_umbrella_up(kind: ActorKind, variant: u32, rain_pct: f32) -> bool {
    rain_pct > 0.0 && kind == ActorKind::Pedestrian && person::has_umbrella_up(variant, rain_pct)
}

/// The model of an actor, under its umbrella if it has one up.
pub fn sheltered_model(kind: ActorKind, variant: u32, detail: Detail, under_umbrella: bool) -> Model {
    match kind {
        ActorKind::Car => car::car(variant, detail),
        ActorKind::Truck => lorry::truck(variant, detail),
        ActorKind::Bus => bus::bus(variant, detail),
        ActorKind::Motorcycle => motorcycle::motorcycle(variant, detail),
        ActorKind::Bicycle => two_wheeler::bicycle(variant, detail),
        ActorKind::Van => van::van(variant, detail),
        ActorKind::Suv => car::suv(variant, detail),
        ActorKind::Emergency => emergency::emergency(variant, detail),
        ActorKind::Scooter => motorcycle::scooter(variant, detail),
        ActorKind::CargoBike => two_wheeler::cargo_bike(variant, detail),
        ActorKind::Pedestrian => person::walker(variant, detail, under_umbrella),
        ActorKind::Child => person::child(variant, detail),
        ActorKind::Pram => wheeled::pram(variant, detail),
        ActorKind::Wheelchair => wheeled::wheelchair(variant, detail),
        ActorKind::Tram => Model::rigid(tram::tram(variant, detail)),
        ActorKind::Door => Model::rigid(car::door(variant)),
        ActorKind::Obstacle => {
            let (what, tag) = (FurnitureKind::Other, SemanticTag::Dynamic);
            Model::rigid(furniture::mesh(what, tag, variant, kind.size_m(), detail))
        }
    }
}

/// The model of a parked car: the same without anybody in it.
pub fn parked_model(kind: ActorKind, variant: u32, detail: Detail) -> Model {
    match kind {
        ActorKind::Car => car::parked(variant, detail),
        ActorKind::Van => van::parked(variant, detail),
        _ => actor_model(kind, variant, detail),
    }
}

/// [`kernel::scene::ActorScene::variant`] that the ego car is drawn with.
pub const EGO_VARIANT: u32 = 2;

/// The model of the ego car; the origin is the middle of its footprint.
pub fn ego_model() -> &'static Model {
    static EGO: OnceLock<Model> = OnceLock::new();
    EGO.get_or_init(|| car::steered(EGO_VARIANT))
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use kernel::ops;
    use kernel::scene::EgoScene;

    use super::*;
    use crate::mesh::model::{Joint, Part};
    use crate::mesh::motion::{LAP_M, Motion};

    /// Mirrors and heads may stand out by this, metres.
    const OVER_M: f32 = 0.18;

    #[test]
    fn every_kind_is_drawn_as_large_as_it_is() {
        for &kind in ActorKind::ALL {
            for (detail, variant) in Detail::ALL.into_iter().flat_map(|detail| (0..12).map(move |v| (detail, v))) {
                let (model, size) = (actor_model(kind, variant, detail), kind.size_m());
                let mut most = Vec3::ZERO;
                for (mesh, pose) in model.posed(&Motion::default()) {
                    let corners = mesh.vertices.iter().map(|v| pose.transform_point3(Vec3::from(v.position)));
                    most = corners.fold(most, |most, p| most.max(Vec3::new(p.x.abs() * 2.0, p.y.abs() * 2.0, p.z)));
                }
                let over = (most - size) * Vec3::new(0.5, 0.5, 1.0);
                assert!(over.max_element() < OVER_M && most.z > 0.85 * size.z, "{kind:?} {detail:?}: {most} of {size}");
            }
        }
    }

    const SPOKE_RAD: f32 = core::f32::consts::TAU / 5.0;
    const MOTORCARS: [ActorKind; 6] =
        [ActorKind::Car, ActorKind::Suv, ActorKind::Van, ActorKind::Truck, ActorKind::Bus, ActorKind::Emergency];

    fn ego(x: f32, speed_mps: f32, wheel_angle_rad: f32) -> EgoScene {
        EgoScene { position: Vec3::X * x, rotation: Quat::IDENTITY, speed_mps, wheel_angle_rad, lamps: 0 }
    }

    /// Of each part that is a wheel: how far forward of the middle it is, and the heading that it points to.
    fn wheels(model: &Model, motion: &Motion) -> Vec<(f32, f32)> {
        let parts = model.parts.iter().zip(model.pose(motion));
        let wheels = parts.filter(|(part, _)| part.parent.is_none() && part.pivot.z > 0.0);
        wheels.map(|(_, pose)| (pose.translation.x, ops::atan2(pose.matrix3.x_axis.y, pose.matrix3.x_axis.x))).collect()
    }

    /// Turns about y of the rims that are shown, radians.
    fn rims(model: &Model, motion: &Motion) -> Vec<f32> {
        let parts = model.parts.iter().zip(model.pose(motion));
        let rolls = |part: &Part| matches!(part.joint, Some(Joint::Roll { .. }));
        let rims = parts.filter(|(part, _)| rolls(part) && part.is_shown(motion.speed_mps.abs()));
        rims.map(|(_, pose)| ops::atan2(-pose.matrix3.x_axis.z, pose.matrix3.z_axis.z)).collect()
    }

    #[test]
    fn the_front_wheels_of_the_ego_car_steer_and_no_others() {
        for right_rad in [0.0, 0.4, -0.6] {
            let wheels = wheels(ego_model(), &Motion::of_ego(&ego(7.0, 1.0, right_rad)));
            assert_eq!(wheels.len(), 4);
            for (x, heading_rad) in wheels {
                let wanted = if x > 0.0 { -right_rad } else { 0.0 };
                assert!((heading_rad - wanted).abs() < 1e-3, "{x}: {heading_rad} for {right_rad} to the right");
            }
        }
    }

    #[test]
    fn rims_turn_by_the_way_over_the_radius_and_begin_anew_unseen() {
        for kind in MOTORCARS {
            let model = actor_model(kind, 5, Detail::Fine);
            let at = |rolled_m: f32| rims(&model, &Motion { rolled_m, speed_mps: 1.0, ..Motion::default() });
            let wheel = model.parts.iter().find(|part| part.joint == Some(Joint::Steer)).expect("it steers");
            let wheels = wheels(&model, &Motion::default()).len();
            assert_eq!(at(0.2).len(), wheels, "{kind:?}");
            for (turn, lap) in at(0.2).into_iter().zip(at(LAP_M)) {
                assert!((turn * wheel.pivot.z / 0.2 - 1.0).abs() < 0.07, "{kind:?}: {turn} rad");
                let spokes = lap / SPOKE_RAD;
                assert!((spokes - spokes.round()).abs() < 1e-3, "{kind:?}: {spokes}");
            }
        }
    }

    #[test]
    fn rims_of_the_ego_car_turn_as_it_drives_until_they_blur() {
        let at = |x: f32, mps: f32| rims(ego_model(), &Motion::of_ego(&ego(x, mps, 0.0)));
        // A rim looks the same a spoke on.
        let turn =
            |a: f32, b: f32| (at(b, 1.0)[0] - at(a, 1.0)[0] + 0.5 * SPOKE_RAD).rem_euclid(SPOKE_RAD) - 0.5 * SPOKE_RAD;
        for (from, to) in [(0.0, 0.1), (4.97, 5.07), (2.0, 1.9), (0.05, -0.05)] {
            assert!((turn(from, to) - (to - from) / kernel::ego::WHEEL_RADIUS_M).abs() < 0.02, "{from} to {to}");
        }
        assert_eq!(at(3.3, -1.0), at(3.3, 1.0), "where it is, not how it came there");
        assert_eq!([1.0, 4.0, -4.0, 9.0, -9.0].map(|mps| at(3.3, mps).len()), [4, 4, 4, 0, 0]);
    }

    #[test]
    fn all_parts_of_a_motorcar_are_of_its_class() {
        for (kind, detail) in MOTORCARS.into_iter().flat_map(|kind| Detail::ALL.map(|detail| (kind, detail))) {
            for model in [&actor_model(kind, 3, detail), ego_model()] {
                let tag = model.parts[0].mesh.vertices[0].tag;
                assert!(model.parts.iter().flat_map(|part| &part.mesh.vertices).all(|v| v.tag == tag), "{kind:?}");
            }
        }
    }
}

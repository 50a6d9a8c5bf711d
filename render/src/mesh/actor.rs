//! Which model each kind of actor has.

use std::sync::OnceLock;

use kernel::scene::ActorKind;

use super::model::{Detail, Model};
use super::{car, heavy, loose, person, tram, two_wheeler, wheeled};

/// The model of an actor.
pub fn actor_model(kind: ActorKind, variant: u32, detail: Detail) -> Model {
    match kind {
        ActorKind::Car => car::car(variant, detail),
        ActorKind::Truck => heavy::truck(variant, detail),
        ActorKind::Bus => heavy::bus(variant, detail),
        ActorKind::Motorcycle => two_wheeler::motorcycle(variant, detail),
        ActorKind::Bicycle => two_wheeler::bicycle(variant, detail),
        ActorKind::Van => heavy::van(variant, detail),
        ActorKind::Suv => car::suv(variant, detail),
        ActorKind::Emergency => heavy::emergency(detail),
        ActorKind::Scooter => two_wheeler::scooter(variant, detail),
        ActorKind::CargoBike => two_wheeler::cargo_bike(variant, detail),
        ActorKind::Pedestrian => person::walker(variant, detail),
        ActorKind::Child => person::child(variant, detail),
        ActorKind::Pram => wheeled::pram(variant, detail),
        ActorKind::Wheelchair => wheeled::wheelchair(variant, detail),
        ActorKind::Tram => Model::rigid(tram::tram(variant, detail)),
        ActorKind::Door => Model::rigid(car::door(variant)),
        ActorKind::Obstacle => Model::rigid(loose::movable(variant, kind.size_m(), detail)),
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
    use glam::Vec3;

    use super::*;
    use crate::mesh::motion::Motion;

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
}

//! Which model each kind of actor has.

use std::sync::OnceLock;

use kernel::scene::ActorKind;

use super::model::{Detail, Model};
use super::{car, heavy, person, tram, two_wheeler, wheeled};

/// The model of an actor.
pub fn actor_model(kind: ActorKind, variant: u32, detail: Detail) -> Model {
    match kind {
        ActorKind::Car => Model::rigid(car::car(variant, detail)),
        ActorKind::Truck => Model::rigid(heavy::truck(variant, detail)),
        ActorKind::Bus => Model::rigid(heavy::bus(variant, detail)),
        ActorKind::Motorcycle => two_wheeler::motorcycle(variant, detail),
        ActorKind::Bicycle => two_wheeler::bicycle(variant, detail),
        ActorKind::Van => Model::rigid(heavy::van(variant, detail)),
        ActorKind::Suv => Model::rigid(car::suv(variant, detail)),
        ActorKind::Emergency => Model::rigid(heavy::emergency(detail)),
        ActorKind::Scooter => two_wheeler::scooter(variant, detail),
        ActorKind::CargoBike => two_wheeler::cargo_bike(variant, detail),
        ActorKind::Pedestrian => person::walker(variant, detail),
        ActorKind::Child => person::child(variant, detail),
        ActorKind::Pram => wheeled::pram(variant, detail),
        ActorKind::Wheelchair => wheeled::wheelchair(variant, detail),
        ActorKind::Tram => Model::rigid(tram::tram(variant, detail)),
        ActorKind::Door => Model::rigid(car::door(variant)),
    }
}

/// [`kernel::scene::ActorScene::variant`] that the ego car is drawn with.
pub const EGO_VARIANT: u32 = 2;

/// The model of the ego car; the origin is the middle of its footprint.
pub fn ego_model() -> &'static Model {
    static EGO: OnceLock<Model> = OnceLock::new();
    EGO.get_or_init(|| actor_model(ActorKind::Car, EGO_VARIANT, Detail::Fine))
}

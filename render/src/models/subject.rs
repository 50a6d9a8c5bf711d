//! What a model may stand for.

use glam::Vec3;
use kernel::map::{FurnitureKind, Prop, PropKind};
use kernel::scene::ActorKind;

use crate::SemanticTag;

/// What a model may stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    /// The ego car.
    Ego,
    /// A road user, or a parked one.
    Actor(ActorKind),
    /// A tree.
    Tree,
    /// A street lamp, whose arm reaches forward.
    Lamp,
    /// A piece of street furniture, whether it stands fast or not.
    Furniture(FurnitureKind),
}

use ActorKind as A;
use FurnitureKind as F;
use Subject::{Actor, Ego, Furniture, Lamp, Tree};

/// Every one with its name. Open doors are those of the renderer's own cars.
const NAMES: [(&str, Subject); 33] = [
    ("ego", Ego),
    ("car", Actor(A::Car)),
    ("suv", Actor(A::Suv)),
    ("van", Actor(A::Van)),
    ("emergency", Actor(A::Emergency)),
    ("truck", Actor(A::Truck)),
    ("bus", Actor(A::Bus)),
    ("tram", Actor(A::Tram)),
    ("motorcycle", Actor(A::Motorcycle)),
    ("scooter", Actor(A::Scooter)),
    ("bicycle", Actor(A::Bicycle)),
    ("cargo_bike", Actor(A::CargoBike)),
    ("pedestrian", Actor(A::Pedestrian)),
    ("child", Actor(A::Child)),
    ("pram", Actor(A::Pram)),
    ("wheelchair", Actor(A::Wheelchair)),
    ("obstacle", Actor(A::Obstacle)),
    ("tree", Tree),
    ("lamp", Lamp),
    ("bench", Furniture(F::Bench)),
    ("bin", Furniture(F::Bin)),
    ("cabinet", Furniture(F::Cabinet)),
    ("post", Furniture(F::Post)),
    ("hydrant", Furniture(F::Hydrant)),
    ("mailbox", Furniture(F::Mailbox)),
    ("shelter", Furniture(F::Shelter)),
    ("dumpster", Furniture(F::Dumpster)),
    ("planter", Furniture(F::Planter)),
    ("bicycle_stand", Furniture(F::BicycleStand)),
    ("cone", Furniture(F::Cone)),
    ("beacon", Furniture(F::Beacon)),
    ("barricade", Furniture(F::Barricade)),
    ("stall", Furniture(F::Stall)),
];

impl Subject {
    /// The one with a name.
    pub fn named(name: &str) -> Option<Self> {
        NAMES.iter().find(|(known, _)| *known == name).map(|(_, subject)| *subject)
    }

    /// The names of all.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMES.iter().map(|(name, _)| *name)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        NAMES.iter().find(|(_, subject)| *subject == self).map_or("door", |(name, _)| name)
    }

    /// What an object of a map is.
    pub(super) fn of(object: &Prop) -> Option<Self> {
        match object.kind {
            PropKind::Tree => Some(Tree),
            PropKind::Lamp => Some(Lamp),
            PropKind::Furniture | PropKind::Movable | PropKind::Sundry => {
                Some(Furniture(FurnitureKind::of(object.variant)))
            }
            _ => None,
        }
    }

    /// Its class; that of furniture is its object's.
    pub fn tag(self) -> SemanticTag {
        use SemanticTag as T;
        match self {
            Ego => T::Vehicles,
            Actor(kind) => match kind {
                A::Car | A::Suv | A::Van | A::Emergency | A::Door => T::Vehicles,
                A::Truck => T::Truck,
                A::Bus => T::Bus,
                A::Tram => T::Train,
                A::Motorcycle | A::Scooter => T::Motorcycle,
                A::Bicycle | A::CargoBike => T::Bicycle,
                A::Pedestrian | A::Child | A::Pram | A::Wheelchair => T::Pedestrian,
                A::Obstacle => T::Dynamic,
            },
            Tree => T::Vegetation,
            Lamp => T::Pole,
            Furniture(_) => T::Static,
        }
    }

    /// Length, width and height that it has, metres; of what stands in the street, where each has its own, usual ones.
    pub(super) fn usual_size_m(self) -> Vec3 {
        match self {
            Ego => A::Car.size_m(),
            Actor(kind) => kind.size_m(),
            Tree => Vec3::new(3.6, 3.6, 8.0),
            Lamp => Vec3::new(2.0, 0.5, 7.0),
            Furniture(F::Shelter | F::Stall) => Vec3::new(3.0, 2.0, 2.5),
            Furniture(_) => Vec3::ONE,
        }
    }

    /// Whether each of them is kept in memory by itself, as what stands in the street is.
    pub fn stands_still(self) -> bool {
        matches!(self, Tree | Lamp | Furniture(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::actor::actor_model;
    use crate::mesh::model::Detail;

    #[test]
    fn every_subject_is_found_by_its_name() {
        for (name, subject) in NAMES {
            assert_eq!((Subject::named(name), subject.name()), (Some(subject), name));
        }
        let unnamed = ActorKind::ALL.iter().filter(|kind| Subject::named(Actor(**kind).name()) != Some(Actor(**kind)));
        assert_eq!(unnamed.collect::<Vec<_>>(), [&A::Door]);
    }

    #[test]
    fn classes_are_those_of_what_is_drawn_otherwise() {
        for &kind in ActorKind::ALL {
            let model = actor_model(kind, 3, Detail::Fine);
            let tags = model.parts.iter().flat_map(|part| &part.mesh.vertices).map(|v| v.tag);
            let first = tags.clone().find(|tag| *tag != SemanticTag::Rider as u8);
            assert_eq!(first, Some(Actor(kind).tag() as u8), "{kind:?}");
        }
    }
}

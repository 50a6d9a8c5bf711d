//! What somebody on foot looks like, in words: for statistics of who was seen.

use kernel::scene::ActorKind;

use super::outfit::Outfit;
pub use super::outfit::{Age, Carried};
use crate::mesh::variety::Variety;

/// What is told of somebody's looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Appearance {
    /// Years as far as they are seen.
    pub age: Age,
    /// Height when upright, bare-headed, metres.
    pub height_m: f32,
    /// Dressed in dark, top and legs.
    pub is_dark: bool,
    /// In a high-visibility vest.
    pub has_vest: bool,
    /// What is carried.
    pub carried: Carried,
}

impl Appearance {
    /// That of a walker or a child; others have none.
    pub fn of(kind: ActorKind, variant: u32) -> Option<Self> {
        let is_child = match kind {
            ActorKind::Pedestrian => false,
            ActorKind::Child => true,
            _ => return None,
        };
        let outfit = Outfit::of(&mut Variety::of(variant), is_child);
        Some(Self {
            age: outfit.age,
            height_m: outfit.build.height_m,
            is_dark: outfit.is_dark(),
            has_vest: outfit.vest.is_some(),
            carried: outfit.carried,
        })
    }
}

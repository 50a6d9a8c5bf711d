//! Models of a user's own, which stand for what the renderer makes in code.
//!
//! Whoever reads them from files makes them [known](Models::register); a camera then names them by their [`ModelsId`], so that
//! a picture follows from snapshot, camera and map still.

mod fit;
mod id;
mod subject;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec3;
use kernel::map::{Prop, PropKind};
use kernel::scene::ActorKind;

use crate::mesh::look::look;
use crate::mesh::model::{Detail, Model};
use crate::mesh::variety::Variety;
use crate::mesh::vehicles::lacquer;
use crate::mesh::{CODE_LACQUER, Mesh, simplify};

pub use fit::per_m;
pub use id::ModelsId;
pub use subject::Subject;

/// By how much less a level may differ from a finer one than its outlines: models have small parts near one another.
const LEVEL_SHARE: f32 = 0.5;
/// Colours of vertices that are drawn into one another differ by up to this at [`Detail::Coarse`], of 255.
const COARSE_COLOUR: u8 = 40;

/// A model that stands for something, as large as that is, at all levels of detail.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// In the order of [`Detail::ALL`].
    levels: [Model; Detail::ALL.len()],
    /// Length, width and height of the box around it, metres.
    size_m: Vec3,
    /// The middle of the glass of a street lamp, if it has one.
    glass: Option<Vec3>,
}

impl Figure {
    /// Fits a model into the box of what it stands for, wherever its origin is. The error says what is wrong with its shape.
    pub fn new(subject: Subject, model: Model) -> Result<Self, String> {
        let (fitted, size_m) = fit::fitted(subject, model)?;
        let level = |detail: Detail| {
            let mut model = fitted.clone();
            let differ = if detail == Detail::Rough { u8::MAX } else { COARSE_COLOUR };
            for part in model.parts.iter_mut().filter(|_| detail != Detail::Fine) {
                part.mesh = simplify::simplified_in_colour(&part.mesh, LEVEL_SHARE * detail.error_m(), differ);
            }
            model
        };
        let levels = Detail::ALL.map(level);
        Ok(Self { levels, size_m, glass: fit::glass(&fitted) })
    }

    /// That level, in the colours that its file has.
    pub fn at(&self, detail: Detail) -> &Model {
        &self.levels[detail as usize]
    }

    /// That level in the colour of a variant.
    fn level(&self, detail: Detail, kind: ActorKind, variant: u32) -> Model {
        let mut model = self.levels[detail as usize].clone();
        let lacquer = lacquer::of(kind, &mut Variety::of(variant)).colour;
        for vertex in model.parts.iter_mut().flat_map(|part| &mut part.mesh.vertices) {
            if vertex.code == CODE_LACQUER {
                (vertex.code, vertex.colour) = (0, fit::tinted(lacquer, vertex.colour));
            }
        }
        model
    }
}

/// What stands for what; several models of one thing are taken by variant.
#[derive(Clone, Debug, PartialEq)]
pub struct Models {
    id: ModelsId,
    figures: BTreeMap<Subject, Vec<Figure>>,
}

/// All that were read so far, by their digests: what a digest stands for does not change.
static KNOWN: Mutex<BTreeMap<ModelsId, Arc<Models>>> = Mutex::new(BTreeMap::new());

impl Models {
    /// Models that come from files with this digest.
    pub fn new(id: ModelsId, figures: BTreeMap<Subject, Vec<Figure>>) -> Self {
        Self { id, figures }
    }

    /// Makes them known to every renderer of this process.
    pub fn register(self) -> ModelsId {
        let id = self.id;
        KNOWN.lock().unwrap_or_else(PoisonError::into_inner).entry(id).or_insert_with(|| Arc::new(self));
        id
    }

    /// Those with a digest, if they were read.
    pub(crate) fn known(id: ModelsId) -> Option<Arc<Self>> {
        KNOWN.lock().unwrap_or_else(PoisonError::into_inner).get(&id).cloned()
    }

    /// The digests of those that were read, as a sentence may name them.
    pub(crate) fn known_ids() -> String {
        let known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        let ids: Vec<String> = known.keys().map(ModelsId::to_string).collect();
        if ids.is_empty() { "none".into() } else { ids.join(", ") }
    }

    /// Their digest.
    pub fn id(&self) -> ModelsId {
        self.id
    }

    /// Those of a subject.
    pub fn of(&self, subject: Subject) -> &[Figure] {
        self.figures.get(&subject).map_or(&[], Vec::as_slice)
    }

    /// The ego car, if there is a model of it.
    pub(crate) fn ego(&self, variant: u32) -> Option<Model> {
        let figure = self.of(Subject::Ego).first()?;
        Some(figure.level(Detail::Fine, ActorKind::Car, variant))
    }

    /// A road user; `made` is what is drawn without models, whose rider it has if it brings none.
    pub(crate) fn actor(
        &self,
        kind: ActorKind,
        variant: u32,
        detail: Detail,
        made: impl FnOnce() -> Model,
    ) -> Option<Model> {
        let figure = self.chosen(Subject::Actor(kind), variant, |_| true)?;
        let model = figure.level(detail, kind, variant);
        let is_ridden = fit::is_ridden(kind) && !fit::has_rider(&model);
        Some(if is_ridden { fit::with_rider_of(model, made()) } else { model })
    }

    /// What stands in the street, if a model of it can be made as large as that is.
    pub(crate) fn object(&self, object: &Prop, detail: Detail) -> Option<Mesh> {
        if object.kind == PropKind::ParkedCar {
            let kind = object.parked_kind();
            return Some(self.actor(kind, look(object), detail, Model::default)?.at_rest());
        }
        let (figure, stretch) = self.standing(object)?;
        let mut mesh = figure.levels[detail as usize].at_rest();
        mesh.scale(stretch);
        fit::finish_object(&mut mesh, object);
        Some(mesh)
    }

    /// Where a street lamp of a map shines, as seen from its foot, if its model says so.
    pub(crate) fn lamp_glass(&self, object: &Prop) -> Option<Vec3> {
        let (figure, stretch) = self.standing(object)?;
        Some(figure.glass? * stretch)
    }

    /// The model of what stands in the street, and the factors that make it as large as that is.
    fn standing(&self, object: &Prop) -> Option<(&Figure, Vec3)> {
        let subject = Subject::of(object)?;
        let stretch = |figure: &Figure| fit::stretch(subject, figure.size_m, object.size).ok();
        let figure = self.chosen(subject, look(object), |figure| stretch(figure).is_some())?;
        Some((figure, stretch(figure)?))
    }

    fn chosen(&self, subject: Subject, variant: u32, fits: impl Fn(&Figure) -> bool) -> Option<&Figure> {
        let fitting: Vec<&Figure> = self.of(subject).iter().filter(|figure| fits(figure)).collect();
        let number = Variety::of(variant ^ CHOICE).bits() as usize;
        fitting.get(number % fitting.len().max(1)).copied()
    }
}

/// Sets the choice among models apart from the others that a variant makes.
const CHOICE: u32 = 0x6d6f_6465;

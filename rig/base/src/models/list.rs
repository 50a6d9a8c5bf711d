//! `models.toml`.

use std::collections::BTreeSet;

use render::models::Subject;
use serde::Deserialize;

use crate::toml_text;

/// The list of a folder.
pub(super) const LIST: &str = "models.toml";

/// Files of a list at most.
const MOST_FILES: usize = 256;

/// What stands for what.
#[derive(Debug)]
pub(super) struct List {
    pub(super) entries: Vec<Entry>,
}

/// A file and what it stands for.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) is: Vec<Subject>,
    pub(super) said: Model,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default)]
    models: Vec<Model>,
}

/// What is said of a file: what it is, and what its parts are by the names of its nodes and materials.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Model {
    pub(super) file: String,
    is: Vec<String>,
    /// Turns the model to the left, degrees, where it does not face along the z axis of glTF.
    pub(super) yaw_deg: f32,
    /// Nodes that roll.
    pub(super) wheels: Vec<String>,
    /// Those of them that steer.
    pub(super) steered: Vec<String>,
    /// Nodes that swing as somebody walks: of the left and of the right.
    pub(super) legs: Vec<String>,
    pub(super) arms: Vec<String>,
    /// Nodes that are a rider.
    pub(super) rider: Vec<String>,
    /// Materials that take the colour of their vehicle.
    pub(super) lacquer: Vec<String>,
    pub(super) lamps: Lamps,
}

/// Materials that shine.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Lamps {
    pub(super) head: Vec<String>,
    pub(super) brake: Vec<String>,
    pub(super) left: Vec<String>,
    pub(super) right: Vec<String>,
    pub(super) street: Vec<String>,
}

impl List {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let document: Document = toml_text::read(text)?;
        let count = document.models.len();
        if !(1..=MOST_FILES).contains(&count) {
            return Err(format!("lists {count} models, expected 1 to {MOST_FILES} as [[models]]"));
        }
        let entries = document.models.into_iter().map(Entry::of);
        Ok(Self { entries: entries.collect::<Result<_, _>>()? })
    }
}

impl Model {
    /// All lists of names, and what they are called.
    fn names(&self) -> impl Iterator<Item = (&'static str, &[String])> {
        let Self { is, wheels, steered, legs, arms, rider, lacquer, lamps, .. } = self;
        let Lamps { head, brake, left, right, street } = lamps;
        let parts = [("is", is), ("wheels", wheels), ("steered", steered), ("legs", legs), ("arms", arms)];
        let rest = [("rider", rider), ("lacquer", lacquer), ("lamps.head", head), ("lamps.brake", brake)];
        let lamps = [("lamps.left", left), ("lamps.right", right), ("lamps.street", street)];
        parts.into_iter().chain(rest).chain(lamps).map(|(what, names)| (what, names.as_slice()))
    }
}

/// A name that is there more than once.
fn repeated(names: &[String]) -> Option<&String> {
    let mut known = BTreeSet::new();
    names.iter().find(|name| !known.insert(*name))
}

impl Entry {
    fn of(said: Model) -> Result<Self, String> {
        let Model { file, is, .. } = &said;
        let subject = |name: &String| {
            let known = || Subject::names().collect::<Vec<_>>().join(", ");
            Subject::named(name).ok_or_else(|| format!("{file} is {name:?}, expected one of {}", known()))
        };
        let twice = said.names().find_map(|(what, names)| Some((what, repeated(names)?)));
        if let Some((what, name)) = twice {
            return Err(format!("{file} has {name:?} twice in {what}, expected different names"));
        }
        let is: BTreeSet<Subject> = is.iter().map(subject).collect::<Result<_, _>>()?;
        if is.is_empty() {
            return Err(format!("{file} is nothing, expected a name such as is = [\"car\"]"));
        }
        if !(-360.0..=360.0).contains(&said.yaw_deg) {
            return Err(format!("{file} has yaw_deg = {}, expected -360 to 360", said.yaw_deg));
        }
        if let Some(stray) = said.steered.iter().find(|node| !said.wheels.contains(node)) {
            return Err(format!("{file} steers {stray:?}, expected one of its wheels"));
        }
        for (what, nodes) in [("legs", &said.legs), ("arms", &said.arms)] {
            if ![0, 2].contains(&nodes.len()) {
                return Err(format!("{file} has {} {what}, expected two, the left one first", nodes.len()));
            }
        }
        Ok(Self { is: is.into_iter().collect(), said })
    }
}

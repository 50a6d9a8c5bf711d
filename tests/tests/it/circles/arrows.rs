//! Which file takes which names from which other file of its crate.

use std::collections::BTreeMap;

use super::mentions::{How, Mention};
use super::modules::{Binding, Modules};
use super::names::{Target, is_within, targets};

/// From one file to another: each name that is taken, with the first line that takes it.
pub type Arrows = BTreeMap<(String, String), BTreeMap<String, usize>>;

/// The arrows of a crate.
pub fn of(modules: &Modules) -> Arrows {
    let mut arrows = Arrows::new();
    for (id, module) in modules.all.iter().enumerate() {
        for mention in &module.mentions {
            for (to, name) in taken(modules, id, mention) {
                let to = modules.all[to].file.clone();
                if to != module.file {
                    let line = arrows.entry((module.file.clone(), to)).or_default().entry(name).or_insert(mention.line);
                    *line = mention.line.min(*line);
                }
            }
        }
    }
    arrows
}

/// The modules, each with a name of its own, that a mention takes.
///
/// A module that is named by itself is not taken: what counts is what is then taken from it.
fn taken(modules: &Modules, module: usize, mention: &Mention) -> Vec<(usize, String)> {
    if offers_a_child(modules, module, mention) {
        return Vec::new();
    }
    let glob = matches!(mention.how, How::Use { name: None, .. });
    let found = targets(modules, module, &mention.path).into_iter();
    found
        .filter_map(|target| match target {
            Target::Item(to, name) => Some((to, name)),
            Target::Module(to) => (glob && defines_names(modules, to)).then(|| (to, "*".to_owned())),
        })
        .collect()
}

/// Whether a mention is a facade's `pub use` of what is below it.
fn offers_a_child(modules: &Modules, module: usize, mention: &Mention) -> bool {
    let through = match &mention.how {
        How::Use { name: None, public: true } => &mention.path[..],
        How::Use { name: Some(_), public: true } => &mention.path[..mention.path.len() - 1],
        _ => return false,
    };
    let home = |target: &Target| match target {
        Target::Module(id) | Target::Item(id, _) => *id,
    };
    let through = targets(modules, module, through);
    through.iter().map(home).any(|id| id != module && is_within(modules, id, module))
}

/// Whether a module has items of its own; `use super::*` brings these, and others only when they are named.
fn defines_names(modules: &Modules, module: usize) -> bool {
    let here = |binding: &Binding| matches!(binding, Binding::Here);
    modules.all[module].names.values().flatten().any(here)
}

//! What a path leads to: facades are followed to the file that defines the name.

use std::collections::BTreeSet;

use super::modules::{Binding, Modules};

/// The end of a path.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Target {
    Module(usize),
    /// A name that a module defines.
    Item(usize, String),
}

/// Follows paths; keeps what it is following, since `use` lines may lead back to themselves.
pub struct Follower<'a> {
    modules: &'a Modules,
    following: BTreeSet<(usize, String, usize)>,
}

/// All that a path which stands in `module` may mean; nothing where it leads out of the crate.
pub fn targets(modules: &Modules, module: usize, path: &[String]) -> BTreeSet<Target> {
    Follower { modules, following: BTreeSet::new() }.path(module, path)
}

/// A child's child's ... `module`, or itself.
pub fn is_within(modules: &Modules, mut module: usize, outer: usize) -> bool {
    while module != outer {
        let Some(parent) = modules.all[module].parent else { return false };
        module = parent;
    }
    true
}

impl Follower<'_> {
    fn path(&mut self, module: usize, path: &[String]) -> BTreeSet<Target> {
        let Some((first, rest)) = path.split_first() else { return BTreeSet::new() };
        let mut at = self.first(module, first, rest.is_empty());
        for (i, segment) in rest.iter().enumerate() {
            let modules: BTreeSet<usize> = at.iter().filter_map(module_of).collect();
            if modules.is_empty() {
                return at;
            }
            let last = i + 1 == rest.len();
            at = modules.into_iter().flat_map(|module| self.step(module, segment, last)).collect();
        }
        at
    }

    fn first(&mut self, module: usize, name: &str, last: bool) -> BTreeSet<Target> {
        let all = &self.modules.all;
        match name {
            "self" => [Target::Module(module)].into(),
            "super" => all[module].parent.map(Target::Module).into_iter().collect(),
            "crate" => [Target::Module(self.root(module))].into(),
            name => {
                let found = self.lookup(module, name);
                if found.is_empty() { self.without_binding(module, name, last) } else { found }
            }
        }
    }

    /// The library as its programs name it, and macros that are used in the order of the text.
    fn without_binding(&self, module: usize, name: &str, last: bool) -> BTreeSet<Target> {
        match (&self.modules.library, self.modules.macros.get(name).map(Vec::as_slice)) {
            (Some((library, package)), _) if package == name && self.root(module) != *library => {
                [Target::Module(*library)].into()
            }
            (_, Some([only])) if last => [Target::Item(*only, name.to_owned())].into(),
            _ => BTreeSet::new(),
        }
    }

    fn root(&self, mut module: usize) -> usize {
        while let Some(parent) = self.modules.all[module].parent {
            module = parent;
        }
        module
    }

    /// One segment on. A name that no item has is made by a macro, or comes from another crate: it
    /// is then taken from the module itself.
    fn step(&mut self, module: usize, name: &str, last: bool) -> BTreeSet<Target> {
        match name {
            "self" => [Target::Module(module)].into(),
            "super" => self.modules.all[module].parent.map(Target::Module).into_iter().collect(),
            name => {
                let found = self.lookup(module, name);
                let library = self.modules.library.as_ref().is_some_and(|(root, _)| *root == module);
                match self.modules.macros.get(name).map(Vec::as_slice) {
                    Some([only]) if found.is_empty() && last && library => {
                        [Target::Item(*only, name.to_owned())].into()
                    }
                    _ if found.is_empty() => [Target::Item(module, name.to_owned())].into(),
                    _ => found,
                }
            }
        }
    }

    fn lookup(&mut self, module: usize, name: &str) -> BTreeSet<Target> {
        let all = &self.modules.all;
        let mut found = BTreeSet::new();
        for (i, binding) in all[module].names.get(name).into_iter().flatten().enumerate() {
            match binding {
                Binding::Here => found.extend([Target::Item(module, name.to_owned())]),
                Binding::Child(child) => found.extend([Target::Module(*child)]),
                Binding::Used(path) => found.extend(self.once((module, name.to_owned(), i), |f| f.path(module, path))),
            }
        }
        if !found.is_empty() || all[module].names.contains_key(name) {
            return found;
        }
        for (i, glob) in all[module].globs.iter().enumerate() {
            found.extend(self.once((module, format!("{name} *"), i), |follower| follower.glob(module, glob, name)));
        }
        found
    }

    /// `name` among what `use glob::*` brings.
    fn glob(&mut self, module: usize, glob: &[String], name: &str) -> BTreeSet<Target> {
        let modules: Vec<usize> = self.path(module, glob).iter().filter_map(module_of).collect();
        modules.into_iter().flat_map(|module| self.lookup(module, name)).collect()
    }

    fn once<T: Default>(&mut self, key: (usize, String, usize), follow: impl FnOnce(&mut Self) -> T) -> T {
        if !self.following.insert(key.clone()) {
            return T::default();
        }
        let found = follow(self);
        self.following.remove(&key);
        found
    }
}

fn module_of(target: &Target) -> Option<usize> {
    match target {
        Target::Module(module) => Some(*module),
        Target::Item(..) => None,
    }
}

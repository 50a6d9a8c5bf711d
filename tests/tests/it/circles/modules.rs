//! The modules of a crate: what each binds and what each mentions, read from its files' texts.

use std::collections::BTreeMap;

use syn::{Item, ItemMod};

use super::attributes::for_tests_only;
use super::mentions::{self, How, Mention};

/// Texts of a crate's files by path, relative to its `src`.
pub type Files = BTreeMap<String, String>;

/// What a name stands for in a module.
#[derive(Clone, Debug)]
pub enum Binding {
    /// An item that this module defines.
    Here,
    /// A child.
    Child(usize),
    /// What a path of a `use` line leads to.
    Used(Vec<String>),
}

/// A module, in a file of its own or inline.
#[derive(Debug)]
pub struct Module {
    pub file: String,
    pub parent: Option<usize>,
    pub names: BTreeMap<String, Vec<Binding>>,
    /// Paths of `use path::*`.
    pub globs: Vec<Vec<String>>,
    pub mentions: Vec<Mention>,
}

/// All modules of a crate, parents before their children.
#[derive(Debug, Default)]
pub struct Modules {
    pub all: Vec<Module>,
    /// The library's root and the name under which programs beside it know it.
    pub library: Option<(usize, String)>,
    /// Macros by name, for those that are used without a path.
    pub macros: BTreeMap<String, Vec<usize>>,
}

/// Reads the crate of a package.
pub fn read(package: &str, files: &Files) -> Result<Modules, String> {
    let mut reader = Reader { files, modules: Modules::default() };
    for path in files.keys().filter(|path| is_root(path)) {
        let root = reader.file(path, "", None)?;
        if path == "lib.rs" {
            reader.modules.library = Some((root, package.replace('-', "_")));
        }
    }
    Ok(reader.modules)
}

fn is_root(path: &str) -> bool {
    path == "lib.rs" || path == "main.rs" || (path.starts_with("bin/") && path.matches('/').count() == 1)
}

/// Whether a file holds tests or what only tests need.
fn is_of_tests(path: &str) -> bool {
    path.split('/').any(|part| part == "tests" || part == "tests.rs") || path.ends_with("testing.rs")
}

struct Reader<'a> {
    files: &'a Files,
    modules: Modules,
}

impl Reader<'_> {
    /// Reads a file whose children are in the folder `home`, which is empty or ends with a slash.
    fn file(&mut self, path: &str, home: &str, parent: Option<usize>) -> Result<usize, String> {
        let file = syn::parse_file(&self.files[path]).map_err(|e| format!("{path}: {e}"))?;
        self.module(path, home, parent, file.items)
    }

    fn module(&mut self, file: &str, home: &str, parent: Option<usize>, items: Vec<Item>) -> Result<usize, String> {
        let id = self.modules.all.len();
        let file = file.to_owned();
        self.modules.all.push(Module { file, parent, names: BTreeMap::new(), globs: Vec::new(), mentions: Vec::new() });
        for item in items.into_iter().filter(|item| !for_tests_only(item)) {
            match item {
                Item::Mod(child) => self.child(id, home, child)?,
                item => self.item(id, &item),
            }
        }
        Ok(id)
    }

    fn child(&mut self, parent: usize, home: &str, child: ItemMod) -> Result<(), String> {
        let name = child.ident.to_string();
        let inner = format!("{home}{name}/");
        let file = self.modules.all[parent].file.clone();
        let id = match child.content {
            Some((_, items)) => self.module(&file, &inner, Some(parent), items)?,
            None => {
                let places = [format!("{home}{name}.rs"), format!("{inner}mod.rs")];
                let place = places.iter().find(|place| self.files.contains_key(*place));
                let place = place.ok_or_else(|| format!("{file}: no file for `mod {name}` at {places:?}"))?;
                if is_of_tests(place) {
                    return Ok(());
                }
                self.file(place, &inner, Some(parent))?
            }
        };
        self.bind(parent, name, Binding::Child(id));
        Ok(())
    }

    fn item(&mut self, module: usize, item: &Item) {
        if let Some(name) = name_of(item) {
            if let Item::Macro(_) = item {
                self.modules.macros.entry(name.clone()).or_default().push(module);
            }
            self.bind(module, name, Binding::Here);
        }
        for mention in mentions::of(item) {
            match &mention.how {
                How::Use { name: Some(name), .. } => {
                    self.bind(module, name.clone(), Binding::Used(mention.path.clone()))
                }
                How::Use { name: None, .. } => self.modules.all[module].globs.push(mention.path.clone()),
                How::Code => {}
            }
            self.modules.all[module].mentions.push(mention);
        }
    }

    fn bind(&mut self, module: usize, name: String, binding: Binding) {
        self.modules.all[module].names.entry(name).or_default().push(binding);
    }
}

/// The name that an item defines.
fn name_of(item: &Item) -> Option<String> {
    let name = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Macro(item) => item.ident.as_ref()?,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        _ => return None,
    };
    Some(name.to_string())
}

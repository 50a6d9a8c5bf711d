//! Files and folders of a crate import each other one way only.
//!
//! An arrow leads from a file to each file that defines a name which it takes: in a `use` line, by a
//! path in code or among the tokens of a macro. Names are followed through `pub use` to their
//! definition, so that a facade neither makes a circle nor hides one. A facade's `pub use` of what is
//! below it and `mod` are no arrows; neither is what tests import. Methods are not seen: a type's
//! `impl` blocks may be spread over files that need each other by their methods.
//!
//! Two rules hold in every crate: no circle of files; and at each level of folders, with every folder
//! taken as one part, no circle of parts.

mod arrows;
mod attributes;
mod folders;
mod graph;
mod made_up;
mod mentions;
mod modules;
mod names;
mod report;
mod workspace;

#[test]
fn nothing_imports_itself_around_a_circle() {
    let mut broken = Vec::new();
    for package in workspace::packages() {
        match report::of_package(&package.name, &package.files) {
            Ok(found) => broken.extend(found.iter().map(|circle| format!("{}: {circle}", package.folder))),
            Err(error) => broken.push(format!("{}: {error}", package.folder)),
        }
    }
    assert!(broken.is_empty(), "\n{}", broken.join("\n"));
}

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

/// Folders of packages that are still to be freed of their circles, with why they are not yet.
const KNOWN: [(&str, &str); 0] = [];

#[test]
fn nothing_imports_itself_around_a_circle() {
    let packages = workspace::packages();
    let mut broken = Vec::new();
    for package in &packages {
        let folder = &package.folder;
        let known = KNOWN.iter().any(|(known, _)| known == folder);
        match report::of_package(&package.name, &package.files) {
            Ok(found) if known && found.is_empty() => broken.push(format!("{folder}: is free now, take it from KNOWN")),
            Ok(_) if known => {}
            Ok(found) => broken.extend(found.iter().map(|circle| format!("{folder}: {circle}"))),
            Err(error) => broken.push(format!("{folder}: {error}")),
        }
    }
    let gone = KNOWN.iter().filter(|(known, _)| !packages.iter().any(|package| package.folder == *known));
    broken.extend(gone.map(|(folder, _)| format!("{folder}: is no package, take it from KNOWN")));
    assert!(broken.is_empty(), "\n{}", broken.join("\n"));
}

//! Tells the lab which sources it is built from: what bots drive follows from them and the machine, in any executable.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The workspace, from the folder of this crate.
const WORKSPACE: &str = "../..";
/// This crate, from there.
const LAB: &str = "rig/lab";
/// Folders of crates that no program is built from.
const BESIDE: [&str; 5] = ["benches", "examples", "proptest-regressions", "regressions", "tests"];

fn main() {
    let mut files = BTreeSet::new();
    let shared = ["Cargo.lock", "Cargo.toml"].map(|name| Path::new(WORKSPACE).join(name));
    for part in crates().iter().flat_map(|folder| parts(folder)).chain(shared) {
        println!("cargo::rerun-if-changed={}", part.display());
        collect(part, &mut files);
    }
    let mut digest = blake3::Hasher::new();
    for file in &files {
        let name = file.to_string_lossy().replace('\\', "/");
        let text = fs::read(file).unwrap_or_else(|error| panic!("{name}: {error}"));
        digest.update(blake3::hash(name.as_bytes()).as_bytes()).update(blake3::hash(&text).as_bytes());
    }
    println!("cargo::rustc-env=LAB_SOURCES={}", digest.finalize().to_hex());
}

/// Folders of this crate and of those of the workspace that it stands on.
fn crates() -> Vec<PathBuf> {
    let workspace = read(&Path::new(WORKSPACE).join("Cargo.toml"));
    let mut found = vec![LAB];
    let mut next = 0;
    while let Some(folder) = found.get(next) {
        let manifest = read(&Path::new(WORKSPACE).join(folder).join("Cargo.toml"));
        let of_workspace = dependencies(&manifest).filter_map(|name| path(&workspace, name));
        let news: Vec<&str> = of_workspace.filter(|folder| !found.contains(folder)).collect();
        found.extend(news);
        next += 1;
    }
    found.iter().map(|folder| Path::new(WORKSPACE).join(folder)).collect()
}

/// What a crate's manifest depends on, but for tests and build scripts.
fn dependencies(manifest: &str) -> impl Iterator<Item = &str> {
    let section = manifest.split("\n[dependencies]\n").nth(1).unwrap_or_default();
    let lines = section.lines().take_while(|line| !line.starts_with('['));
    lines.filter_map(|line| line.split(['.', ' ', '=']).next()).filter(|name| !name.is_empty())
}

/// Where the workspace's manifest says that a crate of its own lies.
fn path<'a>(workspace: &'a str, name: &str) -> Option<&'a str> {
    let line = workspace.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(" = { path = \""))?;
    line.split('"').next()
}

/// What a crate's folder holds that a program may be built from.
fn parts(folder: &Path) -> Vec<PathBuf> {
    entries(folder).into_iter().filter(|path| !BESIDE.iter().any(|beside| path.ends_with(beside))).collect()
}

/// A file, or all files of a folder.
fn collect(path: PathBuf, files: &mut BTreeSet<PathBuf>) {
    if path.is_dir() {
        entries(&path).into_iter().for_each(|entry| collect(entry, files));
    } else {
        files.insert(path);
    }
}

/// What is in a folder, but for hidden files.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let read = fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let entries = read.unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let seen = entries.iter().filter(|entry| !entry.file_name().to_string_lossy().starts_with('.'));
    seen.map(fs::DirEntry::path).collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

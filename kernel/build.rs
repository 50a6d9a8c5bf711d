//! Tells the kernel the exact versions of the libraries that it is built on.
#![allow(clippy::disallowed_methods, reason = "a build script reads a file; the kernel does not")]

use std::fs;

/// What the kernel's arithmetic rests on.
const ENGINES: [&str; 5] = ["glam", "libm", "parry3d", "rapier3d", "xodr"];
const LOCK: &str = "../Cargo.lock";

fn main() {
    println!("cargo::rerun-if-changed={LOCK}");
    let lock = fs::read_to_string(LOCK).expect("Cargo.lock is beside the folder of the kernel");
    let engines = ENGINES.map(|name| format!("{name} {}", version(&lock, name)));
    println!("cargo::rustc-env=KERNEL_ENGINES={}", engines.join(", "));
}

/// The version of a library; where there are several, the one that the kernel or its engine is built on.
fn version<'a>(lock: &'a str, name: &str) -> &'a str {
    let versions: Vec<_> = packages(lock, name).filter_map(|package| between(package, "version = \"", "\"")).collect();
    let used = ["kernel", "rapier3d"].iter().flat_map(|user| packages(lock, user));
    let named = used.filter_map(|user| between(user, &format!("\n \"{name} "), "\"")).next();
    match versions[..] {
        [only] => only,
        _ => named.unwrap_or_else(|| panic!("Cargo.lock does not say which {name} the kernel is built on")),
    }
}

/// What stands in the lock file about the packages of a name.
fn packages<'a>(lock: &'a str, name: &str) -> impl Iterator<Item = &'a str> {
    let head = format!("name = \"{name}\"\n");
    lock.split("[[package]]\n").filter(move |package| package.starts_with(&head))
}

fn between<'a>(text: &'a str, before: &str, after: &str) -> Option<&'a str> {
    text.split_once(before)?.1.split_once(after).map(|(inside, _)| inside)
}

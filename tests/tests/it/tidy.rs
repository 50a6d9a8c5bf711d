//! The rules of the house as a test: who imports whom, where a library may be named, how long files
//! and functions may be. Each rule is itself tested on a text that breaks it.

use std::fs;
use std::path::{Path, PathBuf};

/// Longest source file in lines.
const MAX_FILE_LINES: usize = 600;
/// Longest function in lines, from `fn` to its closing brace.
const MAX_FUNCTION_LINES: usize = 100;

/// Every crate by its folder, and which others of the workspace it may depend on; each stands above those.
const IMPORTS: [(&str, &[&str]); 16] = [
    ("tests/hunt", &[]),
    ("intake", &[]),
    ("kernel", &["hunt"]),
    ("perception", &["hunt", "intake"]),
    ("render", &["kernel"]),
    ("replay", &["intake", "kernel"]),
    ("rig/base", &["hunt", "intake", "kernel", "render", "replay"]),
    ("rig/drivers", &["kernel", "perception", "render", "replay", "base"]),
    ("rig/study", &["kernel", "perception", "render", "replay", "base", "drivers"]),
    ("rig/measures", &["kernel", "replay", "base", "drivers", "study"]),
    ("rig/sound", &["kernel"]),
    ("rig/viewers", &["kernel", "render", "base"]),
    (
        "rig/lab",
        &["kernel", "perception", "render", "replay", "base", "drivers", "study", "measures", "sound", "viewers"],
    ),
    ("python", &["kernel", "perception", "render", "replay", "base", "drivers", "measures", "lab"]),
    (
        "rig/live",
        &["kernel", "perception", "render", "replay", "base", "drivers", "study", "measures", "sound", "viewers"],
    ),
    (
        "rig/aeye",
        &["kernel", "perception", "render", "replay", "base", "drivers", "study", "measures", "viewers", "lab", "live"],
    ),
];

/// Those that look at all others.
const ONLOOKERS: [&str; 2] = ["tests", "benches"];

/// Where windows are made and painted.
const WINDOWS: [&str; 3] = ["rig/live/src/desktop/", "rig/live/src/drive/windows/", "rig/live/src/view/windows/"];

/// A library and the only files that name it, where its crate has more. A trailing slash allows a folder.
const NAMED_ONCE: [(&str, &[&str]); 23] = [
    ("rapier3d::", &["kernel/src/physics/"]),
    ("xodr::", &["kernel/src/baking/"]),
    ("roxmltree::", &["kernel/src/baking/limits/", "kernel/src/story/reader/"]),
    ("gltf::", &["rig/base/src/models/"]),
    ("tract_onnx", &["perception/src/onnx/", "perception/src/operators/"]),
    ("tract_cuda", &["perception/src/onnx/"]),
    ("use ort::", &["perception/src/onnx/onnxruntime.rs"]),
    ("bincode::", &["replay/src/wire.rs"]),
    ("rusqlite::", &["rig/lab/src/cases/"]),
    ("cdr_encoding::", &["rig/lab/src/export/ros2/"]),
    ("wgpu::", &["render/", WINDOWS[0], WINDOWS[1], WINDOWS[2]]),
    ("winit::", &WINDOWS),
    ("egui::", &WINDOWS),
    ("gilrs::", &["rig/live/src/units/mappings.rs"]),
    ("gilrs_core::", &["rig/live/src/units/hardware.rs"]),
    (
        "tungstenite::",
        &["rig/viewers/src/server/access.rs", "rig/viewers/src/server/client.rs", "rig/viewers/src/server/tests.rs"],
    ),
    ("evdev::", &["rig/live/src/drive/force/linux.rs"]),
    ("alsa::", &["rig/live/src/speakers/device.rs"]),
    ("cpal::", &["rig/live/src/speakers/device.rs"]),
    ("hound::", &["rig/lab/src/export/hearing.rs"]),
    ("pyo3::", &["python/src/"]),
    ("numpy::", &["python/src/"]),
    // What cannot be printed must not end a drive: `base::say` and `aeye::print` see to that.
    ("println!(", &[]),
];

/// What the kernel may not name beyond what its clippy.toml refuses item by item.
const KERNEL_BANNED: [&str; 5] = ["std::fs", "std::env", "std::thread", "std::net", "std::time"];

/// Marks of unfinished work.
const UNFINISHED: [&str; 5] = ["todo!(", "unimplemented!(", "#[ignore]", "FIXME", "XXX"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace is above").to_owned()
}

/// Every crate's folder.
fn folders() -> impl Iterator<Item = &'static str> {
    IMPORTS.into_iter().map(|(folder, _)| folder).chain(ONLOOKERS)
}

/// Every file below the workspace's crates with one of the endings, as (relative path, text).
fn sources(endings: &[&str]) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for folder in folders() {
        collect(&root().join(folder), endings, &mut found);
    }
    assert!(found.len() >= IMPORTS.len(), "the walk found only {} files", found.len());
    found.sort();
    found
}

fn collect(dir: &Path, endings: &[&str], found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(dir).expect("a readable folder") {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            collect(&path, endings, found);
        } else if endings.iter().any(|e| path.to_string_lossy().ends_with(e)) {
            let relative = path.strip_prefix(root()).expect("below the root").to_string_lossy().into_owned();
            found.push((relative, fs::read_to_string(&path).expect("a text file")));
        }
    }
}

fn check(rule: impl Fn(&str, &str) -> Vec<String>, endings: &[&str]) {
    let broken: Vec<String> = sources(endings).iter().flat_map(|(path, text)| rule(path, text)).collect();
    assert!(broken.is_empty(), "\n{}", broken.join("\n"));
}

fn is_this_file(path: &str) -> bool {
    path == "tests/tests/it/tidy.rs"
}

/// What a crate is called: its folder's own name.
fn name(folder: &str) -> &str {
    folder.rsplit('/').next().unwrap_or(folder)
}

fn wrong_imports(path: &str, manifest: &str) -> Vec<String> {
    let folder = path.strip_suffix("/Cargo.toml").unwrap_or(path);
    if ONLOOKERS.contains(&folder) {
        return Vec::new();
    }
    let Some((_, allowed)) = IMPORTS.iter().find(|(known, _)| *known == folder) else {
        return vec![format!("{path}: not a crate of the table")];
    };
    let manifest: toml::Table = match manifest.parse() {
        Ok(manifest) => manifest,
        Err(error) => return vec![format!("{path}: {error}")],
    };
    let named = dependencies(&manifest);
    let wrong = folders().map(name).filter(|other| named.contains(other) && !allowed.contains(other));
    wrong.map(|other| format!("{path}: {} may not import {other}", name(folder))).collect()
}

/// Nobody may import whoever stands below in the table.
fn upward_imports() -> Vec<String> {
    let floor = |crate_name: &str| IMPORTS.iter().position(|(folder, _)| name(folder) == crate_name);
    let pairs = IMPORTS.iter().flat_map(|(folder, allowed)| allowed.iter().map(move |other| (name(folder), *other)));
    pairs.filter(|(from, to)| floor(to) >= floor(from)).map(|(from, to)| format!("{from} -> {to}")).collect()
}

/// Packages that a manifest depends on in any of its sections, for any target, under any name.
fn dependencies(manifest: &toml::Table) -> Vec<&str> {
    let mut packages = Vec::new();
    for (key, value) in manifest {
        let Some(section) = value.as_table() else { continue };
        if key.ends_with("dependencies") {
            packages.extend(section.iter().map(|(name, spec)| renamed(spec).unwrap_or(name)));
        } else if key == "target" {
            packages.extend(section.values().filter_map(toml::Value::as_table).flat_map(dependencies));
        }
    }
    packages
}

/// The package behind a dependency that has another name.
fn renamed(spec: &toml::Value) -> Option<&str> {
    spec.get("package")?.as_str()
}

fn misplaced_names(path: &str, text: &str) -> Vec<String> {
    if !path.contains("/src/") || ONLOOKERS.iter().any(|folder| path.starts_with(folder)) {
        return Vec::new();
    }
    let allowed = |files: &[&str]| files.iter().any(|f| path == *f || (f.ends_with('/') && path.starts_with(f)));
    let code = without_comments(text);
    let misplaced = NAMED_ONCE.iter().filter(|(word, files)| !allowed(files) && code.contains(word));
    let mut broken: Vec<_> = misplaced.map(|(word, files)| format!("{path}: {word} belongs in {files:?}")).collect();
    if path.starts_with("kernel/") {
        let banned = KERNEL_BANNED.iter().filter(|word| code.contains(**word));
        broken.extend(banned.map(|word| format!("{path}: the kernel may not use {word}")));
    }
    broken
}

fn without_comments(text: &str) -> String {
    text.lines().map(|l| l.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

fn too_long(path: &str, text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().collect();
    let mut broken = Vec::new();
    if lines.len() > MAX_FILE_LINES {
        broken.push(format!("{path}: {} lines, more than {MAX_FILE_LINES}", lines.len()));
    }
    for (start, line) in lines.iter().enumerate() {
        if !path.ends_with(".rs") || !begins_function(line) {
            continue;
        }
        let length = function_lines(&lines[start..]);
        if length > MAX_FUNCTION_LINES {
            broken.push(format!("{path}:{}: a function of {length} lines", start + 1));
        }
    }
    broken
}

/// Whether a line holds the `fn` of an item, whatever stands before it.
fn begins_function(line: &str) -> bool {
    let mut rest = line.trim_start();
    while let Some(next) = after_qualifier(rest) {
        rest = next.trim_start();
    }
    rest.starts_with("fn ")
}

/// What follows a visibility, a qualifier of a function or the name of a binary interface.
fn after_qualifier(text: &str) -> Option<&str> {
    if let Some(path) = text.strip_prefix("pub(") {
        return path.split_once(')').map(|(_, rest)| rest);
    }
    if let Some(interface) = text.strip_prefix('"') {
        return interface.split_once('"').map(|(_, rest)| rest);
    }
    ["pub ", "default ", "const ", "async ", "unsafe ", "extern "].iter().find_map(|word| text.strip_prefix(word))
}

/// Lines from the first of `lines`, which begins a function, to its closing brace.
fn function_lines(lines: &[&str]) -> usize {
    let head = lines[0];
    if head.ends_with(['}', ';']) {
        return 1;
    }
    let indent = head.len() - head.trim_start().len();
    let close = format!("{}}}", " ".repeat(indent));
    lines.iter().position(|line| *line == close).unwrap_or(0) + 1
}

fn unfinished(path: &str, text: &str) -> Vec<String> {
    if is_this_file(path) {
        return Vec::new();
    }
    UNFINISHED.iter().filter(|w| text.contains(**w)).map(|w| format!("{path}: {w}")).collect()
}

fn undocumented_module(path: &str, text: &str) -> Vec<String> {
    let documented = text.lines().find(|l| !l.starts_with("#![")).is_some_and(|l| l.starts_with("//!"));
    if documented { Vec::new() } else { vec![format!("{path}: does not say in its first line what it is for")] }
}

#[test]
fn crates_import_only_what_the_table_allows() {
    check(wrong_imports, &["Cargo.toml"]);
    for forbidden in [
        "[dependencies]\nrender.workspace = true",
        "[dependencies]\nrender = { path = \"../render\" }",
        "[dependencies.render]\nworkspace = true",
        "[dev-dependencies.render]\npath = \"../render\"",
        "[build-dependencies]\nrender.workspace = true",
        "[target.'cfg(unix)'.dependencies.render]\nworkspace = true",
        "[dependencies]\npictures = { path = \"../render\", package = \"render\" }",
    ] {
        assert_eq!(wrong_imports("kernel/Cargo.toml", forbidden).len(), 1, "{forbidden}");
        assert_eq!(wrong_imports("rig/lab/Cargo.toml", forbidden), Vec::<String>::new());
    }
    assert_eq!(upward_imports(), Vec::<String>::new());
    assert_eq!(wrong_imports("rig/new/Cargo.toml", "[dependencies]").len(), 1);
    assert_eq!(wrong_imports("kernel/Cargo.toml", "[dependencies").len(), 1);
    assert_eq!(wrong_imports("kernel/Cargo.toml", "[features]\nrender = []"), Vec::<String>::new());
}

#[test]
fn libraries_and_hazards_stand_where_they_may() {
    check(misplaced_names, &[".rs"]);
    assert_eq!(misplaced_names("kernel/src/ego.rs", "use rapier3d::prelude::*;").len(), 1);
    assert_eq!(misplaced_names("kernel/src/ego.rs", "use std::time::Instant;").len(), 1);
    assert_eq!(misplaced_names("kernel/src/ego.rs", "// std::time is banned"), Vec::<String>::new());
}

#[test]
fn files_and_functions_are_short() {
    check(too_long, &[".rs", ".wgsl"]);
    assert_eq!(too_long("a.rs", &"\n".repeat(MAX_FILE_LINES + 1)).len(), 1);
    let body = format!(" {{\n{}}}\n", "    x();\n".repeat(MAX_FUNCTION_LINES));
    for head in [
        "fn f()",
        "pub fn f()",
        "pub(crate) async fn f()",
        "pub(in crate::world) fn f()",
        "pub const fn f()",
        "const unsafe fn f()",
        "unsafe fn f()",
        "default fn f()",
        "extern \"C\" fn f()",
        "pub unsafe extern \"C\" fn f()",
    ] {
        assert_eq!(too_long("a.rs", &format!("{head}{body}")).len(), 1, "{head}");
    }
    for other in ["pub const F: [u8; 1] =", "unsafe impl F for G", "impl F", "extern \"C\"", "mod functions"] {
        assert_eq!(too_long("a.rs", &format!("{other}{body}")), Vec::<String>::new());
    }
    assert_eq!(too_long("a.rs", &format!("fn f() {{}}\nimpl F{body}")), Vec::<String>::new());
}

#[test]
fn nothing_is_left_unfinished() {
    check(unfinished, &[".rs", ".wgsl"]);
    assert_eq!(unfinished("a.rs", "todo!()").len(), 1);
}

#[test]
fn every_module_says_what_it_is_for() {
    check(undocumented_module, &[".rs"]);
    assert_eq!(undocumented_module("a.rs", "use std::fs;").len(), 1);
}

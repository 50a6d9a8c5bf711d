//! The build without windows asks for nothing but a C compiler: by the names of its packages, none of them links a
//! library of the system, and none is there for windows, wheels or CUDA. Nor is one for the Python package.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

/// How the names of packages begin that come with windows, wheels, sound or CUDA.
const OUTSIDE: [&str; 12] = [
    "libudev",
    "alsa",
    "gilrs",
    "evdev",
    "x11",
    "xkbcommon",
    "winit",
    "egui",
    "wayland",
    "cudarc",
    "tract-cuda",
    "tract-gpu",
];

/// Bindings, as `-sys` at the end of a name says, that need nothing installed: system calls, types alone, libraries
/// that are compiled along, and what OpenGL and onnxruntime look for when they are asked for.
const SELF_CONTAINED: [&str; 6] =
    ["libsqlite3-sys", "linux-raw-sys", "ort-sys", "renderdoc-sys", "wayland-sys", "zstd-sys"];

/// Packages that are compiled for one of the workspace on this machine, by name.
fn packages(package: &str, features: &[&str]) -> BTreeSet<String> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace is above"));
    cargo.args(["tree", "--locked", "--offline", "--package", package, "--edges=normal,build", "--prefix=none"]);
    let output = cargo.arg("--format={p}").args(features).output().expect("cargo starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    text.lines().filter_map(|line| line.split_whitespace().next()).map(str::to_owned).collect()
}

fn from_outside(packages: &BTreeSet<String>) -> Vec<&str> {
    let links = |name: &str| name.ends_with("-sys") || OUTSIDE.iter().any(|word| name.starts_with(word));
    let is_outside = |name: &&str| links(name) && !SELF_CONTAINED.contains(name);
    packages.iter().map(String::as_str).filter(is_outside).collect()
}

#[test]
fn a_build_without_windows_asks_the_system_for_no_library() {
    assert_eq!(from_outside(&packages("aeye", &["--no-default-features"])), Vec::<&str>::new());
    assert_eq!(from_outside(&packages("python", &[])), Vec::<&str>::new());
    let full = packages("aeye", &[]);
    let found = from_outside(&full);
    for (word, feature) in [("libudev-sys", "live"), ("alsa-sys", "live"), ("winit", "live"), ("tract-cuda", "cuda")] {
        assert!(found.contains(&word), "{word} is no longer what {feature} asks for: {found:?}");
    }
}

//! Tells the tests what can be opened for them: a Vulkan driver; windows, for which it takes the feature `live`, a
//! virtual display and a way to press keys in it besides.

#[path = "../../tests/probes/vulkan.rs"]
mod vulkan;

const PROGRAMS: [&str; 2] = ["Xvfb", "xdotool"];

fn main() {
    let has_vulkan = vulkan::find();
    println!("cargo::rustc-check-cfg=cfg(no_windows)");
    println!("cargo::rerun-if-env-changed=PATH");
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders: Vec<_> = std::env::split_paths(&path).collect();
    let has_programs = PROGRAMS.iter().all(|name| folders.iter().any(|folder| folder.join(name).is_file()));
    let has_live = std::env::var_os("CARGO_FEATURE_LIVE").is_some();
    if !(has_live && has_programs && has_vulkan) {
        println!("cargo::rustc-cfg=no_windows");
    }
    println!("cargo::rerun-if-changed=/usr/bin");
}

//! Tells the tests whether a Vulkan driver is installed and the real maps are at hand, so that those
//! that need them show as ignored and never as passed. With AEYE_GPU=require those on the GPU run all
//! the same, and fail without one.

use std::path::Path;

const DRIVER_FOLDERS: [&str; 3] = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d"];
const DRIVER_VARIABLES: [&str; 2] = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];

/// Beside the repository; beside a folder of clones of it.
const MAP_FOLDERS: [&str; 2] = ["../../shared/maps", "../../../shared/maps"];

fn main() {
    find_vulkan();
    find_maps();
}

fn find_maps() {
    println!("cargo::rustc-check-cfg=cfg(no_real_maps)");
    match MAP_FOLDERS.iter().find_map(|folder| Path::new(folder).canonicalize().ok()) {
        Some(folder) => println!("cargo::rustc-env=AEYE_REAL_MAPS={}", folder.display()),
        None => println!("cargo::rustc-cfg=no_real_maps"),
    }
    for folder in MAP_FOLDERS {
        println!("cargo::rerun-if-changed={folder}");
    }
}

fn find_vulkan() {
    println!("cargo::rustc-check-cfg=cfg(no_vulkan)");
    for name in DRIVER_VARIABLES.iter().chain(&["AEYE_GPU"]) {
        println!("cargo::rerun-if-env-changed={name}");
    }
    let has_files = |folder: &&str| Path::new(folder).read_dir().is_ok_and(|mut files| files.next().is_some());
    let installed =
        DRIVER_FOLDERS.iter().any(has_files) || DRIVER_VARIABLES.iter().any(|v| std::env::var_os(v).is_some());
    let required = std::env::var("AEYE_GPU").is_ok_and(|value| value == "require");
    if !installed && !required {
        println!("cargo::rustc-cfg=no_vulkan");
    }
    for folder in DRIVER_FOLDERS.iter().filter(|folder| Path::new(folder).exists()) {
        println!("cargo::rerun-if-changed={folder}");
    }
}

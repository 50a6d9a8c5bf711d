//! For build scripts: whether a Vulkan driver is installed, so that tests that need one show as ignored and never
//! as passed. With `AEYE_GPU=require` they run all the same, and fail without one.

use std::path::Path;

const DRIVER_FOLDERS: [&str; 3] = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d", "/usr/local/share/vulkan/icd.d"];
const DRIVER_VARIABLES: [&str; 2] = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];

/// Whether one is, or is required; sets `no_vulkan` where none is.
pub fn find() -> bool {
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
    installed || required
}

//! For build scripts: whether OpenGL draws without a display here (EGL with a driver), so that tests that need it show as
//! ignored and never as passed. With `AEYE_GPU=require` they run all the same, and fail without it.

use std::path::Path;

/// Where libraries of EGL's vendors say that they are there.
const VENDOR_FOLDERS: [&str; 2] = ["/usr/share/glvnd/egl_vendor.d", "/etc/glvnd/egl_vendor.d"];

/// Sets `no_opengl` where it does not, and is not required.
pub fn find() {
    println!("cargo::rustc-check-cfg=cfg(no_opengl)");
    println!("cargo::rerun-if-env-changed=AEYE_GPU");
    let has_files = |folder: &&str| Path::new(folder).read_dir().is_ok_and(|mut files| files.next().is_some());
    let required = std::env::var("AEYE_GPU").is_ok_and(|value| value == "require");
    if !VENDOR_FOLDERS.iter().any(has_files) && !required {
        println!("cargo::rustc-cfg=no_opengl");
    }
    for folder in VENDOR_FOLDERS.iter().filter(|folder| Path::new(folder).exists()) {
        println!("cargo::rerun-if-changed={folder}");
    }
}

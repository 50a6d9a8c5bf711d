//! Tells the tests whether drivers of Vulkan and OpenGL are installed and the real maps are at hand, so that those
//! that need them show as ignored and never as passed. With AEYE_GPU=require those on the GPU run all
//! the same, and fail without one.

#[path = "probes/opengl.rs"]
mod opengl;
#[path = "probes/vulkan.rs"]
mod vulkan;

use std::path::Path;

/// Beside the repository; beside a folder of clones of it.
const MAP_FOLDERS: [&str; 2] = ["../../shared/maps", "../../../shared/maps"];

fn main() {
    vulkan::find();
    opengl::find();
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

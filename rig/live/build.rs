//! Tells the tests what can be opened for them: a Vulkan driver, and Linux's way to play devices.

#[path = "../../tests/probes/vulkan.rs"]
mod vulkan;

use std::path::Path;

const UINPUT: &str = "/dev/uinput";

fn main() {
    vulkan::find();
    println!("cargo::rustc-check-cfg=cfg(no_uinput)");
    if std::fs::OpenOptions::new().write(true).open(UINPUT).is_err() {
        println!("cargo::rustc-cfg=no_uinput");
    }
    if Path::new(UINPUT).exists() {
        println!("cargo::rerun-if-changed={UINPUT}");
    }
}

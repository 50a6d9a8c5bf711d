//! Tells the tests what can be opened for them, so that those that need it show as ignored and never
//! as passed. Windows: a virtual display, a way to press keys in it, and a Vulkan driver. Devices:
//! Linux's way to play them.

use std::path::Path;

const PROGRAMS: [&str; 2] = ["Xvfb", "xdotool"];
const DRIVERS: &str = "/usr/share/vulkan/icd.d";
const UINPUT: &str = "/dev/uinput";

fn main() {
    find_windows();
    find_uinput();
}

fn find_uinput() {
    println!("cargo::rustc-check-cfg=cfg(no_uinput)");
    if std::fs::OpenOptions::new().write(true).open(UINPUT).is_err() {
        println!("cargo::rustc-cfg=no_uinput");
    }
    if Path::new(UINPUT).exists() {
        println!("cargo::rerun-if-changed={UINPUT}");
    }
}

fn find_windows() {
    println!("cargo::rustc-check-cfg=cfg(no_windows)");
    println!("cargo::rerun-if-env-changed=PATH");
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders: Vec<_> = std::env::split_paths(&path).collect();
    let programs = PROGRAMS.iter().all(|name| folders.iter().any(|folder| folder.join(name).is_file()));
    let drivers = Path::new(DRIVERS).read_dir().is_ok_and(|mut files| files.next().is_some());
    if !(programs && drivers) {
        println!("cargo::rustc-cfg=no_windows");
    }
    for folder in ["/usr/bin", DRIVERS].into_iter().filter(|folder| Path::new(folder).exists()) {
        println!("cargo::rerun-if-changed={folder}");
    }
}

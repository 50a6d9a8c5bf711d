//! Keeps Mesa quiet where there is no desktop.

use std::env;
use std::process::Command;

/// Mesa picks a device by window system, and complains on stderr where there is none. It listens to
/// the environment alone, which a process cannot change safely for itself; so where the complaint
/// is due, the command starts itself over with the choice switched off.
#[cfg(unix)]
pub fn start_over_without_complaints() {
    use std::os::unix::process::CommandExt;

    const SWITCH: &str = "NODEVICE_SELECT";
    if env::var_os("XDG_RUNTIME_DIR").is_some() || env::var_os(SWITCH).is_some() {
        return;
    }
    if let Ok(program) = env::current_exe() {
        // Comes back only when it fails; then the complaints are borne.
        let _failed = Command::new(program).args(env::args_os().skip(1)).env(SWITCH, "1").exec();
    }
}

/// There is nothing to complain about elsewhere.
#[cfg(not(unix))]
pub fn start_over_without_complaints() {}

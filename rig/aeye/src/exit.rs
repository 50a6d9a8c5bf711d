//! How a command ends: the exit codes that scripts rely on.

use std::process::ExitCode;

use base::failure::{Usage, is_divergence};
use base::progress::interrupted;

/// What a command that ran to its end says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Everything went well: exit code 0.
    Ok,
    /// A check failed (divergence, budget, gate): exit code 3.
    CheckFailed,
}

impl Verdict {
    /// Of a check that passed or did not.
    pub fn of_check(passed: bool) -> Self {
        if passed { Self::Ok } else { Self::CheckFailed }
    }
}

/// The exit code as a number: 0 ok, 1 error (unreadable, damaged), 2 usage, 3 a check failed.
pub fn number(result: &anyhow::Result<Verdict>) -> u8 {
    match result {
        Ok(Verdict::Ok) => 0,
        Ok(Verdict::CheckFailed) => 3,
        Err(error) if error.is::<Usage>() => 2,
        Err(error) if is_divergence(error) => 3,
        Err(_) => 1,
    }
}

/// The exit code for the system; of a command that a signal interrupted 128 and the signal's number.
pub fn code(result: &anyhow::Result<Verdict>) -> ExitCode {
    ExitCode::from(interrupted().unwrap_or_else(|| number(result)))
}

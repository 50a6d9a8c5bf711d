//! How a command ends: the exit codes that scripts rely on.

use std::process::ExitCode;

use base::failure::{Usage, is_divergence, may_pass};
use base::progress::interrupted;
use lab::campaign::TooFew;

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

/// What `sysexits.h` calls a temporary failure.
const TRY_AGAIN: u8 = 75;

/// The exit code as a number: 0 ok, 1 error (unreadable, damaged), 2 usage, 3 a check failed or runs are missing,
/// 75 what may go well if it is tried again (the disk is full, another process is at work).
pub fn number(result: &anyhow::Result<Verdict>) -> u8 {
    match result {
        Ok(Verdict::Ok) => 0,
        Ok(Verdict::CheckFailed) => 3,
        Err(error) if error.is::<Usage>() => 2,
        Err(error) if is_divergence(error) || error.is::<TooFew>() => 3,
        Err(error) if may_pass(error) => TRY_AGAIN,
        Err(_) => 1,
    }
}

/// The exit code for the system; of a command that a signal interrupted 128 and the signal's number.
pub fn code(result: &anyhow::Result<Verdict>) -> ExitCode {
    ExitCode::from(interrupted().unwrap_or_else(|| number(result)))
}

//! How a command ends: the exit codes that scripts rely on.

use std::process::ExitCode;

/// What a command that ran to its end says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Everything went well: exit code 0.
    Ok,
    /// A check failed (divergence, budget, gate): exit code 3.
    CheckFailed,
}

/// The command line asks for something that does not exist or contradicts itself: exit code 2.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Usage(pub String);

impl std::fmt::Display for Usage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// Whether an error says that a replay is not the run that was recorded.
pub fn is_divergence(error: &anyhow::Error) -> bool {
    let diverged = |error: &replay::Error| matches!(error, replay::Error::Diverged(_));
    error.chain().any(|e| e.downcast_ref::<replay::Error>().is_some_and(diverged))
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

/// The exit code for the system.
pub fn code(result: &anyhow::Result<Verdict>) -> ExitCode {
    ExitCode::from(number(result))
}

/// An error with its causes as one line; causes that the text tells already are left out.
pub fn sentence(error: &anyhow::Error) -> String {
    let mut text = error.to_string();
    for cause in error.chain().skip(1).map(ToString::to_string) {
        if !text.contains(&cause) {
            text = format!("{text}: {cause}");
        }
    }
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context;

    #[test]
    fn a_sentence_says_each_cause_once() {
        let cause: anyhow::Error = anyhow::anyhow!("no\n room");
        let error = Err::<(), _>(cause).context("b: no\n room").context("a").expect_err("one");
        assert_eq!(sentence(&error), "a: b: no room");
    }
}

//! What can go wrong with a command, beyond what libraries say.

/// The command line asks for something that does not exist or contradicts itself.
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

//! Cases by the verdict on their takeover.

use std::path::Path;

use anyhow::bail;
use replay::CaseHeader;

use super::counterfactual::Counterfactual;
use super::verdict::Need;

/// Of some cases those on whose takeover a campaign came to one of these verdicts; all, where none is asked for.
pub fn keep_judged<T>(cases: Vec<T>, path: impl Fn(&T) -> &Path, verdicts: &[Need]) -> anyhow::Result<Vec<T>> {
    if verdicts.is_empty() {
        return Ok(cases);
    }
    let mut kept = Vec::new();
    for case in cases {
        let path = path(&case);
        if is_judged(path, CaseHeader::open(path)?.info.source, verdicts) {
            kept.push(case);
        }
    }
    if kept.is_empty() {
        let names: Vec<&str> = verdicts.iter().map(|verdict| verdict.name()).collect();
        bail!("on none of the corner cases the verdict is {}", names.join(" or "));
    }
    Ok(kept)
}

/// Whether a campaign came to one of these verdicts on the takeover of a recording, by the case or the recording itself.
pub fn is_judged(path: &Path, recording: [u8; 32], verdicts: &[Need]) -> bool {
    Counterfactual::beside(path, &recording).is_some_and(|found| verdicts.contains(&found.verdict))
}

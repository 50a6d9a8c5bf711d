//! Answers that are given after a drive. A recording is never changed: they are in a file beside it
//! that says by its digest which recording it is about.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use base::files::{self, most};
use base::toml_text;
use replay::Recording;
use toml::{Table, Value};

use super::Questionnaire;

/// The key of the recording's digest.
const RECORDING: &str = "recording";

/// Where the answers to a recording or its case are: `NAME.questionnaire.toml` beside it.
pub fn path_beside(recording: &Path) -> PathBuf {
    let name = recording.file_name().unwrap_or_default().to_string_lossy();
    let stem = [".case.mcap", ".mcap"].iter().find_map(|ending| name.strip_suffix(ending)).unwrap_or(&name);
    recording.with_file_name(format!("{stem}.questionnaire.toml"))
}

/// The file beside a recording that holds these answers, too, and its text. Refuses what contradicts
/// the answers that the recording has already, in itself or beside it.
pub fn attached(path: &Path, recording: &Recording, answers: Questionnaire) -> anyhow::Result<(PathBuf, String)> {
    let beside = path_beside(path);
    let before = read(&beside, recording)?.unwrap_or_default();
    let contradiction = |problem: String| anyhow!("{}: {problem}", path.display());
    let attached = before.joined(answers).map_err(contradiction)?;
    recorded(recording).joined(attached.clone()).map_err(contradiction)?;
    // Plain values stand before tables in TOML.
    let (digest, tables) = (hex(recording.source()), toml::to_string(&attached.to_table())?);
    Ok((beside, format!("{RECORDING} = \"{digest}\"\n\n{tables}")))
}

/// All answers to a recording: those in it, and those beside it.
pub fn answers_of(path: &Path, recording: &Recording) -> anyhow::Result<Questionnaire> {
    let beside = path_beside(path);
    let attached = read(&beside, recording)?.unwrap_or_default();
    recorded(recording).joined(attached).map_err(|problem| anyhow!("{}: {problem}", beside.display()))
}

fn recorded(recording: &Recording) -> Questionnaire {
    Questionnaire::of(&recording.log().manifest.provenance)
}

/// The answers in a file, which must be about the recording; `None` without such a file.
fn read(beside: &Path, recording: &Recording) -> anyhow::Result<Option<Questionnaire>> {
    let file = || beside.display().to_string();
    let Some(text) = files::read_text_if_there(beside, most::TEXT)? else { return Ok(None) };
    let mut table: Table = toml_text::read(&text).map_err(|problem| anyhow!("{}: {problem}", file()))?;
    let expected = hex(recording.source());
    match table.remove(RECORDING) {
        Some(Value::String(digest)) if digest == expected => {}
        _ => bail!("{}: is about another recording; expected {RECORDING} = \"{expected}\"", file()),
    }
    Ok(Some(Questionnaire::from_table(table).map_err(|problem| anyhow!("{}: {problem}", file()))?))
}

fn hex(digest: [u8; 32]) -> String {
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

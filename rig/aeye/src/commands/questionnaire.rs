//! Attaches answers that were given after a drive to its recordings.

use anyhow::bail;
use base::json::Typed;
use base::output;
use replay::Recording;
use serde::Serialize;
use study::{self, Questionnaire, attached};

use crate::cli::QuestionnaireArgs;
use crate::exit::Verdict;
use crate::print::print;

/// What is printed for a recording.
#[derive(Serialize)]
struct Attached {
    /// The recording.
    recording: String,
    /// The file of the answers.
    answers: String,
}

/// A line of `aeye questionnaire`, of a recording.
impl Typed for Attached {
    const TYPE: &'static str = "aeye.questionnaire";
}

/// Answers are of a seat: in all of the recordings the same people must have sat there.
fn check_seats(args: &QuestionnaireArgs, recordings: &[Recording]) -> anyhow::Result<()> {
    let is_swapped = |recording: &Recording| study::is_swapped(&recording.log().manifest.provenance);
    let first = recordings.first().map(is_swapped);
    match args.files.iter().zip(recordings).find(|(_, recording)| Some(is_swapped(recording)) != first) {
        Some((path, _)) => bail!(
            "{}: the operators had swapped seats; expected it in a call of its own, with answers of who sat where then",
            path.display()
        ),
        None => Ok(()),
    }
}

/// Runs `aeye questionnaire`.
pub fn run(args: &QuestionnaireArgs, json: bool) -> anyhow::Result<Verdict> {
    let answers = Questionnaire::read(&args.answers)?;
    let recordings = args.files.iter().map(|path| Recording::open(path)).collect::<Result<Vec<_>, _>>()?;
    let is_case = |(_, recording): &(_, &Recording)| recording.log().manifest.case.is_some();
    if let Some((path, _)) = args.files.iter().zip(&recordings).find(is_case) {
        bail!("{}: is a corner case; expected the recording", path.display());
    }
    check_seats(args, &recordings)?;
    let files = args.files.iter().zip(&recordings);
    let texts = files.map(|(path, recording)| attached(path, recording, answers.clone()));
    // Every file is checked before any is written.
    for (path, (beside, text)) in args.files.iter().zip(texts.collect::<anyhow::Result<Vec<_>>>()?) {
        output::write_file(&beside, text.as_bytes())?;
        let said = Attached { recording: path.display().to_string(), answers: beside.display().to_string() };
        print(json, &said, || format!("{}: answers in {}", said.recording, said.answers))?;
    }
    Ok(Verdict::Ok)
}

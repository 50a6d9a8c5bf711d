//! The HUD of a live drive.

use kernel::arbiter::Phase;

use super::board::Status;
use super::stage::Stage;
use crate::desktop::HudText;

/// That of a session's status.
pub fn text(status: &Status) -> HudText {
    let text = HudText::new(&status.hud, status.steering, status.pedals, status.is_reverse);
    HudText { note: note(&status.stage, status.phase).into(), ..text }
}

/// What is to be done, in words.
fn note(stage: &Stage, phase: Phase) -> &'static str {
    match (stage, phase) {
        (Stage::Ready, _) => "N starts the run",
        (Stage::Labelling(_), _) => "The run has ended: label it in the control centre",
        (Stage::Driving, Phase::Arming) => "Arming",
        (Stage::Driving, Phase::TakenOver) => "Taken over",
        (Stage::Driving, Phase::Driving | Phase::Done) => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::live::stage::Dialog;

    #[test]
    fn something_is_said_whenever_something_is_to_be_done() {
        assert_eq!(note(&Stage::Driving, Phase::Driving), "");
        assert!(note(&Stage::Ready, Phase::Arming).starts_with('N'));
        assert!(note(&Stage::Labelling(Dialog::default()), Phase::Done).contains("label"));
    }
}

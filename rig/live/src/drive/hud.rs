//! The HUD of a live drive.

use kernel::arbiter::Phase;

use super::board::Status;
use super::stage::Stage;
use crate::desktop::HudText;

/// That of a session's status.
pub fn text(status: &Status) -> HudText {
    let text = HudText::new(&status.hud, status.steering, status.pedals, status.flags);
    HudText { note: note(&status.stage, status.phase, status.units_note.as_deref()).into(), ..text }
}

/// What is to be done, in words; a unit that is not armed comes first.
fn note<'a>(stage: &Stage, phase: Phase, units: Option<&'a str>) -> &'a str {
    match (stage, phase, units) {
        (Stage::Ready | Stage::Driving, _, Some(units)) => units,
        (Stage::Ready, ..) => "N starts the run",
        (Stage::Labelling(_), ..) => "The run has ended: label it in the control centre",
        (Stage::Driving, Phase::Arming, None) => "Arming",
        (Stage::Driving, Phase::TakenOver, None) => "Taken over",
        (Stage::Driving, Phase::Driving | Phase::Done, None) => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::stage::Dialog;

    #[test]
    fn something_is_said_whenever_something_is_to_be_done() {
        assert_eq!(note(&Stage::Driving, Phase::Driving, None), "");
        assert!(note(&Stage::Ready, Phase::Arming, None).starts_with('N'));
        assert!(note(&Stage::Labelling(Dialog::default()), Phase::Done, None).contains("label"));
    }

    #[test]
    fn a_unit_that_is_not_armed_is_on_both_screens() {
        let lost = Some("safety driver's G29: lost");
        for stage in [Stage::Ready, Stage::Driving] {
            assert_eq!(Some(note(&stage, Phase::Driving, lost)), lost);
        }
        assert!(note(&Stage::Labelling(Dialog::default()), Phase::Done, lost).contains("label"));
    }
}

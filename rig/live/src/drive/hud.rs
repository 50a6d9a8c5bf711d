//! The HUD of a live drive.

use kernel::Seat;
use kernel::arbiter::Phase;

use super::alert::Alert;
use super::board::Status;
use super::stage::{Pause, Stage};
use crate::desktop::HudText;

/// That of a session's status on a driver's screen.
pub fn text(status: &Status, seat: Seat) -> HudText {
    let text = HudText::new(&status.hud, status.steering, status.pedals, status.flags);
    let alert = status.alert.as_ref().and_then(|alert: &Alert| alert.words(seat));
    HudText {
        note: rest(status)
            .unwrap_or_else(|| note(&status.stage, status.phase, seat, status.units_note.as_deref()).into()),
        alert: alert.unwrap_or_default().into(),
        is_taken_over: status.phase == Phase::TakenOver,
        ..text
    }
}

/// What is left of a break.
pub fn rest(status: &Status) -> Option<String> {
    let seconds = status.rest_s.filter(|_| status.stage == Stage::Ready)?;
    Some(format!("Break: {}:{:02} to run {}", seconds / 60, seconds % 60, status.run))
}

/// What is to be done, in words; a unit that is not armed comes first.
fn note<'a>(stage: &Stage, phase: Phase, seat: Seat, units: Option<&'a str>) -> &'a str {
    match (stage, phase, units) {
        (Stage::Paused(Pause::Ending), ..) => "Time stands: P drives on, Q ends the session",
        (Stage::Ready | Stage::Driving | Stage::Paused(_), _, Some(units)) => units,
        (Stage::Paused(_), ..) => "Time stands: P drives on",
        (Stage::Ready, ..) => "N starts the run",
        (Stage::Labelling(_), ..) => "The run has ended: label it in the control centre",
        (Stage::Asking(_), ..) => "The operators ask you how you are",
        (Stage::Over, ..) => "All runs of the plan are driven",
        (Stage::Driving, Phase::Arming, None) => "Arming",
        (Stage::Driving, Phase::TakenOver, None) => match seat {
            Seat::Semantic => "The safety driver has the car: your controls are off",
            Seat::Safety => "You have the car: drive to a safe stop",
        },
        (Stage::Driving, Phase::Driving | Phase::Done, None) => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::stage::Dialog;

    fn said<'a>(stage: &Stage, phase: Phase, units: Option<&'a str>) -> &'a str {
        note(stage, phase, Seat::Safety, units)
    }

    #[test]
    fn something_is_said_whenever_something_is_to_be_done() {
        assert_eq!(said(&Stage::Driving, Phase::Driving, None), "");
        assert!(said(&Stage::Ready, Phase::Arming, None).starts_with('N'));
        assert!(said(&Stage::Over, Phase::Arming, None).starts_with("All runs"));
        assert!(said(&Stage::Labelling(Dialog::of_case(None)), Phase::Done, None).contains("label"));
        assert!(said(&Stage::Paused(Pause::Ending), Phase::Driving, None).contains("Q ends"));
    }

    #[test]
    fn each_driver_is_told_who_has_the_car_after_a_takeover() {
        let [semantic, safety] =
            [Seat::Semantic, Seat::Safety].map(|seat| note(&Stage::Driving, Phase::TakenOver, seat, None));
        assert!(semantic.contains("your controls are off") && safety.starts_with("You have the car"));
    }

    #[test]
    fn a_unit_that_is_not_armed_is_on_both_screens() {
        let lost = Some("safety driver's G29: lost");
        for stage in [Stage::Ready, Stage::Driving, Stage::Paused(Pause::UnitLost)] {
            for seat in [Seat::Semantic, Seat::Safety] {
                assert_eq!(Some(note(&stage, Phase::Driving, seat, lost)), lost);
            }
        }
        assert!(said(&Stage::Labelling(Dialog::of_case(None)), Phase::Done, lost).contains("label"));
    }
}

//! Where the session stands between and within runs, and what the operators' keys do there.

mod dialog;
mod form;
mod press;
mod wish;

use replay::{Annotation, Label};

pub use dialog::Dialog;
pub use form::Form;
pub use press::Press;
pub use wish::{Pause, Wish};

/// Where a session stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stage {
    /// A run waits for its start.
    Ready,
    /// The car drives.
    Driving,
    /// The car drives no more for now: time stands.
    Paused(Pause),
    /// The run has ended and waits for what is to be said of it.
    Labelling(Dialog),
    /// Both drivers are asked how they are.
    Asking(Form),
    /// All that was planned has been driven.
    Over,
}

impl Stage {
    /// Takes a key. `repeated` says that it is held down: then it only types or deletes.
    pub fn press(&mut self, press: &Press, repeated: bool) -> Wish {
        match self {
            Self::Labelling(dialog) if !dialog.is_empty() => dialog.press(press, repeated),
            Self::Asking(form) => form.press(press, repeated),
            Self::Driving if *press == Press::Escape && !repeated => Wish::Pause(Pause::Ending),
            _ if *press == Press::Escape && !repeated => Wish::Quit,
            Self::Labelling(dialog) => dialog.press(press, repeated),
            _ if repeated => Wish::Nothing,
            _ if is(press, 'f') => Wish::Force,
            _ if is(press, 'm') => Wish::Mute,
            Self::Ready if is(press, 'n') => Wish::Start,
            Self::Ready if is(press, 'x') => Wish::Swap,
            Self::Ready | Self::Over if is(press, 'q') => Wish::Quit,
            Self::Driving if is(press, 'p') => Wish::Pause(Pause::Asked),
            Self::Driving | Self::Paused(_) if is(press, 'b') => Wish::BreakOff,
            Self::Driving => label(press).map_or(Wish::Nothing, Wish::Label),
            Self::Paused(_) if is(press, 'p') => Wish::Resume,
            Self::Paused(_) if is(press, 'q') => Wish::Quit,
            Self::Ready | Self::Paused(_) | Self::Over => Wish::Nothing,
        }
    }

    /// What has been entered about the end of a run, when a label is chosen.
    pub fn annotation(&self) -> Option<Annotation> {
        match self {
            Self::Labelling(dialog) => dialog.annotation(),
            Self::Ready | Self::Driving | Self::Paused(_) | Self::Asking(_) | Self::Over => None,
        }
    }
}

fn is(press: &Press, letter: char) -> bool {
    matches!(press, Press::Text { command: Some(command), .. } if *command == letter)
}

/// The kind of corner case that a key stands for.
fn label(press: &Press) -> Option<Label> {
    let Press::Text { command: Some(command), .. } = press else { return None };
    dialog::case_of(*command)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> Press {
        Press::Text { text: text.into(), command: text.to_lowercase().chars().next() }
    }

    fn enter(stage: &mut Stage, keys: &str) {
        for key in keys.chars() {
            assert_eq!(stage.press(&text(&key.to_string()), false), Wish::Nothing);
        }
    }

    #[test]
    fn n_starts_a_run_and_nothing_else_does() {
        assert_eq!(Stage::Ready.press(&text("n"), false), Wish::Start);
        assert_eq!(Stage::Ready.press(&text("n"), true), Wish::Nothing);
        assert_eq!(Stage::Ready.press(&text("w"), false), Wish::Nothing);
        assert_eq!(Stage::Driving.press(&text("n"), false), Wish::Nothing);
    }

    #[test]
    fn forces_and_sound_are_switched_off_at_any_time_but_not_by_a_comment() {
        assert_eq!(Stage::Driving.press(&text("f"), false), Wish::Force);
        assert_eq!(Stage::Driving.press(&text("f"), true), Wish::Nothing);
        assert_eq!(
            [Stage::Ready, Stage::Driving].map(|mut stage| stage.press(&text("m"), false)),
            [Wish::Mute, Wish::Mute]
        );
        let mut stage = Stage::Labelling(Dialog::of_case(None));
        enter(&mut stage, "1off");
    }

    #[test]
    fn seats_are_swapped_between_runs_only() {
        assert_eq!(Stage::Ready.press(&text("X"), false), Wish::Swap);
        assert_eq!(Stage::Driving.press(&text("x"), false), Wish::Nothing);
        let mut stage = Stage::Labelling(Dialog::of_case(None));
        assert_eq!(stage.press(&text("x"), false), Wish::Nothing);
    }

    #[test]
    fn a_case_gets_its_label_then_its_comment() {
        let mut stage = Stage::Labelling(Dialog::of_case(None));
        assert_eq!(stage.press(&Press::Enter, false), Wish::Nothing, "a label is asked for");
        enter(&mut stage, "w92near quarter 7x");
        assert_eq!(stage.press(&Press::Backspace, true), Wish::Nothing);
        let annotation =
            Annotation { label: Label::Vehicle, comment: "near quarter 7".into(), perception_caused: None };
        assert_eq!(stage.press(&Press::Enter, false), Wish::Finish(Some(annotation)));
    }

    #[test]
    fn keys_held_from_driving_type_nothing_and_a_label_can_be_changed() {
        let mut stage = Stage::Labelling(Dialog::of_case(None));
        enter(&mut stage, "1a");
        assert_eq!(stage.press(&text("w"), true), Wish::Nothing);
        let entered = Dialog { comment: "a".into(), ..Dialog::of_case(Some(Label::Walker)) };
        assert_eq!(stage, Stage::Labelling(entered));
        for _ in 0..2 {
            stage.press(&Press::Backspace, false);
        }
        enter(&mut stage, "4");
        let entered = Dialog::of_case(Some(Label::Boredom));
        assert_eq!(stage, Stage::Labelling(entered));
    }

    #[test]
    fn q_quits_between_runs_only_and_escape_everywhere_but_in_a_label() {
        assert_eq!(Stage::Ready.press(&text("q"), false), Wish::Quit);
        assert_eq!(Stage::Driving.press(&text("q"), false), Wish::Nothing, "it is beside W and A");
        assert_eq!(Stage::Driving.press(&Press::Escape, false), Wish::Pause(Pause::Ending), "it asks first");
        let mut ending = Stage::Paused(Pause::Ending);
        assert_eq!(ending.press(&Press::Escape, true), Wish::Nothing, "held down");
        let [again, on] = [Press::Escape, text("p")].map(|press| ending.press(&press, false));
        assert_eq!((again, on), (Wish::Quit, Wish::Resume));
        let mut stage = Stage::Labelling(Dialog::of_case(None));
        enter(&mut stage, "q1q");
        assert_eq!(stage.annotation().map(|a| (a.label, a.comment)), Some((Label::Walker, "q".into())));
        assert_eq!(stage.press(&Press::Escape, false), Wish::Nothing, "the entry goes first");
        assert_eq!((stage.annotation(), stage.press(&Press::Escape, false)), (None, Wish::Quit));
    }

    #[test]
    fn a_run_that_is_broken_off_is_no_corner_case_and_may_go_without_a_word() {
        for mut stage in [Stage::Driving, Stage::Paused(Pause::UnitLost)] {
            assert_eq!(stage.press(&text("b"), false), Wish::BreakOff);
        }
        let mut stage = Stage::Labelling(Dialog::of_broken_off());
        enter(&mut stage, "14");
        assert_eq!(stage.annotation(), None, "no takeover has happened");
        assert_eq!(stage.press(&Press::Enter, false), Wish::Finish(None));
        enter(&mut stage, "6wheel");
        let annotation = Annotation { label: Label::TechnicalFault, comment: "wheel".into(), perception_caused: None };
        assert_eq!(stage.press(&Press::Enter, false), Wish::Finish(Some(annotation)));
    }

    #[test]
    fn a_takeover_can_be_labelled_while_it_goes_on_and_set_aside_at_its_end() {
        assert_eq!(Stage::Driving.press(&text("2"), false), Wish::Label(Label::Vehicle));
        assert_eq!(Stage::Driving.press(&text("6"), false), Wish::Nothing);
        let mut stage = Stage::Labelling(Dialog::of_case(Some(Label::Vehicle)));
        assert_eq!(stage.press(&Press::Backspace, false), Wish::Nothing);
        enter(&mut stage, "5");
        assert_eq!(stage.annotation().map(|said| said.label), Some(Label::DriverError));
    }
}

//! Where the session stands between and within runs, and what the operators' keys do there.

use replay::{Annotation, Label};

/// Longest comment, characters.
const MAX_COMMENT: usize = 400;

/// Where a session stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stage {
    /// A run waits for its start.
    Ready,
    /// The car drives.
    Driving,
    /// The run has ended as a corner case and waits for its label.
    Labelling(Dialog),
}

/// What the operators have entered about a corner case so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Dialog {
    /// The label, once chosen.
    pub label: Option<Label>,
    /// The comment as typed.
    pub comment: String,
}

/// A key went down.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Press {
    /// Enter.
    Enter,
    /// Escape.
    Escape,
    /// Backspace.
    Backspace,
    /// Any other key.
    Text {
        /// What it types into a comment.
        text: String,
        /// The operators' letter or digit that it stands for; none of a seat's key, whatever that types.
        command: Option<char>,
    },
}

/// What a key asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Nothing, or something that the stage has done itself.
    Nothing,
    /// Start the run.
    Start,
    /// Let the units change seats.
    Swap,
    /// Switch force feedback off or on.
    Force,
    /// End the run with this said about it.
    Annotate(Annotation),
    /// End the session.
    Quit,
}

impl Stage {
    /// Takes a key. `repeated` says that it is held down: then it only types or deletes.
    pub fn press(&mut self, press: &Press, repeated: bool) -> Wish {
        match self {
            Self::Labelling(dialog) if *dialog != Dialog::default() => dialog.press(press, repeated),
            _ if *press == Press::Escape => Wish::Quit,
            Self::Labelling(dialog) => dialog.press(press, repeated),
            _ if repeated => Wish::Nothing,
            Self::Ready if is(press, 'n') => Wish::Start,
            Self::Ready if is(press, 'x') => Wish::Swap,
            _ if is(press, 'f') => Wish::Force,
            Self::Ready if is(press, 'q') => Wish::Quit,
            _ => Wish::Nothing,
        }
    }

    /// What has been entered about a corner case, when a label is chosen.
    pub fn annotation(&self) -> Option<Annotation> {
        match self {
            Self::Labelling(dialog) => dialog.annotation(),
            Self::Ready | Self::Driving => None,
        }
    }
}

impl Dialog {
    /// The label comes first, so that keys still held from driving type nothing.
    fn press(&mut self, press: &Press, repeated: bool) -> Wish {
        match (press, self.label) {
            (Press::Text { command, .. }, None) if !repeated => self.label = command.and_then(label_of),
            (Press::Text { text, .. }, Some(_)) if !repeated => self.type_in(text),
            (Press::Backspace, Some(_)) if self.comment.pop().is_none() => self.label = None,
            (Press::Enter, Some(_)) if !repeated => return self.annotation().map_or(Wish::Nothing, Wish::Annotate),
            (Press::Escape, _) => *self = Self::default(),
            _ => {}
        }
        Wish::Nothing
    }

    fn annotation(&self) -> Option<Annotation> {
        Some(Annotation { label: self.label?, comment: self.comment.trim().to_owned(), perception_caused: None })
    }

    fn type_in(&mut self, text: &str) {
        let room = MAX_COMMENT.saturating_sub(self.comment.chars().count());
        self.comment.extend(text.chars().filter(|c| !c.is_control()).take(room));
    }
}

fn is(press: &Press, letter: char) -> bool {
    matches!(press, Press::Text { command: Some(command), .. } if *command == letter)
}

/// The label with a number key: 1 for the first.
fn label_of(digit: char) -> Option<Label> {
    let number = digit.to_digit(10)? as usize;
    Label::ALL.get(number.checked_sub(1)?).copied()
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
    fn forces_are_switched_off_at_any_time_but_not_by_a_comment() {
        assert_eq!(Stage::Driving.press(&text("f"), false), Wish::Force);
        assert_eq!(Stage::Driving.press(&text("f"), true), Wish::Nothing);
        let mut stage = Stage::Labelling(Dialog::default());
        enter(&mut stage, "1off");
    }

    #[test]
    fn seats_are_swapped_between_runs_only() {
        assert_eq!(Stage::Ready.press(&text("X"), false), Wish::Swap);
        assert_eq!(Stage::Driving.press(&text("x"), false), Wish::Nothing);
        let mut stage = Stage::Labelling(Dialog::default());
        assert_eq!(stage.press(&text("x"), false), Wish::Nothing);
    }

    #[test]
    fn a_case_gets_its_label_then_its_comment() {
        let mut stage = Stage::Labelling(Dialog::default());
        assert_eq!(stage.press(&Press::Enter, false), Wish::Nothing, "a label is asked for");
        enter(&mut stage, "w92near quarter 7x");
        assert_eq!(stage.press(&Press::Backspace, true), Wish::Nothing);
        let annotation =
            Annotation { label: Label::Vehicle, comment: "near quarter 7".into(), perception_caused: None };
        assert_eq!(stage.press(&Press::Enter, false), Wish::Annotate(annotation));
    }

    #[test]
    fn keys_held_from_driving_type_nothing_and_a_label_can_be_changed() {
        let mut stage = Stage::Labelling(Dialog::default());
        enter(&mut stage, "1a");
        assert_eq!(stage.press(&text("w"), true), Wish::Nothing);
        let entered = Dialog { label: Some(Label::Walker), comment: "a".into() };
        assert_eq!(stage, Stage::Labelling(entered));
        for _ in 0..2 {
            stage.press(&Press::Backspace, false);
        }
        enter(&mut stage, "4");
        let entered = Dialog { label: Some(Label::Boredom), comment: String::new() };
        assert_eq!(stage, Stage::Labelling(entered));
    }

    #[test]
    fn q_quits_between_runs_only_and_escape_everywhere_but_in_a_label() {
        assert_eq!(Stage::Ready.press(&text("q"), false), Wish::Quit);
        assert_eq!(Stage::Driving.press(&text("q"), false), Wish::Nothing, "it is beside W and A");
        assert_eq!(Stage::Driving.press(&Press::Escape, false), Wish::Quit);
        let mut stage = Stage::Labelling(Dialog::default());
        enter(&mut stage, "q1q");
        assert_eq!(stage.annotation().map(|a| (a.label, a.comment)), Some((Label::Walker, "q".into())));
        assert_eq!(stage.press(&Press::Escape, false), Wish::Nothing, "the entry goes first");
        assert_eq!((stage.annotation(), stage.press(&Press::Escape, false)), (None, Wish::Quit));
    }
}

//! Questions that both drivers are asked after a run, on the operators' screen.

use kernel::Seat;
use study::Questionnaire;
use study::questionnaire::{AFTER, Question};

use super::press::Press;
use super::wish::Wish;

/// What has been answered so far.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Form {
    /// What is asked of whom.
    asked: Vec<(Seat, String, &'static Question)>,
    /// What was typed for each of them.
    typed: Vec<String>,
}

impl Form {
    /// About the state of both drivers, by the names they go by, semantic driver's first.
    pub fn about(names: [String; 2]) -> Self {
        let seats = [Seat::Semantic, Seat::Safety].into_iter().zip(names);
        let asked = seats.flat_map(|(seat, name)| AFTER.iter().map(move |question| (seat, name.clone(), question)));
        Self { asked: asked.collect(), typed: vec![String::new()] }
    }

    /// What is asked now: of whom, and what; and what is typed.
    pub fn asks(&self) -> (&str, &'static Question, &str) {
        let at = self.typed.len() - 1;
        let (_, name, question) = &self.asked[at.min(self.asked.len() - 1)];
        (name, question, &self.typed[at])
    }

    /// Number of the question, from 1, and of all of them.
    pub fn place(&self) -> (usize, usize) {
        (self.typed.len(), self.asked.len())
    }

    /// Takes a key: digits, Enter for the next question, also without an answer, Backspace for the one before.
    pub(super) fn press(&mut self, press: &Press, repeated: bool) -> Wish {
        let (is_good, place, last) = (self.is_good(), self.typed.len(), self.asked.len());
        let (Some(typed), false) = (self.typed.last_mut(), repeated) else { return Wish::Nothing };
        match press {
            Press::Text { command: Some(digit @ '0'..='9'), .. } if typed.len() < 3 => typed.push(*digit),
            Press::Backspace if typed.pop().is_none() && place > 1 => drop(self.typed.pop()),
            Press::Enter if is_good && place == last => return Wish::Answered,
            Press::Enter if is_good => self.typed.push(String::new()),
            Press::Escape if typed.is_empty() => return Wish::Quit,
            Press::Escape => typed.clear(),
            _ => {}
        }
        Wish::Nothing
    }

    /// Whether what is typed answers the question, or nothing is.
    fn is_good(&self) -> bool {
        let (_, question, typed) = self.asks();
        typed.is_empty() || typed.parse().is_ok_and(|number: i64| question.range.contains(&number))
    }

    /// What was answered; what is half typed is not.
    pub fn answers(&self) -> Questionnaire {
        let mut answers = Questionnaire::default();
        for ((seat, _, question), typed) in self.asked.iter().zip(&self.typed) {
            if let Some(number) = typed.parse().ok().filter(|number| question.range.contains(number)) {
                answers.answer(*seat, question, number);
            }
        }
        answers
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(digit: char) -> Press {
        Press::Text { text: digit.into(), command: Some(digit) }
    }

    fn told(answers: &Questionnaire) -> Vec<String> {
        answers.answers().map(|(key, answer)| format!("{key} {answer}")).collect()
    }

    #[test]
    fn both_drivers_are_asked_and_nobody_has_to_answer() {
        let mut form = Form::about(["P07".into(), "P03".into()]);
        assert_eq!((form.asks().0, form.place()), ("P07", (1, 4)));
        let mut wish = Wish::Nothing;
        for press in [key('4'), Press::Enter, key('1'), key('0'), Press::Enter, Press::Enter, key('3'), Press::Enter] {
            assert_eq!(wish, Wish::Nothing);
            wish = form.press(&press, false);
        }
        assert_eq!(wish, Wish::Answered);
        assert_eq!(
            told(&form.answers()),
            ["safety.after.stress 3", "semantic.after.fatigue 4", "semantic.after.stress 10"]
        );
    }

    #[test]
    fn an_answer_out_of_range_is_not_taken_and_can_be_mended() {
        let mut form = Form::about(["P07".into(), "P03".into()]);
        for press in [key('9'), key('9'), Press::Enter] {
            form.press(&press, false);
        }
        assert_eq!((form.asks().2, form.place().0), ("99", 1));
        assert!(told(&form.answers()).is_empty(), "half typed");
        for press in [Press::Backspace, Press::Enter, Press::Backspace, Press::Backspace, key('2')] {
            form.press(&press, false);
        }
        assert_eq!(told(&form.answers()), ["semantic.after.fatigue 2"]);
        assert_eq!(form.press(&Press::Escape, false), Wish::Nothing, "what is typed goes first");
        assert_eq!(form.press(&Press::Escape, false), Wish::Quit);
    }
}

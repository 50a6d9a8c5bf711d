//! Notes of a tick that has not come yet: while time stands, all that happens is of the tick after.

use kernel::Seat;
use replay::{Note, NoteKind};

/// What happened since the last tick. Whatever comes and goes meanwhile leaves a note of each kind at most, so that time may
/// stand for as long as people like.
#[derive(Debug, Default)]
pub struct Pending(Vec<Note>);

/// What a note is about: a seat's unit, or time.
type Subject = Option<Option<Seat>>;

impl Pending {
    /// Takes a note. One that brings its subject back to where it has been since the last tick undoes what lies between.
    pub fn take(&mut self, note: Note) {
        let is_of = |other: &Note| subject(other) == subject(&note);
        match self.0.iter().position(|other| is_of(other) && other.kind == note.kind) {
            None => self.0.push(note),
            Some(first) => {
                let mut index = 0;
                self.0.retain(|other| {
                    index += 1;
                    index <= first + 1 || !is_of(other)
                });
            }
        }
    }

    /// Hands out all of them, in order.
    pub fn drain(&mut self) -> std::vec::Drain<'_, Note> {
        self.0.drain(..)
    }
}

fn subject(note: &Note) -> Subject {
    match note.kind {
        NoteKind::Paused | NoteKind::Resumed => None,
        NoteKind::UnitBound | NoteKind::UnitArmed | NoteKind::UnitLost | NoteKind::UnitReturned => Some(note.seat),
    }
}

#[cfg(test)]
mod tests {
    use NoteKind::{Paused, Resumed, UnitArmed, UnitLost, UnitReturned};

    use super::*;

    fn left_of(happened: &[(NoteKind, Option<Seat>)]) -> Vec<(NoteKind, Option<Seat>)> {
        let mut pending = Pending::default();
        happened.iter().for_each(|&(kind, seat)| pending.take(Note { tick: 7, kind, seat }));
        pending.drain().map(|note| (note.kind, note.seat)).collect()
    }

    #[test]
    fn a_unit_that_comes_and_goes_leaves_how_it_went_and_how_it_is() {
        let seat = Some(Seat::Semantic);
        let gone = [(UnitLost, seat), (Paused, seat)];
        let back = [(UnitReturned, seat), (UnitArmed, seat)];
        let again = [(UnitLost, seat), (UnitReturned, seat), (UnitArmed, seat)];
        let loose: Vec<_> = gone.into_iter().chain(back).chain([again; 9].concat()).collect();
        let told: Vec<_> = gone.into_iter().chain(back).collect();
        assert_eq!(left_of(&loose), told);
        assert_eq!(left_of(&loose[..loose.len() - 2]), gone, "it is lost at the end");
        let others = [(UnitLost, Some(Seat::Safety)), (Resumed, None)];
        assert_eq!(left_of(&[&loose[..], &others].concat()), [&told[..], &others].concat());
    }

    #[test]
    fn time_that_stands_again_before_a_tick_has_stood_once() {
        let taps = [(Paused, None), (Resumed, None)].repeat(20);
        assert_eq!(left_of(&taps), [(Paused, None), (Resumed, None)]);
        assert_eq!(left_of(&taps[..39]), [(Paused, None)]);
    }
}

//! Stories: what others do to whom when, as OpenSCENARIO XML tells it.
//!
//! A [`Story`] is a text that was read; a [`Stage`] is it on a map; a [`StoryState`] is how far it has come, a part of the
//! world's state. Who plays moves as the story says and else on along its lane at its speed; nobody who plays looks out for
//! others, but traffic sees all of them. The ego car plays what its drivers do.

mod action;
mod actor;
mod cues;
mod deeds;
mod doors;
mod error;
mod facts;
mod lanes;
mod library;
mod lights;
mod moves;
mod pace;
mod places;
mod plan;
mod position;
mod reader;
mod relative;
mod script;
mod setting;
mod spot;
mod stage;
mod state;
mod text;
mod weather;

pub use crate::actor::FIRST_STORY_ID;
pub use error::StoryError;
pub use library::{BUNDLED, bundled_text};
pub use reader::{ELEMENTS, Row, Support};
pub use script::Script;
pub(crate) use stage::{Around, Stage};
pub use state::StoryState;
pub use text::Story;

#[cfg(test)]
mod tests;

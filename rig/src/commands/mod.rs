//! The commands that drive, and those that look at recordings.

pub mod campaign;
pub mod doctor;
pub mod drive;
pub mod inspect;
pub mod questionnaire;
pub mod statistics;
pub mod verify;
pub mod wheel;

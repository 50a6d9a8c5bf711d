//! A file a command: its arguments become options, its result is printed.

pub mod campaign;
pub mod compare;
pub mod dataset;
pub mod demo;
pub mod doctor;
pub mod drive;
pub mod eval;
pub mod experiment;
pub mod export;
pub mod inspect;
pub mod questionnaire;
pub mod redrive;
pub mod report;
pub mod rerender;
pub mod shell;
pub mod statistics;
pub mod train;
pub mod verify;
pub mod view;
pub mod wheel;

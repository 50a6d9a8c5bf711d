//! What every part of the rig stands on: recordings and maps found by name, results that appear whole or not
//! at all, progress and Ctrl-C, the clock, work spread over threads, pictures as files, what may be asked for, what is said,
//! and the words for it all.

pub mod asked;
pub mod chart;
pub mod clock;
pub mod failure;
pub mod files;
pub mod image;
pub mod json;
pub mod library;
pub mod maps;
pub mod models;
pub mod newest;
pub mod output;
pub mod png;
pub mod progress;
pub mod room;
pub mod say;
pub mod scenario_file;
pub mod setting;
pub mod spread;
pub mod toml_text;
pub mod words;

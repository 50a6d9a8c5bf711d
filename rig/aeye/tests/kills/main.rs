//! The program is killed again and again, at any moment of everything that takes long, and goes on: what was finished
//! stays, and in the end every file is the one of a run that nobody killed.
//!
//! `AEYE_KILLS` is how often in all (7 unless told otherwise), `AEYE_KILLS_SEED` draws the moments.
#![cfg(unix)]

#[path = "../common/mod.rs"]
mod common;

mod campaign;
mod cases;
mod contents;
mod draws;
mod drive;
mod experiment;
mod learning;
mod ordeal;
mod program;
mod street;

//! A file a command: its arguments become options, its result is printed.
//!
//! What needs windows or wheels is in `windows`; a build without the feature `live` has `windowless` in its place, which
//! says so.

pub mod campaign;
pub mod cases;
pub mod compare;
pub mod dataset;
pub mod demo;
pub mod doctor;
pub mod drive;
pub mod eval;
pub mod experiment;
pub mod export;
pub mod gallery;
pub mod inspect;
pub mod map;
mod plan;
pub mod questionnaire;
pub mod redrive;
pub mod render;
pub mod report;
pub mod rerender;
pub mod shell;
pub mod statistics;
pub mod train;
pub mod verify;
pub mod view;
#[cfg(not(feature = "live"))]
pub mod windowless;
#[cfg(feature = "live")]
pub mod windows;
#[cfg(not(feature = "live"))]
pub use windowless as windows;

use base::failure::Failed;
use lab::share::ShareDone;

use crate::exit::Verdict;
use crate::print;

/// Prints what came of a share.
fn share(json: bool, done: &ShareDone) -> anyhow::Result<Verdict> {
    print::result(json, done)?;
    Failed::check(&done.failed, done.done)?;
    Ok(Verdict::Ok)
}

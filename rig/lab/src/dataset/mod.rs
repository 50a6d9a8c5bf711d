//! Datasets: frames with ground truth in the layout of Cityscapes, each with its provenance.
//!
//! | kind | frames | module |
//! |---|---|---|
//! | natural | simulated drives, one frame a second | [`natural`], driven by [`drivers::expert`] in `drive` |
//! | cases | the 3 s up to each takeover, ten frames a second | [`cases`] |
//! | mix | natural ones, some replaced by others | [`mix`] |
//!
//! A folder is a dataset as soon as it holds `dataset.json` ([`Manifest`]: the recipe and what came of
//! it), which is written last. `frames.jsonl` says where each frame comes from ([`FrameLine`]). The
//! pictures are a function of the recipe, on one adapter ([`rebuild`]).

pub mod cases;
pub mod drive;
mod manifest;
pub mod mix;
pub mod natural;
mod parts;
mod provenance;
pub mod rebuild;
pub(crate) mod recipe;
mod views;

pub use manifest::{Manifest, check_whole};
pub use provenance::{FrameLine, Part, WeatherLine};
pub use recipe::Recipe;

//! The log of a run: what a world started from, both drivers' controls at every tick, and the hashes
//! that prove that a replay is the same run.
//!
//! A [`Recorder`] writes while the run goes on; a [`Recording`] is such a file read back, every byte
//! of it checked; a [`Replayer`] simulates it again and compares each tick; a [`Case`] is a
//! self-contained cut around an intervention, but for the file of a foreign map, which may be beside it.
//! [`Log`] is the content of all of these as plain data.
//!
//! Files are MCAP; `layout.rs` describes every channel. An [`Exporter`] writes MCAP files for viewers, of
//! messages that the caller made.

mod block;
mod case;
mod chunk;
mod columns;
mod container;
mod divergence;
mod encode;
mod error;
mod export;
mod header;
mod index;
mod layout;
mod log;
mod mark;
mod notes;
mod program;
mod recorder;
mod recording;
mod records;
mod replayer;
mod scan;
mod seal;
#[cfg(test)]
mod testing;
mod verify;
mod wire;

pub use case::Case;
pub use divergence::Divergence;
pub use error::Error;
pub use export::{ExportChannel, Exported, Exporter, Schema, exported};
pub use header::CaseHeader;
pub use layout::{FORMAT_VERSION, nanoseconds};
pub use log::{Annotation, CaseInfo, ForeignMap, Label, LiveTimes, Log, Manifest, MaskShown, Provenance, RunSummary};
pub use mark::Mark;
pub use notes::{Note, NoteKind};
pub use program::{PROGRAM, WRITTEN_BY};
pub use recorder::Recorder;
pub use recording::Recording;
pub use replayer::Replayer;
pub use verify::{Report, against, resumes, rewind, verify};

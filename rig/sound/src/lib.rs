//! What is to be heard in the ego car, made of what the world says at each tick: nothing is played from files.
//!
//! An [`Ear`] takes in ticks and says what is [`Heard`]; a [`Mixer`] turns that into samples, the same ones whenever it hears
//! the same. Neither knows of devices.

mod dsp;
mod heard;
mod mixer;
mod voices;

pub use heard::{Around, Cue, Ear, Heard, Size};
pub use mixer::{Mixer, SAMPLE_HZ};

//! Operators of our own for the engine, where its own are slow on a CPU: they take and give maps channels last
//! (batch, rows, columns, channels: `NHWC`), so that a vector holds neighbouring channels of one pixel.
//!
//! Every sum is made in the order of the kernel, rows before columns before channels, one output at a time: the result
//! depends neither on the width of the vectors nor on threads ([`crate::simd`] says where it may depend on the
//! machine). [`prepare`] puts them into a typed graph in place of the engine's own.

mod activation;
mod by_channel;
mod convolve;
mod depthwise;
mod ends;
mod follow;
mod pool;
mod prelu;
mod residual;
mod resize;
mod resizing;
mod rewrite;
#[cfg(test)]
mod tests;
mod tile;
mod window;
mod wiring;

pub(crate) use ends::{give_channels_last, take_channels_last};
pub(crate) use rewrite::prepare;

//! The windows as people use them: a virtual display, real keys.

mod display;
mod drive;
mod ends;
mod plan;
mod rig;
mod study;
mod view;

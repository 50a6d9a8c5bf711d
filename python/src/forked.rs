//! Graphics devices do not survive a fork: in a process that was forked after drawing they may neither be used nor given back.

use std::ops::Deref;
use std::sync::atomic::{AtomicU32, Ordering};
use std::{mem, process};

use pyo3::prelude::*;

use crate::errors::engine;

/// The process that has drawn; 0 before any has.
static DREW: AtomicU32 = AtomicU32::new(0);

/// Refuses to draw in a process that was forked from one that has drawn.
pub fn check() -> PyResult<()> {
    let me = process::id();
    match DREW.compare_exchange(0, me, Ordering::Relaxed, Ordering::Relaxed) {
        Err(other) if other != me => Err(engine(
            "this process was forked from one that has drawn, and graphics devices do not survive that; start it with \
             multiprocessing's method \"spawn\" (DataLoader: multiprocessing_context=\"spawn\")"
                .to_owned(),
        )),
        _ => Ok(()),
    }
}

/// What may hold a graphics device, and is left alone where that is of another process: giving it back would wait for threads
/// that are not there.
pub struct Owned<T>(Option<T>);

impl<T> Owned<T> {
    pub fn new(owned: T) -> Self {
        Self(Some(owned))
    }
}

impl<T> Deref for Owned<T> {
    type Target = T;

    fn deref(&self) -> &T {
        self.0.as_ref().expect("it is there until it is dropped")
    }
}

impl<T> Drop for Owned<T> {
    fn drop(&mut self) {
        if ![0, process::id()].contains(&DREW.load(Ordering::Relaxed)) {
            mem::forget(self.0.take());
        }
    }
}

//! How fast drawing would be without looking, and looking without drawing: what the two together are
//! measured against.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Barrier, Mutex};
use std::thread;

use base::clock::seconds_of;
use render::Frame;
use serde::Serialize;

use super::{OpenFile, Pipeline, Work, lock};

/// Files whose frames are drawn and looked at, each stage for itself.
const SAMPLE: usize = 2;
/// Files that must be left to do; fewer are done before they are measured.
const LEAST: usize = 3 * SAMPLE;

/// Rates of each stage with the machine to itself, frames a second.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Alone {
    /// Drawing.
    pub render_fps: f64,
    /// Looking through all checkpoints, and comparing with the truth.
    pub inference_fps: f64,
}

/// A frame and its file.
type Drawn<'f, W> = (&'f OpenFile<W>, Frame);

impl<W: Work> Pipeline<'_, W> {
    /// Measures both stages on the first files, with the threads that they have in [`Pipeline::run`]; what they
    /// find is dropped. `None` where too few files are left for it to be worth it, or none of the first is whole.
    pub fn alone(&self) -> anyhow::Result<Option<Alone>> {
        if self.files.len() < LEAST || self.interrupt.is_raised() {
            return Ok(None);
        }
        let opened = self.files.iter().take(SAMPLE).filter_map(|index| OpenFile::read(self.work, *index).ok());
        let opened: Vec<_> = opened.collect();
        if opened.is_empty() {
            return Ok(None);
        }
        let (drawn, draw_s) = self.draw_alone(&opened)?;
        let look_s = self.look_alone(&drawn)?;
        let frames = drawn.len() as f64;
        Ok(Some(Alone { render_fps: frames / draw_s, inference_fps: frames / look_s }))
    }

    fn draw_alone<'f>(&self, opened: &'f [OpenFile<W>]) -> anyhow::Result<(Vec<Drawn<'f, W>>, f64)> {
        let scenes: Vec<_> =
            opened.iter().flat_map(|file| file.footage.scenes.iter().map(move |s| (file, s))).collect();
        let (next, drawn) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
        let seconds = together(self.drawing(), |start| {
            self.studios.with(self.size, |studio| {
                let mut each = opened.iter().map(|file| &file.footage);
                let ready = each.try_for_each(|f| studio.draw(&f.network, &f.scenes[0]).map(drop));
                start.wait();
                ready?;
                while let Some((file, scene)) = scenes.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let frame = studio.draw(&file.footage.network, scene)?;
                    lock(&drawn).push((*file, frame));
                }
                Ok(())
            })
        })?;
        Ok((std::mem::take(&mut lock(&drawn)), seconds))
    }

    fn look_alone(&self, drawn: &[Drawn<'_, W>]) -> anyhow::Result<f64> {
        let next = AtomicUsize::new(0);
        together(self.jobs.max(1), |start| {
            let mut eyes = self.eyes.to_vec();
            let (file, frame) = &drawn[0];
            let ready = self.work.see(file, frame, &mut eyes);
            start.wait();
            ready?;
            while let Some((file, frame)) = drawn.get(next.fetch_add(1, Ordering::Relaxed)) {
                self.work.see(file, frame, &mut eyes)?;
            }
            Ok(())
        })
    }
}

/// Seconds that so many threads need from when all are ready, of which each waits for the others.
fn together(threads: usize, work: impl Fn(&Barrier) -> anyhow::Result<()> + Sync) -> anyhow::Result<f64> {
    let start = Barrier::new(threads + 1);
    thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(|| work(&start))).collect();
        start.wait();
        let join = |thread: thread::ScopedJoinHandle<'_, _>| match thread.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        let (done, seconds) = seconds_of(|| running.into_iter().try_for_each(join));
        done.map(|()| seconds)
    })
}

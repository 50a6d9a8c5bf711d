//! The threads that draw and those that look do not wait for one another for ever.

use std::path::PathBuf;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use base::progress::Interrupt;
use drivers::vision::Eye;
use lab::pipeline::{OpenFile, Pipeline, Studios, Work};
use measures::footage::Footage;
use render::{Frame, Imaging};
use tests::recordings::recorded;

/// Looks at one file and panics at a frame, or at each.
struct Broken {
    case: PathBuf,
    at: Option<usize>,
}

impl Work for Broken {
    type Notes = ();
    type Seen = ();

    fn read(&self, _: usize) -> anyhow::Result<(Footage, ())> {
        Ok((Footage::read(&self.case, 180, 10)?, ()))
    }

    fn see(&self, file: &OpenFile<Self>, frame: &Frame, _: &mut [Eye]) -> anyhow::Result<()> {
        assert!(self.at.is_some_and(|at| file.footage.scenes[at].tick != frame.tick), "as a network might");
        Ok(())
    }

    fn finish(&self, _: &OpenFile<Self>, _: Vec<()>) -> anyhow::Result<()> {
        Ok(())
    }
}

/// Whether the work ends by a panic.
fn panics(work: &Broken, jobs: usize) -> bool {
    let interrupt = Interrupt::default();
    let (size, studios) = ((16, 8), Studios::new(Imaging::default()));
    let pipeline = Pipeline { work, files: &[0], size, eyes: &[], jobs, interrupt: &interrupt, studios };
    thread::scope(|scope| scope.spawn(|| pipeline.run()).join().is_err())
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_panic_of_those_who_look_ends_the_work() {
    let dir = tempfile::tempdir().unwrap();
    let case = recorded(dir.path()).1;
    for (jobs, at) in [(1, None), (2, None), (2, Some(1)), (1, Some(29))] {
        let work = Broken { case: case.clone(), at };
        let (said, ended) = mpsc::channel();
        thread::spawn(move || said.send(panics(&work, jobs)));
        let panicked = ended.recv_timeout(Duration::from_secs(100)).expect("it comes to its end");
        assert!(panicked, "{jobs} jobs, frame {at:?}");
    }
}

//! The threads that draw and those that look do not wait for one another for ever.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

use render::Frame;
use rig::lab::footage::Footage;
use rig::lab::pipeline::{Crew, Film, Studios, Work};
use rig::progress::Interrupt;
use rig::vision::Eye;
use tests::recordings::recorded;

/// Looks at one file and panics.
struct Broken(PathBuf);

impl Work for Broken {
    type Notes = ();
    type Seen = ();

    fn read(&self, _: usize) -> anyhow::Result<(Footage, ())> {
        Ok((Footage::read(&self.0, 180, 10)?, ()))
    }

    fn see(&self, _: &Film<Self>, _: &Frame, _: &mut [Eye]) -> anyhow::Result<()> {
        panic!("as a network might");
    }

    fn finish(&self, _: &Film<Self>, _: Vec<()>) -> anyhow::Result<()> {
        Ok(())
    }
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_panic_of_those_who_look_ends_the_work() {
    let dir = tempfile::tempdir().unwrap();
    let work = Broken(recorded(dir.path()).1);
    for jobs in [1, 2] {
        let crew = Crew {
            work: &work,
            files: &[0],
            size: (16, 8),
            eyes: &[],
            jobs,
            interrupt: &Interrupt::default(),
            studios: Studios::default(),
        };
        assert!(catch_unwind(AssertUnwindSafe(|| crew.run())).is_err(), "{jobs} jobs");
    }
}

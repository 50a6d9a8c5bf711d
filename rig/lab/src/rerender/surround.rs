//! What further cameras see of the windows: `OUT/NAME/cameras/CAMERA/rgb/TICK.png` and `labels` beside it.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, bail};
use base::library::Entry;
use base::png;
use base::progress::Interrupt;
use base::spread::{jobs, on_threads};
use kernel::time::Tick;
use measures::footage::Asked;
use render::Frame;
use serde::{Deserialize, Serialize};
use tempfile::TempDir;

use super::options::Options;
use crate::cameras::Named;
use crate::shots::{Shots, Stage, Workshop};
use crate::store::{Key, Settings, Store, remove_folder};

/// Draws with cameras what is missing.
pub struct Surround<'a> {
    pub args: &'a Options,
    pub cameras: &'a [Named],
    pub store: &'a Store,
    pub settings: &'a Settings,
}

/// What a camera's pictures follow from.
#[derive(PartialEq, Serialize, Deserialize)]
struct CameraKey {
    key: Key,
    camera: String,
}

impl Surround<'_> {
    /// Draws the windows of these files; what an earlier call left whole is kept, and what is of cameras that are no more goes.
    pub fn draw(&self, files: &[Entry], interrupt: &Interrupt) -> anyhow::Result<()> {
        let workshop = Arc::new(Workshop::default());
        on_threads(
            jobs(self.args.jobs),
            files.len(),
            || (),
            |(), number| {
                let file = &files[number];
                self.draw_file(file, &workshop, interrupt).with_context(|| file.path.display().to_string())
            },
        )
    }

    /// Simulates a window once for all cameras whose pictures are missing.
    fn draw_file(&self, file: &Entry, workshop: &Arc<Workshop>, interrupt: &Interrupt) -> anyhow::Result<()> {
        self.forget_gone(file)?;
        let missing: Vec<&Named> = self.cameras.iter().filter(|named| !self.is_there(file, named)).collect();
        let Some(first) = missing.first() else { return Ok(()) };
        let stage = Arc::new(Stage::open(&file.path, workshop)?);
        let asked = Asked { last: Some(self.args.last), from: None, to: None, fps: self.args.fps };
        let shots = Shots::of_window(&stage, &asked, first.camera)?;
        let pending = missing.iter().map(|_| self.pending()).collect::<anyhow::Result<Vec<_>>>()?;
        for (index, tick) in shots.ticks().iter().enumerate() {
            for (Named { camera, .. }, pending) in missing.iter().zip(&pending) {
                if interrupt.is_raised() {
                    bail!("interrupted; the same command goes on from there");
                }
                write(pending.path(), *tick, &shots.draw_through(index, camera)?.frame)?;
            }
        }
        missing.iter().zip(&pending).try_for_each(|(named, pending)| self.keep(file, named, pending, shots.ticks()))
    }

    /// Removes what earlier calls drew through cameras that the file of cameras no longer has.
    fn forget_gone(&self, file: &Entry) -> anyhow::Result<()> {
        let folder = self.args.out.join(&file.name).join(CAMERAS);
        for entry in fs::read_dir(&folder).into_iter().flatten() {
            let name = entry.with_context(|| folder.display().to_string())?.file_name().to_string_lossy().into_owned();
            if self.cameras.iter().all(|named| named.name != name) {
                self.store.forget(&mark(file, &name))?;
                remove_folder(&folder.join(name))?;
            }
        }
        Ok(())
    }

    fn is_there(&self, file: &Entry, Named { name, camera }: &Named) -> bool {
        let ticks: Option<Vec<Tick>> = self.store.find(&mark(file, name), &self.key(file, camera));
        ticks.is_some_and(|ticks| holds(&self.home(file, name), &ticks))
    }

    fn pending(&self) -> anyhow::Result<TempDir> {
        let pending = self.store.pending()?;
        [RGB, LABELS].iter().try_for_each(|folder| make(&pending.path().join(folder)))?;
        Ok(pending)
    }

    /// Moves pictures to their place.
    fn keep(
        &self,
        file: &Entry,
        Named { name, camera }: &Named,
        pending: &TempDir,
        ticks: &[Tick],
    ) -> anyhow::Result<()> {
        let (mark, home) = (mark(file, name), self.home(file, name));
        self.store.forget(&mark)?;
        for folder in [RGB, LABELS] {
            let to = home.join(folder);
            remove_folder(&to)?;
            make(&home)?;
            fs::rename(pending.path().join(folder), &to).with_context(|| to.display().to_string())?;
        }
        self.store.keep(&mark, self.key(file, camera), ticks)
    }

    fn home(&self, file: &Entry, name: &str) -> PathBuf {
        self.args.out.join(&file.name).join(CAMERAS).join(name)
    }

    fn key(&self, file: &Entry, camera: &render::Camera) -> CameraKey {
        CameraKey { key: self.settings.key(file, None), camera: format!("{camera:?}") }
    }
}

const CAMERAS: &str = "cameras";
const RGB: &str = "rgb";
const LABELS: &str = "labels";

fn mark(file: &Entry, camera: &str) -> String {
    format!("{}/{CAMERAS}/{camera}", file.name)
}

/// Writes the pictures of a frame.
fn write(folder: &Path, tick: Tick, frame: &Frame) -> anyhow::Result<()> {
    let size = (frame.width, frame.height);
    for (below, bytes) in [(RGB, png::rgb(size, &frame.rgb)?), (LABELS, png::tags(size, &frame.class_ids)?)] {
        let path = picture(&folder.join(below), tick);
        fs::write(&path, bytes).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

fn picture(folder: &Path, tick: Tick) -> PathBuf {
    folder.join(format!("{tick:08}.png"))
}

fn holds(home: &Path, ticks: &[Tick]) -> bool {
    ticks.iter().all(|tick| [RGB, LABELS].iter().all(|folder| picture(&home.join(folder), *tick).is_file()))
}

fn make(folder: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())
}

//! What further cameras see of the windows: `OUT/NAME/cameras/CAMERA/rgb/TICK.png` and `labels` beside it.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, bail};
use base::library::Entry;
use base::png;
use base::progress::Interrupt;
use base::spread::{jobs, on_threads};
use drivers::film::Viewpoint;
use kernel::time::Tick;
use measures::footage::Asked;
use serde::{Deserialize, Serialize};

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
    /// Draws the windows of these files; what an earlier call left whole is kept.
    pub fn draw(&self, files: &[Entry], interrupt: &Interrupt) -> anyhow::Result<()> {
        let workshop = Arc::new(Workshop::default());
        let count = files.len() * self.cameras.len();
        on_threads(
            jobs(self.args.jobs),
            count,
            || (),
            |(), number| {
                let (file, named) = (&files[number / self.cameras.len()], &self.cameras[number % self.cameras.len()]);
                self.draw_one(file, named, &workshop, interrupt).with_context(|| file.path.display().to_string())
            },
        )
    }

    fn draw_one(
        &self,
        file: &Entry,
        Named { name, camera }: &Named,
        workshop: &Arc<Workshop>,
        interrupt: &Interrupt,
    ) -> anyhow::Result<()> {
        let (mark, folder) = (format!("{}/cameras/{name}", file.name), Path::new("cameras").join(name));
        let (key, home) = (self.key(file, camera), self.args.out.join(&file.name).join(folder));
        if self.store.find::<Vec<Tick>, _>(&mark, &key).is_some_and(|ticks| holds(&home, &ticks)) {
            return Ok(());
        }
        let stage = Arc::new(Stage::open(&file.path, workshop)?);
        let asked = Asked { last: Some(self.args.last), from: None, to: None, fps: self.args.fps };
        let size = (camera.width, camera.height);
        let shots = Shots::of_window(&stage, &asked, Viewpoint::Driver, size)?.through(*camera);
        let pending = self.store.pending()?;
        make(&pending.path().join(RGB))?;
        make(&pending.path().join(LABELS))?;
        for (index, tick) in shots.ticks().iter().enumerate() {
            if interrupt.is_raised() {
                bail!("interrupted; the same command goes on from there");
            }
            let frame = shots.draw(index)?.frame;
            let planes = [(RGB, png::rgb(size, &frame.rgb)?), (LABELS, png::tags(size, &frame.class_ids)?)];
            for (folder, bytes) in planes {
                let path = picture(&pending.path().join(folder), *tick);
                fs::write(&path, bytes).with_context(|| path.display().to_string())?;
            }
        }
        self.store.forget(&mark)?;
        for folder in [RGB, LABELS] {
            let to = home.join(folder);
            remove_folder(&to)?;
            make(&home)?;
            fs::rename(pending.path().join(folder), &to).with_context(|| to.display().to_string())?;
        }
        self.store.keep(&mark, key, shots.ticks())
    }

    fn key(&self, file: &Entry, camera: &render::Camera) -> CameraKey {
        CameraKey { key: self.settings.key(file, None), camera: format!("{camera:?}") }
    }
}

const RGB: &str = "rgb";
const LABELS: &str = "labels";

fn picture(folder: &Path, tick: Tick) -> PathBuf {
    folder.join(format!("{tick:08}.png"))
}

fn holds(home: &Path, ticks: &[Tick]) -> bool {
    ticks.iter().all(|tick| [RGB, LABELS].iter().all(|folder| picture(&home.join(folder), *tick).is_file()))
}

fn make(folder: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())
}

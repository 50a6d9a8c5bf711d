//! The pictures of one file after the other, each made once.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context;
use base::library::Entry;
use base::png;
use base::progress::Bar;
use drivers::vision::Eye;
use kernel::time::Tick;
use measures::footage::Footage;
use perception::ConfusionMatrix;
use render::Frame;
use tempfile::TempDir;

use super::super::pipeline::{OpenFile, Work};
use super::super::store::{Settings, Store, remove_folder};
use super::options::Options;

/// A checkpoint's matrix of each frame.
pub type Matrices = Vec<(Tick, ConfusionMatrix)>;

/// Makes the pictures.
pub struct Pictures<'a> {
    pub args: &'a Options,
    pub files: &'a [Entry],
    pub eyes: &'a [Eye],
    pub store: &'a Store,
    pub bar: &'a Bar,
    pub settings: Settings,
}

/// What is made of a file.
pub struct Making {
    /// Colour and labels as well; without them, they are there already.
    frames: bool,
    /// Numbers of the checkpoints that look.
    eyes: Vec<usize>,
    /// Where it lies until it is whole.
    folder: TempDir,
}

impl Work for Pictures<'_> {
    type Notes = Making;
    type Seen = (Tick, Vec<ConfusionMatrix>);

    fn read(&self, index: usize) -> anyhow::Result<(Footage, Making)> {
        let file = &self.files[index];
        self.store.check(&frames_mark(file), file)?;
        let footage = Footage::read(&file.path, self.args.last, self.args.fps)?;
        let (frames, eyes) = self.missing(file);
        let making = Making { frames, eyes, folder: self.store.pending()? };
        for folder in self.folders(&making) {
            let folder = making.folder.path().join(folder);
            fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
        }
        Ok((footage, making))
    }

    fn see(&self, file: &OpenFile<Self>, frame: &Frame, eyes: &mut [Eye]) -> anyhow::Result<Self::Seen> {
        let size = (frame.width, frame.height);
        let write = |folder: &Path, bytes: Vec<u8>| {
            let path = file.notes.folder.path().join(folder).join(file_name(frame.tick));
            fs::write(&path, bytes).with_context(|| path.display().to_string())
        };
        if file.notes.frames {
            write(Path::new(RGB), png::rgb(size, &frame.rgb)?)?;
            write(Path::new(LABELS), png::tags(size, &frame.class_ids)?)?;
        }
        let mut matrices = Vec::new();
        for eye in &file.notes.eyes {
            let eye = &mut eyes[*eye];
            let mask = eye.see(frame.clone())?;
            let mut matrix = ConfusionMatrix::default();
            matrix.add(&frame.class_ids, &mask.ids);
            matrices.push(matrix);
            write(&predictions(eye), png::tags(size, &mask.ids)?)?;
        }
        Ok((frame.tick, matrices))
    }

    fn finish(&self, file: &OpenFile<Self>, seen: Vec<Self::Seen>) -> anyhow::Result<()> {
        let (file, making) = (&self.files[file.index], &file.notes);
        let home = self.args.out.join(&file.name);
        if making.frames {
            // What was made from other frames goes.
            self.store.forget_below(&file.name)?;
            remove_folder(&home)?;
        }
        // Metrics go before the pictures they are of, so that they never stand over others.
        making.eyes.iter().try_for_each(|eye| self.store.forget(&mark(file, &self.eyes[*eye])))?;
        for folder in self.folders(making) {
            let (from, to) = (making.folder.path().join(&folder), home.join(&folder));
            remove_folder(&to)?;
            let above = to.parent().unwrap_or(&home);
            fs::create_dir_all(above).with_context(|| above.display().to_string())?;
            fs::rename(&from, &to).with_context(|| to.display().to_string())?;
        }
        if making.frames {
            let ticks: Vec<Tick> = seen.iter().map(|(tick, _)| *tick).collect();
            self.store.keep(&frames_mark(file), self.settings.key(file, None), ticks)?;
        }
        for (i, eye) in making.eyes.iter().map(|eye| &self.eyes[*eye]).enumerate() {
            let matrices: Matrices = seen.iter().map(|(tick, all)| (*tick, all[i].clone())).collect();
            self.store.keep(&mark(file, eye), self.settings.key(file, Some(eye)), matrices)?;
        }
        self.bar.inc(self.expected());
        Ok(())
    }
}

impl Pictures<'_> {
    /// Each checkpoint's matrices of each file; `None` if anything is missing.
    pub fn found(&self) -> Option<Vec<Vec<Matrices>>> {
        let of_file = |file: &Entry| self.eyes.iter().map(|eye| self.matrices(file, eye)).collect();
        self.files.iter().map(of_file).collect()
    }

    /// Numbers of the files of which something is missing.
    pub fn left(&self) -> Vec<usize> {
        (0..self.files.len()).filter(|file| !self.missing(&self.files[*file]).1.is_empty()).collect()
    }

    /// Frames of a window that is there as a whole.
    pub fn expected(&self) -> u64 {
        self.args.last.div_ceil(Tick::from(kernel::time::TICK_HZ / self.args.fps))
    }

    /// Whether the frames are missing, and numbers of the checkpoints whose predictions are.
    fn missing(&self, file: &Entry) -> (bool, Vec<usize>) {
        let frames = !self.has_frames(file);
        let is_missing = |eye: &usize| frames || self.matrices(file, &self.eyes[*eye]).is_none();
        (frames, (0..self.eyes.len()).filter(is_missing).collect())
    }

    fn has_frames(&self, file: &Entry) -> bool {
        let ticks: Option<Vec<Tick>> = self.store.find(&frames_mark(file), &self.settings.key(file, None));
        ticks.is_some_and(|ticks| {
            [RGB, LABELS].iter().all(|folder| self.holds(file, Path::new(folder), ticks.iter().copied()))
        })
    }

    /// What a checkpoint made of a file, if its pictures are there.
    fn matrices(&self, file: &Entry, eye: &Eye) -> Option<Matrices> {
        let matrices: Matrices = self.store.find(&mark(file, eye), &self.settings.key(file, Some(eye)))?;
        let ticks = matrices.iter().map(|(tick, _)| *tick);
        self.holds(file, &predictions(eye), ticks).then_some(matrices)
    }

    fn holds(&self, file: &Entry, folder: &Path, mut ticks: impl Iterator<Item = Tick>) -> bool {
        let folder = self.args.out.join(&file.name).join(folder);
        ticks.all(|tick| folder.join(file_name(tick)).is_file())
    }

    /// Folders of what is made, below the file's.
    fn folders(&self, making: &Making) -> Vec<PathBuf> {
        let frames = [RGB, LABELS].into_iter().filter(|_| making.frames).map(PathBuf::from);
        frames.chain(making.eyes.iter().map(|eye| predictions(&self.eyes[*eye]))).collect()
    }
}

const RGB: &str = "rgb";
const LABELS: &str = "labels";

fn file_name(tick: Tick) -> String {
    format!("{tick:08}.png")
}

fn predictions(eye: &Eye) -> PathBuf {
    Path::new("predictions").join(eye.name())
}

fn frames_mark(file: &Entry) -> String {
    format!("{}/frames", file.name)
}

fn mark(file: &Entry, eye: &Eye) -> String {
    format!("{}/predictions/{}", file.name, eye.name())
}

//! Films of many files: some threads replay and draw while the others look at what was drawn. What is
//! found out does not depend on the number of threads.

mod alone;

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

use base::clock::seconds_of;
use base::failure::Failure;
use base::library::Entry;
use base::progress::Interrupt;
use drivers::vision::Eye;
use measures::footage::Footage;
use render::{Frame, Imaging};

use super::looks::Studio;

pub use alone::Alone;

/// Looking threads that one drawing thread keeps busy. A frame is drawn several times faster than a
/// network looks at it.
const LOOKING_A_DRAWING: usize = 8;
/// Frames that wait for each looking thread, at most.
const WAITING: usize = 2;

/// What is done with files.
pub trait Work: Sync {
    /// What is remembered of a file while its frames are on their way.
    type Notes: Send + Sync;
    /// What is found out about a frame.
    type Seen: Send;

    /// Replays a file. An error is that file's alone: the others go on.
    fn read(&self, index: usize) -> anyhow::Result<(Footage, Self::Notes)>;

    /// Looks at a frame.
    fn see(&self, file: &OpenFile<Self>, frame: &Frame, eyes: &mut [Eye]) -> anyhow::Result<Self::Seen>;

    /// Called when all frames of a file have been seen; what was found out comes in their order.
    fn finish(&self, file: &OpenFile<Self>, seen: Vec<Self::Seen>) -> anyhow::Result<()>;
}

/// A file under work.
pub struct OpenFile<W: Work + ?Sized> {
    /// Number of the file.
    pub index: usize,
    /// Its scenes.
    pub footage: Footage,
    /// What is remembered of it.
    pub notes: W::Notes,
    seen: Mutex<Vec<Option<W::Seen>>>,
}

/// A frame on its way from the thread that drew it to one that looks.
struct Shot<W: Work> {
    file: Arc<OpenFile<W>>,
    number: usize,
    frame: Frame,
}

/// How much was done in which time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pace {
    /// Frames that were drawn and looked at.
    pub frames: usize,
    /// Time from the first file to the last frame, seconds.
    pub seconds: f64,
}

impl Pace {
    /// Frames a second.
    pub fn rate(&self) -> f64 {
        self.frames as f64 / self.seconds
    }
}

/// Takes the files that could not be read out of those that were given.
pub fn set_aside(files: &mut Vec<Entry>, unread: Vec<Unread>) -> Vec<Failure> {
    let failed = unread.iter().map(|(index, error)| Failure::new(&files[*index].path, error)).collect();
    for (index, _) in unread.into_iter().rev() {
        files.remove(index);
    }
    failed
}

/// Work, and who does it with what.
pub struct Pipeline<'a, W> {
    /// What is done.
    pub work: &'a W,
    /// Numbers of the files that it is done with.
    pub files: &'a [usize],
    /// Width and height of the pictures, pixels.
    pub size: (u32, u32),
    /// Who looks; each looking thread has copies.
    pub eyes: &'a [Eye],
    /// Looking threads.
    pub jobs: usize,
    /// Ends the work early; files that are not finished by then are dropped.
    pub interrupt: &'a Interrupt,
    /// Renderers, one set a drawing thread; those that are missing are made.
    pub studios: Studios,
}

/// Renderers that outlast the threads that draw with them.
pub struct Studios {
    imaging: Imaging,
    free: Mutex<Vec<Studio>>,
}

impl Studios {
    /// For pictures of one kind.
    pub fn new(imaging: Imaging) -> Self {
        Self { imaging, free: Mutex::default() }
    }

    /// Calls `draw` with a set for pictures of one size.
    pub fn with<T>(&self, size: (u32, u32), draw: impl FnOnce(&mut Studio) -> T) -> T {
        let free = lock(&self.free).pop();
        let mut studio = free.unwrap_or_else(|| Studio::new(size, self.imaging));
        let value = draw(&mut studio);
        lock(&self.free).push(studio);
        value
    }
}

/// What the threads share.
struct Shared<'a, W> {
    pipeline: &'a Pipeline<'a, W>,
    next: AtomicUsize,
    frames: AtomicUsize,
    has_failed: AtomicBool,
    failure: Mutex<Option<anyhow::Error>>,
    unread: Mutex<Vec<Unread>>,
}

/// The number of a file that could not be read, and why.
pub type Unread = (usize, anyhow::Error);

impl<W: Work> OpenFile<W> {
    fn read(work: &W, index: usize) -> anyhow::Result<Self> {
        let (footage, notes) = work.read(index)?;
        let seen = Mutex::new(footage.scenes.iter().map(|_| None).collect());
        Ok(Self { index, footage, notes, seen })
    }
}

impl<W: Work> Pipeline<'_, W> {
    /// Number of drawing threads.
    fn drawing(&self) -> usize {
        self.jobs.div_ceil(LOOKING_A_DRAWING).max(1)
    }

    /// Does the work with every file that can be read, and gives those that cannot, by number. After the first
    /// other error nothing new is begun, and that error is returned.
    pub fn run(&self) -> anyhow::Result<(Pace, Vec<Unread>)> {
        let shared = Shared {
            pipeline: self,
            next: AtomicUsize::new(0),
            frames: AtomicUsize::new(0),
            has_failed: AtomicBool::new(false),
            failure: Mutex::new(None),
            unread: Mutex::new(Vec::new()),
        };
        let ((), seconds) = seconds_of(|| shared.run());
        if let Some(error) = lock(&shared.failure).take() {
            return Err(error);
        }
        let mut unread = std::mem::take(&mut *lock(&shared.unread));
        unread.sort_by_key(|(index, _)| *index);
        Ok((Pace { frames: shared.frames.load(Ordering::Relaxed), seconds }, unread))
    }
}

impl<W: Work> Shared<'_, W> {
    fn run(&self) {
        let jobs = self.pipeline.jobs.max(1);
        let (shots, waiting) = sync_channel(WAITING * jobs);
        let waiting = Arc::new(Mutex::new(waiting));
        thread::scope(|scope| {
            for _ in 0..self.pipeline.drawing() {
                let shots = shots.clone();
                scope.spawn(move || self.draw_all(&shots));
            }
            drop(shots);
            for _ in 0..jobs {
                let waiting = waiting.clone();
                scope.spawn(move || self.look_at_all(&waiting));
            }
            // The looking threads alone hold it: when all of them have panicked, nobody waits for room.
            drop(waiting);
        });
    }

    fn draw_all(&self, shots: &SyncSender<Shot<W>>) {
        let _alarm = Alarm(&self.has_failed);
        self.pipeline.studios.with(self.pipeline.size, |studio| {
            while !self.is_over() {
                let next = self.next.fetch_add(1, Ordering::Relaxed);
                let Some(index) = self.pipeline.files.get(next) else { return };
                self.note(self.draw(*index, studio, shots));
            }
        });
    }

    fn draw(&self, index: usize, studio: &mut Studio, shots: &SyncSender<Shot<W>>) -> anyhow::Result<()> {
        let file = match OpenFile::read(self.pipeline.work, index) {
            Ok(file) => Arc::new(file),
            Err(error) => {
                lock(&self.unread).push((index, error));
                return Ok(());
            }
        };
        for (number, scene) in file.footage.scenes.iter().enumerate() {
            if self.is_over() {
                break;
            }
            let frame = studio.draw(&file.footage.network, scene)?;
            if shots.send(Shot { file: file.clone(), number, frame }).is_err() {
                break;
            }
        }
        Ok(())
    }

    fn look_at_all(&self, waiting: &Mutex<Receiver<Shot<W>>>) {
        let _alarm = Alarm(&self.has_failed);
        let mut eyes = self.pipeline.eyes.to_vec();
        loop {
            let Ok(shot) = lock(waiting).recv() else { return };
            if !self.is_over() {
                self.note(self.look(&shot, &mut eyes));
            }
        }
    }

    fn look(&self, shot: &Shot<W>, eyes: &mut [Eye]) -> anyhow::Result<()> {
        let seen = self.pipeline.work.see(&shot.file, &shot.frame, eyes)?;
        self.frames.fetch_add(1, Ordering::Relaxed);
        let mut all = lock(&shot.file.seen);
        all[shot.number] = Some(seen);
        if !all.iter().all(Option::is_some) {
            return Ok(());
        }
        let all = std::mem::take(&mut *all).into_iter().flatten().collect();
        self.pipeline.work.finish(&shot.file, all)
    }

    fn note(&self, result: anyhow::Result<()>) {
        if let Err(error) = result {
            lock(&self.failure).get_or_insert(error);
            self.has_failed.store(true, Ordering::Relaxed);
        }
    }

    fn is_over(&self) -> bool {
        self.has_failed.load(Ordering::Relaxed) || self.pipeline.interrupt.is_raised()
    }
}

/// Tells the other threads that this one panicked.
struct Alarm<'a>(&'a AtomicBool);

impl Drop for Alarm<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

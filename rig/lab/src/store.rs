//! Results that a command finds again when it is called again, each with what it depends on.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::files::{self, most};
use base::library::Entry;
use base::output;
use drivers::vision::{self, Eye};
use kernel::time::Tick;
use render::RENDERER_VERSION;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use tempfile::TempDir;

/// Everything that what is seen in pictures follows from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Key {
    /// BLAKE3 of the recording or case.
    pub log: String,
    /// Length of the window, ticks.
    pub last_ticks: Tick,
    /// Frames a second.
    pub fps: u32,
    /// Width and height of the pictures, pixels.
    pub size: (u32, u32),
    /// Version of the program, hence of the measures.
    pub program: String,
    /// Version of the renderer.
    pub renderer: String,
    /// The graphics adapter and its driver.
    pub adapter: String,
    /// Digest of the checkpoint, if one looks.
    pub checkpoint: Option<String>,
}

/// What the results of a command have in common.
#[derive(Clone, Debug)]
pub struct Settings {
    last_ticks: Tick,
    fps: u32,
    size: (u32, u32),
    adapter: String,
}

impl Settings {
    /// For windows of so many ticks at so many frames a second, drawn in one size on this machine's adapter.
    pub fn new(last_ticks: Tick, fps: u32, size: (u32, u32)) -> Self {
        Self { last_ticks, fps, size, adapter: vision::adapter() }
    }

    /// The key of what is found out about a file, by an eye or without any.
    pub fn key(&self, file: &Entry, eye: Option<&Eye>) -> Key {
        Key {
            log: file.digest.to_hex().to_string(),
            last_ticks: self.last_ticks,
            fps: self.fps,
            size: self.size,
            program: env!("CARGO_PKG_VERSION").into(),
            renderer: RENDERER_VERSION.into(),
            adapter: self.adapter.clone(),
            checkpoint: eye.map(Eye::digest),
        }
    }
}

#[derive(Serialize, Deserialize)]
struct Kept<K, T> {
    key: K,
    value: T,
}

/// `OUT/.KIND`: a file for each result, written when everything that belongs to it is in its place.
/// Dropped, it takes with it what was begun, and `OUT` if nothing else is in it.
pub struct Store {
    out: PathBuf,
    folder: PathBuf,
    /// Locked as long as its process works here; none where the file system knows no locks.
    _claim: Option<File>,
}

impl Store {
    /// Starts or continues `out`, which must not exist, be empty, or be of the same kind.
    pub fn open(out: &Path, kind: &str) -> anyhow::Result<Self> {
        let folder = out.join(format!(".{kind}"));
        let is_empty = || fs::read_dir(out).is_ok_and(|mut entries| entries.next().is_none());
        if out.is_dir() && !folder.is_dir() && !is_empty() {
            let out = out.display();
            bail!("{out}: exists already; expected a new or an empty folder, or one that aeye {kind} began");
        }
        output::create_folder(&folder)?;
        let claim = File::open(&folder).ok();
        if let Some(Err(TryLockError::WouldBlock)) = claim.as_ref().map(File::try_lock) {
            bail!("{}: another aeye {kind} is at work there; expected another folder, or to wait", out.display());
        }
        let store = Self { out: out.to_owned(), folder, _claim: claim };
        store.sweep()?;
        Ok(store)
    }

    /// Removes what killed processes had begun.
    fn sweep(&self) -> anyhow::Result<()> {
        let place = || self.folder.display().to_string();
        for entry in fs::read_dir(&self.folder).with_context(place)? {
            let entry = entry.with_context(place)?;
            if entry.file_name().to_string_lossy().starts_with(PENDING) {
                fs::remove_dir_all(entry.path()).with_context(|| entry.path().display().to_string())?;
            }
        }
        Ok(())
    }

    /// A folder for what is being made, on the disk of the results.
    pub fn pending(&self) -> anyhow::Result<TempDir> {
        let folder = tempfile::Builder::new().prefix(PENDING).tempdir_in(&self.folder);
        folder.with_context(|| self.folder.display().to_string())
    }

    /// A result, if it is there, whole and of this key.
    pub fn find<T: DeserializeOwned, K: DeserializeOwned + PartialEq>(&self, name: &str, key: &K) -> Option<T> {
        let bytes = files::read(&self.file(name), most::TABLE).ok()?;
        let kept: Kept<K, T> = serde_json::from_slice(&bytes).ok()?;
        (kept.key == *key).then_some(kept.value)
    }

    /// Keeps a result.
    pub fn keep<T: Serialize, K: Serialize>(&self, name: &str, key: K, value: T) -> anyhow::Result<()> {
        let file = self.file(name);
        output::create_folder(file.parent().unwrap_or(&self.folder))?;
        output::write_file(&file, &serde_json::to_vec(&Kept { key, value })?)
    }

    /// Forgets every result whose name begins with `name/`.
    pub fn forget_below(&self, name: &str) -> anyhow::Result<()> {
        remove_folder(&self.folder.join(name))
    }

    /// Drops a result.
    pub fn forget(&self, name: &str) -> anyhow::Result<()> {
        let path = self.file(name);
        match fs::remove_file(&path) {
            Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(e).with_context(|| path.display().to_string()),
            _ => Ok(()),
        }
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.json"))
    }
}

const PENDING: &str = ".aeye-";

impl Drop for Store {
    fn drop(&mut self) {
        // A folder with anything in it stays.
        let _ = fs::remove_dir(&self.folder).and_then(|()| fs::remove_dir(&self.out));
    }
}

/// Removes a folder with all that is in it, if it is there.
pub fn remove_folder(path: &Path) -> anyhow::Result<()> {
    match fs::remove_dir_all(path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(e).with_context(|| path.display().to_string()),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(log: &str) -> Key {
        let [program, renderer, adapter] = ["1", "1", "cpu"].map(str::to_owned);
        Key { log: log.into(), last_ticks: 180, fps: 10, size: (64, 32), program, renderer, adapter, checkpoint: None }
    }

    #[test]
    fn a_result_is_found_again_under_its_key_only() {
        let dir = tempfile::tempdir().expect("a folder");
        let out = dir.path().join("out");
        drop(Store::open(&out, "test").expect("free"));
        assert!(!out.exists(), "nothing was kept");
        Store::open(&out, "test").expect("free").keep("a/b/full", key("x"), vec![3, 4]).expect("writable");
        let store = Store::open(&out, "test").expect("of the same kind");
        assert_eq!(store.find::<Vec<u8>, Key>("a/b/full", &key("x")), Some(vec![3, 4]));
        assert_eq!(store.find::<Vec<u8>, Key>("a/b/full", &key("y")), None);
        assert_eq!(store.find::<Vec<u8>, Key>("a/b/early", &key("x")), None);
        store.forget_below("a/b").expect("removed");
        assert_eq!(store.find::<Vec<u8>, Key>("a/b/full", &key("x")), None);
    }

    #[test]
    fn other_folders_are_refused_and_what_was_begun_is_swept() {
        let dir = tempfile::tempdir().expect("a folder");
        let out = dir.path().join("out");
        let store = Store::open(&out, "test").expect("free");
        let begun = store.pending().expect("a folder").keep();
        fs::write(begun.join("half"), "").expect("writable");
        drop(store);
        let store = Store::open(&out, "test").expect("of the same kind");
        assert!(!begun.exists());
        let said = Store::open(&out, "test").err().expect("in use").to_string();
        assert!(said.contains("another aeye test is at work there"), "{said}");
        store.keep("a", key("x"), 1).expect("writable");
        let said = Store::open(&out, "other").err().expect("of another kind").to_string();
        assert!(said.contains("expected a new or an empty folder, or one that aeye other began"), "{said}");
    }
}

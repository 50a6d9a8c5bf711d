//! Results that a command finds again when it is called again, each with what it depends on.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::files::{self, most};
use base::library::Entry;
use base::output::{self, OutputFolder};
use drivers::vision::Eye;
use kernel::time::Tick;
use render::Imaging;
use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};
use tempfile::TempDir;

use crate::machine::Machine;

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
    /// How good the pictures are, and what lens and chip do to them.
    pub quality: String,
    /// Version of the program, hence of the measures.
    pub program: String,
    /// Identity of the kernel that replays.
    pub kernel: String,
    /// Version of the renderer.
    pub renderer: String,
    /// What kind of machine it is.
    pub machine: Machine,
    /// Digest of the checkpoint, if one looks.
    pub checkpoint: Option<String>,
}

/// What the results of a command have in common.
#[derive(Clone, Debug)]
pub struct Settings {
    last_ticks: Tick,
    fps: u32,
    size: (u32, u32),
    imaging: Imaging,
    machine: Machine,
}

impl Settings {
    /// For windows of so many ticks at so many frames a second, made in one size and way on this machine.
    pub fn new(last_ticks: Tick, fps: u32, size: (u32, u32), imaging: Imaging) -> Self {
        Self { last_ticks, fps, size, imaging, machine: Machine::this() }
    }

    /// The key of what is found out about a file, by an eye or without any.
    pub fn key(&self, file: &Entry, eye: Option<&Eye>) -> Key {
        Key {
            log: file.digest.to_hex().to_string(),
            last_ticks: self.last_ticks,
            fps: self.fps,
            size: self.size,
            quality: self.imaging.to_string(),
            program: env!("CARGO_PKG_VERSION").into(),
            kernel: kernel::identity(),
            renderer: render::identity(),
            machine: self.machine.clone(),
            checkpoint: eye.map(Eye::digest),
        }
    }
}

#[derive(Serialize, Deserialize)]
struct Kept<K, T> {
    key: K,
    value: T,
}

/// Of a key, the file that a result is about.
#[derive(Deserialize)]
struct About {
    /// BLAKE3 of the recording or case.
    log: String,
}

/// `OUT/.KIND`: a file for each result, written when everything that belongs to it is in its place.
/// Dropped, it takes with it what was begun, and `OUT` if it was made for it and nothing is in it.
pub struct Store {
    out: PathBuf,
    folder: PathBuf,
    home: OutputFolder,
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
        let home = OutputFolder::open(out)?;
        home.make(&folder)?;
        let store = Self { out: out.to_owned(), folder, home };
        store.sweep()?;
        Ok(store)
    }

    /// Holds results of these options from now on, and refuses others: a file that is there must not be one or the
    /// other's.
    pub fn hold(&self, options: &[String]) -> anyhow::Result<()> {
        let path = self.folder.join(OPTIONS);
        // A process that was killed before it kept anything leaves its options.
        let held = fs::read(&path).ok().filter(|_| !self.is_empty());
        let Some(text) = held else {
            return output::write_file(&path, &serde_json::to_vec(options)?);
        };
        let held: Vec<String> = serde_json::from_slice(&text).with_context(|| path.display().to_string())?;
        let beyond = |these: &[String], those: &[String]| {
            these.iter().filter(|option| !those.contains(option)).cloned().collect::<Vec<_>>().join(" ")
        };
        let (others, ours) = (beyond(&held, options), beyond(options, &held));
        if !(others.is_empty() && ours.is_empty()) {
            let out = self.out.display();
            bail!("{out}: holds results of {others}; expected the same, or another folder for {ours}");
        }
        Ok(())
    }

    /// Makes a folder among the results.
    pub fn make(&self, folder: &Path) -> anyhow::Result<()> {
        self.home.make(folder)
    }

    /// Removes what killed processes had begun.
    fn sweep(&self) -> anyhow::Result<()> {
        let place = || self.folder.display().to_string();
        for entry in fs::read_dir(&self.folder).with_context(place)? {
            let entry = entry.with_context(place)?;
            if entry.file_name().to_string_lossy().starts_with(PENDING) {
                let path = entry.path();
                let removed = if path.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
                removed.with_context(|| path.display().to_string())?;
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

    /// Refuses a name under which there is a result about another file.
    pub fn check(&self, name: &str, file: &Entry) -> anyhow::Result<()> {
        let kept = fs::read(self.file(name)).ok();
        let kept = kept.and_then(|bytes| serde_json::from_slice::<Kept<About, IgnoredAny>>(&bytes).ok());
        match kept {
            Some(Kept { key: About { log }, .. }) if log != file.digest.to_hex().as_str() => {
                let (path, out, name) = (file.path.display(), self.out.display(), &file.name);
                bail!("{path}: {out} holds results of another file as {name}; expected another folder")
            }
            _ => Ok(()),
        }
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

    /// Whether nothing is kept: where that is so, no options are held.
    fn is_empty(&self) -> bool {
        let mut kept = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        kept.all(|entry| entry.file_name() == OPTIONS)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.json"))
    }
}

const PENDING: &str = ".aeye-";
/// No result has a name that begins with a dot.
const OPTIONS: &str = ".options.json";

impl Drop for Store {
    fn drop(&mut self) {
        if self.is_empty() {
            let _ = fs::remove_file(self.folder.join(OPTIONS));
        }
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
        let [log, program, kernel, renderer, arch, adapter] = [log, "1", "1", "1", "x86", "cpu"].map(str::to_owned);
        let machine = Machine { arch, cpu_features: Vec::new(), adapter };
        let quality = "plain".into();
        Key {
            log,
            last_ticks: 180,
            fps: 10,
            size: (64, 32),
            quality,
            program,
            kernel,
            renderer,
            machine,
            checkpoint: None,
        }
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
        let file = out.join(".test/.aeye-a.json-abcdef");
        fs::write(&file, "").expect("writable");
        drop(store);
        let store = Store::open(&out, "test").expect("of the same kind");
        assert!(!begun.exists() && !file.exists());
        let said = Store::open(&out, "test").err().expect("in use").to_string();
        assert!(said.contains("another aeye is at work there"), "{said}");
        store.keep("a", key("x"), 1).expect("writable");
        let said = Store::open(&out, "other").err().expect("of another kind").to_string();
        assert!(said.contains("expected a new or an empty folder, or one that aeye other began"), "{said}");
    }

    #[test]
    fn results_of_other_options_and_of_other_files_are_refused() {
        let dir = tempfile::tempdir().expect("a folder");
        let out = dir.path().join("out");
        let options = |size: &str| ["--fps 10".to_owned(), format!("--size {size}")];
        Store::open(&out, "test").expect("free").hold(&options("64x32")).expect("the first");
        assert!(!out.exists(), "nothing was kept");
        let store = Store::open(&out, "test").expect("free");
        store.hold(&options("128x64")).expect("the first");
        let digest = blake3::hash(b"x");
        store.keep("a", key(&digest.to_hex()), 1).expect("writable");
        drop(store);
        let store = Store::open(&out, "test").expect("of the same kind");
        store.hold(&options("128x64")).expect("the same");
        let said = store.hold(&options("64x32")).expect_err("others").to_string();
        let words = "out: holds results of --size 128x64; expected the same, or another folder for --size 64x32";
        assert!(said.ends_with(words), "{said}");
        let entry = |digest| Entry { is_case: true, path: "a.case.mcap".into(), name: "a".into(), digest };
        store.check("a", &entry(digest)).expect("the same");
        store.check("b", &entry(digest)).expect("none yet");
        let said = store.check("a", &entry(blake3::hash(b"y"))).expect_err("another").to_string();
        assert!(said.starts_with("a.case.mcap: ") && said.contains("holds results of another file as a"), "{said}");
    }
}

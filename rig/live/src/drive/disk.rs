//! Writes a recording from a thread of its own, so that a slow disk delays nobody.

use std::collections::BTreeSet;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::JoinHandle;

use anyhow::Context;
use base::library::case_path;

/// A file that is written in the background. Bytes reach it in order; each flush reaches the system.
pub struct BackgroundFile {
    bytes: Option<Sender<Vec<u8>>>,
    pending: Vec<u8>,
    writer: Option<JoinHandle<io::Result<()>>>,
}

impl BackgroundFile {
    /// Writes to an open file; `failed` is called at once when that cannot go on.
    pub fn new(file: File, failed: impl FnOnce(&io::Error) + Send + 'static) -> Self {
        let (bytes, inbox) = mpsc::channel();
        let writer = std::thread::spawn(move || write_all(file, &inbox).inspect_err(failed));
        Self { bytes: Some(bytes), pending: Vec::new(), writer: Some(writer) }
    }

    /// Waits until everything is written.
    pub fn close(mut self) -> io::Result<()> {
        self.flush()?;
        self.bytes = None;
        self.result()
    }

    /// What became of the thread.
    fn result(&mut self) -> io::Result<()> {
        let gone = || Err(io::Error::other("the writing thread is gone"));
        self.writer.take().map_or_else(gone, |writer| writer.join().unwrap_or_else(|_| gone()))
    }
}

impl Drop for BackgroundFile {
    /// What was handed over is written, also when the run ends by an error.
    fn drop(&mut self) {
        self.bytes = None;
        self.writer.take().into_iter().for_each(|writer| drop(writer.join()));
    }
}

impl Write for BackgroundFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.pending.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    /// Hands over what was written; fails with the reason when the thread could not write.
    fn flush(&mut self) -> io::Result<()> {
        if self.pending.is_empty() {
            return Ok(());
        }
        let bytes = std::mem::take(&mut self.pending);
        let sent = self.bytes.as_ref().is_some_and(|sender| sender.send(bytes).is_ok());
        if sent { Ok(()) } else { self.result() }
    }
}

fn write_all(mut file: File, inbox: &Receiver<Vec<u8>>) -> io::Result<()> {
    inbox.iter().try_for_each(|bytes| file.write_all(&bytes))
}

/// Opens a new file for a run: `NAME` for the first, `NAME-2`, `NAME-3` and so on. Nothing is ever
/// overwritten.
pub fn create(record: &Path, number: u32) -> anyhow::Result<(PathBuf, File)> {
    let path = numbered(record, number);
    let file = OpenOptions::new().write(true).create_new(true).open(&path);
    file.map(|file| (path.clone(), file)).with_context(|| path.display().to_string())
}

/// The numbers of the runs under a name of which there is a recording, or at least the case.
pub fn numbers(record: &Path) -> BTreeSet<u32> {
    let folder = record.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let names = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    names.filter_map(|name| number_of(record, &name.to_string_lossy())).collect()
}

fn number_of(record: &Path, name: &str) -> Option<u32> {
    let is_run = |number: &u32| {
        let path = numbered(record, *number);
        [&path, &case_path(&path)].iter().any(|path| path.file_name().is_some_and(|n| n.to_string_lossy() == name))
    };
    let stem = record.file_stem()?.to_string_lossy();
    let rest = name.strip_prefix(&*stem)?.trim_start_matches('-');
    let digits = rest.split(|c: char| !c.is_ascii_digit()).next().unwrap_or_default();
    let number = if digits.is_empty() { 1 } else { digits.parse().ok()? };
    Some(number).filter(is_run)
}

/// The recording of a run.
pub fn numbered(record: &Path, number: u32) -> PathBuf {
    if number == 1 {
        return record.to_owned();
    }
    let stem = record.file_stem().unwrap_or_default().to_string_lossy();
    let ending = record.extension().map(|e| format!(".{}", e.to_string_lossy())).unwrap_or_default();
    record.with_file_name(format!("{stem}-{number}{ending}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_numbered_and_nothing_is_overwritten() {
        let dir = tempfile::tempdir().expect("a folder");
        let record = dir.path().join("drive.mcap");
        assert_eq!(numbers(&record), BTreeSet::new());
        let names: Vec<_> = (1..=3).map(|number| create(&record, number).expect("free").0).collect();
        let expected = ["drive.mcap", "drive-2.mcap", "drive-3.mcap"].map(|name| dir.path().join(name));
        assert_eq!(names, expected);
        assert!(create(&record, 2).is_err());
        assert_eq!(case_path(&expected[1]), dir.path().join("drive-2.case.mcap"));
        assert!(create(&dir.path().join("absent/drive.mcap"), 1).is_err());
        assert_ne!(case_path(Path::new("run.1")), case_path(Path::new("run.2")));
        std::fs::remove_file(&expected[0]).expect("there");
        for other in ["drive-x.mcap", "drive-04.mcap", "drive--7.mcap", "drives.mcap", "drive-8.txt"] {
            std::fs::write(dir.path().join(other), "no run of that name").expect("written");
        }
        std::fs::write(dir.path().join("drive-5.case.mcap"), "a case whose recording is elsewhere").expect("written");
        assert_eq!(numbers(&record), BTreeSet::from([2, 3, 5]));
    }

    #[test]
    fn everything_arrives_in_order() {
        let dir = tempfile::tempdir().expect("a folder");
        let (path, file) = create(&dir.path().join("a"), 1).expect("free");
        let mut out = BackgroundFile::new(file, |error| panic!("{error}"));
        for i in 0..100u8 {
            out.write_all(&[i; 3]).expect("taken");
            out.flush().expect("taken");
        }
        out.close().expect("written");
        let expected: Vec<u8> = (0..100).flat_map(|i| [i; 3]).collect();
        assert_eq!(std::fs::read(path).expect("there"), expected);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_full_disk_is_said() {
        let file = OpenOptions::new().write(true).open("/dev/full").expect("a device that is always full");
        let (tell, told) = mpsc::channel();
        let mut out = BackgroundFile::new(file, move |error| tell.send(error.kind()).expect("heard"));
        out.write_all(&[0; 10]).expect("taken");
        out.flush().expect("taken");
        assert_eq!(told.recv().expect("told before anything else is written"), io::ErrorKind::StorageFull);
        assert_eq!(out.close().expect_err("full").kind(), io::ErrorKind::StorageFull);
    }
}

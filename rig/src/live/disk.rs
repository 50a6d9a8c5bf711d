//! Writes a recording from a thread of its own, so that a slow disk delays nobody.

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::JoinHandle;

use anyhow::{Context, anyhow};

/// A file that is written in the background. Bytes reach it in order; each flush reaches the system.
pub struct BackgroundFile {
    bytes: Option<Sender<Vec<u8>>>,
    pending: Vec<u8>,
    writer: Option<JoinHandle<io::Result<()>>>,
}

impl BackgroundFile {
    /// Writes to an open file.
    pub fn new(file: File) -> Self {
        let (bytes, inbox) = mpsc::channel();
        let writer = std::thread::spawn(move || write_all(file, &inbox));
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

/// Opens a new file for the next run: the name given, or the first of `NAME-2`, `NAME-3` ... that is
/// free, with the name of its case. Nothing is ever overwritten.
pub fn create_next(record: &Path) -> anyhow::Result<(PathBuf, File)> {
    for number in 1..100_000 {
        let path = numbered(record, number);
        if case_path(&path).exists() {
            continue;
        }
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => return Ok((path, file)),
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
            Err(e) => return Err(e).with_context(|| path.display().to_string()),
        }
    }
    Err(anyhow!("{}: no number is free", record.display()))
}

/// The runs that are recorded under a name already, in order.
pub fn recorded(record: &Path) -> impl Iterator<Item = PathBuf> + '_ {
    (1..).map(move |number| numbered(record, number)).take_while(|path| path.is_file())
}

/// The path of a corner case beside its recording.
pub fn case_path(recording: &Path) -> PathBuf {
    let name = recording.file_name().unwrap_or_default().to_string_lossy();
    recording.with_file_name(format!("{}.case.mcap", name.strip_suffix(".mcap").unwrap_or(&name)))
}

fn numbered(record: &Path, number: u32) -> PathBuf {
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
        let names: Vec<_> = (0..3).map(|_| create_next(&record).expect("free").0).collect();
        let expected = ["drive.mcap", "drive-2.mcap", "drive-3.mcap"].map(|name| dir.path().join(name));
        assert_eq!(names, expected);
        assert_eq!(case_path(&expected[1]), dir.path().join("drive-2.case.mcap"));
        assert_eq!(recorded(&record).collect::<Vec<_>>(), expected);
        assert!(create_next(&dir.path().join("absent/drive.mcap")).is_err());
        assert_ne!(case_path(Path::new("run.1")), case_path(Path::new("run.2")));
        std::fs::write(dir.path().join("old.case.mcap"), "a case whose recording is elsewhere").expect("written");
        assert_eq!(create_next(&dir.path().join("old.mcap")).expect("free").0, dir.path().join("old-2.mcap"));
    }

    #[test]
    fn everything_arrives_in_order() {
        let dir = tempfile::tempdir().expect("a folder");
        let (path, file) = create_next(&dir.path().join("a")).expect("free");
        let mut out = BackgroundFile::new(file);
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
        let mut out = BackgroundFile::new(file);
        out.write_all(&[0; 10]).expect("taken");
        assert_eq!(out.close().expect_err("full").kind(), io::ErrorKind::StorageFull);
    }
}

//! Writes a recording from a thread of its own, so that a slow disk delays nobody.

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::JoinHandle;

use anyhow::Context;
use base::library;

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
    let path = library::numbered(record, number);
    let file = OpenOptions::new().write(true).create_new(true).open(&path);
    file.map(|file| (path.clone(), file)).with_context(|| path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_numbered_and_nothing_is_overwritten() {
        let dir = tempfile::tempdir().expect("a folder");
        let record = dir.path().join("drive.mcap");
        let names: Vec<_> = (1..=3).map(|number| create(&record, number).expect("free").0).collect();
        let expected = ["drive.mcap", "drive-2.mcap", "drive-3.mcap"].map(|name| dir.path().join(name));
        assert_eq!(names, expected);
        assert!(create(&record, 2).is_err());
        assert!(create(&dir.path().join("absent/drive.mcap"), 1).is_err());
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

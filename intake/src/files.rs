//! Reads files that may be anything.

use std::fs::{self, File};
use std::io::{Error, ErrorKind, Read, Result, Seek, SeekFrom};
use std::path::Path;

/// Longest files that are read, in bytes, and largest pictures.
pub mod most {
    /// Options, questionnaires, calibrations, descriptions: what a person writes.
    pub const TEXT: u64 = 4 << 20;
    /// A story in OpenSCENARIO XML: those of recordings have everybody's places of every tick.
    pub const STORY: u64 = 16 << 20;
    /// What is written for programs, a line for each of many.
    pub const TABLE: u64 = 256 << 20;
    /// A map of roads.
    pub const MAP: u64 = 256 << 20;
    /// A picture.
    pub const PICTURE: u64 = 256 << 20;
    /// The same in pixels: 8192 x 8192.
    pub const PIXELS: u64 = 1 << 26;
    /// A file of a model.
    pub const MODEL: u64 = 256 << 20;
    /// A network with its weights.
    pub const NETWORK: u64 = 1 << 30;
    /// A recording: an hour is some megabytes.
    pub const RECORDING: u64 = 192 << 20;
}

/// The bytes of a regular file that holds at most so many. Pipes and devices, which may never end, are refused.
pub fn read(path: &Path, most: u64) -> Result<Vec<u8>> {
    let length = length(path)?;
    check_length(length, most)?;
    // What the system tells of a length is not always so, as below /proc.
    let mut bytes = Vec::with_capacity(length as usize);
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    check_length(bytes.len() as u64, most)?;
    Ok(bytes)
}

/// As [`read`], of text.
pub fn read_text(path: &Path, most: u64) -> Result<String> {
    String::from_utf8(read(path, most)?).map_err(|_| Error::new(ErrorKind::InvalidData, "is no text in UTF-8"))
}

/// As [`read`], of a part of a file: so many bytes, or all to its end, from a byte on.
pub fn read_part(path: &Path, from: u64, count: Option<u64>, most: u64) -> Result<Vec<u8>> {
    let length = length(path)?;
    let end = count.map_or(Some(length), |count| from.checked_add(count)).filter(|end| (from..=length).contains(end));
    let Some(end) = end else {
        let wanted = count.map_or(String::new(), |count| format!("{count} bytes "));
        let text = format!("has {length} bytes, expected {wanted}from byte {from} on");
        return Err(Error::new(ErrorKind::UnexpectedEof, text));
    };
    check_length(end - from, most)?;
    let mut bytes = vec![0; (end - from) as usize];
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(from))?;
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

/// How long a regular file is; it is asked before it is opened, which a pipe would let wait.
fn length(path: &Path) -> Result<u64> {
    let is = fs::metadata(path)?;
    if is.is_file() { Ok(is.len()) } else { Err(Error::new(ErrorKind::InvalidInput, "is no regular file")) }
}

fn check_length(length: u64, most: u64) -> Result<()> {
    let too_long =
        || Error::new(ErrorKind::FileTooLarge, format!("is longer than {most} bytes, the most that is read"));
    if length > most { Err(too_long()) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_up_to_their_limit() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a");
        fs::write(&path, "four").unwrap();
        assert_eq!(read_text(&path, 4).unwrap(), "four");
        assert!(read(&path, 3).unwrap_err().to_string().contains("longer than 3 bytes"));
        fs::write(&path, [0xff]).unwrap();
        assert!(read_text(&path, 4).unwrap_err().to_string().contains("no text"));
        assert_eq!(read(&dir.path().join("absent"), 4).unwrap_err().kind(), ErrorKind::NotFound);
    }

    #[test]
    fn folders_devices_and_pipes_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let mut odd = vec![dir.path().to_owned()];
        odd.extend(Path::new("/dev/zero").exists().then(|| "/dev/zero".into()));
        let pipe = dir.path().join("pipe");
        if std::process::Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success()) {
            odd.push(pipe);
        }
        for path in odd {
            assert!(read(&path, 9).unwrap_err().to_string().contains("no regular file"), "{}", path.display());
        }
    }

    #[test]
    fn parts_of_files_are_read_where_they_are() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a");
        fs::write(&path, "abcdef").unwrap();
        assert_eq!(read_part(&path, 2, Some(3), 3).unwrap(), b"cde");
        assert_eq!(read_part(&path, 4, None, 3).unwrap(), b"ef");
        for (from, count) in [(4, Some(3)), (7, None), (1, Some(u64::MAX))] {
            assert!(read_part(&path, from, count, 9).unwrap_err().to_string().contains("has 6 bytes"));
        }
        assert!(read_part(&path, 0, None, 3).unwrap_err().to_string().contains("longer than 3 bytes"));
    }

    #[test]
    fn what_is_longer_than_the_system_tells_is_refused_too() {
        let endless = Path::new("/proc/self/maps");
        if endless.exists() {
            assert_eq!(fs::metadata(endless).unwrap().len(), 0);
            assert!(read(endless, 9).is_err());
        }
    }
}

//! Files that are named in a list: `@FILE`, or `@-` for stdin, as `aeye cases --paths` prints them.

use std::io::{Read, stdin};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};

use crate::failure::Failure;
use crate::files::{self, most};

/// What a list's name begins with.
const MARK: char = '@';

/// The paths with those of lists in the place of the lists, and the lists that cannot be read. A file whose own name begins
/// with `@` is no list.
pub fn expand(paths: &[PathBuf]) -> (Vec<PathBuf>, Vec<Failure>) {
    let (mut all, mut failed) = (Vec::new(), Vec::new());
    for path in paths {
        match list_of(path).map(read) {
            None => all.push(path.clone()),
            Some(Ok(listed)) => all.extend(listed),
            Some(Err(error)) => failed.push(Failure::new(path, &error)),
        }
    }
    (all, failed)
}

/// The list that a path stands for, if it does.
fn list_of(path: &Path) -> Option<&str> {
    path.to_str()?.strip_prefix(MARK).filter(|_| !path.exists())
}

fn read(list: &str) -> anyhow::Result<Vec<PathBuf>> {
    let bytes = if list == "-" { from_stdin()? } else { files::read(Path::new(list), most::TABLE)? };
    let text = String::from_utf8(bytes).ok().with_context(|| format!("{MARK}{list}: is no text in UTF-8"))?;
    let paths = paths_in(&text);
    if paths.is_empty() {
        bail!("{MARK}{list}: names no file; expected a path a line");
    }
    Ok(paths)
}

fn from_stdin() -> anyhow::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    stdin().lock().take(most::TABLE + 1).read_to_end(&mut bytes).context("stdin")?;
    if bytes.len() as u64 > most::TABLE {
        bail!("stdin: is longer than {} bytes, the most that is read", most::TABLE);
    }
    Ok(bytes)
}

/// A path a line; or, where there is a NUL, each ended by one.
fn paths_in(text: &str) -> Vec<PathBuf> {
    let split: Vec<&str> = if text.contains('\0') { text.split('\0').collect() } else { text.lines().collect() };
    split.into_iter().filter(|path| !path.is_empty()).map(PathBuf::from).collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_list_stands_for_the_paths_in_it() {
        let dir = tempfile::tempdir().expect("a folder");
        let mark = |name: &str| PathBuf::from(format!("@{}", dir.path().join(name).display()));
        fs::write(dir.path().join("lines"), "a.case.mcap\r\nb c.case.mcap\n\n").expect("writable");
        fs::write(dir.path().join("nul"), "d\ne.case.mcap\0f.case.mcap\0").expect("writable");
        fs::write(dir.path().join("none"), "\n").expect("writable");
        let (paths, failed) = expand(&[mark("lines"), "runs".into(), mark("nul"), mark("none"), mark("gone")]);
        let expected = ["a.case.mcap", "b c.case.mcap", "runs", "d\ne.case.mcap", "f.case.mcap"];
        assert_eq!(paths, expected.map(PathBuf::from));
        assert_eq!(failed.len(), 2);
        assert!(failed[0].error.contains("names no file") && failed[1].file.ends_with("gone"), "{failed:?}");
    }

    #[test]
    fn a_file_that_is_called_so_is_no_list() {
        let dir = tempfile::tempdir().expect("a folder");
        let file = dir.path().join("@a.case.mcap");
        fs::write(&file, "").expect("writable");
        assert_eq!(expand(std::slice::from_ref(&file)), (vec![file], Vec::new()));
    }
}

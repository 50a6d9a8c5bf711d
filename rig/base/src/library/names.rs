//! The names under which results about files are filed.

use std::collections::{BTreeMap, HashSet};
use std::path::{Component, Path, PathBuf};

use anyhow::bail;

/// What the names of recordings and corner cases end with.
pub const ENDING: &str = ".mcap";

/// A file and how much of the way to it is its name.
pub struct Way {
    /// Where it is.
    pub path: PathBuf,
    /// Every folder above, and the name without `.mcap`.
    parts: Vec<String>,
    /// How many of them, from the end.
    taken: usize,
}

impl Way {
    /// Of a file, below the folder in which it was found.
    pub fn new(path: PathBuf, folder: &Path) -> Self {
        let whole = std::path::absolute(&path).unwrap_or_else(|_| path.clone());
        let normal = |part: Component<'_>| match part {
            Component::Normal(part) => Some(part.to_string_lossy().into_owned()),
            _ => None,
        };
        let mut parts: Vec<String> = whole.components().filter_map(normal).collect();
        if let Some(last) = parts.last_mut() {
            *last = last.strip_suffix(ENDING).unwrap_or(last).to_owned();
        }
        let taken = path.strip_prefix(folder).unwrap_or(&path).components().count().clamp(1, parts.len().max(1));
        Self { path, parts, taken }
    }

    /// The file's name without `.mcap`, after the folders that belong to it.
    pub fn name(&self) -> String {
        self.parts[self.parts.len().saturating_sub(self.taken)..].join("/")
    }

    /// Refuses names under which results cannot be filed: `...mcap` would be filed above the results, `.mcap` as all
    /// of them, and hidden ones among their books.
    pub fn check(&self) -> anyhow::Result<()> {
        let name = self.name();
        if name.split('/').any(|part| part.is_empty() || part.starts_with('.')) {
            let place = self.path.display();
            bail!("{place}: its results would be hidden under {name:?}; expected a name that begins with no dot");
        }
        Ok(())
    }
}

/// Gives names that are the same one more folder each, until none is; nor may one be the folder of another.
pub fn tell_apart(ways: &mut [Way]) {
    loop {
        let mut known: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (index, way) in ways.iter().enumerate() {
            known.entry(way.name()).or_default().push(index);
        }
        let folders: HashSet<&Path> = known.keys().flat_map(|name| Path::new(name).ancestors().skip(1)).collect();
        let clashes = known.iter().filter(|(name, ways)| ways.len() > 1 || folders.contains(Path::new(name)));
        let longer: Vec<usize> = clashes.flat_map(|(_, ways)| ways.iter().copied()).collect();
        let mut is_done = true;
        for index in longer {
            let way = &mut ways[index];
            if way.taken < way.parts.len() {
                way.taken += 1;
                is_done = false;
            }
        }
        if is_done {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(given: &[(&str, &str)]) -> Vec<String> {
        let mut ways: Vec<Way> = given.iter().map(|(path, folder)| Way::new(path.into(), Path::new(folder))).collect();
        tell_apart(&mut ways);
        ways.iter().map(Way::name).collect()
    }

    #[test]
    fn names_say_the_way_from_the_folder_that_was_given() {
        assert_eq!(names(&[("runs/a/x.case.mcap", "runs"), ("y.mcap", "")]), ["a/x.case", "y"]);
    }

    #[test]
    fn names_that_are_the_same_get_the_folders_that_tell_them_apart() {
        let two = [("/r/1/x.mcap", "/r/1"), ("/r/2/x.mcap", "/r/2"), ("/r/2/y.mcap", "/r/2")];
        assert_eq!(names(&two), ["1/x", "2/x", "y"]);
        assert_eq!(names(&[("/r/1/b/x.mcap", "/r/1"), ("/s/b.mcap", "/s")]), ["b/x", "s/b"], "no name is a folder");
    }
}

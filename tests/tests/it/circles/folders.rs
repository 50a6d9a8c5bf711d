//! Levels of folders: what is directly in a folder, each of its folders taken as one.

use std::collections::BTreeSet;

use super::arrows::Arrows;

/// Every folder that holds a file of the arrows, with a slash at its end; the root is empty.
pub fn of(arrows: &Arrows) -> BTreeSet<String> {
    let files = arrows.keys().flat_map(|(from, to)| [from, to]);
    let above = |file: &String| file.match_indices('/').map(|(i, _)| file[..=i].to_owned()).collect::<Vec<_>>();
    files.flat_map(above).chain([String::new()]).collect()
}

/// What of a folder a file belongs to: itself, or the folder below, without a slash.
///
/// A file `a.rs` beside a folder `a` is that folder's facade, as `a/mod.rs` would be: seen from above
/// they are one, and inside the folder it is a file like others.
pub fn part<'a>(folders: &BTreeSet<String>, folder: &str, file: &'a str) -> Option<&'a str> {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    if folder.strip_suffix('/') == Some(stem) {
        return Some(file);
    }
    let rest = file.strip_prefix(folder)?;
    match rest.find('/') {
        Some(slash) => Some(&file[..folder.len() + slash]),
        None if folders.contains(&format!("{stem}/")) => Some(stem),
        None => Some(file),
    }
}

/// Whether a part of a folder is a folder.
pub fn is_folder(part: &str) -> bool {
    !part.ends_with(".rs")
}

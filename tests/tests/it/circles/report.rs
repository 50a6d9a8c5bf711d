//! The circles of a crate, told so that one sees what to move.

use std::collections::BTreeMap;

use super::arrows::{self, Arrows};
use super::folders::{self, is_folder, part};
use super::graph::{Circle, circles, graph};
use super::modules::{self, Files};

/// Most names that are told of an arrow.
const MAX_NAMES: usize = 6;

/// Every circle of files and of folders of a package, as a text for each; an error where a file
/// cannot be read.
pub fn of_package(package: &str, files: &Files) -> Result<Vec<String>, String> {
    let arrows = arrows::of(&modules::read(package, files)?);
    let of_files = circles(&graph(arrows.keys().cloned()), |_| true);
    let mut told: Vec<String> = of_files.iter().map(|circle| of_files_told(circle, &arrows)).collect();
    let folders = folders::of(&arrows);
    for folder in &folders {
        let mut between: BTreeMap<(String, String), Vec<String>> = BTreeMap::new();
        for (from, to) in arrows.keys() {
            let parts = (part(&folders, folder, from), part(&folders, folder, to));
            let (Some(a), Some(b)) = parts else { continue };
            if a != b {
                let line = arrow_told(from, to, &arrows);
                between.entry((a.to_owned(), b.to_owned())).or_default().push(line);
            }
        }
        let found = circles(&graph(between.keys().cloned()), is_folder);
        told.extend(found.iter().map(|circle| level_told(circle, &between)));
    }
    Ok(told)
}

fn of_files_told(circle: &Circle, arrows: &Arrows) -> String {
    let lines: Vec<String> = around(&circle.way).map(|(from, to)| arrow_told(from, to, arrows)).collect();
    format!("circle of {} files\n{}{}", circle.way.len(), lines.concat(), others_told(circle))
}

/// A circle of what is directly in one folder; each arrow with one that it is made of.
fn level_told(circle: &Circle, between: &BTreeMap<(String, String), Vec<String>>) -> String {
    let lines = around(&circle.way).map(|(from, to)| {
        let made_of = &between[&(from.to_owned(), to.to_owned())];
        let more = if made_of.len() > 1 { format!("    ({} more arrows)\n", made_of.len() - 1) } else { String::new() };
        format!("  {from} -> {to}, by\n  {}{more}", made_of[0])
    });
    let lines = lines.collect::<String>();
    format!("circle of {} parts of a folder\n{lines}{}", circle.way.len(), others_told(circle))
}

fn arrow_told(from: &str, to: &str, arrows: &Arrows) -> String {
    let taken = &arrows[&(from.to_owned(), to.to_owned())];
    let mut names: Vec<String> = taken.iter().take(MAX_NAMES).map(|(n, line)| format!("{n} (line {line})")).collect();
    if taken.len() > MAX_NAMES {
        names.push(format!("{} more", taken.len() - MAX_NAMES));
    }
    format!("  {from} -> {to}: {}\n", names.join(", "))
}

/// Members of the circle's knot that its shortest way leaves out.
fn others_told(circle: &Circle) -> String {
    let others: Vec<&str> = circle.members.iter().filter(|m| !circle.way.contains(m)).map(String::as_str).collect();
    if others.is_empty() { String::new() } else { format!("  tied to it: {}\n", others.join(", ")) }
}

/// The arrows of a way around.
fn around(way: &[String]) -> impl Iterator<Item = (&str, &str)> {
    let next = way.iter().cycle().skip(1);
    way.iter().zip(next).map(|(from, to)| (from.as_str(), to.as_str()))
}

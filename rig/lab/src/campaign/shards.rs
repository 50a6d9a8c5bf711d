//! The folders of a campaign's shards, and whether they belong together.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::say::say;

use super::shard::Shard;
use crate::machine::{Build, Machine};

/// A shard and its folder.
pub struct Placed {
    /// Where its runs are.
    pub folder: PathBuf,
    /// What they are.
    pub shard: Shard,
}

/// The shards in folders and in those directly below them, by their paths.
pub fn find(folders: &[PathBuf]) -> anyhow::Result<Vec<Placed>> {
    let mut shards = Vec::new();
    for folder in folders {
        if let Some(shard) = Shard::read(folder)? {
            shards.push(Placed { folder: folder.clone(), shard });
            continue;
        }
        let before = shards.len();
        for below in below(folder)? {
            let shard = Shard::read(&below)?;
            shards.extend(shard.map(|shard| Placed { folder: below, shard }));
        }
        if shards.len() == before {
            let folder = folder.display();
            say(format_args!("{folder}: holds no shard.json, nor does a folder in it; taken for a shard without runs"));
        }
    }
    Ok(shards)
}

/// The folders in a folder, of which there may be none.
fn below(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let context = || folder.display().to_string();
    let entries = fs::read_dir(folder).with_context(context)?.collect::<Result<Vec<_>, _>>().with_context(context)?;
    let mut folders: Vec<PathBuf> = entries.iter().map(fs::DirEntry::path).filter(|path| path.is_dir()).collect();
    folders.sort();
    Ok(folders)
}

/// Refuses shards of several campaigns or programs; gives the first one.
pub fn check(shards: &[Placed]) -> anyhow::Result<&Placed> {
    let Some(first) = shards.first() else { bail!("no shard is there; expected folders with a shard.json") };
    for other in &shards[1..] {
        let (one, another) = (first.folder.display(), other.folder.display());
        if let Some((name, here, there)) = first.shard.plan.difference(&other.shard.plan)? {
            bail!("{another}/shard.json: {name} is {there}, in {one} it is {here}; expected shards of one campaign");
        }
        let (build, built) = (&first.shard.build, &other.shard.build);
        if build != built {
            bail!("{another}/shard.json: was driven by {built}, {one} by {build}; expected one program for all");
        }
    }
    let (this, build) = (Build::this(), &first.shard.build);
    if !this.reads(build) {
        let one = first.folder.display();
        bail!("{one}/shard.json: was driven by {build}, this is {this}; expected one that drives the same");
    }
    Ok(first)
}

/// The kinds of machines that drove, which are told, if they are several.
pub fn machines(shards: &[Placed]) -> Vec<Machine> {
    let mut kinds: Vec<(&Machine, &Path)> = Vec::new();
    for (placed, machine) in shards.iter().flat_map(|placed| placed.shard.machines.iter().map(move |m| (placed, m))) {
        if kinds.iter().all(|(kind, _)| *kind != machine) {
            kinds.push((machine, &placed.folder));
        }
    }
    if kinds.len() < 2 {
        return Vec::new();
    }
    let each: Vec<_> = kinds.iter().map(|(kind, folder)| format!("{} on {kind}", folder.display())).collect();
    say(format_args!("machines of {} kinds drove, whose predictions may differ: {}", kinds.len(), each.join("; ")));
    kinds.into_iter().map(|(kind, _)| kind.clone()).collect()
}

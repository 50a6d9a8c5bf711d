//! Models of a user's own: a folder with glTF files and `models.toml`, which says what stands for what.

mod document;
mod files;
mod geometry;
mod list;
mod material;
mod texture;
mod texture_split;

#[cfg(test)]
mod fuzz;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, anyhow};
use render::models::{Figure, Models, ModelsId, Subject};

use files::Folder;
use list::{Entry, LIST, List};

/// Reads a folder of models and makes them known to the renderer.
pub fn read(folder: &Path) -> anyhow::Result<ModelsId> {
    Ok(load(folder)?.register())
}

/// Reads a folder of models.
pub fn load(folder: &Path) -> anyhow::Result<Models> {
    let mut files = Folder::open(folder)?;
    let text = files.text(LIST)?;
    let list = List::parse(&text).map_err(|problem| anyhow!("{}: {problem}", folder.join(LIST).display()))?;
    let mut figures: BTreeMap<Subject, Vec<Figure>> = BTreeMap::new();
    for entry in &list.entries {
        for (subject, figure) in
            figures_of(&mut files, entry).with_context(|| format!("{}", folder.join(&entry.said.file).display()))?
        {
            figures.entry(subject).or_default().push(figure);
        }
    }
    Ok(Models::new(files.digest(), figures))
}

/// What a file stands for, and how it looks as each of them.
fn figures_of(files: &mut Folder, entry: &Entry) -> anyhow::Result<Vec<(Subject, Figure)>> {
    let document = document::read(files, &entry.said.file)?;
    let of = |subject: Subject| {
        let model = geometry::model(&document, entry, subject)?;
        let is = |problem: String| anyhow!("as {} it {problem}", subject.name());
        Ok((subject, Figure::new(subject, model).map_err(is)?))
    };
    entry.is.iter().map(|subject| of(*subject)).collect()
}

//! The packages of this workspace, as its manifests tell them.

use std::fs;
use std::path::{Path, PathBuf};

use super::modules::Files;

/// A package with the texts below its `src`.
pub struct Package {
    /// Its folder below the root.
    pub folder: String,
    pub name: String,
    pub files: Files,
}

/// Every member of the workspace.
pub fn packages() -> Vec<Package> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace is above").to_owned();
    let manifest = manifest(&root);
    let members = manifest["workspace"]["members"].as_array().expect("a list of members");
    let members = members.iter().map(|member| member.as_str().expect("a path"));
    members.flat_map(|member| folders(&root, member)).map(|folder| package(&root, &folder)).collect()
}

/// The folders that a member's path names; `a/*` names all packages in `a`.
fn folders(root: &Path, member: &str) -> Vec<String> {
    let Some(parent) = member.strip_suffix("/*") else { return vec![member.to_owned()] };
    let entries = fs::read_dir(root.join(parent)).expect("a readable folder");
    let names = entries.map(|entry| entry.expect("a readable entry").file_name().to_string_lossy().into_owned());
    let mut folders: Vec<String> = names.map(|name| format!("{parent}/{name}")).collect();
    folders.retain(|folder| root.join(folder).join("Cargo.toml").is_file());
    folders.sort();
    folders
}

fn package(root: &Path, folder: &str) -> Package {
    let path = root.join(folder);
    let name = manifest(&path)["package"]["name"].as_str().expect("a name").to_owned();
    let mut files = Files::new();
    let src = path.join("src");
    collect(&src, &src, &mut files);
    assert!(!files.is_empty(), "{folder} has no sources");
    Package { folder: folder.to_owned(), name, files }
}

fn manifest(folder: &Path) -> toml::Table {
    let text = fs::read_to_string(folder.join("Cargo.toml")).expect("a manifest");
    text.parse().expect("a manifest is TOML")
}

fn collect(src: &Path, folder: &Path, files: &mut Files) {
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let path: PathBuf = entry.expect("a readable entry").path();
        if path.is_dir() {
            collect(src, &path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let relative = path.strip_prefix(src).expect("below src").to_string_lossy().replace('\\', "/");
            files.insert(relative, fs::read_to_string(&path).expect("a text file"));
        }
    }
}

//! The files of a folder, and their digest.

use std::path::{Component, Path, PathBuf};

use anyhow::{Context, anyhow, bail};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use render::ModelsId;

use super::list::LIST;
use crate::files::{self, most};

/// Bytes of all files together at most.
const MOST_BYTES: u64 = 1 << 30;

/// A folder whose files are read one after another.
pub(super) struct Folder {
    /// Where it is, without links.
    path: PathBuf,
    digest: blake3::Hasher,
    left: u64,
}

impl Folder {
    pub(super) fn open(path: &Path) -> anyhow::Result<Self> {
        let place = || format!("{}: expected a folder with {}", path.display(), LIST);
        let path = path.canonicalize().with_context(place)?;
        Ok(Self { path, digest: blake3::Hasher::new(), left: MOST_BYTES })
    }

    /// Of the list and of all files that were read, in their order.
    pub(super) fn digest(&self) -> ModelsId {
        let mut digest = [0; 16];
        self.digest.finalize_xof().fill(&mut digest);
        digest.into()
    }

    pub(super) fn text(&mut self, name: &str) -> anyhow::Result<String> {
        let path = self.path.join(name);
        let text = files::read_text(&path, most::TEXT).with_context(|| path.display().to_string())?;
        self.count(name, text.as_bytes());
        Ok(text)
    }

    /// The bytes of a file in the folder or below it.
    pub(super) fn bytes(&mut self, name: &str) -> anyhow::Result<Vec<u8>> {
        let is_plain = |name: &str| Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        if name.is_empty() || name.contains(['\\', ':']) || !is_plain(name) {
            bail!("{name:?} is no path below the folder of models, expected one such as \"cars/saloon.glb\"");
        }
        let path = self.path.join(name).canonicalize().with_context(|| format!("{name:?}"))?;
        if !path.starts_with(&self.path) {
            bail!("{name:?} leads out of the folder of models");
        }
        let bytes = files::read(&path, most::MODEL.min(self.left)).with_context(|| format!("{name:?}"))?;
        self.count(name, &bytes);
        Ok(bytes)
    }

    /// The bytes that an address in a file names, which stands in a folder below: of a file, or of itself (`data:`).
    pub(super) fn resource(&mut self, beside: &str, uri: &str) -> anyhow::Result<Vec<u8>> {
        if let Some(data) = uri.strip_prefix("data:") {
            let (_, text) = data.split_once(";base64,").ok_or_else(|| anyhow!("expected data in base64"))?;
            return STANDARD.decode(text).context("data in base64");
        }
        let name = unescaped(uri).ok_or_else(|| anyhow!("{uri:?} is no address of a file"))?;
        let folder = Path::new(beside).parent().and_then(Path::to_str).filter(|folder| !folder.is_empty());
        self.bytes(&folder.map_or(name.clone(), |folder| format!("{folder}/{name}")))
    }

    fn count(&mut self, name: &str, bytes: &[u8]) {
        self.left = self.left.saturating_sub(bytes.len() as u64);
        for part in [name.as_bytes(), bytes] {
            self.digest.update(&(part.len() as u64).to_le_bytes()).update(part);
        }
    }
}

/// `%20` and the like as what they stand for.
fn unescaped(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        rest = after;
        if first != b'%' {
            bytes.push(first);
            continue;
        }
        let (digits, after) = rest.split_at_checked(2)?;
        bytes.push(u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?);
        rest = after;
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_outside_of_the_folder_is_read() {
        let outer = tempfile::tempdir().unwrap();
        std::fs::write(outer.path().join("secret.bin"), "s").unwrap();
        let inner = outer.path().join("models");
        std::fs::create_dir_all(inner.join("a b")).unwrap();
        std::fs::write(inner.join("a b/c.bin"), "c").unwrap();
        let mut folder = Folder::open(&inner).unwrap();
        assert_eq!(folder.resource("car.gltf", "a%20b/c.bin").unwrap(), b"c");
        assert_eq!(folder.resource("a b/car.gltf", "c.bin").unwrap(), b"c");
        assert_eq!(folder.resource("car.gltf", "data:application/octet-stream;base64,Yw==").unwrap(), b"c");
        #[cfg(unix)]
        std::os::unix::fs::symlink("../secret.bin", inner.join("link.bin")).unwrap();
        let secret = outer.path().join("secret.bin").to_str().unwrap().to_owned();
        for uri in ["../secret.bin", "a%20b/../../secret.bin", "link.bin", &secret, "%2e%2e/secret.bin", "", "%", "%zz"]
        {
            assert!(folder.resource("car.gltf", uri).is_err(), "{uri}");
        }
        for uri in ["http://a/b.bin", "file:///etc/passwd", "data:,abc", "data:;base64,?"] {
            assert!(folder.resource("car.gltf", uri).is_err(), "{uri}");
        }
    }
}

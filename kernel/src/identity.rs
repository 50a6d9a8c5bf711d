//! Which kernel this is.

use xxhash_rust::xxh3::xxh3_64;

/// The hashes of scripted drives that every build must come to (`tests/golden.rs`).
const TIMELINE: &str = include_str!("../tests/golden_timeline.txt");

/// The exact versions of the libraries on which the kernel's arithmetic rests, as in `glam 0.33.12, ...`.
pub const ENGINES: &str = env!("KERNEL_ENGINES");

/// The kernel's version and a digest of its golden timeline, as in `0.1.0-5f0c1e77a2b94d36`: a kernel that drives
/// differently has another one, without anybody's care.
pub fn identity() -> String {
    format!("{}-{:016x}", env!("CARGO_PKG_VERSION"), xxh3_64(TIMELINE.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_engines_have_exact_versions() {
        let named: Vec<_> = ENGINES.split(", ").filter_map(|engine| engine.split_once(' ')).collect();
        assert_eq!(
            named.iter().map(|(name, _)| *name).collect::<Vec<_>>(),
            ["glam", "libm", "parry3d", "rapier3d", "xodr"]
        );
        for (name, version) in named {
            assert_eq!(version.split('.').filter(|part| part.parse::<u32>().is_ok()).count(), 3, "{name} {version}");
        }
    }
}

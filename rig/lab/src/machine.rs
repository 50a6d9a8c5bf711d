//! Which program drove, and on what kind of machine.

use std::env::consts::ARCH;
use std::fmt;

use drivers::vision;
use serde::{Deserialize, Serialize};

/// Characters of a digest by which people tell programs apart.
const TOLD: usize = 12;

/// What makes one program another.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Build {
    /// Version of the program.
    pub program: String,
    /// BLAKE3 of the sources that drive: every crate that a drive may depend on, and the versions of all libraries.
    pub sources: String,
    /// Identity of the kernel.
    pub kernel: String,
    /// Exact versions of the libraries that its arithmetic rests on.
    pub engines: String,
    /// Version of the renderer.
    pub renderer: String,
}

impl Build {
    /// This one.
    pub fn this() -> Self {
        Self {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            sources: env!("LAB_SOURCES").to_owned(),
            kernel: kernel::identity(),
            engines: kernel::ENGINES.to_owned(),
            renderer: render::identity(),
        }
    }

    /// Whether what the other drove is what it would drive, and reads the same to it.
    pub fn reads(&self, other: &Self) -> bool {
        *self == Self { sources: self.sources.clone(), ..other.clone() }
    }
}

impl fmt::Display for Build {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sources = self.sources.get(..TOLD).unwrap_or(&self.sources);
        write!(f, "aeye {} (sources {sources}, kernel {}, renderer {})", self.program, self.kernel, self.renderer)
    }
}

/// What predictions may depend on beyond the build.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's architecture.
    pub arch: String,
    /// Instructions of the processor that networks and renderers choose by.
    pub cpu_features: Vec<String>,
    /// The graphics adapter and its driver.
    pub adapter: String,
}

impl Machine {
    /// This one.
    pub fn this() -> Self {
        Self {
            arch: ARCH.to_owned(),
            cpu_features: cpu_features().into_iter().map(str::to_owned).collect(),
            adapter: vision::adapter(),
        }
    }
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} with {}, {}", self.arch, self.cpu_features.join(" "), self.adapter)
    }
}

/// Names of those that this processor has.
macro_rules! found {
    ($detected:ident: $($name:tt)*) => {
        [$(($name, std::arch::$detected!($name))),*].into_iter().filter(|(_, has)| *has).map(|(name, _)| name).collect()
    };
}

#[cfg(target_arch = "x86_64")]
fn cpu_features() -> Vec<&'static str> {
    found!(is_x86_feature_detected: "sse4.1" "sse4.2" "avx" "avx2" "fma" "f16c" "avx512f" "avx512bw" "avx512vl" "avx512vnni")
}

#[cfg(target_arch = "aarch64")]
fn cpu_features() -> Vec<&'static str> {
    found!(is_aarch64_feature_detected: "neon" "fp16" "dotprod" "i8mm" "sve" "sve2")
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
fn cpu_features() -> Vec<&'static str> {
    Vec::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_build_reads_what_other_sources_of_its_version_drove() {
        let this = Build::this();
        assert_eq!(this.sources.len(), 64);
        assert!(this.reads(&Build { sources: "others".into(), ..this.clone() }));
        assert!(!this.reads(&Build { kernel: "another".into(), ..this.clone() }));
    }
}

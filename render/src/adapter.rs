//! Which graphics adapter draws.

/// Which graphics adapter to draw with.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// A GPU if there is one, else a CPU adapter.
    #[default]
    Auto,
    /// A CPU adapter (lavapipe).
    Cpu,
    /// A GPU.
    Gpu,
    /// The first whose name contains this text, ignoring case.
    Named(String),
}

/// A graphics adapter of this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterInfo {
    /// Name, as in "llvmpipe (LLVM 15.0.6, 256 bits)".
    pub name: String,
    /// API, as in "vulkan".
    pub backend: String,
    /// Driver and its version.
    pub driver: String,
    /// Whether it is a CPU in disguise; such adapters get the cheap preset.
    pub is_cpu: bool,
}

/// The graphics adapters of this machine, GPUs first; empty without any driver.
pub fn adapters() -> Vec<AdapterInfo> {
    todo!()
}

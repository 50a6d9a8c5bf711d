//! Which graphics adapter draws.

use std::sync::OnceLock;

use crate::RenderError;

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
    /// Whether it is a CPU in disguise.
    pub is_cpu: bool,
}

/// The graphics adapters of this machine, GPUs first; empty without any driver.
pub fn adapters() -> Vec<AdapterInfo> {
    found().iter().map(|adapter| describe(&adapter.get_info())).collect()
}

/// The adapters of the native APIs, looked for once a process; OpenGL's colours differ from Vulkan's,
/// so it is left out.
fn found() -> &'static [wgpu::Adapter] {
    static FOUND: OnceLock<Vec<wgpu::Adapter>> = OnceLock::new();
    FOUND.get_or_init(look)
}

fn look() -> Vec<wgpu::Adapter> {
    let backends = wgpu::Backends::PRIMARY;
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
    adapters.sort_by_key(|adapter| rank(adapter.get_info().device_type));
    adapters
}

/// The adapter to make a device from. Mesa's CPU driver (22.3) walks through the scenes of all devices of an instance, while
/// others draw them: one that reads a picture back then ends the process by SIGSEGV. So CPU devices have an instance each.
fn to_itself(at: usize) -> wgpu::Adapter {
    let shared = &found()[at];
    let is_same = |adapter: &wgpu::Adapter| adapter.get_info() == shared.get_info();
    let own = (shared.get_info().device_type == wgpu::DeviceType::Cpu).then(look);
    own.and_then(|own| own.into_iter().find(is_same)).unwrap_or_else(|| shared.clone())
}

fn rank(kind: wgpu::DeviceType) -> u8 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

fn describe(info: &wgpu::AdapterInfo) -> AdapterInfo {
    AdapterInfo {
        name: info.name.clone(),
        backend: info.backend.to_string(),
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        is_cpu: info.device_type == wgpu::DeviceType::Cpu,
    }
}

impl AdapterChoice {
    fn accepts(&self, info: &AdapterInfo) -> bool {
        match self {
            Self::Auto => true,
            Self::Cpu => info.is_cpu,
            Self::Gpu => !info.is_cpu,
            Self::Named(part) => info.name.to_lowercase().contains(&part.to_lowercase()),
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Auto => "graphics adapter".into(),
            Self::Cpu => "CPU graphics adapter".into(),
            Self::Gpu => "GPU".into(),
            Self::Named(part) => format!("graphics adapter '{part}'"),
        }
    }

    /// The adapter that would draw; the error says what to install.
    pub fn find(&self) -> Result<AdapterInfo, RenderError> {
        self.best().map(|(_, info)| info)
    }

    /// The best adapter of the wanted kind, for one device.
    pub(crate) fn open(&self) -> Result<(wgpu::Adapter, AdapterInfo), RenderError> {
        self.best().map(|(at, info)| (to_itself(at), info))
    }

    /// Number and description of the best adapter of the wanted kind.
    fn best(&self) -> Result<(usize, AdapterInfo), RenderError> {
        let mut names = Vec::new();
        for (at, adapter) in found().iter().enumerate() {
            let info = describe(&adapter.get_info());
            if self.accepts(&info) {
                return Ok((at, info));
            }
            names.push(info.name);
        }
        let found = if names.is_empty() { "none".into() } else { names.join(", ") };
        Err(RenderError::NoAdapter { wanted: self.text(), found })
    }
}

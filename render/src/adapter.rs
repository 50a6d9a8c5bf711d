//! Which graphics adapter draws.

use std::sync::OnceLock;

use crate::RenderError;

/// Which graphics adapter to draw with. Of OpenGL's it is only where it is asked for, or no other API has one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// The one that the environment's `AEYE_GPU` names as [`AdapterChoice::Named`]; else a GPU if there is one, else a CPU adapter.
    #[default]
    Auto,
    /// A CPU adapter (lavapipe).
    Cpu,
    /// A GPU.
    Gpu,
    /// The first of the API of this name (`vulkan`, `gl`), or whose own name contains this text; in any case.
    Named(String),
}

/// Names the adapter that [`AdapterChoice::Auto`] takes.
const VARIABLE: &str = "AEYE_GPU";
/// Its value where tests are to fail without an adapter: it names none.
const ANY: &str = "require";

/// A graphics adapter of this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterInfo {
    /// Name, as in "llvmpipe (LLVM 15.0.6, 256 bits)".
    pub name: String,
    /// API, as in "vulkan" or "gl" (OpenGL).
    pub backend: String,
    /// Driver and its version.
    pub driver: String,
    /// Whether it is a CPU in disguise.
    pub is_cpu: bool,
}

/// The graphics adapters of this machine, GPUs first, OpenGL's last; empty without any driver.
pub fn adapters() -> Vec<AdapterInfo> {
    APIS.into_iter().flat_map(found).map(|adapter| describe(&adapter.get_info())).collect()
}

/// Those whose adapters are preferred first.
const APIS: [wgpu::Backends; 2] = [wgpu::Backends::PRIMARY, wgpu::Backends::GL];

/// The adapters of some of [`APIS`], looked for once a process: OpenGL has to make a context for it.
fn found(apis: wgpu::Backends) -> &'static [wgpu::Adapter] {
    static FOUND: [OnceLock<Vec<wgpu::Adapter>>; 2] = [const { OnceLock::new() }; 2];
    FOUND[usize::from(apis == wgpu::Backends::GL)].get_or_init(|| look(apis))
}

fn look(backends: wgpu::Backends) -> Vec<wgpu::Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(backends));
    adapters.sort_by_key(|adapter| rank(adapter.get_info().device_type));
    adapters
}

/// The adapter to make a device from. Mesa's CPU driver (22.3) walks through the scenes of all devices of an instance, while
/// others draw them: one that reads a picture back then ends the process by SIGSEGV. So CPU devices have an instance each; and
/// so have those of OpenGL, which would wait for each other's turn at one context. It makes a context there, too.
pub(crate) fn to_itself(shared: &wgpu::Adapter) -> wgpu::Adapter {
    let info = shared.get_info();
    let is_same = |adapter: &wgpu::Adapter| adapter.get_info() == info;
    let is_alone = info.device_type == wgpu::DeviceType::Cpu || info.backend == wgpu::Backend::Gl;
    let own = is_alone.then(|| look(info.backend.into()));
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
    /// The same, but what the environment says of `Auto`.
    fn asked(&self) -> Self {
        let named = || std::env::var(VARIABLE).ok().filter(|name| !name.is_empty() && name != ANY);
        match self {
            Self::Auto => named().map_or(Self::Auto, Self::Named),
            other => other.clone(),
        }
    }

    fn accepts(&self, info: &AdapterInfo) -> bool {
        match self {
            Self::Auto => true,
            Self::Cpu => info.is_cpu,
            Self::Gpu => !info.is_cpu,
            Self::Named(part) => {
                let (part, apis) = (part.to_lowercase(), wgpu::Backend::ALL.map(wgpu::Backend::to_str));
                if apis.contains(&&*part) { info.backend == part } else { info.name.to_lowercase().contains(&part) }
            }
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

    /// The best adapter of the wanted kind and its description; devices take theirs by [`to_itself`].
    pub(crate) fn best(&self) -> Result<(&'static wgpu::Adapter, AdapterInfo), RenderError> {
        let (asked, mut names) = (self.asked(), Vec::new());
        for adapter in APIS.into_iter().flat_map(found) {
            let info = describe(&adapter.get_info());
            if asked.accepts(&info) {
                return Ok((adapter, info));
            }
            names.push(format!("{} ({})", info.name, info.backend));
        }
        let found = if names.is_empty() { "none".into() } else { names.join(", ") };
        Err(RenderError::NoAdapter { wanted: asked.text(), found })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adapters_are_named_by_their_api_or_by_a_part_of_their_name() {
        let adapter = |name: &str, backend: &str| AdapterInfo {
            name: name.into(),
            backend: backend.into(),
            driver: String::new(),
            is_cpu: true,
        };
        let accepts = |part: &str, info: &AdapterInfo| AdapterChoice::Named(part.into()).accepts(info);
        let [vulkan, opengl] = ["vulkan", "gl"].map(|api| adapter("Eagle (LLVM 15)", api));
        for (part, by_vulkan, by_opengl) in [
            ("gl", false, true),
            ("GL", false, true),
            ("vulkan", true, false),
            ("eagle", true, true),
            ("nvidia", false, false),
        ] {
            assert_eq!((accepts(part, &vulkan), accepts(part, &opengl)), (by_vulkan, by_opengl), "{part}");
        }
    }
}

//! The device and what went wrong on it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::{AdapterChoice, AdapterInfo, RenderError, adapter};

/// An open device.
pub(crate) struct Gpu {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) info: AdapterInfo,
    /// Whether depth can be copied to a buffer, which OpenGL cannot.
    pub(crate) copies_depth: bool,
    failure: Arc<Mutex<Option<String>>>,
}

/// Mesa's CPU driver has one screen for all of OpenGL, whatever instances they are of, and that goes wrong as `adapter.rs`
/// says: so its devices take turns.
static SCREEN: Mutex<()> = Mutex::new(());

fn turn(info: &AdapterInfo) -> Option<MutexGuard<'static, ()>> {
    let shares_screen = info.is_cpu && info.backend == wgpu::Backend::Gl.to_str();
    shares_screen.then(|| SCREEN.lock().unwrap_or_else(PoisonError::into_inner))
}

impl Gpu {
    /// A group of resources, in the order of their bindings.
    pub(super) fn bind(
        &self,
        layout: &wgpu::BindGroupLayout,
        resources: &[wgpu::BindingResource<'_>],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, r)| wgpu::BindGroupEntry { binding, resource: r.clone() }).collect();
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    }

    pub(crate) fn open(choice: &AdapterChoice) -> Result<Self, RenderError> {
        let (shared, info) = choice.best()?;
        let _turn = turn(&info);
        let adapter = adapter::to_itself(shared);
        // Roads of a hundred kilometres are one buffer.
        let max_buffer_size = adapter.limits().max_buffer_size;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("a-eye"),
            required_limits: wgpu::Limits {
                max_buffer_size,
                ..wgpu::Limits::default().using_resolution(adapter.limits())
            },
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| RenderError::Device { adapter: info.name.clone(), reason: e.to_string() })?;
        let failure = Arc::new(Mutex::new(None));
        let kept = failure.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            kept.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error.to_string());
        }));
        let copies = adapter.get_downlevel_capabilities().flags;
        let copies_depth = copies.contains(wgpu::DownlevelFlags::DEPTH_TEXTURE_AND_BUFFER_COPIES);
        Ok(Self { device, queue, info, copies_depth, failure })
    }

    /// Held while the device is at work.
    pub(crate) fn turn(&self) -> Option<MutexGuard<'static, ()>> {
        turn(&self.info)
    }

    /// Lets something go wrong.
    #[cfg(test)]
    pub(crate) fn fail(&self, reason: &str) {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(reason.into());
    }

    /// The first error since the last call.
    pub(crate) fn failure(&self) -> Option<String> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Longest side of an image, pixels.
    pub(crate) fn longest_side(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }
}

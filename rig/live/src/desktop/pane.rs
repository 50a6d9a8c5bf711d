//! One window with what paints it. All windows share one graphics device.

use std::cell::Cell;
use std::num::NonZeroU32;
use std::sync::Arc;

use anyhow::Context;
use egui::ViewportId;
use egui_wgpu::winit::Painter;
use egui_wgpu::{
    RenderState, RendererOptions, SurfaceConfig, WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew, WgpuSetupExisting,
    wgpu,
};
use winit::dpi::{LogicalPosition, LogicalSize, PhysicalPosition, PhysicalSize};
use winit::event::WindowEvent;
use winit::event_loop::ActiveEventLoop;
use winit::window::{Fullscreen, Window, WindowId};

use super::blit;
use super::layout::Placement;

/// Present at once and wait for nobody: a window that is out of sight must not hold up the others.
const SURFACE: SurfaceConfig =
    SurfaceConfig { present_mode: wgpu::PresentMode::AutoNoVsync, desired_maximum_frame_latency: Some(1) };
/// Behind everything.
const GROUND: [f32; 4] = [0.06, 0.063, 0.07, 1.0];

/// A window and its painter.
pub struct Pane {
    window: Arc<Window>,
    context: egui::Context,
    input: egui_winit::State,
    painter: Painter,
    /// Where it was before it filled its monitor.
    windowed: Cell<Option<Placement>>,
}

impl Pane {
    /// Opens a window by title, place and size (logical pixels), on a device or a new one.
    pub fn open(
        events: &ActiveEventLoop,
        (title, [x, y], [width, height]): (&str, [u32; 2], [u32; 2]),
        device: Option<RenderState>,
    ) -> anyhow::Result<Self> {
        let attributes = Window::default_attributes()
            .with_title(title)
            .with_position(LogicalPosition::new(x, y))
            .with_inner_size(LogicalSize::new(width, height));
        let window = Arc::new(events.create_window(attributes).context("opening a window")?);
        let context = egui::Context::default();
        context.set_theme(egui::Theme::Dark);
        let painter = pollster::block_on(painter(events, &context, &window, device)).context("drawing in a window")?;
        let scale = Some(window.scale_factor() as f32);
        let input =
            egui_winit::State::new(context.clone(), ViewportId::ROOT, &window, scale, None, painter.max_texture_side());
        Ok(Self { window, context, input, painter, windowed: Cell::new(None) })
    }

    /// The device, for other windows.
    pub fn device(&self) -> Option<RenderState> {
        self.painter.render_state()
    }

    /// Which window it is.
    pub fn id(&self) -> WindowId {
        self.window.id()
    }

    /// Fills the monitor that the window is on, or goes back to its size.
    pub fn toggle_full_screen(&self) {
        let full = self.window.fullscreen().is_none();
        if full {
            self.windowed.set(self.placement());
        }
        self.window.set_fullscreen(full.then_some(Fullscreen::Borderless(None)));
    }

    /// Goes to the next monitor, in the order in which the system names them.
    pub fn to_next_monitor(&self) {
        let monitors: Vec<_> = self.window.available_monitors().collect();
        let here = self.window.current_monitor();
        let at = monitors.iter().position(|monitor| Some(monitor) == here.as_ref()).unwrap_or(0);
        let Some(next) = monitors.get((at + 1) % monitors.len().max(1)) else { return };
        self.window.set_outer_position(next.position());
        if let (true, Some(windowed)) = (self.window.fullscreen().is_some(), self.windowed.get()) {
            self.windowed.set(Some(Placement { position: next.position().into(), ..windowed }));
        }
        if self.window.fullscreen().is_some() {
            self.window.set_fullscreen(Some(Fullscreen::Borderless(Some(next.clone()))));
        }
    }

    /// Covers all monitors, which stand in a row, or goes back to its place.
    pub fn span_monitors(&self) {
        if !self.window.is_decorated() {
            self.window.set_decorations(true);
            self.windowed.take().iter().for_each(|placement| self.place(placement));
            return;
        }
        self.windowed.set(self.placement());
        let corners = self.window.available_monitors().map(|monitor| (monitor.position(), monitor.size()));
        let corners: Vec<_> = corners.collect();
        let left = corners.iter().map(|(at, _)| at.x).min().unwrap_or(0);
        let top = corners.iter().map(|(at, _)| at.y).min().unwrap_or(0);
        let right = corners.iter().map(|(at, size)| at.x + size.width as i32).max().unwrap_or(0);
        let height = corners.iter().map(|(_, size)| size.height).min().unwrap_or(0);
        if right > left && height > 0 {
            self.window.set_decorations(false);
            self.window.set_outer_position(PhysicalPosition::new(left, top));
            let _ = self.window.request_inner_size(PhysicalSize::new((right - left) as u32, height));
        }
    }

    /// Goes where it was.
    pub fn place(&self, placement: &Placement) {
        let Placement { position: [x, y], size: [width, height], full_screen } = *placement;
        let is_seen = |at: PhysicalPosition<i32>, size: PhysicalSize<u32>| {
            let overlaps = |at: i32, side: u32, from: i32, length: u32| {
                from < at + side as i32 && at < from.saturating_add(length as i32)
            };
            overlaps(at.x, size.width, x, width) && overlaps(at.y, size.height, y, height)
        };
        // A monitor that is gone must not take the window with it.
        if !self.window.available_monitors().any(|monitor| is_seen(monitor.position(), monitor.size())) {
            return;
        }
        self.window.set_outer_position(PhysicalPosition::new(x, y));
        // The answer is an event like any other.
        let _ = self.window.request_inner_size(PhysicalSize::new(width, height));
        if full_screen {
            self.windowed.set(Some(*placement));
            self.window.set_fullscreen(Some(Fullscreen::Borderless(None)));
        }
    }

    /// Where it is; unknown where the system does not say.
    pub fn placement(&self) -> Option<Placement> {
        let full_screen = self.window.fullscreen().is_some();
        if let (true, Some(windowed)) = (full_screen, self.windowed.get()) {
            return Some(Placement { full_screen, ..windowed });
        }
        let (position, size) = (self.window.outer_position().ok()?, self.window.inner_size());
        Some(Placement { position: position.into(), size: size.into(), full_screen })
    }

    /// Asks for a new picture, as soon as the event loop comes to it.
    pub fn redraw(&self) {
        self.window.request_redraw();
    }

    /// Takes note of anything but keys.
    pub fn event(&mut self, event: &WindowEvent) {
        if let WindowEvent::Resized(size) = event
            && let (Some(width), Some(height)) = (NonZeroU32::new(size.width), NonZeroU32::new(size.height))
        {
            self.painter.on_window_resized(ViewportId::ROOT, width, height);
        }
        if self.input.on_window_event(&self.window, event).repaint {
            self.redraw();
        }
    }

    /// Paints the window; the picture is on its way to the screen afterwards.
    pub fn paint(&mut self, draw: impl FnMut(&mut egui::Ui)) {
        let input = self.input.take_egui_input(&self.window);
        let mut output = self.context.run_ui(input, draw);
        self.input.handle_platform_output(&self.window, output.platform_output);
        let shapes = self.context.tessellate(output.shapes, output.pixels_per_point);
        let scale = output.pixels_per_point;
        let textures = &mut output.textures_delta;
        self.painter.paint_and_update_textures(
            ViewportId::ROOT,
            scale,
            GROUND,
            &shapes,
            textures,
            vec![],
            &self.window,
        );
        textures.clear();
    }
}

/// Three monitors side by side may be wider than what every adapter has to offer.
fn as_large_as_it_gets(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    let limits = wgpu::Limits::default().using_resolution(adapter.limits());
    wgpu::DeviceDescriptor { label: Some("windows"), required_limits: limits, ..Default::default() }
}

async fn painter(
    events: &ActiveEventLoop,
    context: &egui::Context,
    window: &Arc<Window>,
    device: Option<RenderState>,
) -> Result<Painter, egui_wgpu::WgpuError> {
    let wgpu_setup = match device {
        Some(RenderState { instance, adapter, device, queue, .. }) => {
            WgpuSetup::Existing(WgpuSetupExisting { instance, adapter, device, queue })
        }
        None => {
            let mut setup = WgpuSetupCreateNew::from_display_handle(events.owned_display_handle());
            setup.device_descriptor = Arc::new(as_large_as_it_gets);
            // It is for pictures without a window, where it is asked for.
            setup.instance_descriptor.backends.remove(wgpu::Backends::GL);
            WgpuSetup::CreateNew(setup)
        }
    };
    let config = WgpuConfiguration { surface: SURFACE, wgpu_setup, ..Default::default() };
    let mut painter = Painter::new(
        context.clone(),
        config,
        false,
        RendererOptions { dithering: false, ..RendererOptions::default() },
    )
    .await;
    painter.set_window(ViewportId::ROOT, Some(window.clone())).await?;
    painter.render_state().iter().for_each(blit::install);
    Ok(painter)
}

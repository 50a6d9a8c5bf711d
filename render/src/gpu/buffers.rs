//! Buffers that are written each frame.

use bytemuck::{Pod, Zeroable};
use kernel::SceneSnapshot;
use kernel::weather::Water;

use super::Gpu;
use crate::light::Light;
use crate::light_map::LightMap;
use crate::shadow_box::ShadowBox;
use crate::view::View;
use crate::{clouds, rain, wind};

/// The uniform block of `scene.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct SceneUniform {
    eye: [f32; 3],
    wind_phase: f32,
    right: [f32; 3],
    wind_m: f32,
    up: [f32; 3],
    cloudiness: f32,
    ahead: [f32; 3],
    exposure: f32,
    sun: [f32; 3],
    shadow_texel: f32,
    sun_light: [f32; 3],
    sky_drift_x: f32,
    sky_light: [f32; 3],
    sky_drift_y: f32,
    ground_light: [f32; 3],
    shadow_at_x: f32,
    horizon: [f32; 3],
    shadow_at_y: f32,
    zenith: [f32; 3],
    fog_from_m: f32,
    shadow: [[f32; 4]; 4],
    fog: [f32; 3],
    fog_per_m: f32,
    rain_streak: [f32; 3],
    rain_fall: f32,
    wet: f32,
    puddles: f32,
    pixel_rad: f32,
    leaf_bias: f32,
    street: [f32; 3],
    window: f32,
    headlight: [f32; 3],
    windows_lit: f32,
    afterglow: [f32; 3],
    shine: f32,
    light_map_at: [f32; 2],
    light_map_per_m: f32,
    light_map_height: f32,
}

impl SceneUniform {
    pub(crate) fn new(view: &View, scene: &SceneSnapshot, light: &Light) -> Self {
        let weather = &scene.weather;
        let water = Water::of(weather);
        let drift = clouds::drift(scene.tick);
        Self {
            eye: view.eye.to_array(),
            wind_phase: wind::phase_rad(scene.tick),
            right: (view.right / view.tan_x).to_array(),
            wind_m: wind::strength_m(weather),
            up: (view.up / view.tan_y).to_array(),
            cloudiness: 0.01 * weather.cloudiness_pct,
            ahead: view.ahead.to_array(),
            exposure: light.exposure,
            sun: light.sun.to_array(),
            sun_light: light.sun_light.to_array(),
            sky_drift_x: drift.x,
            sky_light: light.sky_light.to_array(),
            sky_drift_y: drift.y,
            ground_light: light.ground_light.to_array(),
            horizon: light.horizon.to_array(),
            zenith: light.zenith.to_array(),
            fog_from_m: weather.fog_distance_m,
            fog: light.fog.to_array(),
            fog_per_m: weather.fog_extinction_per_m(),
            rain_streak: rain::streak_m(weather).to_array(),
            rain_fall: rain::fall_m(scene.tick),
            wet: water.wet,
            puddles: water.level,
            pixel_rad: 1.0 / view.pixels_per_m,
            leaf_bias: 0.0,
            ..Self::zeroed()
        }
    }

    /// The same with shadows of a box of a map with such texels.
    pub(crate) fn shaded(self, shadow: &ShadowBox, shadow_texel: f32) -> Self {
        let [shadow_at_x, shadow_at_y] = shadow.corner().to_array();
        Self { shadow: shadow.matrix().to_cols_array_2d(), shadow_at_x, shadow_at_y, shadow_texel, ..self }
    }

    /// The same for so many samples a pixel along each axis. Labels are those of pixels' middles however many there are, so leaves are
    /// those of pixels.
    pub(crate) fn sampled(self, samples: u32) -> Self {
        Self { leaf_bias: (samples as f32).log2(), ..self }
    }

    /// The same with lamps that shine, if they do.
    pub(crate) fn lit(self, light: &Light, map: &LightMap) -> Self {
        let Some(lamps) = light.lamps else { return self };
        let [street, headlight] = map.lights(&lamps).map(|lit| (lit / light.sky_light).to_array());
        let per_m = LightMap::PER_M;
        let [x, y, z] = self.eye;
        Self {
            street,
            headlight,
            window: lamps.window,
            windows_lit: lamps.windows_lit,
            afterglow: lamps.afterglow.to_array(),
            shine: lamps.shine,
            light_map_at: [(x - map.corner.x) * per_m, (y - map.corner.y) * per_m],
            light_map_per_m: per_m,
            light_map_height: z - map.lowest_m(),
            ..self
        }
    }
}

/// A buffer that is made anew, twice as large, when its content outgrows it.
pub(crate) struct GrowingBuffer {
    pub(crate) buffer: wgpu::Buffer,
    usage: wgpu::BufferUsages,
}

impl GrowingBuffer {
    pub(crate) fn new(gpu: &Gpu, usage: wgpu::BufferUsages) -> Self {
        Self { buffer: make(gpu, usage, 1 << 16), usage }
    }

    pub(crate) fn write<T: Pod>(&mut self, gpu: &Gpu, content: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(content);
        if bytes.is_empty() {
            return;
        }
        if bytes.len() as u64 > self.buffer.size() {
            self.buffer = make(gpu, self.usage, (bytes.len() as u64).next_power_of_two());
        }
        gpu.queue.write_buffer(&self.buffer, 0, bytes);
    }
}

fn make(gpu: &Gpu, usage: wgpu::BufferUsages, size: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

//! The pipelines of a frame.

use super::targets::{COLOUR, DEPTH, IDS};
use super::{Gpu, shaders};
use crate::SemanticTag;
use crate::glows::Glow;
use crate::mesh::{FINISHES, Finish, Vertex};
use crate::mirrors::Streak;
use crate::spray::Puff;

/// Bind group layouts that the pipelines share.
pub(super) struct Layouts {
    /// Scene uniform, noise and its sampler, map of lamps' light, textures of ground, leaves.
    pub(super) scene: wgpu::BindGroupLayout,
    /// Shadow map and its sampler.
    pub(super) shadow: wgpu::BindGroupLayout,
    /// From the world to a shadow map, one of several.
    pub(super) clip: wgpu::BindGroupLayout,
    /// A shadow map to copy from.
    pub(super) still: wgpu::BindGroupLayout,
    /// Depths that are known.
    pub(super) known: wgpu::BindGroupLayout,
}

/// Which light there is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lighting {
    /// That of the sky.
    Day,
    /// That of the sky and of lamps.
    Dusk,
    /// The same without any of the sun's.
    Night,
}

/// The pipelines of a frame.
pub(super) struct Pipelines {
    /// One for each [`crate::mesh::Finish`].
    pub(super) world: [wgpu::RenderPipeline; FINISHES],
    pub(super) sky: wgpu::RenderPipeline,
    pub(super) rain: wgpu::RenderPipeline,
    pub(super) glow: wgpu::RenderPipeline,
    pub(super) mirror: wgpu::RenderPipeline,
    pub(super) spray: wgpu::RenderPipeline,
    /// Fills in depths that are known.
    pub(super) known: wgpu::RenderPipeline,
}

/// The pipelines of shadow maps.
pub(super) struct ShadowPipelines {
    pub(super) cast: wgpu::RenderPipeline,
    pub(super) clear: wgpu::RenderPipeline,
    pub(super) copy: wgpu::RenderPipeline,
}

impl Layouts {
    pub(super) fn new(gpu: &Gpu) -> Self {
        use wgpu::{BindingType as T, SamplerBindingType as S, TextureSampleType as K};
        let ty = wgpu::BufferBindingType::Uniform;
        let [uniform, one_of_several] =
            [false, true].map(|has_dynamic_offset| T::Buffer { ty, has_dynamic_offset, min_binding_size: None });
        use wgpu::TextureViewDimension::{D2, D2Array};
        let texture = |sample_type, view_dimension| T::Texture { sample_type, view_dimension, multisampled: false };
        let colours = K::Float { filterable: true };
        let [noise, layers] = [D2, D2Array].map(|dimension| texture(colours, dimension));
        Self {
            scene: layout(gpu, &[uniform, noise, T::Sampler(S::Filtering), noise, layers, layers]),
            shadow: layout(gpu, &[texture(K::Depth, D2), T::Sampler(S::Comparison)]),
            clip: layout(gpu, &[one_of_several]),
            still: layout(gpu, &[texture(K::Depth, D2)]),
            known: layout(gpu, &[texture(K::Float { filterable: false }, D2)]),
        }
    }
}

fn layout(gpu: &Gpu, types: &[wgpu::BindingType]) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = (0..)
        .zip(types)
        .map(|(binding, &ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty,
            count: None,
        })
        .collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

/// What sets one pipeline apart from another.
struct Recipe<'a> {
    module: &'a wgpu::ShaderModule,
    layout: &'a wgpu::PipelineLayout,
    vertex: &'a str,
    fragment: Option<&'a str>,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    targets: &'a [Option<wgpu::ColorTargetState>],
    constants: &'a [(&'a str, f64)],
    cull: bool,
    depth_write: bool,
    depth_compare: wgpu::CompareFunction,
    bias: wgpu::DepthBiasState,
}

impl Recipe<'_> {
    fn make(&self, gpu: &Gpu) -> wgpu::RenderPipeline {
        let compilation_options = wgpu::PipelineCompilationOptions { constants: self.constants, ..Default::default() };
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.vertex),
            layout: Some(self.layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(self.vertex),
                compilation_options: compilation_options.clone(),
                buffers: self.buffers,
            },
            primitive: wgpu::PrimitiveState { cull_mode: self.cull.then_some(wgpu::Face::Back), ..Default::default() },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(self.depth_write),
                depth_compare: Some(self.depth_compare),
                stencil: Default::default(),
                bias: self.bias,
            }),
            multisample: Default::default(),
            fragment: self.fragment.map(|entry| wgpu::FragmentState {
                module: self.module,
                entry_point: Some(entry),
                compilation_options,
                targets: self.targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// The pipelines that draw classes and instances, and no colours, one for each [`crate::mesh::Finish`].
pub(super) fn classes(gpu: &Gpu, layouts: &Layouts) -> [wgpu::RenderPipeline; FINISHES] {
    let base = Recipe {
        module: &module(gpu, "classes"),
        layout: &pipeline_layout(gpu, &[Some(&layouts.scene)]),
        vertex: "vertex",
        fragment: Some("fragment"),
        buffers: &[Some(world_vertices())],
        targets: &[None, Some(IDS.into())],
        constants: &[],
        cull: true,
        depth_write: true,
        depth_compare: wgpu::CompareFunction::Greater,
        bias: Default::default(),
    };
    let opaque = base.make(gpu);
    let leafy = Recipe { vertex: "vertex_leafy", fragment: Some("fragment_leafy"), ..base }.make(gpu);
    Finish::ALL.map(|finish| if finish.has_holes() { &leafy } else { &opaque }.clone())
}

fn module(gpu: &Gpu, name: &str) -> wgpu::ShaderModule {
    let text = shaders::source(name).unwrap_or_default();
    gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("shader"),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    })
}

fn pipeline_layout(gpu: &Gpu, groups: &[Option<&wgpu::BindGroupLayout>]) -> wgpu::PipelineLayout {
    gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: groups,
        immediate_size: 0,
    })
}

impl Pipelines {
    /// `shadow_taps`: samples of the shadow map along each axis; `weather`: whether there is fog, water or rain.
    pub(super) fn new(gpu: &Gpu, layouts: &Layouts, shadow_taps: u32, (weather, lighting): (bool, Lighting)) -> Self {
        let flag = |name: &'static str, is_so: bool| (name, f64::from(u8::from(is_so)));
        let weather = flag("WEATHER", weather);
        let night = flag("NIGHT", lighting != Lighting::Day);
        let sun = flag("SUN", lighting != Lighting::Night);
        let scene_only = pipeline_layout(gpu, &[Some(&layouts.scene)]);
        let with_shadow = pipeline_layout(gpu, &[Some(&layouts.scene), Some(&layouts.shadow)]);
        let [world, sky, rain] = ["world", "sky", "rain"].map(|name| module(gpu, name));
        let [glow, mirror, spray] = ["glow", "mirror", "spray"].map(|name| module(gpu, name));
        let opaque = [Some(COLOUR.into()), Some(IDS.into())];
        let base = Recipe {
            module: &world,
            layout: &with_shadow,
            vertex: "vertex",
            fragment: None,
            buffers: &[Some(world_vertices())],
            targets: &opaque,
            constants: &[("SHADOW_TAPS", f64::from(shadow_taps)), weather, night, sun],
            cull: true,
            depth_write: true,
            depth_compare: wgpu::CompareFunction::Greater,
            bias: Default::default(),
        };
        let shining = Recipe {
            layout: &scene_only,
            fragment: Some("fragment"),
            targets: &[Some(brightening()), Some(unwritten(IDS))],
            constants: &[],
            cull: false,
            depth_write: false,
            ..base
        };
        let veil = Recipe { targets: &[Some(covering()), Some(unwritten(IDS))], constants: &[night], ..shining };
        let finishes = [
            ("vertex_plain", "fragment_plain"),
            ("vertex", "fragment_grainy"),
            ("vertex_facade", "fragment_facade"),
            ("vertex", "fragment_asphalt"),
            ("vertex", "fragment_paving"),
            ("vertex", "fragment_grass"),
            ("vertex_leafy", "fragment_leafy"),
        ];
        Self {
            world: finishes.map(|(vertex, fragment)| Recipe { vertex, fragment: Some(fragment), ..base }.make(gpu)),
            sky: Recipe {
                module: &sky,
                layout: &scene_only,
                fragment: Some("fragment"),
                buffers: &[],
                constants: &[("SKY_TAG", f64::from(SemanticTag::Sky as u8)), weather, night],
                depth_write: false,
                depth_compare: wgpu::CompareFunction::Equal,
                ..base
            }
            .make(gpu),
            known: Recipe {
                module: &module(gpu, "known"),
                layout: &pipeline_layout(gpu, &[Some(&layouts.known)]),
                fragment: Some("fragment"),
                buffers: &[],
                targets: &[Some(unwritten(COLOUR)), Some(unwritten(IDS))],
                constants: &[],
                depth_compare: wgpu::CompareFunction::Always,
                ..base
            }
            .make(gpu),
            rain: Recipe { module: &rain, buffers: &[], ..veil }.make(gpu),
            spray: Recipe { module: &spray, buffers: &[Some(puff_instances())], ..veil }.make(gpu),
            glow: Recipe { module: &glow, buffers: &[Some(glow_instances())], constants: &[weather], ..shining }
                .make(gpu),
            mirror: Recipe { module: &mirror, buffers: &[Some(streak_instances())], ..shining }.make(gpu),
        }
    }
}

impl ShadowPipelines {
    pub(super) fn new(gpu: &Gpu, layouts: &Layouts) -> Self {
        let cast = Recipe {
            module: &module(gpu, "shadow"),
            layout: &pipeline_layout(gpu, &[Some(&layouts.clip)]),
            vertex: "vertex",
            fragment: None,
            buffers: &[Some(world_vertices())],
            targets: &[],
            constants: &[],
            cull: false,
            depth_write: true,
            depth_compare: wgpu::CompareFunction::Less,
            bias: wgpu::DepthBiasState { constant: 1, slope_scale: 2.0, clamp: 0.0 },
        };
        let copy = Recipe {
            module: &module(gpu, "shadow_copy"),
            layout: &pipeline_layout(gpu, &[Some(&layouts.still)]),
            fragment: Some("copied"),
            buffers: &[],
            depth_compare: wgpu::CompareFunction::Always,
            bias: Default::default(),
            ..cast
        };
        let clear = Recipe { layout: &pipeline_layout(gpu, &[]), fragment: None, ..copy };
        Self { cast: cast.make(gpu), clear: clear.make(gpu), copy: copy.make(gpu) }
    }
}

fn world_vertices() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 5] =
        wgpu::vertex_attr_array![0 => Float32x3, 1 => Snorm8x4, 2 => Unorm8x4, 3 => Uint32, 4 => Float32x2];
    wgpu::VertexBufferLayout {
        array_stride: size_of::<Vertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &ATTRIBUTES,
    }
}

fn glow_instances() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 3] =
        wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32, 2 => Float32x3];
    instances::<Glow>(&ATTRIBUTES)
}

fn puff_instances() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 3] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32, 2 => Float32];
    instances::<Puff>(&ATTRIBUTES)
}

fn streak_instances() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 5] =
        wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32, 2 => Float32x3, 3 => Float32, 4 => Float32x3];
    instances::<Streak>(&ATTRIBUTES)
}

/// One of a type for each time that something is drawn.
fn instances<T>(attributes: &'static [wgpu::VertexAttribute]) -> wgpu::VertexBufferLayout<'static> {
    let step_mode = wgpu::VertexStepMode::Instance;
    wgpu::VertexBufferLayout { array_stride: size_of::<T>() as u64, step_mode, attributes }
}

/// What comes is added to what is there, the less the brighter that is.
fn brightening() -> wgpu::ColorTargetState {
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::OneMinusDst,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    let blend = Some(wgpu::BlendState { color: add, alpha: add });
    wgpu::ColorTargetState { format: COLOUR, blend, write_mask: wgpu::ColorWrites::COLOR }
}

/// What comes, as far as its alpha says, over what is there.
fn covering() -> wgpu::ColorTargetState {
    let blend = Some(wgpu::BlendState::ALPHA_BLENDING);
    wgpu::ColorTargetState { format: COLOUR, blend, write_mask: wgpu::ColorWrites::COLOR }
}

fn unwritten(format: wgpu::TextureFormat) -> wgpu::ColorTargetState {
    wgpu::ColorTargetState { format, blend: None, write_mask: wgpu::ColorWrites::empty() }
}

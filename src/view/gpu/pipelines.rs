//! The shaders made ready, pass by pass.

use super::device::Gpu;
use crate::view::pins::FLOATS;
use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, BlendState, BufferBindingType,
    ColorTargetState, ColorWrites, CompareFunction, DepthStencilState, FragmentState, MultisampleState,
    PipelineLayoutDescriptor, PrimitiveState, PrimitiveTopology, RenderPipeline, RenderPipelineDescriptor,
    SamplerBindingType, ShaderModule, ShaderModuleDescriptor, ShaderSource, ShaderStages, TextureFormat,
    TextureSampleType, TextureViewDimension, VertexBufferLayout, VertexState, VertexStepMode, vertex_attr_array,
};

/// Format of depth textures.
pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// Format of everything that is computed on the way: every device can draw to it.
pub const DATA: TextureFormat = TextureFormat::Rgba8Unorm;
/// Format of shapes: bits of a position and a packed normal.
pub const SHAPE: TextureFormat = TextureFormat::Rgba32Uint;
/// Samples a pixel in the picture.
pub const SAMPLES: u32 = 4;

/// Layouts of the bind groups.
pub struct Layouts {
    /// Group 0 everywhere: the frame.
    pub frame: BindGroupLayout,
    /// Group 1 where the surface is drawn: its textures.
    pub mesh: BindGroupLayout,
    /// Group 2 of the picture: shadows.
    pub shade: BindGroupLayout,
    /// Group 1 of the filters: the picture they read.
    pub source: BindGroupLayout,
    /// Group 1 where a skin moves the vertices.
    pub skin: BindGroupLayout,
}

/// Every pass.
pub struct Pipelines {
    /// Layouts of what they read.
    pub layouts: Layouts,
    /// Depth as the key light sees it.
    pub shadow: RenderPipeline,
    /// Heights over the ground.
    pub ground: RenderPipeline,
    /// Depth and normals.
    pub depth: RenderPipeline,
    /// The surface in the picture.
    pub picture: RenderPipeline,
    /// The ground and all that is around.
    pub studio: RenderPipeline,
    /// The ground map blurred in one direction and the other.
    pub spread: [RenderPipeline; 2],
    /// Shade in hollows, and its blur.
    pub hollow: [RenderPipeline; 2],
    /// Vertices moved by a skin.
    pub skin: RenderPipeline,
    /// Pins that shine through the surface, and pins.
    pub pins: [RenderPipeline; 2],
}

/// What one pass is made of.
struct Pass<'a> {
    module: &'a ShaderModule,
    groups: &'a [Option<&'a BindGroupLayout>],
    vertex: &'a str,
    fragment: Option<(&'a str, TextureFormat)>,
    depth: Option<CompareFunction>,
    samples: u32,
    /// Whether quads are drawn, an instance each, that mix with what is below.
    quads: bool,
}

impl Pipelines {
    /// Makes all of them.
    pub fn new(gpu: &Gpu) -> Self {
        let layouts = Layouts::new(gpu);
        let module = |source: &str| {
            gpu.device.create_shader_module(ShaderModuleDescriptor {
                label: None,
                source: ShaderSource::Wgsl([include_str!("stage.wgsl"), source].concat().into()),
            })
        };
        let mesh = module(include_str!("mesh.wgsl"));
        let filters = module(include_str!("filters.wgsl"));
        let skin = module(include_str!("skin.wgsl"));
        let pins = module(include_str!("pins.wgsl"));
        let (frame, surface, shade, source) =
            (Some(&layouts.frame), Some(&layouts.mesh), Some(&layouts.shade), Some(&layouts.source));
        let drawn = |vertex, fragment| {
            let (module, groups, depth) = (&mesh, &[frame, surface][..], Some(CompareFunction::Less));
            pipeline(gpu, &Pass { module, groups, vertex, fragment, depth, samples: 1, quads: false })
        };
        let seen = |vertex, fragment, depth| {
            let (module, groups) = (&mesh, &[frame, surface, shade][..]);
            let fragment = Some((fragment, gpu.format));
            pipeline(
                gpu,
                &Pass { module, groups, vertex, fragment, depth: Some(depth), samples: SAMPLES, quads: false },
            )
        };
        let filter = |fragment, groups: &[_]| {
            let module = &filters;
            let fragment = Some((fragment, DATA));
            pipeline(gpu, &Pass { module, groups, vertex: "screen", fragment, depth: None, samples: 1, quads: false })
        };
        let skinned = Pass {
            module: &skin,
            groups: &[frame, Some(&layouts.skin)],
            vertex: "everywhere",
            fragment: Some(("skinned", SHAPE)),
            depth: None,
            samples: 1,
            quads: false,
        };
        let pin = |fragment| {
            let (module, groups, fragment) = (&pins, &[frame][..], Some((fragment, gpu.format)));
            // Whether the surface hides them is known already.
            let depth = Some(CompareFunction::Always);
            pipeline(
                gpu,
                &Pass { module, groups, vertex: "pin_vertex", fragment, depth, samples: SAMPLES, quads: true },
            )
        };
        Self {
            skin: pipeline(gpu, &skinned),
            pins: [pin("ghost_fragment"), pin("pin_fragment")],
            shadow: drawn("shadow_vertex", None),
            ground: drawn("ground_vertex", Some(("ground_fragment", DATA))),
            depth: drawn("depth_vertex", Some(("depth_fragment", DATA))),
            picture: seen("picture_vertex", "picture_fragment", CompareFunction::Less),
            studio: seen("screen", "studio_fragment", CompareFunction::Always),
            spread: [filter("spread_across", &[frame, source]), filter("spread_down", &[frame, source])],
            hollow: [filter("hollow", &[frame, source, shade]), filter("hollow_blur", &[frame, source])],
            layouts,
        }
    }
}

impl Layouts {
    fn new(gpu: &Gpu) -> Self {
        let layout = |entries: &[(ShaderStages, BindingType)]| {
            let entries: Vec<BindGroupLayoutEntry> = entries
                .iter()
                .enumerate()
                .map(|(i, &(visibility, ty))| BindGroupLayoutEntry { binding: i as u32, visibility, ty, count: None })
                .collect();
            gpu.device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: None, entries: &entries })
        };
        let texture = |sample_type| BindingType::Texture {
            sample_type,
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        };
        let uniform =
            BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None };
        let words = (ShaderStages::VERTEX, texture(TextureSampleType::Uint));
        let in_fragment = |ty| (ShaderStages::FRAGMENT, ty);
        let smooth = texture(TextureSampleType::Float { filterable: true });
        let exact = texture(TextureSampleType::Float { filterable: false });
        Self {
            frame: layout(&[(ShaderStages::VERTEX_FRAGMENT, uniform)]),
            mesh: layout(&[words, words, words, words, in_fragment(exact)]),
            shade: layout(&[
                in_fragment(texture(TextureSampleType::Depth)),
                in_fragment(BindingType::Sampler(SamplerBindingType::Comparison)),
                in_fragment(smooth),
                in_fragment(BindingType::Sampler(SamplerBindingType::Filtering)),
                in_fragment(exact),
            ]),
            source: layout(&[in_fragment(exact)]),
            skin: layout(&[
                in_fragment(texture(TextureSampleType::Uint)),
                in_fragment(texture(TextureSampleType::Uint)),
                in_fragment(exact),
            ]),
        }
    }
}

fn pipeline(gpu: &Gpu, pass: &Pass) -> RenderPipeline {
    let layout = gpu.device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: pass.groups,
        immediate_size: 0,
    });
    let blend = pass.quads.then_some(BlendState::PREMULTIPLIED_ALPHA_BLENDING);
    let targets =
        pass.fragment.map(|(_, format)| [Some(ColorTargetState { format, blend, write_mask: ColorWrites::ALL })]);
    let topology = if pass.quads { PrimitiveTopology::TriangleStrip } else { PrimitiveTopology::TriangleList };
    let instances = Some(VertexBufferLayout {
        array_stride: 4 * FLOATS as u64,
        step_mode: VertexStepMode::Instance,
        attributes: &vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4],
    });
    gpu.device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some(pass.fragment.map_or(pass.vertex, |f| f.0)),
        layout: Some(&layout),
        vertex: VertexState {
            module: pass.module,
            entry_point: Some(pass.vertex),
            compilation_options: Default::default(),
            buffers: if pass.quads { std::slice::from_ref(&instances) } else { &[] },
        },
        primitive: PrimitiveState { topology, ..Default::default() },
        depth_stencil: pass.depth.map(|compare| DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(compare == CompareFunction::Less),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: MultisampleState { count: pass.samples, ..Default::default() },
        fragment: pass.fragment.zip(targets.as_ref()).map(|((entry, _), targets)| FragmentState {
            module: pass.module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

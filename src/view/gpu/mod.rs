//! The GPU's side of drawing, for WebGPU and WebGL 2 alike.
//!
//! A frame is drawn in six small passes, after one that moves the vertices where a skin does. The surface is drawn as the key light sees it (a shadow map), from under
//! the ground (which gives, blurred, the soft shadow that it stands on), and as depth and normals at half the
//! resolution (which give the shade in hollows and, with the shadow map, the light that arrives). Then comes the picture itself,
//! with the pins on it. All that lies between passes is
//! eight bits a channel, which every device can draw to.

pub mod device;
pub mod pins;
pub mod pipelines;
pub mod skin;
pub mod textures;

use crate::view::frame::{FLOATS, Frame};
use crate::view::pins as view_pins;
use crate::view::skin::{Map, Skin};
use crate::view::surface::Surface;
use device::Gpu;
use glam::Vec3;
use pins::PinsOnDevice;
use pipelines::{DATA, DEPTH, Pipelines, SAMPLES};
use skin::SkinOnDevice;
use textures::MeshTextures;
use wgpu::{
    AddressMode, BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindingResource, Buffer,
    BufferDescriptor, BufferUsages, Color, CommandEncoder, CompareFunction, Extent3d, FilterMode, LoadOp, Operations,
    RenderPass, RenderPassColorAttachment, RenderPassDepthStencilAttachment, RenderPassDescriptor, RenderPipeline,
    Sampler, SamplerDescriptor, StoreOp, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages,
    TextureView,
};

/// Side of the shadow map, pixels: small, because its edges are wanted soft.
const SHADOW_SIDE: u32 = 512;
/// Side of the ground map, pixels.
const GROUND_SIDE: u32 = 160;

/// Draws frames.
pub struct Renderer {
    gpu: Gpu,
    pipelines: Pipelines,
    uniform: Buffer,
    frame_group: BindGroup,
    samplers: [Sampler; 2],
    fixed: FixedTargets,
    sized: Option<SizedTargets>,
    mesh: Option<Mesh>,
    pins: PinsOnDevice,
    /// Bytes that moved the vertices of the last frame.
    moved: usize,
}

/// The surface on the device.
struct Mesh {
    textures: MeshTextures,
    /// With the first shape as the earlier and with the second.
    groups: [BindGroup; 2],
    faces: u32,
    /// Which of the two is the earlier.
    earlier: usize,
    /// The first shape as a target, the second as a source.
    views: [TextureView; 2],
    skin: Option<SkinOnDevice>,
}

/// What does not depend on the size of the picture.
struct FixedTargets {
    shadow: TextureView,
    ground: [TextureView; 2],
    ground_depth: TextureView,
    spread: [BindGroup; 2],
}

/// What depends on the size of the picture.
struct SizedTargets {
    size: (u32, u32),
    colour: TextureView,
    depth: TextureView,
    deep: TextureView,
    deep_depth: TextureView,
    hollow: [TextureView; 2],
    hollow_groups: [BindGroup; 2],
    shade: BindGroup,
}

impl Renderer {
    /// Makes everything ready on a device.
    pub fn new(gpu: Gpu) -> Self {
        let pipelines = Pipelines::new(&gpu);
        let uniform = gpu.device.create_buffer(&BufferDescriptor {
            label: None,
            size: 4 * FLOATS as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let frame_group = group(&gpu, &pipelines.layouts.frame, &[uniform.as_entire_binding()]);
        let sampler = |compare| {
            gpu.device.create_sampler(&SamplerDescriptor {
                address_mode_u: AddressMode::ClampToEdge,
                address_mode_v: AddressMode::ClampToEdge,
                mag_filter: FilterMode::Linear,
                min_filter: FilterMode::Linear,
                compare,
                ..Default::default()
            })
        };
        let samplers = [sampler(Some(CompareFunction::LessEqual)), sampler(None)];
        let fixed = FixedTargets::new(&gpu, &pipelines.layouts.source);
        let pins = PinsOnDevice::new(&gpu);
        Self { gpu, pipelines, uniform, frame_group, samplers, fixed, sized: None, mesh: None, pins, moved: 0 }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Sets the size of the picture, device pixels.
    pub fn resize(&mut self, width: u32, height: u32) {
        self.gpu.resize(width, height);
    }

    /// Puts another surface on the stage. The error is a sentence, and the old surface stays.
    pub fn set_surface(&mut self, surface: &Surface) -> Result<(), &'static str> {
        let textures = MeshTextures::new(&self.gpu, surface)?;
        let view = |t: &wgpu::Texture| t.create_view(&Default::default());
        let (faces, paints, table) = (view(&textures.faces), view(&textures.paints), view(&textures.table));
        let shapes = [view(&textures.shapes[0]), view(&textures.shapes[1])];
        let groups = [[0, 1], [1, 0]].map(|[a, b]: [usize; 2]| {
            let views = [&faces, &paints, &shapes[a], &shapes[b], &table].map(BindingResource::TextureView);
            group(&self.gpu, &self.pipelines.layouts.mesh, &views)
        });
        let faces = surface.corners.len() as u32;
        self.mesh = Some(Mesh { textures, groups, faces, earlier: 0, views: shapes, skin: None });
        Ok(())
    }

    /// Uploads a shape into one of the two places.
    pub fn write_shape(&self, which: usize, surface: &Surface, positions: &[Vec3], normals: &[u32]) {
        if let Some(mesh) = &self.mesh {
            mesh.textures.write_shape(&self.gpu, which, surface, positions, normals);
        }
    }

    /// Says which of the two places holds the earlier shape.
    pub fn set_earlier(&mut self, which: usize) {
        if let Some(mesh) = &mut self.mesh {
            mesh.earlier = which & 1;
        }
    }

    /// Uploads the paint: see [`crate::view::paint::Paint::words`] and [`crate::view::paint::Paint::table`].
    pub fn write_paint(&self, words: &[[u32; 4]], table: Option<&[[u8; 4]]>) {
        if let Some(mesh) = &self.mesh {
            mesh.textures.write_paint(&self.gpu, words, table);
        }
    }

    /// Has a skin move the shape in the second place into the first, or nothing. The error is a sentence.
    pub fn set_skin(&mut self, surface: &Surface, skin: Option<&Skin>) -> Result<(), &'static str> {
        let Some(mesh) = &mut self.mesh else { return Ok(()) };
        let make = |skin| SkinOnDevice::new(&self.gpu, &self.pipelines.layouts.skin, surface, skin, &mesh.views[1]);
        mesh.skin = skin.map(make).transpose()?;
        Ok(())
    }

    /// Uploads the pins, farthest first.
    pub fn write_pins(&mut self, pins: &[[f32; view_pins::FLOATS]]) {
        self.pins.write(&self.gpu, pins);
    }

    /// Bytes that were uploaded to move the vertices of the last frame.
    pub fn moved(&self) -> usize {
        self.moved
    }

    /// Draws a frame; whether it was drawn. `maps` move the skin, or leave it where it is if there are none.
    pub fn draw(&mut self, frame: &Frame, maps: &[Map]) -> bool {
        let Some(picture) = self.gpu.picture() else { return false };
        let Some(mesh) = &self.mesh else { return false };
        let size = (picture.texture.width(), picture.texture.height());
        if self.sized.as_ref().is_none_or(|s| s.size != size) {
            self.sized = Some(SizedTargets::new(self, size));
        }
        let Some(sized) = &self.sized else { return false };
        self.gpu.queue.write_buffer(&self.uniform, 0, bytemuck::cast_slice(&frame.floats()));
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let e = &mut encoder;
        let (p, fixed) = (&self.pipelines, &self.fixed);
        self.moved = match &mesh.skin {
            Some(skin) if !maps.is_empty() => {
                skin.move_vertices(&self.gpu, &p.skin, &self.frame_group, e, maps, &mesh.views[0])
            }
            _ => 0,
        };
        let surface = |pass: &mut RenderPass, pipeline: &RenderPipeline| {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.frame_group, &[]);
            pass.set_bind_group(1, &mesh.groups[mesh.earlier], &[]);
            if mesh.faces > 0 {
                pass.draw(0..3 * mesh.faces, 0..1);
            }
        };
        let filter = |e: &mut CommandEncoder,
                      pipeline: &RenderPipeline,
                      source: &BindGroup,
                      target: &TextureView,
                      shade: Option<&BindGroup>| {
            let mut pass = begin(e, Some((target, None, Color::TRANSPARENT)), None);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &self.frame_group, &[]);
            pass.set_bind_group(1, source, &[]);
            if let Some(shade) = shade {
                pass.set_bind_group(2, shade, &[]);
            }
            pass.draw(0..3, 0..1);
        };
        let over = Some((&fixed.ground[0], None, Color::TRANSPARENT));
        surface(&mut begin(e, over, Some((&fixed.ground_depth, StoreOp::Discard))), &p.ground);
        filter(e, &p.spread[0], &fixed.spread[0], &fixed.ground[1], None);
        filter(e, &p.spread[1], &fixed.spread[1], &fixed.ground[0], None);
        if frame.shadows() {
            surface(&mut begin(e, None, Some((&fixed.shadow, StoreOp::Store))), &p.shadow);
            let deep = Some((&sized.deep, None, Color::WHITE));
            surface(&mut begin(e, deep, Some((&sized.deep_depth, StoreOp::Discard))), &p.depth);
            filter(e, &p.hollow[0], &sized.hollow_groups[0], &sized.hollow[0], Some(&sized.shade));
            filter(e, &p.hollow[1], &sized.hollow_groups[1], &sized.hollow[1], None);
        }
        {
            let view = picture.texture.create_view(&Default::default());
            let target = Some((&sized.colour, Some(&view), Color::BLACK));
            let mut pass = begin(e, target, Some((&sized.depth, StoreOp::Discard)));
            pass.set_bind_group(2, &sized.shade, &[]);
            pass.set_bind_group(0, &self.frame_group, &[]);
            pass.set_bind_group(1, &mesh.groups[mesh.earlier], &[]);
            pass.set_pipeline(&p.studio);
            pass.draw(0..3, 0..1);
            surface(&mut pass, &p.picture);
            self.pins.draw(&mut pass, p);
        }
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.submitted();
        self.gpu.queue.present(picture);
        true
    }
}

impl FixedTargets {
    fn new(gpu: &Gpu, source: &BindGroupLayout) -> Self {
        let ground = [(); 2].map(|()| target(gpu, (GROUND_SIDE, GROUND_SIDE), DATA, 1));
        let spread = [0, 1].map(|i: usize| group(gpu, source, &[BindingResource::TextureView(&ground[i])]));
        Self {
            shadow: target(gpu, (SHADOW_SIDE, SHADOW_SIDE), DEPTH, 1),
            ground_depth: target(gpu, (GROUND_SIDE, GROUND_SIDE), DEPTH, 1),
            ground,
            spread,
        }
    }
}

impl SizedTargets {
    fn new(renderer: &Renderer, size: (u32, u32)) -> Self {
        let Renderer { gpu, pipelines, samplers, fixed, .. } = renderer;
        let half = (size.0.div_ceil(2), size.1.div_ceil(2));
        let deep = target(gpu, half, DATA, 1);
        let hollow = [(); 2].map(|()| target(gpu, half, DATA, 1));
        let source = |view| group(gpu, &pipelines.layouts.source, &[BindingResource::TextureView(view)]);
        let shade = [
            BindingResource::TextureView(&fixed.shadow),
            BindingResource::Sampler(&samplers[0]),
            BindingResource::TextureView(&fixed.ground[0]),
            BindingResource::Sampler(&samplers[1]),
            BindingResource::TextureView(&hollow[1]),
        ];
        Self {
            size,
            colour: target(gpu, size, gpu.format, SAMPLES),
            depth: target(gpu, size, DEPTH, SAMPLES),
            deep_depth: target(gpu, half, DEPTH, 1),
            hollow_groups: [source(&deep), source(&hollow[0])],
            shade: group(gpu, &pipelines.layouts.shade, &shade),
            deep,
            hollow,
        }
    }
}

/// A texture to draw to, and to read from where it has one sample a pixel.
fn target(gpu: &Gpu, size: (u32, u32), format: TextureFormat, samples: u32) -> TextureView {
    let read = if samples == 1 { TextureUsages::TEXTURE_BINDING } else { TextureUsages::empty() };
    let texture = gpu.device.create_texture(&TextureDescriptor {
        label: None,
        size: Extent3d { width: size.0, height: size.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: TextureDimension::D2,
        format,
        usage: TextureUsages::RENDER_ATTACHMENT | read,
        view_formats: &[],
    });
    texture.create_view(&Default::default())
}

/// A bind group with `resources` at 0, 1, ….
fn group(gpu: &Gpu, layout: &BindGroupLayout, resources: &[BindingResource]) -> BindGroup {
    let entries: Vec<BindGroupEntry> = resources
        .iter()
        .enumerate()
        .map(|(i, resource)| BindGroupEntry { binding: i as u32, resource: resource.clone() })
        .collect();
    gpu.device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries: &entries })
}

/// Begins a pass that clears: colour (with where to resolve it) and depth (and whether it is kept).
fn begin<'e>(
    encoder: &'e mut CommandEncoder,
    colour: Option<(&TextureView, Option<&TextureView>, Color)>,
    depth: Option<(&TextureView, StoreOp)>,
) -> RenderPass<'e> {
    let colour = colour.map(|(view, resolve_target, clear)| {
        let store = if resolve_target.is_some() { StoreOp::Discard } else { StoreOp::Store };
        [Some(RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target,
            ops: Operations { load: LoadOp::Clear(clear), store },
        })]
    });
    encoder.begin_render_pass(&RenderPassDescriptor {
        label: None,
        color_attachments: colour.as_ref().map_or(&[], |c| c),
        depth_stencil_attachment: depth.map(|(view, store)| RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(Operations { load: LoadOp::Clear(1.0), store }),
            stencil_ops: None,
        }),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

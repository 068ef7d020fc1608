//! A skin on the device: what each drawn vertex follows, the maps of the moment, and the pass that moves the vertices.

use super::device::Gpu;
use super::textures::{WIDTH, rows, texture, write_rows};
use super::{begin, group};
use crate::view::skin::{Map, Skin};
use crate::view::surface::Surface;
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, Color, CommandEncoder, RenderPipeline, Texture, TextureFormat,
    TextureUsages, TextureView,
};

/// Texels of a map.
const MAP: usize = 3;

/// A skin on the device.
pub struct SkinOnDevice {
    maps: Texture,
    group: BindGroup,
}

impl SkinOnDevice {
    /// Uploads what the drawn vertices of `surface` follow; `reference` is the shape that the maps move. The error is
    /// a sentence.
    pub fn new(
        gpu: &Gpu,
        layout: &BindGroupLayout,
        surface: &Surface,
        skin: &Skin,
        reference: &TextureView,
    ) -> Result<Self, &'static str> {
        let height = rows(surface.vertex.len());
        let blocks = skin.each().div_ceil(4);
        let map_rows = rows(MAP * skin.handles());
        if (height * blocks).max(map_rows) > gpu.longest as usize {
            return Err("This mesh has more vertices than this browser's graphics can move.");
        }
        let follows = texture(gpu, height * blocks, TextureFormat::Rgba32Uint, TextureUsages::empty());
        let maps = texture(gpu, map_rows, TextureFormat::Rgba32Float, TextureUsages::empty());
        let mut data = vec![[0_u32; 4]; blocks * height * WIDTH];
        for (drawn, &v) in surface.vertex.iter().enumerate() {
            for (k, word) in skin.words(v as usize).enumerate() {
                data[(k / 4) * height * WIDTH + drawn][k % 4] = word;
            }
        }
        write_rows(gpu, &follows, 0, WIDTH, bytemuck::cast_slice(data.as_flattened()));
        let view = |t: &Texture| t.create_view(&Default::default());
        let (follows, map_view) = (view(&follows), view(&maps));
        let resources = [reference, &follows, &map_view].map(BindingResource::TextureView);
        let group = group(gpu, layout, &resources);
        Ok(Self { maps, group })
    }

    /// Uploads the maps of a moment and moves the vertices into `target`; how many bytes were uploaded.
    pub fn move_vertices(
        &self,
        gpu: &Gpu,
        pipeline: &RenderPipeline,
        frame: &BindGroup,
        encoder: &mut CommandEncoder,
        maps: &[Map],
        target: &TextureView,
    ) -> usize {
        let mut data: Vec<[f32; 4]> = maps.iter().flatten().map(|row| row.to_array()).collect();
        // One row as long as it needs to be, or whole rows.
        let width = data.len().clamp(1, WIDTH);
        data.resize(data.len().next_multiple_of(width), [0.0; 4]);
        let bytes: &[u8] = bytemuck::cast_slice(data.as_flattened());
        write_rows(gpu, &self.maps, 0, width, bytes);
        let mut pass = begin(encoder, Some((target, None, Color::TRANSPARENT)), None);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(1, &self.group, &[]);
        pass.draw(0..3, 0..1);
        bytes.len()
    }
}

//! The surface and its shapes as textures that the vertex shaders read.

use super::device::Gpu;
use crate::view::surface::Surface;
use crate::view::vertex_paint::TABLE;
use glam::Vec3;
use wgpu::{
    Extent3d, Origin3d, TexelCopyBufferLayout, TexelCopyTextureInfo, Texture, TextureAspect, TextureDescriptor,
    TextureDimension, TextureFormat, TextureUsages,
};

/// Texels in a row; the shaders know it too.
pub const WIDTH: usize = 2048;

/// Five textures of the surface.
pub struct MeshTextures {
    /// Corners of each face.
    pub faces: Texture,
    /// Four words of paint for each face.
    pub paints: Texture,
    /// Colours of what lies on the vertices.
    pub table: Texture,
    /// Position and normal of each drawn vertex in two shapes.
    pub shapes: [Texture; 2],
}

impl MeshTextures {
    /// Textures with the faces of `surface`. The error is a sentence.
    pub fn new(gpu: &Gpu, surface: &Surface) -> Result<Self, &'static str> {
        let (faces, vertices) = (surface.corners.len(), surface.vertex.len());
        if rows(faces.max(vertices)) > gpu.longest as usize {
            return Err("This mesh has more faces than this browser's graphics can hold.");
        }
        let textures = Self {
            faces: texture(gpu, rows(faces), TextureFormat::Rgba32Uint, TextureUsages::empty()),
            paints: texture(gpu, rows(faces), TextureFormat::Rgba32Uint, TextureUsages::empty()),
            table: texture(gpu, 1, TextureFormat::Rgba8Unorm, TextureUsages::empty()),
            // A skin draws into one of them.
            shapes: [(); 2]
                .map(|()| texture(gpu, rows(vertices), TextureFormat::Rgba32Uint, TextureUsages::RENDER_ATTACHMENT)),
        };
        write(gpu, &textures.faces, faces, surface.corners.iter().map(|&[a, b, c]| [a, b, c, 0]));
        Ok(textures)
    }

    /// Uploads a shape: positions of the mesh's vertices and packed normals of the drawn ones.
    pub fn write_shape(&self, gpu: &Gpu, which: usize, surface: &Surface, positions: &[Vec3], normals: &[u32]) {
        let texels = surface.vertex.iter().zip(normals).map(|(&v, &n)| {
            let [x, y, z] = positions.get(v as usize).map_or([0; 3], |p| p.to_array().map(f32::to_bits));
            [x, y, z, n]
        });
        write(gpu, &self.shapes[which & 1], surface.vertex.len(), texels);
    }

    /// Uploads the paint.
    pub fn write_paint(&self, gpu: &Gpu, words: &[[u32; 4]], table: Option<&[[u8; 4]]>) {
        write(gpu, &self.paints, words.len(), words.iter().copied());
        if let Some(table) = table {
            let colours = table.iter().map(|&c| [u32::from_le_bytes(c)]);
            write(gpu, &self.table, TABLE, colours);
        }
    }
}

const _: () = assert!(TABLE == WIDTH);

/// Rows that so many texels take.
pub fn rows(texels: usize) -> usize {
    texels.div_ceil(WIDTH).max(1)
}

/// A texture that shaders read texel by texel.
pub fn texture(gpu: &Gpu, rows: usize, format: TextureFormat, usage: TextureUsages) -> Texture {
    gpu.device.create_texture(&TextureDescriptor {
        label: None,
        size: Extent3d { width: WIDTH as u32, height: rows as u32, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST | usage,
        view_formats: &[],
    })
}

/// Writes `count` texels of `N` words each, and zeros behind them to the end of the row.
fn write<const N: usize>(gpu: &Gpu, texture: &Texture, count: usize, texels: impl Iterator<Item = [u32; N]>) {
    let rows = rows(count);
    let mut data: Vec<[u32; N]> = Vec::with_capacity(rows * WIDTH);
    data.extend(texels.take(rows * WIDTH));
    data.resize(rows * WIDTH, [0; N]);
    write_rows(gpu, texture, 0, WIDTH, bytemuck::cast_slice(data.as_flattened()));
}

/// Writes rows of `width` texels each, from the row `first` on; `data` is whole rows.
pub fn write_rows(gpu: &Gpu, texture: &Texture, first: usize, width: usize, data: &[u8]) {
    let row = width * texture.format().block_copy_size(None).unwrap_or(16) as usize;
    gpu.queue.write_texture(
        TexelCopyTextureInfo {
            texture,
            mip_level: 0,
            origin: Origin3d { x: 0, y: first as u32, z: 0 },
            aspect: TextureAspect::All,
        },
        data,
        TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row as u32), rows_per_image: None },
        Extent3d { width: width as u32, height: (data.len() / row) as u32, depth_or_array_layers: 1 },
    );
}

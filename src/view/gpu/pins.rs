//! Pins on the device: an instance of a quad for each.

use super::device::Gpu;
use super::pipelines::Pipelines;
use crate::view::pins::FLOATS;
use wgpu::{Buffer, BufferDescriptor, BufferUsages, RenderPass};

/// Pins on the device.
pub struct PinsOnDevice {
    buffer: Buffer,
    room: usize,
    count: u32,
}

impl PinsOnDevice {
    /// Room for a few pins.
    pub fn new(gpu: &Gpu) -> Self {
        let room = 32;
        Self { buffer: buffer(gpu, room), room, count: 0 }
    }

    /// Uploads pins, farthest first.
    pub fn write(&mut self, gpu: &Gpu, pins: &[[f32; FLOATS]]) {
        if pins.len() > self.room {
            self.room = pins.len().next_power_of_two();
            self.buffer = buffer(gpu, self.room);
        }
        self.count = pins.len() as u32;
        if !pins.is_empty() {
            gpu.queue.write_buffer(&self.buffer, 0, bytemuck::cast_slice(pins.as_flattened()));
        }
    }

    /// Draws them over the picture, those that are hidden first. Groups 0 to 2 are bound.
    pub fn draw(&self, pass: &mut RenderPass, pipelines: &Pipelines) {
        if self.count == 0 {
            return;
        }
        pass.set_vertex_buffer(0, self.buffer.slice(..));
        for pipeline in &pipelines.pins {
            pass.set_pipeline(pipeline);
            pass.draw(0..4, 0..self.count);
        }
    }
}

fn buffer(gpu: &Gpu, room: usize) -> Buffer {
    gpu.device.create_buffer(&BufferDescriptor {
        label: None,
        size: (room * FLOATS * 4) as u64,
        usage: BufferUsages::VERTEX | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

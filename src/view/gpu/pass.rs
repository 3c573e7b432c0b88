//! Recording of passes.

use super::device::Gpu;
use crate::view::mesh::Mesh;
use crate::view::scene::Instance;
use wgpu::util::DeviceExt;

/// A mesh on the device.
pub struct Solid {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
}

/// Copies of a mesh.
pub struct Copies {
    buffer: wgpu::Buffer,
    count: u32,
}

/// Bytes on the device.
pub fn upload(gpu: &Gpu, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents: bytes, usage })
}

impl Solid {
    /// Uploads a mesh; `None` for an empty one.
    pub fn new(gpu: &Gpu, mesh: &Mesh) -> Option<Self> {
        (!mesh.indices.is_empty()).then(|| Self {
            vertices: upload(gpu, bytemuck::cast_slice(&mesh.vertices), wgpu::BufferUsages::VERTEX),
            indices: upload(gpu, bytemuck::cast_slice(&mesh.indices), wgpu::BufferUsages::INDEX),
            count: mesh.indices.len() as u32,
        })
    }

    /// Triangles.
    pub fn triangles(&self) -> u32 {
        self.count / 3
    }

    /// Draws it once, without instances.
    pub fn draw_alone(&self, pass: &mut wgpu::RenderPass) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, 0..1);
    }

    /// Draws its copies.
    pub fn draw(&self, pass: &mut wgpu::RenderPass, copies: &Copies) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, copies.buffer.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, 0..copies.count);
    }
}

impl Copies {
    /// Uploads instances; `None` for none.
    pub fn new(gpu: &Gpu, instances: &[Instance]) -> Option<Self> {
        (!instances.is_empty()).then(|| Self {
            buffer: upload(gpu, bytemuck::cast_slice(instances), wgpu::BufferUsages::VERTEX),
            count: instances.len() as u32,
        })
    }

    /// How many.
    pub fn count(&self) -> u32 {
        self.count
    }
}

/// Begins a pass on a colour target, cleared, with a depth that is cleared to infinity.
pub fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    colour: &wgpu::TextureView,
    resolved: Option<&wgpu::TextureView>,
    depth: Option<&wgpu::TextureView>,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: colour,
            depth_slice: None,
            resolve_target: resolved,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: depth.map(cleared),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

/// Begins a pass that only keeps depth.
pub fn begin_depth<'a>(encoder: &'a mut wgpu::CommandEncoder, depth: &wgpu::TextureView) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[],
        depth_stencil_attachment: Some(cleared(depth)),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

fn cleared(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}

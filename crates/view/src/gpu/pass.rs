//! Recording of render passes.

use super::device::Gpu;
use crate::material_groups::MaterialGroup;
use crate::mesh::Mesh;
use crate::scene::Instance;
use std::ops::Range;
use wgpu::util::DeviceExt;

/// A mesh on the GPU; triangles of one material group are contiguous.
pub struct GpuMesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
    group_ranges: Vec<(MaterialGroup, Range<u32>)>,
}

/// Instances of a mesh.
pub struct MeshInstances {
    buffer: wgpu::Buffer,
    count: u32,
}

/// Uploads bytes to a GPU buffer.
pub fn upload(gpu: &Gpu, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents: bytes, usage })
}

/// Creates a uniform buffer of a size in bytes.
pub fn uniform(gpu: &Gpu, size: usize) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: size as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// Creates a texture to render to and sample.
pub fn texture(gpu: &Gpu, size: (u32, u32), format: wgpu::TextureFormat, samples: u32) -> wgpu::TextureView {
    let descriptor = wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: size.0.max(1), height: size.1.max(1), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    gpu.device.create_texture(&descriptor).create_view(&wgpu::TextureViewDescriptor::default())
}

impl GpuMesh {
    /// Uploads a mesh; returns `None` if it is empty.
    pub fn new(gpu: &Gpu, mesh: &Mesh) -> Option<Self> {
        if mesh.indices.is_empty() {
            return None;
        }
        let (indices, group_ranges) = sorted_by_group(mesh);
        Some(Self {
            vertices: upload(gpu, bytemuck::cast_slice(&mesh.vertices), wgpu::BufferUsages::VERTEX),
            indices: upload(gpu, bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX),
            count: indices.len() as u32,
            group_ranges,
        })
    }

    /// Returns the number of triangles.
    pub fn triangles(&self) -> u32 {
        self.count / 3
    }

    /// Draws the mesh once, without instance data.
    pub fn draw_without_instances(&self, pass: &mut wgpu::RenderPass) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.count, 0, 0..1);
    }

    /// Draws all instances, regardless of material, in depth passes.
    pub fn draw(&self, pass: &mut wgpu::RenderPass, copies: &MeshInstances) {
        self.draw_range(pass, copies, 0..self.count);
    }

    /// Draws the triangles of one material group and returns their number per instance, or `None` if the group is
    /// empty.
    pub fn draw_group(&self, pass: &mut wgpu::RenderPass, copies: &MeshInstances, look: MaterialGroup) -> Option<u32> {
        let (_, run) = self.group_ranges.iter().find(|run| run.0 == look)?;
        self.draw_range(pass, copies, run.clone());
        Some(run.len() as u32 / 3)
    }

    fn draw_range(&self, pass: &mut wgpu::RenderPass, copies: &MeshInstances, range: Range<u32>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, copies.buffer.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(range, 0, 0..copies.count);
    }
}

/// Sorts triangles by material group and returns the index range of each group.
fn sorted_by_group(mesh: &Mesh) -> (Vec<u32>, Vec<(MaterialGroup, Range<u32>)>) {
    let look = |corner: u32| {
        mesh.vertices.get(corner as usize).map_or(MaterialGroup::Simple, |vertex| MaterialGroup::of(vertex.material))
    };
    let mut indices: Vec<u32> = Vec::with_capacity(mesh.indices.len());
    let mut group_ranges = Vec::new();
    for of in MaterialGroup::ALL {
        let from = indices.len() as u32;
        indices.extend(mesh.indices.chunks_exact(3).filter(|corners| look(corners[0]) == of).flatten());
        if indices.len() as u32 > from {
            group_ranges.push((of, from..indices.len() as u32));
        }
    }
    (indices, group_ranges)
}

impl MeshInstances {
    /// Uploads instances; returns `None` if the list is empty.
    pub fn new(gpu: &Gpu, instances: &[Instance]) -> Option<Self> {
        (!instances.is_empty()).then(|| Self {
            buffer: upload(gpu, bytemuck::cast_slice(instances), wgpu::BufferUsages::VERTEX),
            count: instances.len() as u32,
        })
    }

    /// Returns the number of instances.
    pub fn count(&self) -> u32 {
        self.count
    }
}

/// Begins a pass with a cleared color target and a depth buffer cleared to infinity.
pub fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    color: &wgpu::TextureView,
    resolved: Option<&wgpu::TextureView>,
    depth: Option<&wgpu::TextureView>,
) -> wgpu::RenderPass<'a> {
    begin_loading(encoder, (color, wgpu::LoadOp::Clear(wgpu::Color::BLACK)), resolved, depth)
}

/// Same as [`begin`], but with what the color target contains before.
pub fn begin_loading<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    (color, load): (&wgpu::TextureView, wgpu::LoadOp<wgpu::Color>),
    resolved: Option<&wgpu::TextureView>,
    depth: Option<&wgpu::TextureView>,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: color,
            depth_slice: None,
            resolve_target: resolved,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        depth_stencil_attachment: depth.map(cleared_depth),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

/// Begins a depth-only pass.
pub fn begin_depth<'a>(encoder: &'a mut wgpu::CommandEncoder, depth: &wgpu::TextureView) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: None,
        color_attachments: &[],
        depth_stencil_attachment: Some(cleared_depth(depth)),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

fn cleared_depth(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    }
}

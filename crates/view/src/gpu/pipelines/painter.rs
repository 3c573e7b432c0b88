//! Pipelines that draw egui's meshes, and rendered pictures.

use super::{PipelineKey, UNIFORM, attribute, build_pipeline, layout, module, sampler, texture_binding};
use crate::gpu::device::Gpu;
use egui::epaint::Vertex;
use wgpu::VertexFormat::{Float32x2, Unorm8x4};

/// Layouts, sampler, and pipelines of a painter.
#[derive(Debug)]
pub struct PainterPipelines {
    /// Layout of the target's size.
    pub size_layout: wgpu::BindGroupLayout,
    /// Layout of a texture and its sampler.
    pub texture_layout: wgpu::BindGroupLayout,
    /// Linear sampler, clamped to the edge.
    pub smooth: wgpu::Sampler,
    /// Meshes; colors are premultiplied with their opacity.
    pub meshes: wgpu::RenderPipeline,
    /// Opaque pictures that fill the viewport.
    pub pictures: wgpu::RenderPipeline,
}

/// Vertices of egui: position, texture coordinates, color.
fn mesh_corners() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 3] =
        [attribute(0, 0, Float32x2), attribute(1, 8, Float32x2), attribute(2, 16, Unorm8x4)];
    wgpu::VertexBufferLayout {
        array_stride: size_of::<Vertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &ATTRIBUTES,
    }
}

impl PainterPipelines {
    /// Compiles the pipelines for targets of a pixel format.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let image = texture_binding(wgpu::TextureSampleType::Float { filterable: true }, false, false);
        let smooth = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let pixels = wgpu::ShaderStages::FRAGMENT;
        let size_layout = layout(gpu, &[(wgpu::ShaderStages::VERTEX, UNIFORM)]);
        let texture_layout = layout(gpu, &[(pixels, image), (pixels, smooth)]);
        let constants = [("SRGB_TARGET", f64::from(u8::from(format.is_srgb())))];
        let meshes = PipelineKey {
            module: &module(gpu, "painter"),
            entries: ("mesh_corner", "mesh"),
            layouts: &[Some(&size_layout), Some(&texture_layout)],
            buffers: &[Some(mesh_corners())],
            target: Some(format),
            blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            writes: wgpu::ColorWrites::ALL,
            depth: None,
            bias: 0,
            cull: None,
            front: wgpu::FrontFace::Ccw,
            samples: 1,
            constants: &constants,
        };
        let pictures = PipelineKey { entries: ("picture_corner", "picture"), buffers: &[], blend: None, ..meshes };
        Self {
            meshes: build_pipeline(gpu, &meshes),
            pictures: build_pipeline(gpu, &pictures),
            smooth: sampler(gpu, wgpu::AddressMode::ClampToEdge, None, false),
            size_layout,
            texture_layout,
        }
    }
}

//! Ambient occlusion of a picture: a pass for the depth, then those of the `occlusion` shader.

use super::device::Gpu;
use super::pass::{begin, begin_depth, texture, uniform};
use super::pipelines::{DEPTH_FORMAT, OCCLUSION_FORMAT, OcclusionPipelines};
use super::uniforms::OcclusionUniforms;
use crate::shot::Shot;

/// Targets for one picture size and their bind groups.
pub struct OcclusionTargets {
    depth: wgpu::TextureView,
    uniforms: wgpu::Buffer,
    /// Targets of the two passes, each with the bind group of its input.
    passes: [(wgpu::TextureView, wgpu::BindGroup); 2],
}

impl OcclusionTargets {
    /// Creates the targets for a picture size.
    pub fn new(gpu: &Gpu, pipelines: &OcclusionPipelines, size_px: (u32, u32)) -> Self {
        let depth = texture(gpu, size_px, DEPTH_FORMAT, 1);
        let [found, averaged] = [(); 2].map(|()| texture(gpu, size_px, OCCLUSION_FORMAT, 1));
        let uniforms = uniform(gpu, size_of::<OcclusionUniforms>());
        let bind = |input: &wgpu::TextureView| {
            let view = wgpu::BindingResource::TextureView;
            let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("occlusion"),
                layout: &pipelines.input_layout,
                entries: &[entry(0, uniforms.as_entire_binding()), entry(1, view(&depth)), entry(2, view(input))],
            })
        };
        // The first pass has no input but the depth; its own target must not be bound.
        let (of_depth, of_found) = (bind(&averaged), bind(&found));
        Self { passes: [(found, of_depth), (averaged, of_found)], depth, uniforms }
    }

    /// Returns the result.
    pub fn result(&self) -> &wgpu::TextureView {
        &self.passes[1].0
    }

    /// Draws the occlusion of a shot. `draw_solids` draws the surfaces that occlude each other into a pass for the depth.
    pub fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        pipelines: &OcclusionPipelines,
        shot: &Shot,
        draw_solids: impl FnOnce(&mut wgpu::RenderPass),
    ) {
        gpu.queue.write_buffer(&self.uniforms, 0, bytemuck::bytes_of(&OcclusionUniforms::new(shot)));
        {
            let mut pass = begin_depth(encoder, &self.depth);
            pass.set_pipeline(&pipelines.depth);
            draw_solids(&mut pass);
        }
        for (pipeline, (target, input)) in pipelines.passes.iter().zip(&self.passes) {
            let mut pass = begin(encoder, target, None, None);
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, input, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

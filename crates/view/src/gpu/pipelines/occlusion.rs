//! Pipelines of the ambient occlusion.

use super::{
    PipelineKey, UNFILTERED, UNIFORM, build_pipeline, copies, corners, full_screen_key, layout, module, solid_key,
    texture_binding,
};
use crate::gpu::device::Gpu;
use crate::material_groups::MaterialGroup;

/// Format of the targets of the `occlusion` shader.
pub const OCCLUSION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// Pipelines that draw the occlusion of a picture.
pub struct OcclusionPipelines {
    /// Layout of the shader's inputs.
    pub input_layout: wgpu::BindGroupLayout,
    /// Depth of the solids, one sample per pixel.
    pub depth: wgpu::RenderPipeline,
    /// Few directions per pixel, then their average over neighbors.
    pub passes: [wgpu::RenderPipeline; 2],
}

impl OcclusionPipelines {
    /// Compiles the pipelines for the globals' existing bind group layout.
    pub fn new(gpu: &Gpu, globals_layout: &wgpu::BindGroupLayout, directions: u32) -> Self {
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let depth = texture_binding(wgpu::TextureSampleType::Depth, false, false);
        let input_layout = layout(gpu, &[(fragment, UNIFORM), (fragment, depth), (fragment, UNFILTERED)]);
        let [surface, occlusion] = ["surface", "occlusion"].map(|name| module(gpu, name));
        let (globals, inputs, buffers) = ([Some(globals_layout)], [Some(&input_layout)], [Some(corners()), Some(copies())]);
        // Only the shapes of trees depend on the material group, and they are among the simple materials.
        let of_any_group = [("LOOK", f64::from(MaterialGroup::Simple as u32))];
        let shape = PipelineKey { target: None, ..solid_key(&surface, &globals, &buffers, (1, &of_any_group)) };
        let key = PipelineKey { target: Some(OCCLUSION_FORMAT), ..full_screen_key(&shape, (&occlusion, &inputs), &[]) };
        let directions = [("DIRECTIONS", f64::from(directions))];
        let passes = [("occlude", &directions[..]), ("average", &[])]
            .map(|(entry, constants)| build_pipeline(gpu, &PipelineKey { entries: ("vs", entry), constants, ..key }));
        Self { depth: build_pipeline(gpu, &shape), passes, input_layout }
    }
}

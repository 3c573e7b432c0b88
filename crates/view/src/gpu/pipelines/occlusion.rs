//! Pipelines of the ambient occlusion.

use super::{PipelineKey, UNIFORM, build_pipeline, build_with_constants, full_screen_key, layout, module, texture_binding};
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
    /// Compiles the pipelines. `solid` is the key of the pipelines of solids.
    pub(super) fn new(gpu: &Gpu, solid: &PipelineKey, directions: u32) -> Self {
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let depth = texture_binding(wgpu::TextureSampleType::Depth, false, false);
        let input_layout = layout(gpu, &[(fragment, UNIFORM), (fragment, depth), (fragment, OCCLUSION_TEXTURE)]);
        // Only trees depend on the material group, and they are among the simple materials.
        let of_any_group = [("LOOK", f64::from(MaterialGroup::Simple as u32))];
        let shape = PipelineKey { target: None, samples: 1, ..*solid };
        let (module, layouts) = (module(gpu, "occlusion"), [Some(&input_layout)]);
        let key = PipelineKey { target: Some(OCCLUSION_FORMAT), ..full_screen_key(solid, (&module, &layouts), &[]) };
        let directions = [("DIRECTIONS", f64::from(directions))];
        let passes = ["occlude", "average"].map(|entry| {
            let constants = if entry == "occlude" { &directions[..] } else { &[] };
            build_pipeline(gpu, &PipelineKey { entries: ("vs", entry), constants, ..key })
        });
        Self { depth: build_with_constants(gpu, &shape, &of_any_group), passes, input_layout }
    }
}

/// A texture with the occlusion, which shaders read without a sampler.
pub const OCCLUSION_TEXTURE: wgpu::BindingType =
    texture_binding(wgpu::TextureSampleType::Float { filterable: false }, false, false);

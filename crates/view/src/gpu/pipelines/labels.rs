//! Pipelines that render element and defect labels instead of radiance.

use super::{DEPTH_COMPARE, PipelineKey, build_pipeline, build_with_constants, copies, corners, module, patches, solid_key};
use crate::gpu::device::Gpu;
use crate::scene::defects::defect_drawings;

/// Pipelines with numeric targets: element in red, defect in green. Half floats represent integers up to 2048 exactly.
pub struct LabelPipelines {
    /// Solids and the lake.
    pub solid: wgpu::RenderPipeline,
    /// Defects, by drawing.
    pub defects: Vec<(u32, wgpu::RenderPipeline)>,
}

impl LabelPipelines {
    /// Compiles the pipelines for the existing layouts of the globals and the ambient occlusion.
    pub fn new(gpu: &Gpu, layouts: [&wgpu::BindGroupLayout; 2]) -> Self {
        let [surface, defect] = ["surface", "defect"].map(|name| module(gpu, name));
        let layouts = layouts.map(Some);
        let (solids, of_patches) = ([Some(corners()), Some(copies())], [Some(patches())]);
        let constants = [("MASK", 1.0)];
        let solid = solid_key(&surface, &layouts, &solids, (1, &constants));
        let flat = PipelineKey {
            module: &defect,
            buffers: &of_patches,
            writes: wgpu::ColorWrites::GREEN,
            depth: Some((false, DEPTH_COMPARE)),
            bias: 2,
            cull: None,
            ..solid
        };
        let defects =
            defect_drawings().map(|code| (code, build_with_constants(gpu, &flat, &[("KIND", f64::from(code))]))).collect();
        Self { solid: build_pipeline(gpu, &solid), defects }
    }
}

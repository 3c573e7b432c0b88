//! Pipelines that render element and defect labels instead of radiance.

use super::{
    DEPTH_COMPARE, ENTRY_POINTS, PipelineKey, RADIANCE_FORMAT, build_pipeline, build_with_constants, copies, corners, module,
    patches,
};
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
        let solid = PipelineKey {
            module: &surface,
            entries: ENTRY_POINTS,
            layouts: &layouts,
            buffers: &solids,
            target: Some(RADIANCE_FORMAT),
            blend: None,
            writes: wgpu::ColorWrites::ALL,
            depth: Some((true, DEPTH_COMPARE)),
            bias: 0,
            cull: Some(wgpu::Face::Back),
            front: wgpu::FrontFace::Ccw,
            samples: 1,
            constants: &constants,
        };
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

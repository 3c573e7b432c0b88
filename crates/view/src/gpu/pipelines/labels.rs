//! Pipelines that render element and defect labels instead of radiance.

use super::{ENTRIES, LIGHT, NEARER, PipelineKey, build, copies, corners, module, patches, special};
use crate::gpu::device::Gpu;
use spandrel_model::defect_codes;

/// Pipelines with numeric targets: element in red, defect in green. Half floats represent integers up to 2048 exactly.
pub struct LabelPipelines {
    /// Solids and the lake.
    pub solid: wgpu::RenderPipeline,
    /// Defects, by AASHTO code.
    pub defects: Vec<(u32, wgpu::RenderPipeline)>,
}

impl LabelPipelines {
    /// Compiles the pipelines for an existing bind group layout of the globals.
    pub fn new(gpu: &Gpu, globals_layout: &wgpu::BindGroupLayout) -> Self {
        let [surface, defect] = ["surface", "defect"].map(|name| module(gpu, name));
        let globals = [Some(globals_layout)];
        let (solids, of_patches) = ([Some(corners()), Some(copies())], [Some(patches())]);
        let constants = [("MASK", 1.0)];
        let solid = PipelineKey {
            module: &surface,
            entries: ENTRIES,
            layouts: &globals,
            buffers: &solids,
            target: Some(LIGHT),
            blend: None,
            writes: wgpu::ColorWrites::ALL,
            depth: Some((true, NEARER)),
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
            depth: Some((false, NEARER)),
            bias: 2,
            cull: None,
            ..solid
        };
        let defects =
            defect_codes::KINDS.iter().map(|code| (*code, special(gpu, &flat, &[("KIND", f64::from(*code))]))).collect();
        Self { solid: build(gpu, &solid), defects }
    }
}

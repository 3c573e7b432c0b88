//! Render pipelines.

mod labels;
mod occlusion;
mod painter;

use super::device::Gpu;
use crate::material_groups::MaterialGroup;
use crate::mesh::Vertex;
use crate::quality::Quality;
use crate::scene::defects::{STAIN_CODES, defect_drawings};
use crate::scene::{DefectPatch, Instance};
use crate::shaders;
use wgpu::VertexFormat::{Float32, Float32x2, Float32x3, Float32x4, Uint32, Unorm8x4};

pub use labels::LabelPipelines;
pub use occlusion::{OCCLUSION_FORMAT, OcclusionPipelines};
pub use painter::PainterPipelines;

/// Format of radiance targets.
pub const RADIANCE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Format of the targets of the `adapt` shader.
pub const ADAPTATION_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;
/// Depth format: 1 at the near plane, 0 at infinity.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Format of rendered pictures; the shader encodes sRGB.
pub const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A texture that shaders read without a sampler.
const UNFILTERED: wgpu::BindingType = texture_binding(wgpu::TextureSampleType::Float { filterable: false }, false, false);

/// One pipeline per material group.
pub type MaterialPipelines = Vec<(MaterialGroup, wgpu::RenderPipeline)>;

/// Layouts, samplers, and pipelines of a renderer.
pub struct Pipelines {
    /// Layout of globals, shadow maps and their sampler.
    pub globals_layout: wgpu::BindGroupLayout,
    /// Layout of a texture and its sampler: the water reflection, inputs of the `adapt` shader.
    pub sampled_layout: wgpu::BindGroupLayout,
    /// Layout of the ambient occlusion that surfaces read.
    pub occluded_layout: wgpu::BindGroupLayout,
    /// Layout of the `develop` shader's inputs.
    pub develop_layout: wgpu::BindGroupLayout,
    /// Layout of a shadow map's projection.
    pub map_layout: wgpu::BindGroupLayout,
    /// Linear sampler, clamped to the edge.
    pub smooth: wgpu::Sampler,
    /// Linear sampler, repeating.
    pub tiled: wgpu::Sampler,
    /// Comparison sampler for shadow maps.
    pub compare: wgpu::Sampler,
    /// Solids, without and with the lamp.
    pub surfaces: [MaterialPipelines; 2],
    /// Reflected solids, without and with the lamp.
    pub surfaces_mirrored: [MaterialPipelines; 2],
    /// Translucent surfaces.
    pub translucent: wgpu::RenderPipeline,
    /// Stains, then defects, by drawing.
    pub defects: Vec<(u32, wgpu::RenderPipeline)>,
    /// Lake, without and with breaking waves, each without and with the lamp.
    pub water: [[wgpu::RenderPipeline; 2]; 2],
    /// Sky.
    pub sky: wgpu::RenderPipeline,
    /// Drops and flakes.
    pub precipitation: wgpu::RenderPipeline,
    /// Reflected sky.
    pub sky_mirrored: wgpu::RenderPipeline,
    /// Shadow map depth.
    pub shadow: wgpu::RenderPipeline,
    /// Brightness of the picture's cells, then the base that local adaptation compresses.
    pub adapt: [wgpu::RenderPipeline; 2],
    /// Conversion of radiance to a picture, for eyes, for a camera, and for a camera over a weak video link.
    pub develop: [wgpu::RenderPipeline; 3],
}

const fn attribute(shader_location: u32, offset: u64, format: wgpu::VertexFormat) -> wgpu::VertexAttribute {
    wgpu::VertexAttribute { format, offset, shader_location }
}

const VERTEX_ATTRIBUTES: &[wgpu::VertexAttribute] = &[
    attribute(0, 0, Float32x3),
    attribute(1, 12, Float32x3),
    attribute(2, 24, Float32x2),
    attribute(3, 32, Float32x2),
    attribute(4, 40, Uint32),
    attribute(5, 44, Unorm8x4),
    attribute(9, 48, Float32),
];
const INSTANCE_ATTRIBUTES: &[wgpu::VertexAttribute] = &[
    attribute(6, 0, Float32x4),
    attribute(7, 16, Float32x4),
    attribute(8, 32, Float32x4),
    attribute(10, 48, Float32x4),
    attribute(11, 64, Float32x4),
];
const PATCH_ATTRIBUTES: &[wgpu::VertexAttribute] = &[
    attribute(0, 0, Float32x4),
    attribute(1, 16, Float32x4),
    attribute(2, 32, Float32x4),
    attribute(3, 48, Float32x4),
    attribute(4, 64, Float32x4),
    attribute(5, 80, Float32x4),
];

fn corners() -> wgpu::VertexBufferLayout<'static> {
    wgpu::VertexBufferLayout {
        array_stride: size_of::<Vertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: VERTEX_ATTRIBUTES,
    }
}

fn copies() -> wgpu::VertexBufferLayout<'static> {
    wgpu::VertexBufferLayout {
        array_stride: size_of::<Instance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: INSTANCE_ATTRIBUTES,
    }
}

fn patches() -> wgpu::VertexBufferLayout<'static> {
    wgpu::VertexBufferLayout {
        array_stride: size_of::<DefectPatch>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: PATCH_ATTRIBUTES,
    }
}

/// Parameters of a pipeline.
#[derive(Clone, Copy)]
struct PipelineKey<'a> {
    module: &'a wgpu::ShaderModule,
    /// Vertex and fragment entry points of the module.
    entries: (&'static str, &'static str),
    layouts: &'a [Option<&'a wgpu::BindGroupLayout>],
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    target: Option<wgpu::TextureFormat>,
    blend: Option<wgpu::BlendState>,
    writes: wgpu::ColorWrites,
    /// Whether depth is written, and the comparison; `None` for no depth buffer.
    depth: Option<(bool, wgpu::CompareFunction)>,
    bias: i32,
    cull: Option<wgpu::Face>,
    front: wgpu::FrontFace,
    samples: u32,
    /// Values of the shader's override constants.
    constants: &'a [(&'a str, f64)],
}

fn build_pipeline(gpu: &Gpu, kind: &PipelineKey) -> wgpu::RenderPipeline {
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: kind.layouts,
        immediate_size: 0,
    });
    let constants = wgpu::PipelineCompilationOptions { constants: kind.constants, ..Default::default() };
    let targets = [kind.target.map(|format| wgpu::ColorTargetState { format, blend: kind.blend, write_mask: kind.writes })];
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: kind.module,
            entry_point: Some(kind.entries.0),
            compilation_options: constants.clone(),
            buffers: kind.buffers,
        },
        primitive: wgpu::PrimitiveState { cull_mode: kind.cull, front_face: kind.front, ..Default::default() },
        depth_stencil: kind.depth.map(|(write, compare)| wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(write),
            depth_compare: Some(compare),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState { constant: kind.bias, slope_scale: kind.bias.signum() as f32, clamp: 0.0 },
        }),
        multisample: wgpu::MultisampleState { count: kind.samples, ..Default::default() },
        fragment: kind.target.map(|_| wgpu::FragmentState {
            module: kind.module,
            entry_point: Some(kind.entries.1),
            compilation_options: constants,
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn layout(gpu: &Gpu, entries: &[(wgpu::ShaderStages, wgpu::BindingType)]) -> wgpu::BindGroupLayout {
    let entries: Vec<wgpu::BindGroupLayoutEntry> = entries
        .iter()
        .enumerate()
        .map(|(k, (visibility, ty))| wgpu::BindGroupLayoutEntry {
            binding: k as u32,
            visibility: *visibility,
            ty: *ty,
            count: None,
        })
        .collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

const UNIFORM: wgpu::BindingType =
    wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None };

const fn texture_binding(sample_type: wgpu::TextureSampleType, array: bool, multisampled: bool) -> wgpu::BindingType {
    let view_dimension = if array { wgpu::TextureViewDimension::D2Array } else { wgpu::TextureViewDimension::D2 };
    wgpu::BindingType::Texture { sample_type, view_dimension, multisampled }
}

fn module(gpu: &Gpu, name: &str) -> wgpu::ShaderModule {
    let source = wgpu::ShaderSource::Wgsl(shaders::source(name).into());
    gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(name), source })
}

/// Bind group layouts.
struct BindLayouts {
    globals: wgpu::BindGroupLayout,
    sampled: wgpu::BindGroupLayout,
    occluded: wgpu::BindGroupLayout,
    develop: wgpu::BindGroupLayout,
    map: wgpu::BindGroupLayout,
}

impl BindLayouts {
    fn new(gpu: &Gpu, quality: &Quality) -> Self {
        use wgpu::{BindingType::Sampler, SamplerBindingType, ShaderStages, TextureSampleType};
        let (both, fragment) = (ShaderStages::VERTEX_FRAGMENT, ShaderStages::FRAGMENT);
        let filtered = texture_binding(TextureSampleType::Float { filterable: true }, false, false);
        let smooth = Sampler(SamplerBindingType::Filtering);
        let maps = texture_binding(TextureSampleType::Depth, true, false);
        let depth = texture_binding(TextureSampleType::Depth, false, quality.samples > 1);
        let compare = Sampler(SamplerBindingType::Comparison);
        let globals = [
            (both, UNIFORM),
            (fragment, maps),
            (fragment, compare),
            (both, filtered),
            (both, smooth),
            (fragment, filtered),
            (fragment, filtered),
            (fragment, filtered),
        ];
        Self {
            globals: layout(gpu, &globals),
            sampled: layout(gpu, &[(fragment, filtered), (fragment, smooth)]),
            occluded: layout(gpu, &[(fragment, UNFILTERED)]),
            develop: layout(
                gpu,
                &[(fragment, UNIFORM), (fragment, filtered), (fragment, smooth), (fragment, depth), (fragment, filtered)],
            ),
            map: layout(gpu, &[(ShaderStages::VERTEX, UNIFORM)]),
        }
    }
}

fn sampler(gpu: &Gpu, address: wgpu::AddressMode, compare: Option<wgpu::CompareFunction>, between: bool) -> wgpu::Sampler {
    let mipmap_filter = if between { wgpu::MipmapFilterMode::Linear } else { wgpu::MipmapFilterMode::Nearest };
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: address,
        address_mode_v: address,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter,
        compare,
        ..Default::default()
    })
}

/// Returns the override constants of a preset, and of scenes with rain or snow (common.wgsl).
fn preset_constants(quality: &Quality, weathered: bool) -> [(&'static str, f64); 7] {
    [
        ("CASCADES", f64::from(quality.cascades)),
        ("TAPS", f64::from(quality.shadow_taps)),
        ("PENUMBRA", f64::from(u8::from(quality.penumbra))),
        ("LAMP_CASTS", f64::from(u8::from(quality.lamp_shadow))),
        ("MIRROR", f64::from(u8::from(quality.reflection > 0.0))),
        ("DETAIL", f64::from(u8::from(quality.smooth_noise))),
        ("WEATHERED", f64::from(u8::from(weathered))),
    ]
}

/// Builds a pipeline with additional override constants.
fn build_with_constants(gpu: &Gpu, kind: &PipelineKey, more: &[(&str, f64)]) -> wgpu::RenderPipeline {
    let constants = [kind.constants, more].concat();
    build_pipeline(gpu, &PipelineKey { constants: &constants, ..*kind })
}

/// Returns the override constant for surfaces that read the ambient occlusion (occluded.wgsl).
fn occluded(quality: &Quality, mirrored: bool) -> (&'static str, f64) {
    ("OCCLUDED", f64::from(u8::from(quality.occlusion_directions > 0 && !mirrored)))
}

/// Builds one pipeline per material group, without and with the lamp.
fn surfaces(gpu: &Gpu, kind: &PipelineKey, quality: &Quality, mirrored: bool) -> [MaterialPipelines; 2] {
    by_lamp(quality, |lamp| {
        let of = |look: MaterialGroup| {
            let glossy = f64::from(u8::from(look.has_specular()));
            let mirror = ("MIRRORED", f64::from(u8::from(mirrored)));
            let own = [("LOOK", f64::from(look as u32)), ("GLOSSY", glossy), mirror, occluded(quality, mirrored), lamp];
            (look, build_with_constants(gpu, kind, &own))
        };
        MaterialGroup::ALL.into_iter().map(of).collect()
    })
}

/// Builds the pipelines of the lake, without and with breaking waves, each without and with the lamp.
fn lakes(gpu: &Gpu, kind: &PipelineKey, quality: &Quality) -> [[wgpu::RenderPipeline; 2]; 2] {
    [0.0, 1.0].map(|breaking| by_lamp(quality, |lamp| build_with_constants(gpu, kind, &[lamp, ("WHITECAPS", breaking)])))
}

/// Builds two pipelines, without and with the lamp. Only lean presets compile a variant without the lamp; other presets
/// use one pipeline for both.
fn by_lamp<T: Clone>(quality: &Quality, of: impl Fn((&'static str, f64)) -> T) -> [T; 2] {
    let lit = of(("LAMP", 1.0));
    [if quality.lean { of(("LAMP", 0.0)) } else { lit.clone() }, lit]
}

/// Vertex and fragment entry points of most modules.
const ENTRY_POINTS: (&str, &str) = ("vs", "fs");
/// Entry points of the `lean` shader.
const LEAN_ENTRY_POINTS: (&str, &str) = ("vs_lean", "fs_lean");

/// Reversed depth: nearer fragments have greater depth, and equal depth overwrites.
const DEPTH_COMPARE: wgpu::CompareFunction = wgpu::CompareFunction::GreaterEqual;

/// Returns the key of pipelines that draw solids as radiance.
fn solid_key<'a>(
    module: &'a wgpu::ShaderModule,
    layouts: &'a [Option<&'a wgpu::BindGroupLayout>],
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    (samples, constants): (u32, &'a [(&'a str, f64)]),
) -> PipelineKey<'a> {
    PipelineKey {
        module,
        entries: ENTRY_POINTS,
        layouts,
        buffers,
        target: Some(RADIANCE_FORMAT),
        blend: None,
        writes: wgpu::ColorWrites::ALL,
        depth: Some((true, DEPTH_COMPARE)),
        bias: 0,
        cull: Some(wgpu::Face::Back),
        front: wgpu::FrontFace::Ccw,
        samples,
        constants,
    }
}

/// Returns the key of a pipeline that converts radiance to a picture by drawing one full-screen triangle.
fn full_screen_key<'a>(
    solid: &PipelineKey<'a>,
    (module, layouts): (&'a wgpu::ShaderModule, &'a [Option<&'a wgpu::BindGroupLayout>]),
    constants: &'a [(&'a str, f64)],
) -> PipelineKey<'a> {
    PipelineKey {
        module,
        layouts,
        buffers: &[],
        target: Some(COLOR_FORMAT),
        depth: None,
        cull: None,
        samples: 1,
        constants,
        ..*solid
    }
}

/// Builds the pipelines of the `adapt` shader.
fn adapt(gpu: &Gpu, solid: &PipelineKey, input: &wgpu::BindGroupLayout) -> [wgpu::RenderPipeline; 2] {
    let (module, layouts) = (module(gpu, "adapt"), [Some(input)]);
    let key = full_screen_key(solid, (&module, &layouts), &[]);
    ["measure", "fit"]
        .map(|entry| build_pipeline(gpu, &PipelineKey { entries: ("vs", entry), target: Some(ADAPTATION_FORMAT), ..key }))
}

/// Builds the pipelines that convert radiance to a picture: for eyes, for a camera, and for a camera over a weak video link.
fn develop(gpu: &Gpu, film: &PipelineKey) -> [wgpu::RenderPipeline; 3] {
    [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]
        .map(|(sensor, lossy)| build_with_constants(gpu, film, &[("SENSOR", sensor), ("LOSSY", lossy)]))
}

/// Builds the pipeline that draws a kind of defect or stain.
fn defect(gpu: &Gpu, flat: &PipelineKey, quality: &Quality, code: u32) -> (u32, wgpu::RenderPipeline) {
    (code, build_with_constants(gpu, flat, &[("KIND", f64::from(code)), occluded(quality, false)]))
}

impl Pipelines {
    /// Compiles all pipelines. `weathered`: whether rain or snow changes the surfaces.
    pub fn new(gpu: &Gpu, quality: &Quality, weathered: bool) -> Self {
        let layouts = BindLayouts::new(gpu, quality);
        let [surface, sky, falling, patch, water, shadow] =
            ["surface", "sky", "precipitation", "defect", "water", "shadow"].map(|name| module(gpu, name));
        let film_module = module(gpu, if quality.samples > 1 { shaders::DEVELOP_MULTISAMPLED } else { "develop" });
        let over = Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
        let (globals, of_surfaces) = ([Some(&layouts.globals)], [Some(&layouts.globals), Some(&layouts.occluded)]);
        let (solid_buffers, patch_buffers, water_buffers) =
            ([Some(corners()), Some(copies())], [Some(patches())], [Some(corners())]);
        let (lake_layouts, map_layouts, develop_layouts) =
            ([Some(&layouts.globals), Some(&layouts.sampled)], [Some(&layouts.map)], [Some(&layouts.develop)]);
        let preset_constants = preset_constants(quality, weathered);
        let solid = solid_key(&surface, &of_surfaces, &solid_buffers, (quality.samples, &preset_constants));
        let (shown, lean) = (Some((false, DEPTH_COMPARE)), module(gpu, "lean"));
        let shaded = if quality.lean { PipelineKey { module: &lean, entries: LEAN_ENTRY_POINTS, ..solid } } else { solid };
        let mirrored = PipelineKey { front: wgpu::FrontFace::Cw, samples: 1, ..shaded };
        let back = PipelineKey { module: &sky, layouts: &globals, buffers: &[], depth: shown, cull: None, ..solid };
        let see_through = [preset_constants.as_slice(), &[("LOOK", f64::from(MaterialGroup::Simple as u32))]].concat();
        let translucent =
            PipelineKey { blend: Some(wgpu::BlendState::ALPHA_BLENDING), depth: shown, constants: &see_through, ..solid };
        // Biased toward the camera, so that defects appear in front of the surfaces that they are on.
        let flat =
            PipelineKey { module: &patch, buffers: &patch_buffers, blend: over, depth: shown, bias: 2, cull: None, ..solid };
        let lake =
            PipelineKey { module: &water, layouts: &lake_layouts, buffers: &water_buffers, blend: over, cull: None, ..solid };
        // Biased away from the sun.
        let dark = PipelineKey {
            module: &shadow,
            layouts: &map_layouts,
            target: None,
            bias: -2,
            cull: None,
            samples: 1,
            constants: &[],
            ..solid
        };
        let blur = [("BLUR", f64::from(u8::from(quality.blur_taps > 1)))];
        let film = full_screen_key(&solid, (&film_module, &develop_layouts), &blur);
        Self {
            surfaces: surfaces(gpu, &shaded, quality, false),
            surfaces_mirrored: surfaces(gpu, &mirrored, quality, true),
            translucent: build_pipeline(gpu, &translucent),
            defects: STAIN_CODES.into_iter().chain(defect_drawings()).map(|code| defect(gpu, &flat, quality, code)).collect(),
            water: lakes(gpu, &lake, quality),
            sky_mirrored: build_pipeline(gpu, &PipelineKey { samples: 1, ..back }),
            sky: build_pipeline(gpu, &back),
            precipitation: build_pipeline(gpu, &PipelineKey { module: &falling, blend: over, ..back }),
            shadow: build_pipeline(gpu, &dark),
            adapt: adapt(gpu, &solid, &layouts.sampled),
            develop: develop(gpu, &film),
            smooth: sampler(gpu, wgpu::AddressMode::ClampToEdge, None, false),
            tiled: sampler(gpu, wgpu::AddressMode::Repeat, None, quality.smooth_noise),
            compare: sampler(gpu, wgpu::AddressMode::ClampToEdge, Some(DEPTH_COMPARE), false),
            globals_layout: layouts.globals,
            sampled_layout: layouts.sampled,
            occluded_layout: layouts.occluded,
            develop_layout: layouts.develop,
            map_layout: layouts.map,
        }
    }
}

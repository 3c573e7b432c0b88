//! Render targets for one picture size.

use super::device::Gpu;
use super::occlusion::OcclusionTargets;
use super::pass::{texture, uniform};
use super::pipelines::{ADAPTATION_FORMAT, DEPTH_FORMAT, OcclusionPipelines, Pipelines, RADIANCE_FORMAT};
use crate::ground_photo::GroundColors;
use crate::quality::Quality;

/// Cells of the longer side of a picture in which local adaptation measures brightness. A neighborhood has nine cells, a seventh of the
/// picture (estimate: roughly what a person sees sharply at a glance).
const ADAPTATION_CELLS: u32 = 64;

/// Render targets and their bind groups.
pub struct RenderTargets {
    /// Radiance, multisampled.
    pub light: wgpu::TextureView,
    /// Radiance, one sample per pixel; `None` if [`Self::light`] is not multisampled.
    pub resolved: Option<wgpu::TextureView>,
    /// Depth buffer.
    pub depth: wgpu::TextureView,
    /// Radiance of the water reflection.
    pub mirror: wgpu::TextureView,
    /// Depth buffer of the water reflection.
    pub mirror_depth: wgpu::TextureView,
    /// Targets of the ambient occlusion, if the preset has it.
    pub occlusion: Option<OcclusionTargets>,
    /// Bind group of the ambient occlusion that surfaces read; `None` without it.
    pub occluded: Option<wgpu::BindGroup>,
    /// Bind group of the `water` shader.
    pub water: wgpu::BindGroup,
    /// Targets of the passes of the `adapt` shader, each with the bind group of its input.
    pub adapt: [(wgpu::TextureView, wgpu::BindGroup); 2],
    /// Bind group of the `develop` shader.
    pub develop: wgpu::BindGroup,
    /// Uniforms of the `develop` shader.
    pub develop_data: wgpu::Buffer,
}

impl RenderTargets {
    /// Creates the targets for a picture size.
    pub fn new(
        gpu: &Gpu,
        (pipelines, occlusion): (&Pipelines, Option<&OcclusionPipelines>),
        quality: &Quality,
        size: (u32, u32),
    ) -> Self {
        let light = texture(gpu, size, RADIANCE_FORMAT, quality.samples);
        let resolved = (quality.samples > 1).then(|| texture(gpu, size, RADIANCE_FORMAT, 1));
        let depth = texture(gpu, size, DEPTH_FORMAT, quality.samples);
        let part = |px: u32| ((f64::from(px) * quality.reflection) as u32).max(1);
        let small = if quality.reflection > 0.0 { (part(size.0), part(size.1)) } else { (1, 1) };
        let mirror = texture(gpu, small, RADIANCE_FORMAT, 1);
        let mirror_depth = texture(gpu, small, DEPTH_FORMAT, 1);
        let develop_data = uniform(gpu, size_of::<super::uniforms::DevelopUniforms>());
        let view = |view| wgpu::BindingResource::TextureView(view);
        let sampler = wgpu::BindingResource::Sampler(&pipelines.smooth);
        let entry = |binding: u32, resource| wgpu::BindGroupEntry { binding, resource };
        let sampled = |texture| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipelines.sampled_layout,
                entries: &[entry(0, view(texture)), entry(1, sampler.clone())],
            })
        };
        let water = sampled(&mirror);
        let radiance = resolved.as_ref().unwrap_or(&light);
        let longer = f64::from(size.0.max(size.1).max(1));
        let cells = |px: u32| (f64::from(px) / longer * f64::from(ADAPTATION_CELLS)).round() as u32;
        let [measured, fitted] = [(); 2].map(|()| texture(gpu, (cells(size.0), cells(size.1)), ADAPTATION_FORMAT, 1));
        let develop = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("develop"),
            layout: &pipelines.develop_layout,
            entries: &[
                entry(0, develop_data.as_entire_binding()),
                entry(1, view(radiance)),
                entry(2, sampler.clone()),
                entry(3, view(&depth)),
                entry(4, view(&fitted)),
            ],
        });
        let occlusion = occlusion.map(|pipelines| OcclusionTargets::new(gpu, pipelines, size));
        let occluded = occlusion.as_ref().map(|targets| bind_occlusion(gpu, pipelines, targets.result()));
        let (of_radiance, of_measured) = (sampled(radiance), sampled(&measured));
        let adapt = [(measured, of_radiance), (fitted, of_measured)];
        Self { light, resolved, depth, mirror, mirror_depth, occlusion, occluded, water, adapt, develop, develop_data }
    }
}

/// Binds the ambient occlusion for the shaders of surfaces.
pub fn bind_occlusion(gpu: &Gpu, pipelines: &Pipelines, occlusion: &wgpu::TextureView) -> wgpu::BindGroup {
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("occluded"),
        layout: &pipelines.occluded_layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(occlusion) }],
    })
}

/// Creates the noise texture.
pub fn noise_texture(gpu: &Gpu) -> wgpu::TextureView {
    let levels: Vec<_> = crate::noise::levels().into_iter().map(|level| (level.side, level.rgba)).collect();
    tile_texture(gpu, &levels)
}

/// Creates the texture of the photograph on the ground. Without one, it is a single invisible pixel.
pub fn photo_texture(gpu: &Gpu, colors: Option<&GroundColors>) -> wgpu::TextureView {
    let levels = colors.map_or_else(|| vec![(1, vec![0; 4])], GroundColors::levels);
    mipmapped_texture(gpu, &levels, wgpu::TextureFormat::Rgba8UnormSrgb)
}

/// Creates a four-channel tile texture with mipmaps, finest first.
pub fn tile_texture(gpu: &Gpu, levels: &[(usize, Vec<u8>)]) -> wgpu::TextureView {
    mipmapped_texture(gpu, levels, wgpu::TextureFormat::Rgba8Unorm)
}

fn mipmapped_texture(gpu: &Gpu, levels: &[(usize, Vec<u8>)], format: wgpu::TextureFormat) -> wgpu::TextureView {
    let side = |px: usize| wgpu::Extent3d { width: px as u32, height: px as u32, depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("tile"),
        size: side(levels.first().map_or(1, |level| level.0)),
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (k, (texels, rgba)) in levels.iter().enumerate() {
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &texture,
                mip_level: k as u32,
                origin: wgpu::Origin3d::ZERO,
                aspect: wgpu::TextureAspect::All,
            },
            rgba,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * *texels as u32), rows_per_image: None },
            side(*texels),
        );
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

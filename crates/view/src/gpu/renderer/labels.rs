//! Label masks of a shot.

use super::{Frustum, Renderer, solids};
use crate::gpu::device::{Gpu, GpuError};
use crate::gpu::pass::{MeshInstances, begin, texture};
use crate::gpu::picture::{color_texture, read_bytes};
use crate::gpu::pipelines::{DEPTH_FORMAT, LabelPipelines, RADIANCE_FORMAT};
use crate::gpu::uniforms::{Globals, ShadowMaps};
use crate::masks::LabelMask;
use crate::scene::Instance;
use crate::shot::Shot;

/// Bytes per label pixel: four half floats.
const BYTES_PER_PIXEL: u32 = 8;

impl Renderer {
    /// Returns the bridge element and defect at each pixel of a shot.
    ///
    /// # Errors
    /// Returns an error if the shot is too large for the device, or if the device fails or has failed before.
    pub fn labels(&mut self, gpu: &Gpu, shot: &Shot) -> Result<LabelMask, GpuError> {
        gpu.check_size(shot.size_px)?;
        let globals = Globals::new(shot, (self.water_m, self.photo_half_m), &ShadowMaps { sun: &[], lamp: None }, false);
        gpu.queue.write_buffer(&self.globals, 0, bytemuck::bytes_of(&globals));
        let pipelines = self
            .labels
            .take()
            .unwrap_or_else(|| LabelPipelines::new(gpu, [&self.pipelines.globals_layout, &self.pipelines.occluded_layout]));
        let target = color_texture(gpu, shot.size_px, (RADIANCE_FORMAT, wgpu::TextureUsages::COPY_SRC));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.draw_labels(gpu, &mut encoder, &pipelines, shot, &target);
        gpu.queue.submit([encoder.finish()]);
        self.labels = Some(pipelines);
        read(gpu, &target)
    }

    fn draw_labels(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        pipelines: &LabelPipelines,
        shot: &Shot,
        target: &wgpu::Texture,
    ) {
        let (moving, here) = (self.moving(gpu, &shot.moving), MeshInstances::new(gpu, &[Instance::IDENTITY]));
        let shown = Frustum::of(&shot.eye.view_projection(shot.aspect()));
        let view = target.create_view(&wgpu::TextureViewDescriptor::default());
        let depth = texture(gpu, shot.size_px, DEPTH_FORMAT, 1);
        let mut pass = begin(encoder, &view, None, Some(&depth));
        pass.set_bind_group(0, &self.bound, &[]);
        pass.set_bind_group(1, &self.not_occluded, &[]);
        pass.set_pipeline(&pipelines.solid);
        let still = self
            .fixed
            .iter()
            .filter(|fixed| fixed.visible_range.shows(false, 0.0) && shown.cell_may_be_visible(&fixed.bounds))
            .map(|fixed| (&*fixed.solid, &fixed.copies));
        let lake = self.water.iter().flat_map(|(water, _)| Some((water, here.as_ref()?)));
        for (solid, copies) in solids(&self.models, &moving).chain(still).chain(lake) {
            solid.draw(&mut pass, copies);
        }
        self.draw_patches(&mut pass, &pipelines.defects);
    }
}

fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Result<LabelMask, GpuError> {
    let (width, height) = (texture.width(), texture.height());
    let bytes = read_bytes(gpu, texture, BYTES_PER_PIXEL)?;
    let number = |k: usize| u16::from_le_bytes([bytes[k], bytes[k + 1]]);
    let of = |channel: usize| {
        (0..bytes.len() / BYTES_PER_PIXEL as usize)
            .map(|k| LabelMask::half_float_to_integer(number(BYTES_PER_PIXEL as usize * k + channel)))
            .collect()
    };
    Ok(LabelMask { width, height, elements: of(0), defects: of(2) })
}

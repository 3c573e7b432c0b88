//! Rendering of shots with readback.

use super::Renderer;
use crate::gpu::device::{Gpu, GpuError};
use crate::gpu::overlay::Overlay;
use crate::gpu::picture::{picture_texture, read};
use crate::hud::DrawItem;
use crate::picture::Picture;
use crate::shot::Shot;

impl Renderer {
    /// Renders a shot and reads it back.
    ///
    /// # Errors
    /// Returns an error if the shot is too large for the device, or if the device fails or has failed before.
    pub fn picture(&mut self, gpu: &Gpu, shot: &Shot) -> Result<Picture, GpuError> {
        gpu.check_size(shot.size_px)?;
        let texture = picture_texture(gpu, shot.size_px);
        self.draw(gpu, shot, &texture.create_view(&wgpu::TextureViewDescriptor::default()));
        read(gpu, &texture)
    }

    /// Renders a shot with HUD items over it and reads it back.
    ///
    /// # Errors
    /// Returns an error if the shot is too large for the device, or if the device fails or has failed before.
    pub fn picture_with(
        &mut self,
        gpu: &Gpu,
        shot: &Shot,
        overlay: &mut Overlay,
        items: &[DrawItem],
    ) -> Result<Picture, GpuError> {
        gpu.check_size(shot.size_px)?;
        let texture = picture_texture(gpu, shot.size_px);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.draw(gpu, shot, &view);
        if !items.is_empty() {
            overlay.draw(gpu, items, &view, shot.size_px);
        }
        read(gpu, &texture)
    }
}

//! Upload and readback of pictures.

use super::device::{Gpu, GpuError};
use super::pipelines::COLOR_FORMAT;
use crate::picture::Picture;

/// Row alignment of texture copies, bytes.
const ROW_ALIGNMENT: u32 = 256;

/// Creates a picture texture that can be rendered to or filled, read back, and shown in a window.
pub fn picture_texture(gpu: &Gpu, size_px: (u32, u32)) -> wgpu::Texture {
    use wgpu::TextureUsages as Use;
    color_texture(gpu, size_px, (COLOR_FORMAT, Use::COPY_SRC | Use::COPY_DST | Use::TEXTURE_BINDING))
}

/// Uploads a picture into a texture of the same size.
pub fn fill(gpu: &Gpu, texture: &wgpu::Texture, picture: &Picture) {
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * picture.width), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), &picture.rgba, layout, texture.size());
}

/// Creates a color render target with additional usages.
pub fn color_texture(
    gpu: &Gpu,
    (width, height): (u32, u32),
    (format, also): (wgpu::TextureFormat, wgpu::TextureUsages),
) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: width.max(1), height: height.max(1), depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | also,
        view_formats: &[],
    })
}

/// Reads a texture back.
///
/// # Errors
/// Returns an error if the device fails or has failed before, because the contents would be undefined.
pub fn read(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Picture, GpuError> {
    let (width, height) = (texture.width(), texture.height());
    Ok(Picture { width, height, rgba: read_bytes(gpu, texture, 4)? })
}

/// Reads back the pixels of a texture, `pixel` bytes each.
pub fn read_bytes(gpu: &Gpu, texture: &wgpu::Texture, pixel: u32) -> Result<Vec<u8>, GpuError> {
    let (width, height) = (texture.width(), texture.height());
    let row = (pixel * width).div_ceil(ROW_ALIGNMENT) * ROW_ALIGNMENT;
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read"),
        size: u64::from(row) * u64::from(height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
        },
        texture.size(),
    );
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| {});
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| GpuError::Failed(error.to_string()))?;
    // The preceding calls succeed even if the device fails. Without this check, the picture would be black.
    gpu.fault().map_or(Ok(()), Err)?;
    let mapped = buffer.get_mapped_range(..).map_err(|error| GpuError::Failed(error.to_string()))?;
    let lines: Vec<&[u8]> = mapped.chunks(row as usize).map(|line| &line[..(pixel * width) as usize]).collect();
    Ok(lines.concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regress_device_failure_is_reported_instead_of_a_black_picture() {
        let Ok(gpu) = Gpu::open_software() else {
            println!("skipped: no software Vulkan driver (Debian and Ubuntu: apt-get install mesa-vulkan-drivers)");
            return;
        };
        let whole = picture_texture(&gpu, (16, 16));
        assert_eq!(read(&gpu, &whole).map(|picture| picture.rgba.len()), Ok(4 * 16 * 16));
        let longest = gpu.device.limits().max_texture_dimension_2d;
        assert!(gpu.check_size((longest, longest)).is_ok() && gpu.check_size((longest + 1, 16)).is_err());
        drop(picture_texture(&gpu, (longest + 1, 16)));
        assert!(matches!(read(&gpu, &whole), Err(GpuError::Failed(_))));
    }
}

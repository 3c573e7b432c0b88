//! A GPU device, with or without a window surface.

use std::sync::{Arc, OnceLock};

/// Errors that occur while opening or using a GPU device.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// No graphics device is available.
    #[error(
        "no Vulkan, Metal, or Direct3D 12 device found: install a graphics driver or a software renderer \
         (Debian and Ubuntu: apt-get install mesa-vulkan-drivers); all other features work without one ({0})"
    )]
    NoDevice(String),
    /// The device stopped working.
    #[error("the graphics device failed: {0}")]
    Failed(String),
    /// The picture exceeds the device's maximum texture size: width, height, and maximum side, px.
    #[error("a picture of {0} x {1} px is too large for this graphics device (at most {2} px per side)")]
    TooLarge(u32, u32, u32),
}

/// An open GPU device.
#[derive(Debug)]
pub struct Gpu {
    /// Logical device.
    pub device: wgpu::Device,
    /// Command queue.
    pub queue: wgpu::Queue,
    /// Name of the graphics adapter.
    pub name: String,
    /// Whether the device is a software renderer.
    pub software: bool,
    /// Adapter of the device.
    pub adapter: wgpu::Adapter,
    fault: Arc<OnceLock<String>>,
}

impl Gpu {
    /// Opens the best available device for rendering without a window.
    ///
    /// # Errors
    /// Returns an error if no device is available or the device cannot be opened.
    pub fn open() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        Self::open_for(&instance, None)
    }

    /// Opens a software renderer, which is slow but produces the same results on every machine.
    ///
    /// # Errors
    /// Returns an error if no such device is available or it cannot be opened.
    pub fn open_software() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        Self::request(&instance, None, true)
    }

    /// Opens a device that can render to a window's surface.
    ///
    /// # Errors
    /// Returns an error if no such device is available or it cannot be opened.
    pub fn open_for(instance: &wgpu::Instance, surface: Option<&wgpu::Surface<'_>>) -> Result<Self, GpuError> {
        Self::request(instance, surface, false)
    }

    /// Returns the first error since the device was opened. Pictures rendered after that error are invalid.
    #[must_use]
    pub fn fault(&self) -> Option<GpuError> {
        self.fault.get().cloned().map(GpuError::Failed)
    }

    /// Checks that a picture of the given size, in px, fits into one of the device's textures.
    ///
    /// # Errors
    /// Returns an error if either side exceeds the device's maximum.
    pub fn check_size(&self, size_px: (u32, u32)) -> Result<(), GpuError> {
        check_texture_size(size_px, self.device.limits().max_texture_dimension_2d)
    }

    fn request(instance: &wgpu::Instance, surface: Option<&wgpu::Surface<'_>>, software: bool) -> Result<Self, GpuError> {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            force_fallback_adapter: software,
            compatible_surface: surface,
            apply_limit_buckets: false,
        };
        let adapter = pollster::block_on(instance.request_adapter(&options)).map_err(|e| GpuError::NoDevice(e.to_string()))?;
        // Requests the maximum texture size, and buffers large enough to read back pictures of that size.
        let wgpu::Limits { max_texture_dimension_2d, max_buffer_size, .. } = adapter.limits();
        let limits = wgpu::Limits { max_texture_dimension_2d, max_buffer_size, ..wgpu::Limits::default() };
        let descriptor = wgpu::DeviceDescriptor { label: Some("spandrel"), required_limits: limits, ..Default::default() };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|e| GpuError::NoDevice(e.to_string()))?;
        let fault = record_errors(&device);
        let info = adapter.get_info();
        Ok(Self { fault, device, queue, name: info.name, software: info.device_type == wgpu::DeviceType::Cpu, adapter })
    }
}

fn check_texture_size((width, height): (u32, u32), longest: u32) -> Result<(), GpuError> {
    if width.max(height) > longest { Err(GpuError::TooLarge(width, height, longest)) } else { Ok(()) }
}

/// Records errors that occur outside of calls (uncaptured errors, a removed or hung GPU) and would otherwise cause a
/// panic.
fn record_errors(device: &wgpu::Device) -> Arc<OnceLock<String>> {
    let fault = Arc::new(OnceLock::new());
    // Only the first error counts; later ones are consequences of it.
    let recorder = fault.clone();
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| drop(recorder.set(error.to_string()))));
    let recorder = fault.clone();
    device.set_device_lost_callback(move |why, words| {
        // Dropping a device is not an error.
        if why != wgpu::DeviceLostReason::Destroyed {
            drop(recorder.set(format!("device lost: {words}")));
        }
    });
    fault
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_too_large_picture_is_rejected_with_size_and_limit() {
        assert_eq!(check_texture_size((8192, 16), 8192), Ok(()));
        for (width, height) in [(8193, 16), (16, 8193)] {
            let told = check_texture_size((width, height), 8192).expect_err("too large").to_string();
            assert!(told.contains(&format!("{width} x {height} px")) && told.contains("at most 8192 px"), "{told}");
        }
    }

    #[test]
    fn regress_device_failure_is_reported_without_a_panic() {
        let Ok(gpu) = Gpu::open_software() else {
            println!("skipped: no software Vulkan driver (Debian and Ubuntu: apt-get install mesa-vulkan-drivers)");
            return;
        };
        assert_eq!(gpu.fault(), None);
        let size = wgpu::Extent3d { width: 0, height: 1, depth_or_array_layers: 1 };
        let _ = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("without a width"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba8Unorm,
            usage: wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let told = gpu.fault().expect("it failed").to_string();
        assert!(told.contains("without a width"), "{told}");
    }
}

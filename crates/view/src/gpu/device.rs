//! A graphics device, with or without a screen.

use std::sync::{Arc, OnceLock};

/// Why nothing can be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// There is no device.
    #[error(
        "there is no Vulkan (or Metal, or Direct3D 12) device to draw with: install a graphics driver, or a software one \
         (Debian and Ubuntu: apt-get install mesa-vulkan-drivers); everything else works without ({0})"
    )]
    NoDevice(String),
    /// It stopped working.
    #[error("the graphics device failed: {0}")]
    Failed(String),
    /// No texture of it holds such a picture: width, height and the device's longest side, px.
    #[error("a picture of {0} x {1} px is too large for this graphics device, which draws at most {2} px a side")]
    TooLarge(u32, u32, u32),
}

/// An open device.
#[derive(Debug)]
pub struct Gpu {
    /// Makes things.
    pub device: wgpu::Device,
    /// Does things.
    pub queue: wgpu::Queue,
    /// What it calls itself.
    pub name: String,
    /// It is a program on the processor, not a graphics card.
    pub software: bool,
    /// Whose device it is.
    pub adapter: wgpu::Adapter,
    fault: Arc<OnceLock<String>>,
}

impl Gpu {
    /// Opens the best device for drawing without a window.
    ///
    /// # Errors
    /// When there is none, or it does not open.
    pub fn open() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        Self::open_for(&instance, None)
    }

    /// Opens a renderer in software: slow, and the same on every machine.
    ///
    /// # Errors
    /// When there is none, or it does not open.
    pub fn open_software() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        Self::request(&instance, None, true)
    }

    /// Opens a device that can draw on a window's surface.
    ///
    /// # Errors
    /// When there is none, or it does not open.
    pub fn open_for(instance: &wgpu::Instance, surface: Option<&wgpu::Surface<'_>>) -> Result<Self, GpuError> {
        Self::request(instance, surface, false)
    }

    /// What went wrong first since it was opened: what is drawn from then on is worth nothing.
    #[must_use]
    pub fn fault(&self) -> Option<GpuError> {
        self.fault.get().cloned().map(GpuError::Failed)
    }

    /// Refuses a picture of a size, px, that no texture of the device holds.
    ///
    /// # Errors
    /// When a side is longer than the device's longest.
    pub fn check_size(&self, size_px: (u32, u32)) -> Result<(), GpuError> {
        fits(size_px, self.device.limits().max_texture_dimension_2d)
    }

    fn request(instance: &wgpu::Instance, surface: Option<&wgpu::Surface<'_>>, software: bool) -> Result<Self, GpuError> {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            force_fallback_adapter: software,
            compatible_surface: surface,
            apply_limit_buckets: false,
        };
        let adapter = pollster::block_on(instance.request_adapter(&options)).map_err(|e| GpuError::NoDevice(e.to_string()))?;
        // The largest pictures that the device can draw, and buffers that they can be read back through.
        let wgpu::Limits { max_texture_dimension_2d, max_buffer_size, .. } = adapter.limits();
        let limits = wgpu::Limits { max_texture_dimension_2d, max_buffer_size, ..wgpu::Limits::default() };
        let descriptor = wgpu::DeviceDescriptor { label: Some("spandrel"), required_limits: limits, ..Default::default() };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|e| GpuError::NoDevice(e.to_string()))?;
        let fault = watch(&device);
        let info = adapter.get_info();
        Ok(Self { fault, device, queue, name: info.name, software: info.device_type == wgpu::DeviceType::Cpu, adapter })
    }
}

fn fits((width, height): (u32, u32), longest: u32) -> Result<(), GpuError> {
    if width.max(height) > longest { Err(GpuError::TooLarge(width, height, longest)) } else { Ok(()) }
}

/// Keeps what goes wrong beside any call (an error that nobody asks for, a card that is pulled out or hangs); by itself that would end the
/// program by a panic.
fn watch(device: &wgpu::Device) -> Arc<OnceLock<String>> {
    let fault = Arc::new(OnceLock::new());
    // The first one counts: the others follow from it.
    let keeps = fault.clone();
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| drop(keeps.set(error.to_string()))));
    let keeps = fault.clone();
    device.set_device_lost_callback(move |why, words| {
        // Letting go of a device is no fault.
        if why != wgpu::DeviceLostReason::Destroyed {
            drop(keeps.set(format!("it is lost: {words}")));
        }
    });
    fault
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_picture_too_large_is_refused_with_its_size_and_the_limit() {
        assert_eq!(fits((8192, 16), 8192), Ok(()));
        for (width, height) in [(8193, 16), (16, 8193)] {
            let told = fits((width, height), 8192).expect_err("too large").to_string();
            assert!(told.contains(&format!("{width} x {height} px")) && told.contains("at most 8192 px"), "{told}");
        }
    }

    #[test]
    fn regress_a_device_that_fails_is_reported_and_no_panic() {
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

//! A graphics device, with or without a screen.

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

    fn request(instance: &wgpu::Instance, surface: Option<&wgpu::Surface<'_>>, software: bool) -> Result<Self, GpuError> {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            force_fallback_adapter: software,
            compatible_surface: surface,
            apply_limit_buckets: false,
        };
        let adapter = pollster::block_on(instance.request_adapter(&options)).map_err(|e| GpuError::NoDevice(e.to_string()))?;
        let limits =
            wgpu::Limits { max_texture_dimension_2d: adapter.limits().max_texture_dimension_2d, ..wgpu::Limits::default() };
        let descriptor = wgpu::DeviceDescriptor { label: Some("spandrel"), required_limits: limits, ..Default::default() };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&descriptor)).map_err(|e| GpuError::NoDevice(e.to_string()))?;
        let info = adapter.get_info();
        Ok(Self { device, queue, name: info.name, software: info.device_type == wgpu::DeviceType::Cpu, adapter })
    }
}

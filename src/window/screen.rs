//! A window with a surface to render to, and its connection to egui.

use crate::errors::AppError;
use spandrel_view::gpu::{Gpu, GpuError, PaintArea, Painter};
use std::sync::Arc;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::ActiveEventLoop;
use winit::monitor::MonitorHandle;
use winit::window::{Fullscreen, Window};

/// Returns a display other than the primary one.
fn second_display(events: &ActiveEventLoop) -> Option<MonitorHandle> {
    let first = events.primary_monitor().or_else(|| events.available_monitors().next());
    events.available_monitors().find(|display| Some(display) != first.as_ref())
}

/// The window and its graphics device.
pub struct WindowSurface {
    /// Operating system window.
    pub window: Arc<Window>,
    /// Graphics device that renders to the window.
    pub gpu: Gpu,
    /// Draws egui's output and the views' images.
    pub painter: Painter,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    input: egui_winit::State,
    freed_textures: Vec<egui::TextureId>,
}

impl WindowSurface {
    /// Opens a window of this size in px, multiplied by the display's scale factor, or a window that fills the second display, if
    /// there is one.
    ///
    /// # Errors
    /// Returns an error if there is no display or no graphics device.
    pub fn open(
        events: &ActiveEventLoop,
        title: &str,
        (width, height): (u32, u32),
        second_screen: bool,
    ) -> Result<Self, AppError> {
        // The window is never larger than the display, because its edges would then be hidden.
        let display = events.primary_monitor().or_else(|| events.available_monitors().next());
        let scale = display.as_ref().map_or(1.0, |display| display.scale_factor().max(1.0));
        let wanted = PhysicalSize::new((scale * f64::from(width)).round() as u32, (scale * f64::from(height)).round() as u32);
        let room = display.map(|display| display.size()).filter(|size| size.width > 0 && size.height > 0).unwrap_or(wanted);
        let size = PhysicalSize::new(wanted.width.min(room.width), wanted.height.min(room.height));
        let second = if second_screen { second_display(events) } else { None };
        let full_screen = second.map(|display| Fullscreen::Borderless(Some(display)));
        let attributes = Window::default_attributes().with_title(title).with_inner_size(size).with_fullscreen(full_screen);
        let failed = |why: String| AppError::failed(format!("cannot open a window: {why}"));
        let window = Arc::new(events.create_window(attributes).map_err(|error| failed(error.to_string()))?);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        // Creating a surface fails if there is no driver.
        let surface = instance.create_surface(window.clone()).map_err(|error| GpuError::NoDevice(error.to_string()))?;
        let gpu = Gpu::open_for(&instance, Some(&surface))?;
        let size = window.inner_size();
        let config = surface
            .get_default_config(&gpu.adapter, size.width.max(1), size.height.max(1))
            .ok_or_else(|| failed(format!("{} cannot render to windows", gpu.name)))?;
        // egui's output and the rendered images are already in sRGB, so the surface must not convert them again.
        let plain = [wgpu::TextureFormat::Bgra8Unorm, wgpu::TextureFormat::Rgba8Unorm];
        let formats = surface.get_capabilities(&gpu.adapter).formats;
        let format = plain.into_iter().find(|format| formats.contains(format)).unwrap_or(config.format);
        let config = wgpu::SurfaceConfiguration { format, ..config };
        surface.configure(&gpu.device, &config);
        let input = egui_winit::State::new(
            egui::Context::default(),
            egui::ViewportId::ROOT,
            &window,
            Some(window.scale_factor() as f32),
            None,
            Some(gpu.device.limits().max_texture_dimension_2d as usize),
        );
        let painter = Painter::new(&gpu, format);
        Ok(Self { window, gpu, painter, surface, config, input, freed_textures: Vec::new() })
    }

    /// Passes an event to egui. Returns true if egui consumed it.
    pub fn handle_event(&mut self, event: &WindowEvent) -> bool {
        if let WindowEvent::Resized(size) = event {
            (self.config.width, self.config.height) = (size.width.max(1), size.height.max(1));
            self.surface.configure(&self.gpu.device, &self.config);
        }
        self.input.on_window_event(&self.window, event).consumed
    }

    /// Runs egui and shows the result. Returns whether the system has accepted it.
    pub fn show(&mut self, ui: impl FnMut(&mut egui::Ui)) -> Result<bool, AppError> {
        use wgpu::CurrentSurfaceTexture as Current;
        let jobs = self.run(ui);
        let frame = match self.surface.get_current_texture() {
            Current::Success(frame) => frame,
            Current::Suboptimal(frame) => frame,
            Current::Timeout | Current::Occluded => return Ok(false),
            Current::Outdated | Current::Lost => {
                self.surface.configure(&self.gpu.device, &self.config);
                return Ok(false);
            }
            Current::Validation => return Err(AppError::failed("the graphics device rejected the window's surface")),
        };
        let view = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.paint(&jobs, &view);
        self.window.pre_present_notify();
        self.gpu.queue.present(frame);
        Ok(true)
    }

    /// Runs egui and returns the result as an image.
    pub fn picture(&mut self, ui: impl FnMut(&mut egui::Ui)) -> Result<spandrel_view::picture::Picture, AppError> {
        let jobs = self.run(ui);
        let descriptor = wgpu::TextureDescriptor {
            label: Some("window"),
            size: wgpu::Extent3d { width: self.config.width, height: self.config.height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: self.config.format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        };
        let texture = self.gpu.device.create_texture(&descriptor);
        self.paint(&jobs, &texture.create_view(&wgpu::TextureViewDescriptor::default()));
        let mut picture = spandrel_view::gpu::read(&self.gpu, &texture)?;
        if self.config.format == wgpu::TextureFormat::Bgra8Unorm {
            picture.rgba.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
        }
        Ok(picture)
    }

    fn run(&mut self, mut ui: impl FnMut(&mut egui::Ui)) -> Vec<egui::ClippedPrimitive> {
        let context = self.input.egui_ctx().clone();
        let raw = self.input.take_egui_input(&self.window);
        let mut output = context.run_ui(raw, |root| ui(root));
        self.input.handle_platform_output(&self.window, std::mem::take(&mut output.platform_output));
        let mut changes = std::mem::take(&mut output.textures_delta);
        self.painter.update_textures(&self.gpu, &changes);
        let jobs = context.tessellate(std::mem::take(&mut output.shapes), output.pixels_per_point);
        // The frame that is painted next may still show the textures that it frees.
        for id in std::mem::replace(&mut self.freed_textures, changes.free.iter().copied().collect()) {
            self.painter.free_texture(id);
        }
        changes.clear();
        jobs
    }

    fn paint(&self, jobs: &[egui::ClippedPrimitive], target: &wgpu::TextureView) {
        let area = PaintArea {
            size_px: (self.config.width, self.config.height),
            px_per_point: self.input.egui_ctx().pixels_per_point(),
        };
        self.painter.paint(&self.gpu, jobs, (target, wgpu::LoadOp::Clear(wgpu::Color::BLACK)), area);
    }
}

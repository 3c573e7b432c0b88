//! Draws egui's meshes, and rendered pictures between them.
//!
//! This replaces egui-wgpu, whose shader contains two filters and a dither pattern. A software renderer evaluates all of them for each
//! pixel, so it spent more time on the displays of a flight than on its views.

use super::device::Gpu;
use super::pass::{begin_loading, uniform, upload};
use super::pipelines::PainterPipelines;
use egui::epaint::{ClippedPrimitive, ImageData, ImageDelta, PaintCallback, Primitive, Vertex};
use egui::{Rect, TextureId, TexturesDelta};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Size of the uniform buffer, bytes: width and height.
const SIZE_BYTES: usize = size_of::<[f32; 2]>();

/// Size of a target and its pixels per point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaintArea {
    /// Width and height, px.
    pub size_px: (u32, u32),
    /// Number of pixels per point.
    pub px_per_point: f32,
}

/// Draws egui's output. Textures are filtered linearly and not repeated.
#[derive(Debug)]
pub struct Painter {
    pipelines: PainterPipelines,
    size: wgpu::Buffer,
    size_binding: wgpu::BindGroup,
    textures: BTreeMap<TextureId, (wgpu::Texture, wgpu::BindGroup)>,
}

/// A rendered picture that egui places among its shapes.
#[derive(Debug, Clone)]
pub struct PanePicture(wgpu::BindGroup);

impl PanePicture {
    /// Returns the shape that fills a rectangle with the picture. The rectangle must be inside the target.
    pub fn shape(&self, rect: Rect) -> egui::Shape {
        PaintCallback { rect, callback: Arc::new(self.clone()) }.into()
    }
}

impl Painter {
    /// Creates a painter for targets of a pixel format.
    #[must_use]
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let pipelines = PainterPipelines::new(gpu, format);
        let size = uniform(gpu, SIZE_BYTES);
        let size_binding = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("painter"),
            layout: &pipelines.size_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: size.as_entire_binding() }],
        });
        Self { pipelines, size, size_binding, textures: BTreeMap::new() }
    }

    /// Prepares a rendered picture. It shows what its texture contains when the shapes are drawn.
    #[must_use]
    pub fn picture(&self, gpu: &Gpu, texture: &wgpu::TextureView) -> PanePicture {
        PanePicture(self.bind(gpu, texture))
    }

    /// Sets and changes egui's textures. The textures to free are freed by the caller, after painting.
    pub fn update_textures(&mut self, gpu: &Gpu, changes: &TexturesDelta) {
        for (id, deltas) in &changes.set {
            deltas.iter().for_each(|delta| self.update_texture(gpu, *id, delta));
        }
    }

    fn update_texture(&mut self, gpu: &Gpu, id: TextureId, delta: &ImageDelta) {
        let ImageData::Color(image) = &delta.image;
        let [width, height] = image.size.map(|side| side as u32);
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        if delta.pos.is_none() {
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("egui"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba8Unorm,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            let binding = self.bind(gpu, &texture.create_view(&wgpu::TextureViewDescriptor::default()));
            self.textures.insert(id, (texture, binding));
        }
        // egui changes only textures that it has set before.
        let Some((texture, _)) = self.textures.get(&id) else { return };
        let [x, y] = delta.pos.unwrap_or_default().map(|side| side as u32);
        let origin = wgpu::Origin3d { x, y, z: 0 };
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
        let place = wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() };
        gpu.queue.write_texture(place, bytemuck::cast_slice(&image.pixels), layout, size);
    }

    /// Frees one of egui's textures.
    pub fn free_texture(&mut self, id: TextureId) {
        self.textures.remove(&id);
    }

    /// Draws egui's output into a target and submits the work. `load` is what the target contains before.
    pub fn paint(
        &self,
        gpu: &Gpu,
        jobs: &[ClippedPrimitive],
        (target, load): (&wgpu::TextureView, wgpu::LoadOp<wgpu::Color>),
        area: PaintArea,
    ) {
        let (width, height) = area.size_px;
        let points = [width as f32 / area.px_per_point, height as f32 / area.px_per_point];
        gpu.queue.write_buffer(&self.size, 0, bytemuck::cast_slice(&points));
        let buffers = MeshBuffers::of(gpu, jobs);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = begin_loading(&mut encoder, (target, load), None, None);
            pass.set_bind_group(0, &self.size_binding, &[]);
            self.draw(&mut pass, jobs, &buffers, area);
        }
        gpu.queue.submit([encoder.finish()]);
    }

    fn draw(&self, pass: &mut wgpu::RenderPass, jobs: &[ClippedPrimitive], buffers: &MeshBuffers, area: PaintArea) {
        let (mut first_vertex, mut first_index) = (0, 0);
        for job in jobs {
            let clip = PixelRect::of(job.clip_rect, area);
            match &job.primitive {
                Primitive::Mesh(mesh) => {
                    let (base, indices) = (first_vertex, first_index..first_index + mesh.indices.len() as u32);
                    (first_vertex, first_index) = (base + mesh.vertices.len() as i32, indices.end);
                    let Some((_, texture)) = self.textures.get(&mesh.texture_id).filter(|_| !clip.is_empty()) else { continue };
                    pass.set_viewport(0.0, 0.0, area.size_px.0 as f32, area.size_px.1 as f32, 0.0, 1.0);
                    clip.apply_as_scissor(pass);
                    pass.set_pipeline(&self.pipelines.meshes);
                    pass.set_bind_group(1, texture, &[]);
                    buffers.bind(pass);
                    pass.draw_indexed(indices, base, 0..1);
                }
                Primitive::Callback(callback) => {
                    let place = PixelRect::of(callback.rect, area);
                    let picture = callback.callback.downcast_ref::<PanePicture>();
                    let Some(PanePicture(texture)) = picture.filter(|_| !clip.is_empty() && !place.is_empty()) else { continue };
                    place.apply_as_viewport(pass);
                    clip.apply_as_scissor(pass);
                    pass.set_pipeline(&self.pipelines.pictures);
                    pass.set_bind_group(1, texture, &[]);
                    pass.draw(0..6, 0..1);
                }
            }
        }
    }

    fn bind(&self, gpu: &Gpu, texture: &wgpu::TextureView) -> wgpu::BindGroup {
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("painter"),
            layout: &self.pipelines.texture_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(texture) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&self.pipelines.smooth) },
            ],
        })
    }
}

/// The vertices and indices of all meshes, one mesh after the other.
struct MeshBuffers {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
}

impl MeshBuffers {
    fn of(gpu: &Gpu, jobs: &[ClippedPrimitive]) -> Self {
        let meshes = || {
            jobs.iter().filter_map(|job| match &job.primitive {
                Primitive::Mesh(mesh) => Some(mesh),
                Primitive::Callback(_) => None,
            })
        };
        let vertices: Vec<Vertex> = meshes().flat_map(|mesh| mesh.vertices.iter().copied()).collect();
        let indices: Vec<u32> = meshes().flat_map(|mesh| mesh.indices.iter().copied()).collect();
        Self {
            vertices: upload(gpu, bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            indices: upload(gpu, bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX),
        }
    }

    fn bind(&self, pass: &mut wgpu::RenderPass) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
    }
}

/// A rectangle of whole pixels inside a target: left, top, right, bottom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct PixelRect([u32; 4]);

impl PixelRect {
    /// Returns the part of a rectangle in points that is inside a target.
    fn of(rect: Rect, area: PaintArea) -> Self {
        let side = |points: f32, limit: u32| ((points * area.px_per_point).round().max(0.0) as u32).min(limit);
        let (width, height) = area.size_px;
        Self([side(rect.min.x, width), side(rect.min.y, height), side(rect.max.x, width), side(rect.max.y, height)])
    }

    fn is_empty(self) -> bool {
        let Self([left, top, right, bottom]) = self;
        left >= right || top >= bottom
    }

    fn apply_as_scissor(self, pass: &mut wgpu::RenderPass) {
        let Self([left, top, right, bottom]) = self;
        pass.set_scissor_rect(left, top, right - left, bottom - top);
    }

    fn apply_as_viewport(self, pass: &mut wgpu::RenderPass) {
        let Self([left, top, right, bottom]) = self;
        pass.set_viewport(left as f32, top as f32, (right - left) as f32, (bottom - top) as f32, 0.0, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    /// Paints a gray picture into the right half of a black target, and a half-transparent white mesh over the lower half. Returns the
    /// red values of four pixels: background, picture, mesh over the picture, mesh over the background.
    fn painted(gpu: &Gpu, format: wgpu::TextureFormat) -> [u8; 4] {
        use super::super::picture::{color_texture, picture_texture, read};
        const SIZE_PX: (u32, u32) = (32, 32);
        let source = picture_texture(gpu, (2, 2));
        super::super::fill(
            gpu,
            &source,
            &crate::picture::Picture { width: 2, height: 2, rgba: [GRAY, GRAY, GRAY, 255].repeat(4) },
        );
        let mut painter = Painter::new(gpu, format);
        let picture = painter.picture(gpu, &source.create_view(&wgpu::TextureViewDescriptor::default()));
        let half_white = egui::Color32::from_white_alpha(128);
        let mut white = ImageDelta::full(egui::ColorImage::filled([1, 1], egui::Color32::WHITE), egui::TextureOptions::LINEAR);
        painter.update_texture(gpu, TextureId::default(), &white);
        white.pos = Some([0, 0]);
        painter.update_texture(gpu, TextureId::default(), &white);
        let whole = Rect::from_min_max(egui::Pos2::ZERO, pos2(32.0, 32.0));
        let mesh = |from, to| {
            let mut mesh = egui::Mesh::with_texture(TextureId::default());
            mesh.add_colored_rect(Rect::from_min_max(from, to), half_white);
            Primitive::Mesh(mesh)
        };
        let right = Rect::from_min_max(pos2(16.0, 0.0), pos2(32.0, 32.0));
        let egui::Shape::Callback(shape) = picture.shape(right) else { panic!("a picture is a callback") };
        let primitives =
            [mesh(pos2(0.0, 0.0), pos2(4.0, 4.0)), Primitive::Callback(shape), mesh(pos2(0.0, 16.0), pos2(32.0, 32.0))];
        let jobs = primitives.map(|primitive| ClippedPrimitive { clip_rect: whole, primitive });
        let target = color_texture(gpu, SIZE_PX, (format, wgpu::TextureUsages::COPY_SRC));
        let view = target.create_view(&wgpu::TextureViewDescriptor::default());
        let area = PaintArea { size_px: SIZE_PX, px_per_point: 1.0 };
        painter.paint(gpu, &jobs, (&view, wgpu::LoadOp::Clear(wgpu::Color::BLACK)), area);
        painter.free_texture(TextureId::default());
        let shown = read(gpu, &target).unwrap();
        [(8, 8), (24, 8), (24, 24), (8, 24)].map(|(x, y)| shown.at(x, y)[0])
    }

    /// Value of the picture's pixels, out of 255.
    const GRAY: u8 = 100;

    #[test]
    fn exact_pictures_and_meshes_are_painted_in_order() {
        let Ok(gpu) = Gpu::open_software() else {
            println!("skipped: no software Vulkan driver (Debian and Ubuntu: apt-get install mesa-vulkan-drivers)");
            return;
        };
        // Half of white over gray: 128 + 100 (1 - 128/255).
        assert_eq!(painted(&gpu, wgpu::TextureFormat::Rgba8Unorm), [0, GRAY, 178, 128]);
        // A target that converts to sRGB shows the same values where nothing is blended.
        let converted = painted(&gpu, wgpu::TextureFormat::Rgba8UnormSrgb);
        assert_eq!(converted[..2], [0, GRAY]);
    }

    #[test]
    fn exact_rectangles_are_rounded_and_cut_to_the_target() {
        let area = PaintArea { size_px: (100, 50), px_per_point: 2.0 };
        let of = |min, max| PixelRect::of(Rect::from_min_max(min, max), area);
        assert_eq!(of(pos2(1.2, 0.0), pos2(10.0, 20.3)), PixelRect([2, 0, 20, 41]));
        assert_eq!(of(pos2(-5.0, f32::NEG_INFINITY), pos2(f32::INFINITY, 60.0)), PixelRect([0, 0, 100, 50]));
        assert!(of(pos2(60.0, 0.0), pos2(70.0, 10.0)).is_empty() && of(pos2(1.0, 3.0), pos2(9.0, 3.1)).is_empty());
    }
}

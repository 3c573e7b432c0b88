//! Head-up display over a rendered picture.

use super::device::Gpu;
use super::painter::{PaintArea, Painter};
use super::pipelines::COLOR_FORMAT;
use crate::flow::sheet::PictureSource;
use crate::flow::{PICTURES, PageLayout};
use crate::hud::{DrawItem, ScreenPoint, TextAlign};
use crate::picture::Picture;
use egui::{Align2, Color32, FontId, Pos2, Rect, Shape, Stroke};
use std::collections::{BTreeMap, BTreeSet};

/// Draws text and shapes over pictures.
pub struct Overlay {
    context: egui::Context,
    painter: Painter,
}

impl std::fmt::Debug for Overlay {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Overlay").finish_non_exhaustive()
    }
}

impl Overlay {
    /// Creates an overlay for picture textures.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        Self { context: egui::Context::default(), painter: Painter::new(gpu, COLOR_FORMAT) }
    }

    /// Draws items over the contents of `target`; the size is in px.
    pub fn draw(&mut self, gpu: &Gpu, items: &[DrawItem], target: &wgpu::TextureView, size_px: (u32, u32)) {
        self.draw_with(gpu, target, size_px, |painter, rect| paint(painter, items, rect));
    }

    /// Draws a page over the contents of `target`; the size is in px.
    pub fn draw_page(
        &mut self,
        gpu: &Gpu,
        sheet: &PageLayout,
        pictures: &mut PageTextures,
        target: &wgpu::TextureView,
        size_px: (u32, u32),
    ) {
        self.draw_with(gpu, target, size_px, |painter, rect| paint_sheet(painter, sheet, rect, pictures));
    }

    fn draw_with(
        &mut self,
        gpu: &Gpu,
        target: &wgpu::TextureView,
        size_px: (u32, u32),
        mut contents: impl FnMut(&egui::Painter, Rect),
    ) {
        let size = egui::vec2(size_px.0 as f32, size_px.1 as f32);
        let rect = Rect::from_min_size(Pos2::ZERO, size);
        let input = egui::RawInput { screen_rect: Some(rect), ..egui::RawInput::default() };
        let mut output = self.context.run_ui(input, |ui| contents(&ui.ctx().layer_painter(egui::LayerId::background()), rect));
        let mut changes = std::mem::take(&mut output.textures_delta);
        self.painter.update_textures(gpu, &changes);
        let shapes = std::mem::take(&mut output.shapes);
        let jobs = self.context.tessellate(shapes, 1.0);
        self.painter.paint(gpu, &jobs, (target, wgpu::LoadOp::Load), PaintArea { size_px, px_per_point: 1.0 });
        for id in &changes.free {
            self.painter.free_texture(*id);
        }
        changes.clear();
    }
}

/// Pictures of the pages, as textures of one egui context.
pub struct PageTextures {
    textures: BTreeMap<PictureSource, egui::TextureHandle>,
    /// Pictures of jobs that are not textures yet.
    jobs: BTreeMap<String, Picture>,
    /// Files that cannot be loaded, so that they are not read again for each frame.
    unreadable: BTreeSet<String>,
    load: fn(&str) -> Option<Picture>,
}

impl PageTextures {
    /// Creates an empty set. `load` reads the picture file at a path; `None` if that is impossible.
    #[must_use]
    pub fn new(load: fn(&str) -> Option<Picture>) -> Self {
        Self { textures: BTreeMap::new(), jobs: BTreeMap::new(), unreadable: BTreeSet::new(), load }
    }

    /// Adds the picture of a job, by the job's name or path.
    pub fn add_job(&mut self, name: String, picture: Picture) {
        self.jobs.insert(name, picture);
    }

    /// Returns a picture, loading it on first use; `None` if it cannot be loaded or does not exist yet.
    fn of(&mut self, context: &egui::Context, source: &PictureSource) -> Option<egui::TextureId> {
        if !self.textures.contains_key(source) {
            let (name, image) = match source {
                PictureSource::Embedded(name) => {
                    let (_, bytes) = PICTURES.iter().find(|known| known.0 == *name)?;
                    (*name, decode_jpeg(bytes)?)
                }
                PictureSource::File(path) => (path.as_str(), self.load_file(path)?),
                PictureSource::Job(name) => (name.as_str(), self.jobs.remove(name)?),
            };
            let texture = context.load_texture(name, color_image(&image), egui::TextureOptions::LINEAR);
            self.textures.insert(source.clone(), texture);
        }
        self.textures.get(source).map(egui::TextureHandle::id)
    }

    /// Loads a file, unless it could not be loaded before.
    fn load_file(&mut self, path: &str) -> Option<Picture> {
        if self.unreadable.contains(path) {
            return None;
        }
        let picture = (self.load)(path);
        if picture.is_none() {
            self.unreadable.insert(path.to_owned());
        }
        picture
    }

    /// Frees the pictures from files that a page does not show. A file that could not be loaded is tried again when a page shows it
    /// the next time.
    fn keep_files_of(&mut self, sheet: &PageLayout) {
        let is_shown = |source: &PictureSource| sheet.pictures.iter().any(|picture| picture.source == *source);
        self.textures.retain(|source, _| !matches!(source, PictureSource::File(_)) || is_shown(source));
        self.unreadable.retain(|path| is_shown(&PictureSource::File(path.clone())));
    }
}

/// Converts a picture to an egui image.
fn color_image(picture: &Picture) -> egui::ColorImage {
    egui::ColorImage::from_rgba_unmultiplied([picture.width as usize, picture.height as usize], &picture.rgba)
}

/// Decodes a JPEG file; `None` if that is impossible. Does not apply its orientation.
#[must_use]
pub fn decode_jpeg(bytes: &[u8]) -> Option<Picture> {
    let mut decoder = zune_jpeg::JpegDecoder::new(zune_jpeg::zune_core::bytestream::ZCursor::new(bytes));
    let pixels = decoder.decode().ok()?;
    let (width, height) = decoder.dimensions()?;
    if pixels.len() != 3 * width * height {
        return None;
    }
    let rgba = pixels.chunks_exact(3).flat_map(|pixel| [pixel[0], pixel[1], pixel[2], u8::MAX]).collect();
    Some(Picture { width: u32::try_from(width).ok()?, height: u32::try_from(height).ok()?, rgba })
}

/// Paints a page into a rectangle.
pub fn paint_sheet(painter: &egui::Painter, sheet: &PageLayout, rect: Rect, pictures: &mut PageTextures) {
    // The background of a page is below its pictures.
    let ground = usize::from(matches!(sheet.items.first(), Some(DrawItem::Fill { points, .. }) if points.len() == 4));
    let (ground, items) = sheet.items.split_at(ground.min(sheet.items.len()));
    paint(painter, ground, rect);
    let size = rect.size();
    let px = |p: &ScreenPoint| rect.min + egui::vec2(p.x as f32 * size.x, p.y as f32 * size.y);
    let whole = Rect::from_min_max(Pos2::ZERO, egui::pos2(1.0, 1.0));
    pictures.keep_files_of(sheet);
    for picture in &sheet.pictures {
        if let Some(texture) = pictures.of(painter.ctx(), &picture.source) {
            painter.image(texture, Rect::from_min_max(px(&picture.from), px(&picture.to)), whole, Color32::WHITE);
        }
    }
    paint(painter, items, rect);
}

/// Paints items over the picture in a rectangle.
pub fn paint(painter: &egui::Painter, items: &[DrawItem], rect: Rect) {
    for item in items {
        paint_item(painter, item, rect);
    }
}

fn paint_item(painter: &egui::Painter, item: &DrawItem, rect: Rect) {
    let size = rect.size();
    let px = |p: &ScreenPoint| rect.min + egui::vec2(p.x as f32 * size.x, p.y as f32 * size.y);
    let color = |c: crate::hud::HudColor| {
        let [r, g, b, a] = c.rgba();
        Color32::from_rgba_unmultiplied(r, g, b, a)
    };
    match item {
        DrawItem::Panel { from, to, color: fill } => {
            painter.add(Shape::rect_filled(Rect::from_min_max(px(from), px(to)), 0.012 * size.y, color(*fill)));
        }
        DrawItem::Text { place, side, height, color: ink, words } => {
            let align = match side {
                TextAlign::Left => Align2::LEFT_CENTER,
                TextAlign::Center => Align2::CENTER_CENTER,
                TextAlign::Right => Align2::RIGHT_CENTER,
            };
            painter.text(px(place), align, words, FontId::proportional(*height as f32 * size.y), color(*ink));
        }
        DrawItem::Fill { points, color: fill } => {
            painter.add(Shape::convex_polygon(points.iter().map(px).collect(), color(*fill), Stroke::NONE));
        }
        DrawItem::Line { points, width, color: ink } => {
            let stroke = Stroke::new((*width as f32 * size.y).max(1.0), color(*ink));
            painter.add(Shape::line(points.iter().map(px).collect(), stroke));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_tutorial_pictures_can_be_decoded() {
        for (name, bytes) in PICTURES {
            let picture = decode_jpeg(bytes).unwrap_or_else(|| panic!("{name}"));
            assert!(picture.width >= 400 && picture.height >= 150, "{name}: {} x {}", picture.width, picture.height);
        }
        assert!(decode_jpeg(b"no picture").is_none());
    }
}

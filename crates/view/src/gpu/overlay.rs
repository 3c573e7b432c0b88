//! Head-up display over a rendered picture.

use super::device::Gpu;
use super::painter::{PaintArea, Painter};
use super::pipelines::COLOR_FORMAT;
use crate::flow::sheet::PictureSource;
use crate::flow::{PICTURES, PageLayout};
use crate::hud::{DrawItem, HudColor, ScreenPoint, TextAlign};
use crate::picture::Picture;
use egui::{Align2, Color32, FontId, Pos2, Rect, Shape, Stroke};
use std::collections::BTreeMap;

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

/// A picture in the form that becomes a texture. The conversion of a large picture takes longer than a frame, so it can be made on
/// another thread.
pub struct PageImage(egui::ColorImage);

impl PageImage {
    /// Converts a picture.
    #[must_use]
    pub fn new(picture: &Picture) -> Self {
        let size = [picture.width as usize, picture.height as usize];
        Self(egui::ColorImage::from_rgba_unmultiplied(size, &picture.rgba))
    }

    /// Returns width and height, px.
    #[must_use]
    pub fn size_px(&self) -> (usize, usize) {
        (self.0.width(), self.0.height())
    }
}

impl std::fmt::Debug for PageImage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("PageImage").field(&self.0.size).finish()
    }
}

/// Pictures of the pages, as textures of one egui context. The caller reads the files ([`Self::missing_files`]).
#[derive(Default)]
pub struct PageTextures {
    textures: BTreeMap<PictureSource, egui::TextureHandle>,
    /// Pictures of jobs that are not textures yet.
    jobs: BTreeMap<String, PageImage>,
    /// Pictures from files that are not textures yet; `None` for a file that cannot be read.
    files: BTreeMap<String, Option<PageImage>>,
}

impl PageTextures {
    /// Adds the picture of a job, by the job's name or path.
    pub fn add_job(&mut self, name: String, picture: PageImage) {
        self.jobs.insert(name, picture);
    }

    /// Adds the picture from the file at a path; `None` if it cannot be read, so that nothing is drawn in its place.
    pub fn add_file(&mut self, path: String, picture: Option<PageImage>) {
        self.files.insert(path, picture);
    }

    /// Returns the paths of a page's picture files that have not been added.
    #[must_use]
    pub fn missing_files(&self, sheet: &PageLayout) -> Vec<String> {
        let missing = |source: &PictureSource| match source {
            PictureSource::File(path) if self.is_missing(source) => Some(path.clone()),
            PictureSource::File(_) | PictureSource::Embedded(_) | PictureSource::Job(_) => None,
        };
        sheet.pictures.iter().filter_map(|picture| missing(&picture.source)).collect()
    }

    /// Returns whether a picture comes from a file that has not been added.
    fn is_missing(&self, source: &PictureSource) -> bool {
        let PictureSource::File(path) = source else { return false };
        !self.files.contains_key(path) && !self.textures.contains_key(source)
    }

    /// Returns a picture, making its texture on first use; `None` if it cannot be loaded or does not exist yet.
    fn of(&mut self, context: &egui::Context, source: &PictureSource) -> Option<egui::TextureId> {
        if !self.textures.contains_key(source) {
            let (name, PageImage(image)) = match source {
                PictureSource::Embedded(name) => {
                    let (_, bytes) = PICTURES.iter().find(|known| known.0 == *name)?;
                    (*name, PageImage::new(&decode_jpeg(bytes)?))
                }
                PictureSource::File(path) => (path.as_str(), self.take_file(path)?),
                PictureSource::Job(name) => (name.as_str(), self.jobs.remove(name)?),
            };
            let texture = context.load_texture(name, image, egui::TextureOptions::LINEAR);
            self.textures.insert(source.clone(), texture);
        }
        self.textures.get(source).map(egui::TextureHandle::id)
    }

    /// Returns the added picture from a file. A file that cannot be read stays known.
    fn take_file(&mut self, path: &str) -> Option<PageImage> {
        let picture = self.files.get_mut(path)?.take()?;
        self.files.remove(path);
        Some(picture)
    }

    /// Frees the pictures from files that a page does not show. A file that could not be read is tried again when a page shows it
    /// the next time.
    fn keep_files_of(&mut self, sheet: &PageLayout) {
        let is_shown = |source: &PictureSource| sheet.pictures.iter().any(|picture| picture.source == *source);
        self.textures.retain(|source, _| !matches!(source, PictureSource::File(_)) || is_shown(source));
        self.files.retain(|path, _| is_shown(&PictureSource::File(path.clone())));
    }
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
        let place = Rect::from_min_max(px(&picture.from), px(&picture.to));
        if let Some(texture) = pictures.of(painter.ctx(), &picture.source) {
            painter.image(texture, place, whole, Color32::WHITE);
        } else if pictures.is_missing(&picture.source) {
            painter.add(Shape::rect_filled(place, 0.0, color32(HudColor::InputField)));
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

fn color32(color: HudColor) -> Color32 {
    let [r, g, b, a] = color.rgba();
    Color32::from_rgba_unmultiplied(r, g, b, a)
}

fn paint_item(painter: &egui::Painter, item: &DrawItem, rect: Rect) {
    let size = rect.size();
    let px = |p: &ScreenPoint| rect.min + egui::vec2(p.x as f32 * size.x, p.y as f32 * size.y);
    let color = color32;
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
    use crate::flow::sheet::PlacedPicture;
    use crate::hud::at;

    #[test]
    fn exact_tutorial_pictures_can_be_decoded() {
        for (name, bytes) in PICTURES {
            let picture = decode_jpeg(bytes).unwrap_or_else(|| panic!("{name}"));
            assert!(picture.width >= 400 && picture.height >= 150, "{name}: {} x {}", picture.width, picture.height);
        }
        assert!(decode_jpeg(b"no picture").is_none());
    }

    #[test]
    fn exact_a_file_is_missing_until_it_was_read_and_again_after_its_page_was_left() {
        let page = |paths: &[&str]| {
            let picture = |path: &&str| PlacedPicture {
                source: PictureSource::File((*path).to_owned()),
                from: at(0.0, 0.0),
                to: at(0.5, 0.5),
            };
            PageLayout { pictures: paths.iter().map(picture).collect(), ..PageLayout::default() }
        };
        let context = egui::Context::default();
        let source = PictureSource::File("a.png".into());
        let (both, none) = (page(&["a.png", "no.png"]), page(&[]));
        let mut textures = PageTextures::default();
        assert_eq!(textures.missing_files(&both), ["a.png", "no.png"]);
        assert!(textures.of(&context, &source).is_none() && textures.is_missing(&source));
        let picture = Picture { width: 2, height: 1, rgba: vec![9; 8] };
        textures.add_file("a.png".into(), Some(PageImage::new(&picture)));
        textures.add_file("no.png".into(), None);
        for _ in 0..2 {
            textures.keep_files_of(&both);
            assert!(textures.of(&context, &source).is_some() && textures.missing_files(&both).is_empty());
            assert!(textures.of(&context, &PictureSource::File("no.png".into())).is_none());
        }
        textures.keep_files_of(&none);
        assert_eq!(textures.missing_files(&both), ["a.png", "no.png"]);
    }
}

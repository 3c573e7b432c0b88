//! A page as plain data: items to draw, clickable areas, and pictures. Sizes are fractions of the window's height, so
//! text scales with the window. During layout, horizontal positions use the same unit; at the end, they become
//! fractions of the width.

use super::KeyPress;
use crate::hud::{DrawItem, HudColor, ScreenPoint, TextAlign, at};

/// Font size of titles, as a fraction of the window's height (the unit of all sizes in this module).
pub const TITLE_SIZE: f64 = 0.075;
/// Font size of body text.
pub const TEXT_SIZE: f64 = 0.038;
/// Font size of secondary text.
pub const SMALL_TEXT_SIZE: f64 = 0.032;
/// Line spacing in multiples of the font size.
pub const LINE_SPACING: f64 = 1.35;
/// Mean character width as a fraction of the font size (egui's Ubuntu Light, lowercase; slightly wide to prevent
/// overflow).
const CHAR_WIDTH: f64 = 0.48;
/// Maximum width of a page; keeps lines readable on wide windows.
pub const MAX_PAGE_WIDTH: f64 = 2.3;

/// A clickable area.
#[derive(Debug, Clone, PartialEq)]
pub struct ClickArea {
    /// Upper left corner.
    pub from: ScreenPoint,
    /// Lower right corner.
    pub to: ScreenPoint,
    /// Event that a click triggers.
    pub press: KeyPress,
}

impl ClickArea {
    /// Checks whether the area contains a point.
    #[must_use]
    pub fn contains(&self, place: ScreenPoint) -> bool {
        (self.from.x..=self.to.x).contains(&place.x) && (self.from.y..=self.to.y).contains(&place.y)
    }
}

/// Where a picture comes from.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum PictureSource {
    /// An embedded picture with this name.
    Embedded(&'static str),
    /// A PNG file at this path. The program that hosts the window loads it.
    File(String),
}

/// A picture at its position.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedPicture {
    /// Source of the picture.
    pub source: PictureSource,
    /// Upper left corner.
    pub from: ScreenPoint,
    /// Lower right corner.
    pub to: ScreenPoint,
}

/// A page layout.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PageLayout {
    /// Pictures, drawn below everything else.
    pub pictures: Vec<PlacedPicture>,
    /// Items to draw, in order.
    pub items: Vec<DrawItem>,
    /// Clickable areas.
    pub click_areas: Vec<ClickArea>,
}

/// Writes a page in units of the window's height: x from the page's left edge, y from the window's top edge.
#[derive(Debug)]
pub struct PageWriter {
    sheet: PageLayout,
    aspect: f64,
    left: f64,
    /// Width of the page.
    pub width: f64,
}

impl PageWriter {
    /// Creates an empty page for a window with the given aspect ratio (width over height).
    #[must_use]
    pub fn new(aspect: f64) -> Self {
        let width = aspect.min(MAX_PAGE_WIDTH);
        Self { sheet: PageLayout::default(), aspect, left: 0.5 * (aspect - width), width }
    }

    /// Converts a fraction of the window's width to page units.
    #[must_use]
    pub fn across(&self, share: f64) -> f64 {
        share * self.aspect - self.left
    }

    /// Converts page coordinates to fractions of the window.
    fn place(&self, x: f64, y: f64) -> ScreenPoint {
        at((self.left + x) / self.aspect, y)
    }

    /// Adds a rectangle.
    pub fn panel(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), color: HudColor) {
        let (from, to) = (self.place(x, y), self.place(x + width, y + height));
        self.sheet.items.push(DrawItem::Panel { from, to, color });
    }

    /// Fills the whole window with one color.
    pub fn ground(&mut self, color: HudColor) {
        self.sheet.items.push(DrawItem::Fill { points: vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)], color });
    }

    /// Adds a line of text.
    pub fn text(&mut self, (x, y): (f64, f64), side: TextAlign, height: f64, color: HudColor, words: impl Into<String>) {
        let place = self.place(x, y);
        self.sheet.items.push(DrawItem::Text { place, side, height, color, words: words.into() });
    }

    /// Wraps text to a width, adds it, and returns the y position of the next line.
    pub fn lines(&mut self, (x, y): (f64, f64), width: f64, height: f64, color: HudColor, words: &str) -> f64 {
        let mut y = y;
        for line in wrap_text(words, width, height) {
            self.text((x, y), TextAlign::Left, height, color, line);
            y += LINE_SPACING * height;
        }
        y
    }

    /// Adds a polyline.
    pub fn line(&mut self, points: &[(f64, f64)], width: f64, color: HudColor) {
        let points = points.iter().map(|(x, y)| self.place(*x, *y)).collect();
        self.sheet.items.push(DrawItem::Line { points, width, color });
    }

    /// Adds a filled convex polygon.
    pub fn fill(&mut self, points: &[(f64, f64)], color: HudColor) {
        let points = points.iter().map(|(x, y)| self.place(*x, *y)).collect();
        self.sheet.items.push(DrawItem::Fill { points, color });
    }

    /// Adds an arrow.
    pub fn arrow(&mut self, from: (f64, f64), to: (f64, f64), color: HudColor) {
        const ARROWHEAD_LENGTH: f64 = 0.022;
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let long = (dx * dx + dy * dy).sqrt().max(1e-9);
        let (ux, uy) = (dx / long, dy / long);
        let neck = (to.0 - ARROWHEAD_LENGTH * ux, to.1 - ARROWHEAD_LENGTH * uy);
        self.line(&[from, neck], 0.006, color);
        let wing = |side: f64| (neck.0 - side * 0.5 * ARROWHEAD_LENGTH * uy, neck.1 + side * 0.5 * ARROWHEAD_LENGTH * ux);
        self.fill(&[to, wing(1.0), wing(-1.0)], color);
    }

    /// Adds an embedded picture.
    pub fn picture(&mut self, name: &'static str, place: (f64, f64), size: (f64, f64)) {
        self.picture_from(PictureSource::Embedded(name), place, size);
    }

    /// Adds a picture.
    pub fn picture_from(&mut self, source: PictureSource, (x, y): (f64, f64), (width, height): (f64, f64)) {
        let (from, to) = (self.place(x, y), self.place(x + width, y + height));
        self.sheet.pictures.push(PlacedPicture { source, from, to });
    }

    /// Adds a clickable area.
    pub fn click_area(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), press: KeyPress) {
        let (from, to) = (self.place(x, y), self.place(x + width, y + height));
        self.sheet.click_areas.push(ClickArea { from, to, press });
    }

    /// Returns the finished page.
    #[must_use]
    pub fn done(self) -> PageLayout {
        self.sheet
    }
}

/// Returns the approximate width of a text, as a fraction of the window's height.
#[must_use]
pub fn text_width(words: &str, height: f64) -> f64 {
    CHAR_WIDTH * height * words.chars().count() as f64
}

/// Wraps text at spaces and keeps its line breaks. Splits words that are wider than a line, such as addresses.
#[must_use]
pub fn wrap_text(words: &str, width: f64, height: f64) -> Vec<String> {
    let most = ((width / (CHAR_WIDTH * height)).floor() as usize).max(8);
    let mut lines = Vec::new();
    for paragraph in words.lines() {
        let mut line = String::new();
        for word in paragraph.split(' ') {
            let mut word: Vec<char> = word.chars().collect();
            let used = line.chars().count();
            if used > 0 && used + 1 + word.len() > most {
                lines.push(std::mem::take(&mut line));
            }
            while word.len() > most {
                lines.push(word.drain(..most).collect());
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.extend(word);
        }
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_wrapped_lines_fit_and_keep_all_words() {
        let text = "The drone keeps its place when you let go of the sticks.\n\nfile:///a/very/long/address/that/has/no/blank/in/it/at/all.html";
        for width in [0.4, 0.7, 1.5] {
            let lines = wrap_text(text, width, TEXT_SIZE);
            let most = (width / (CHAR_WIDTH * TEXT_SIZE)).floor() as usize;
            assert!(lines.iter().all(|line| line.chars().count() <= most), "{lines:?}");
            let solid = |s: &str| s.chars().filter(|c| !c.is_whitespace()).collect::<String>();
            assert_eq!(solid(&lines.concat()), solid(text));
        }
    }

    #[test]
    fn exact_page_is_centered_in_a_wide_window() {
        for (aspect, left) in [(4.0, 0.5 * (4.0 - MAX_PAGE_WIDTH) / 4.0), (1.5, 0.0)] {
            let mut pen = PageWriter::new(aspect);
            let width = pen.width;
            pen.click_area((0.0, 0.1), (width, 0.2), KeyPress::Char('x'));
            let spot = pen.done().click_areas.remove(0);
            assert!((spot.from.x - left).abs() < 1e-12 && (spot.to.x - (1.0 - left)).abs() < 1e-12, "{spot:?}");
            assert!(spot.contains(at(0.5, 0.2)) && !spot.contains(at(0.5, 0.35)));
        }
    }
}

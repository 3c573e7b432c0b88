//! A page as plain data: items to draw, clickable areas, and pictures. Sizes are fractions of the window's height, so
//! text scales with the window. During layout, horizontal positions use the same unit; at the end, they become
//! fractions of the width. With larger text, the unit is larger, so that the page is narrower and lower than the window.

use super::KeyPress;
pub use crate::hud::text_metrics::{fitted, text_width};
use crate::hud::{Area, DisplayStyle, DrawItem, HudColor, JobDrawing, Pane, ScreenPoint, TextAlign, at};

/// Font size of titles, as a fraction of the window's height with normal text (the unit of all sizes in this module).
pub const TITLE_SIZE: f64 = 0.075;
/// Font size of body text.
pub const TEXT_SIZE: f64 = 0.038;
/// Font size of secondary text.
pub const SMALL_TEXT_SIZE: f64 = 0.032;
/// Line spacing in multiples of the font size.
pub const LINE_SPACING: f64 = 1.35;
/// Maximum width of a page; keeps lines readable on wide windows.
pub const MAX_PAGE_WIDTH: f64 = 2.3;
/// Pages narrower than this have one column.
const MIN_WIDE_WIDTH: f64 = 1.3;

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
    /// A PNG or JPEG file at this path. The program that hosts the window loads it.
    File(String),
    /// The picture of a job, by the job's name or path.
    Job(String),
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

impl PageLayout {
    /// Moves everything up by a fraction of the window's height.
    pub fn move_up(&mut self, by: f64) {
        let points = self.items.iter_mut().flat_map(|item| match item {
            DrawItem::Panel { from, to, .. } => vec![from, to],
            DrawItem::Text { place, .. } => vec![place],
            DrawItem::Fill { points, .. } | DrawItem::Line { points, .. } => points.iter_mut().collect(),
        });
        let points = points.chain(self.pictures.iter_mut().flat_map(|picture| [&mut picture.from, &mut picture.to]));
        let points = points.chain(self.click_areas.iter_mut().flat_map(|area| [&mut area.from, &mut area.to]));
        points.for_each(|point| point.y -= by);
    }

    /// Returns the lower edge of the contents, as a fraction of the window's height.
    #[must_use]
    pub fn bottom(&self) -> f64 {
        let lowest = |points: &[ScreenPoint]| points.iter().map(|point| point.y).fold(0.0, f64::max);
        let items = self.items.iter().map(|item| match item {
            DrawItem::Panel { to, .. } => to.y,
            DrawItem::Text { place, height, .. } => place.y + 0.5 * height,
            DrawItem::Fill { points, .. } | DrawItem::Line { points, .. } => lowest(points),
        });
        items.chain(self.pictures.iter().map(|picture| picture.to.y)).fold(0.0, f64::max)
    }

    /// Returns the upper edge of the panels, as a fraction of the window's height; `None` without panels.
    #[must_use]
    pub fn top(&self) -> Option<f64> {
        let panels = self.items.iter().filter_map(|item| match item {
            DrawItem::Panel { from, .. } => Some(from.y),
            DrawItem::Text { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
        });
        panels.reduce(f64::min)
    }

    /// Adds a page on top of this one.
    pub fn append(&mut self, other: Self) {
        self.pictures.extend(other.pictures);
        self.items.extend(other.items);
        self.click_areas.extend(other.click_areas);
    }
}

/// Writes a page in units of the window's height: x from the page's left edge, y from the window's top edge.
#[derive(Debug)]
pub struct PageWriter {
    sheet: PageLayout,
    aspect: f64,
    left: f64,
    style: DisplayStyle,
    /// Width of the page.
    pub width: f64,
    /// Height of the window.
    pub height: f64,
}

impl PageWriter {
    /// Creates an empty page for a window with the given aspect ratio (width over height).
    #[must_use]
    pub fn new(aspect: f64, style: DisplayStyle) -> Self {
        let scale = style.text_scale.factor();
        // The page has the width of the window in its own unit.
        let aspect = aspect / scale;
        let width = aspect.min(MAX_PAGE_WIDTH);
        Self { sheet: PageLayout::default(), aspect, left: 0.5 * (aspect - width), style, width, height: 1.0 / scale }
    }

    /// Returns the units and the text size.
    #[must_use]
    pub fn style(&self) -> DisplayStyle {
        self.style
    }

    /// Returns the aspect ratio (width over height) of the window.
    #[must_use]
    pub fn window_aspect(&self) -> f64 {
        self.aspect / self.height
    }

    /// Checks whether the page has room for only one column.
    #[must_use]
    pub fn is_narrow(&self) -> bool {
        self.width < MIN_WIDE_WIDTH
    }

    /// Converts fractions of the window's width and height to page units.
    #[must_use]
    pub fn from_window(&self, (across, down): (f64, f64)) -> (f64, f64) {
        (across * self.aspect - self.left, down * self.height)
    }

    /// Returns the lower edge of what has been written so far.
    #[must_use]
    pub fn bottom(&self) -> f64 {
        self.sheet.bottom() * self.height
    }

    /// Converts page coordinates to fractions of the window.
    fn place(&self, x: f64, y: f64) -> ScreenPoint {
        at((self.left + x) / self.aspect, y / self.height)
    }

    /// Adds a rectangle.
    pub fn panel(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), color: HudColor) {
        let (from, to) = (self.place(x, y), self.place(x + width, y + height));
        self.sheet.items.push(DrawItem::Panel { from, to, color });
    }

    /// Adds a line of text.
    pub fn text(&mut self, (x, y): (f64, f64), side: TextAlign, height: f64, color: HudColor, words: impl Into<String>) {
        let (place, height) = (self.place(x, y), height / self.height);
        self.sheet.items.push(DrawItem::Text { place, side, height, color, words: self.style.units.words(&words.into()) });
    }

    /// Adds a title, shrunk to fit into a width.
    pub fn title(&mut self, (x, y): (f64, f64), width: f64, words: &str) {
        self.text((x, y), TextAlign::Left, fitted(words, TITLE_SIZE, width), HudColor::White, words);
    }

    /// Wraps text to a width, adds it, and returns the y position of the next line.
    pub fn lines(&mut self, (x, y): (f64, f64), width: f64, height: f64, color: HudColor, words: &str) -> f64 {
        let mut y = y;
        for line in wrap_text(&self.style.units.words(words), width, height) {
            self.text((x, y), TextAlign::Left, height, color, line);
            y += LINE_SPACING * height;
        }
        y
    }

    /// Adds a polyline.
    pub fn line(&mut self, points: &[(f64, f64)], width: f64, color: HudColor) {
        let points = points.iter().map(|(x, y)| self.place(*x, *y)).collect();
        self.sheet.items.push(DrawItem::Line { points, width: width / self.height, color });
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

    /// Adds one of a job's drawings.
    pub fn job_drawing(&mut self, (drawing, index): (&JobDrawing, usize), (x, y): (f64, f64), (width, height): (f64, f64)) {
        let pane = Pane { width: self.aspect, height: self.height };
        let area = Area { x: self.left + x, y, width, height };
        self.sheet.items.extend(drawing.draw(index, self.style, pane, area));
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

/// Wraps text at spaces and keeps its line breaks. Splits words that are wider than a line, such as addresses.
#[must_use]
pub fn wrap_text(words: &str, width: f64, height: f64) -> Vec<String> {
    let fits = |line: &str| text_width(line, height) <= width;
    let mut lines = Vec::new();
    for paragraph in words.lines() {
        let mut line = String::new();
        for word in paragraph.split(' ') {
            if !line.is_empty() && !fits(&format!("{line} {word}")) {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            for sign in word.chars() {
                line.push(sign);
                if !fits(&line) && line.chars().count() > 1 {
                    line.pop();
                    lines.push(std::mem::replace(&mut line, sign.to_string()));
                }
            }
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
            assert!(lines.iter().all(|line| text_width(line, TEXT_SIZE) <= width), "{lines:?}");
            let solid = |s: &str| s.chars().filter(|c| !c.is_whitespace()).collect::<String>();
            assert_eq!(solid(&lines.concat()), solid(text));
        }
    }

    #[test]
    fn exact_page_is_centered_in_a_wide_window() {
        for (aspect, left) in [(4.0, 0.5 * (4.0 - MAX_PAGE_WIDTH) / 4.0), (1.5, 0.0)] {
            let mut pen = PageWriter::new(aspect, DisplayStyle::default());
            let width = pen.width;
            pen.click_area((0.0, 0.1), (width, 0.2), KeyPress::Char('x'));
            let spot = pen.done().click_areas.remove(0);
            assert!((spot.from.x - left).abs() < 1e-12 && (spot.to.x - (1.0 - left)).abs() < 1e-12, "{spot:?}");
            assert!(spot.contains(at(0.5, 0.2)) && !spot.contains(at(0.5, 0.35)));
        }
    }
}

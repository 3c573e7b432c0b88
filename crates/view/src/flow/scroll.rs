//! Scrolls pages that are higher than the window.

use super::KeyPress;
use super::sheet::PageLayout;
use crate::hud::{DrawItem, HudColor, at};

/// Space below the contents and around the focused row, as a fraction of the window's height.
const MARGIN: f64 = 0.03;
/// Width of the scroll bar, as a fraction of the window's width.
const BAR_WIDTH: f64 = 0.006;

/// How far a page can be scrolled, as fractions of the window's height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScrollRange {
    /// Smallest distance at which the focused row is visible.
    pub focused: f64,
    /// Distance at which the end of the page is visible; 0 if the page fits.
    pub most: f64,
}

impl ScrollRange {
    /// Returns the range for a page and the number of the focused row, if the page is scrolled to it. `end` is the lower edge of
    /// what is visible: the window's, or the upper edge of a notice.
    #[must_use]
    pub fn of(page: &PageLayout, focus: Option<usize>, end: f64) -> Self {
        let bottom = page.bottom();
        if bottom <= end {
            return Self { focused: 0.0, most: 0.0 };
        }
        let most = bottom + MARGIN - end;
        let row = page.click_areas.iter().find(|area| focus.is_some_and(|focus| area.press == KeyPress::Row(focus)));
        let wanted = row.map_or(0.0, |row| (row.to.y + MARGIN - end).min(row.from.y - MARGIN));
        Self { focused: wanted.clamp(0.0, most), most }
    }

    /// Returns the distance for a distance that the user has added to that of the focused row.
    #[must_use]
    pub fn distance(self, added: f64) -> f64 {
        (self.focused + added).clamp(0.0, self.most)
    }

    /// Returns the scroll bar; nothing if the page fits.
    #[must_use]
    pub fn bar(self, added: f64) -> Vec<DrawItem> {
        if self.most <= 0.0 {
            return Vec::new();
        }
        let whole = 1.0 + self.most;
        let (top, bottom) = (self.distance(added) / whole, (self.distance(added) + 1.0) / whole);
        let strip = |from: f64, to: f64, color| DrawItem::Panel { from: at(1.0 - BAR_WIDTH, from), to: at(1.0, to), color };
        vec![strip(0.0, 1.0, HudColor::InputField), strip(top, bottom, HudColor::Gray)]
    }
}

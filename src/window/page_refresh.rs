//! Decides when a page is rendered again. An unchanged page is rarely rendered again.

use spandrel_view::flow::PageLayout;
use std::time::Duration;

/// An unchanged page is rendered again after this time, in case the system's request to render it coincides with one of the window's
/// own (estimate).
const PAGE_REFRESH_INTERVAL: Duration = Duration::from_secs(1);

/// The page that the window shows.
#[derive(Debug)]
pub struct ShownPage {
    /// Layout of the page.
    pub sheet: PageLayout,
    /// Time when it was rendered, since the window's start.
    pub at: Duration,
}

/// Returns whether a page must be rendered: if it differs from the one that the window shows, or after the refresh interval.
/// `shown` is `None` if the window shows something else, or the page without its last pictures.
pub fn must_render(shown: Option<&ShownPage>, sheet: &PageLayout, now: Duration) -> bool {
    shown.is_none_or(|shown| shown.sheet != *sheet || now.saturating_sub(shown.at) >= PAGE_REFRESH_INTERVAL)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_view::hud::{DrawItem, HudColor, at};

    /// Interval of the window's frames on a page.
    const FRAME_INTERVAL: Duration = Duration::from_millis(50);

    fn page(right: f64) -> PageLayout {
        let panel = DrawItem::Panel { from: at(0.1, 0.1), to: at(right, 0.9), color: HudColor::InputField };
        PageLayout { items: vec![panel], ..PageLayout::default() }
    }

    /// Returns the numbers of the frames that are rendered of a sequence of pages, at 20 frames per second.
    fn rendered(pages: impl Iterator<Item = PageLayout>) -> Vec<u32> {
        let (mut shown, mut frames) = (None, Vec::new());
        for (k, sheet) in (0..).zip(pages) {
            let now = FRAME_INTERVAL * k;
            if must_render(shown.as_ref(), &sheet, now) {
                frames.push(k);
                shown = Some(ShownPage { sheet, at: now });
            }
        }
        frames
    }

    #[test]
    fn exact_an_unchanged_page_is_rendered_once_a_second_and_not_20_times() {
        assert_eq!(rendered((0..=60).map(|_| page(0.5))), [0, 20, 40, 60]);
        let shown = ShownPage { sheet: page(0.5), at: Duration::from_secs(3) };
        let nanosecond = Duration::from_nanos(1);
        let due = shown.at + PAGE_REFRESH_INTERVAL;
        assert!(!must_render(Some(&shown), &page(0.5), due - nanosecond) && must_render(Some(&shown), &page(0.5), due));
    }

    #[test]
    fn exact_any_change_is_rendered_at_once() {
        // The smallest change: one coordinate, by one step of its number.
        let moved = page(0.5_f64.next_up());
        let pages = (0..30).map(|k| if k == 7 { moved.clone() } else { page(0.5) });
        assert_eq!(rendered(pages), [0, 7, 8, 28]);
        assert!(must_render(None, &page(0.5), Duration::ZERO), "the window shows something else");
    }

    #[test]
    fn exact_a_page_that_was_rendered_in_the_future_is_not_rendered_again() {
        // A caller that measured the time before the page was rendered.
        let shown = ShownPage { sheet: page(0.5), at: Duration::from_secs(3) };
        assert!(!must_render(Some(&shown), &page(0.5), Duration::from_secs(2)));
    }
}

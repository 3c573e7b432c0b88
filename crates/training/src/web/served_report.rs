//! What the server changes in a report: links to its own pages, and the address of the video. A report that is opened from disk has no
//! such pages, and its video is beside it.

use crate::report::page::VIDEO_SOURCE;
use maud::html;
use spandrel_text::{Language, text};

/// End of the tag after which a page's content begins.
const BODY: &[u8] = b"<body>";
/// Beginning and end of the link past the navigation. It must stay the first link of the page.
const SKIP_LINK: &[u8] = b"<a class=\"skip\"";
const LINK_END: &[u8] = b"</a>";

/// Page from which people open reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParentPage<'a> {
    /// A session, by its ID.
    Session(&'a str),
    /// The list of sessions.
    Sessions,
    /// The cohort page.
    Cohort,
}

impl ParentPage<'_> {
    fn link(self, language: Language) -> (String, String) {
        match self {
            Self::Session(id) => (format!("/sessions/{id}"), text!(language, "web-back-to-session")),
            Self::Sessions => ("/sessions".to_owned(), text!(language, "web-back-to-sessions")),
            Self::Cohort => ("/cohort".to_owned(), text!(language, "web-back-to-cohort")),
        }
    }
}

/// Returns a report page with links to these pages at its beginning, after its link past the navigation, and unchanged if it has no body.
#[must_use]
pub fn with_back_links(page: Vec<u8>, parents: &[ParentPage<'_>], language: Language) -> Vec<u8> {
    let Some(start) = end_of(&page, BODY) else { return page };
    let content = &page[start..];
    let skip_link = if content.starts_with(SKIP_LINK) { end_of(content, LINK_END).unwrap_or(0) } else { 0 };
    let (head, content) = page.split_at(start + skip_link);
    [head, links(parents, language).as_bytes(), content].concat()
}

/// Returns a report page that loads its video from this address, and unchanged if it has none.
#[must_use]
pub fn with_video_address(page: Vec<u8>, address: &str) -> Vec<u8> {
    let Some(start) = end_of(&page, VIDEO_SOURCE.as_bytes()) else { return page };
    let (head, rest) = page.split_at(start);
    let end = rest.iter().position(|byte| *byte == b'"').unwrap_or(0);
    [head, address.as_bytes(), &rest[end..]].concat()
}

/// Returns the position after the first occurrence of a tag.
fn end_of(text: &[u8], tag: &[u8]) -> Option<usize> {
    Some(text.windows(tag.len()).position(|bytes| bytes == tag)? + tag.len())
}

fn links(parents: &[ParentPage<'_>], language: Language) -> String {
    html! {
        nav.back aria-label=(text!(language, "web-back")) {
            @for (address, label) in parents.iter().map(|parent| parent.link(language)) { a href=(address) { "‹ " (label) } }
        }
    }
    .into_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_video_of_served_report_has_another_address() {
        let page = |source: &str| format!("<body><video id=\"video\" src=\"{source}\" controls></video></body>").into_bytes();
        assert_eq!(with_video_address(page("video.mp4"), "/sessions/a/key"), page("/sessions/a/key"));
        assert_eq!(with_video_address(b"<body></body>".to_vec(), "/sessions/a/key"), b"<body></body>");
    }

    #[test]
    fn regress_served_report_links_to_its_session_and_the_list() {
        let page = b"<html><head></head><body><main>...</main></body></html>".to_vec();
        let parents = [ParentPage::Session("2026-a"), ParentPage::Sessions];
        let served = String::from_utf8(with_back_links(page, &parents, Language::English)).unwrap_or_default();
        let expected = "<html><head></head><body><nav class=\"back\" aria-label=\"Back\"><a href=\"/sessions/2026-a\">‹ Back to the session</a>\
                        <a href=\"/sessions\">‹ All sessions</a></nav><main>...</main></body></html>";
        assert_eq!(served, expected);
        let page = b"<body><a class=\"skip\" href=\"#better\">Skip</a><main></main>".to_vec();
        let served = String::from_utf8(with_back_links(page, &parents, Language::English)).unwrap_or_default();
        assert!(served.starts_with("<body><a class=\"skip\" href=\"#better\">Skip</a><nav class=\"back\""), "{served}");
        assert_eq!(with_back_links(b"no page".to_vec(), &parents, Language::English), b"no page");
    }
}

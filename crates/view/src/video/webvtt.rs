//! Chapters of a video as a WebVTT track, for players and other programs.

use std::fmt::Write;

/// A chapter of a video.
#[derive(Debug, Clone, PartialEq)]
pub struct Chapter {
    /// Start time, s.
    pub from_s: f64,
    /// End time, s.
    pub to_s: f64,
    /// Title of the chapter.
    pub title: String,
}

/// Returns the chapters as a WebVTT file.
#[must_use]
pub fn write(chapters: &[Chapter]) -> String {
    let mut out = String::from("WEBVTT\n");
    for (k, chapter) in chapters.iter().enumerate() {
        let _ = write!(
            out,
            "\n{}\n{} --> {}\n{}\n",
            k + 1,
            timestamp(chapter.from_s),
            timestamp(chapter.to_s),
            escaped(&chapter.title)
        );
    }
    out
}

fn timestamp(s: f64) -> String {
    let ms = (s.max(0.0) * 1000.0).round() as u64;
    format!("{:02}:{:02}:{:02}.{:03}", ms / 3_600_000, ms / 60_000 % 60, ms / 1000 % 60, ms % 1000)
}

/// Escapes markup and removes line breaks.
fn escaped(title: &str) -> String {
    title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace(['\n', '\r'], " ")
}

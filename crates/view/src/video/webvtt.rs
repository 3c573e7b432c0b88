//! Chapters of a video as a WebVTT track: players list them, people and programs read them.

use std::fmt::Write;

/// A chapter: from when to when, s of the video, and what it is called.
#[derive(Debug, Clone, PartialEq)]
pub struct Chapter {
    /// Start, s.
    pub from_s: f64,
    /// End, s.
    pub to_s: f64,
    /// Title.
    pub title: String,
}

/// The track.
#[must_use]
pub fn write(chapters: &[Chapter]) -> String {
    let mut out = String::from("WEBVTT\n");
    for (k, chapter) in chapters.iter().enumerate() {
        let _ = write!(out, "\n{}\n{} --> {}\n{}\n", k + 1, stamp(chapter.from_s), stamp(chapter.to_s), escaped(&chapter.title));
    }
    out
}

fn stamp(s: f64) -> String {
    let ms = (s.max(0.0) * 1000.0).round() as u64;
    format!("{:02}:{:02}:{:02}.{:03}", ms / 3_600_000, ms / 60_000 % 60, ms / 1000 % 60, ms % 1000)
}

/// A title is one line, and its signs are no markup.
fn escaped(title: &str) -> String {
    title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace(['\n', '\r'], " ")
}

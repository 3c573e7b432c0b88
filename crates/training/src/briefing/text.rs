//! The briefing as plain text, for a terminal.

use super::{Briefing, TaskBriefing};
use spandrel_text::{Language, text};
use std::fmt::Write as _;

/// Maximum line length, characters.
const MAX_WIDTH: usize = 96;
/// Additional indent of a paragraph's second and later lines.
const HANGING_INDENT: usize = 3;

/// Renders the briefing.
#[must_use]
pub fn render(briefing: &Briefing, language: Language) -> String {
    let mut out = format!("{}\n{}\n", briefing.title, "=".repeat(briefing.title.chars().count()));
    let mut put = |words: &str, indent: &str| {
        let hanging = if indent.is_empty() { 0 } else { HANGING_INDENT };
        for (k, line) in wrap(words, MAX_WIDTH - indent.len() - hanging).into_iter().enumerate() {
            let _ = writeln!(out, "{indent}{:width$}{line}", "", width = if k == 0 { 0 } else { hanging });
        }
    };
    for note in &briefing.notes {
        put("", "");
        put(note, "");
    }
    if !briefing.pictures.is_empty() {
        put("", "");
        put(&text!(language, "report-briefing-pictures"), "");
    }
    for picture in &briefing.pictures {
        put(&format!("{}: {}", picture.file, picture.caption), "  ");
    }
    put("", "");
    let name_width = briefing.conditions.iter().map(|(name, _)| name.chars().count()).max().unwrap_or_default() + 2;
    for (name, value) in &briefing.conditions {
        put(&format!("{name:<name_width$}{value}"), "  ");
    }
    if !briefing.tasks.is_empty() {
        put("", "");
        put(&text!(language, "report-briefing-tasks"), "");
    }
    for task in &briefing.tasks {
        put(&format!("{}  {}: {}", task.id, task.name, task.place), "  ");
        put(&task_numbers(task, language), "     ");
    }
    let lists = [
        (text!(language, "report-briefing-hazards"), &briefing.hazards),
        (text!(language, "report-briefing-counts"), &briefing.counts),
        (text!(language, "report-briefing-check"), &briefing.site_check),
    ];
    for (heading, lines) in lists.into_iter().filter(|(_, lines)| !lines.is_empty()) {
        put("", "");
        put(&heading, "");
        for line in lines {
            put(line, "  ");
        }
    }
    out
}

/// Returns a task's numbers, such as "152 m long, 12 to 24 m above the pad, stand-off 5 ± 1.5 m, lamp needed".
#[must_use]
pub fn task_numbers(task: &TaskBriefing, language: Language) -> String {
    let (low_m, high_m) = task.heights_m;
    let mut parts = Vec::new();
    if task.length_m >= 1.0 {
        parts.push(text!(language, "briefing-length", length = format!("{:.0}", task.length_m)));
    }
    let height = format!("{:.0}", high_m.abs());
    parts.push(if high_m - low_m >= 1.0 {
        text!(language, "briefing-heights", low = format!("{low_m:.0}"), high = format!("{high_m:.0}"))
    } else if high_m < 0.0 {
        text!(language, "briefing-height-below", height = height)
    } else {
        text!(language, "briefing-height-above", height = height)
    });
    parts.push(match task.stand_off_m {
        Some((recommended_m, tolerance_m)) => {
            let (distance, tolerance) = (format!("{recommended_m:.1}"), format!("{tolerance_m:.1}"));
            text!(language, "briefing-stand-off", distance = distance, tolerance = tolerance)
        }
        None => text!(language, "briefing-within", distance = format!("{:.1}", task.threshold_m)),
    });
    if task.lamp {
        parts.push(text!(language, "briefing-lamp-needed"));
    }
    parts.join(", ")
}

/// Splits a text into lines of at most `width` characters, at spaces. Keeps the spaces inside a line.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_inclusive(' ') {
        let line = lines.last().map_or(0, |line| line.chars().count());
        if line > 0 && line + word.trim_end().chars().count() > width {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            line.push_str(word);
        }
    }
    lines.into_iter().map(|line| line.trim_end().to_owned()).collect()
}

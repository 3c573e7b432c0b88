//! Warnings at the lower left, with the most serious at the bottom.

use super::icons::IconShape;
use super::metrics::{BLOCK_GAP, EDGE_MARGIN, MEDIUM_FONT_SIZE};
use super::pane::Pane;
use super::state::Hud;
use super::text_metrics::{text_width, wrap_text};
use super::{DrawItem, HudColor, TextAlign};
use spandrel_mavlink::contract::cue;
use spandrel_text::monitor_texts::Warning;

/// Mean width of a capital letter.
const CAPITAL_WIDTH: f64 = 0.0205;
/// Left padding of a message, which contains its icon.
const ICON_INDENT: f64 = 0.07;
/// Right padding of a message.
const TEXT_MARGIN: f64 = 0.015;
/// Height of a single-line message, and height of each additional line.
const MESSAGE_HEIGHT: f64 = 0.06;
const LINE_HEIGHT: f64 = 0.045;
/// Maximum number of lines; pilots cannot read longer texts in flight.
const MAX_LINES: usize = 2;

/// An active cue.
#[derive(Debug, Clone, PartialEq)]
pub struct ActiveCue {
    /// Shape of the message's icon.
    pub shape: IconShape,
    /// Color of the icon and text.
    pub color: HudColor,
    /// The warning, with its name in capitals.
    pub warning: Warning,
}

/// Returns the active cues, the most serious first.
pub fn warnings(hud: &Hud) -> Vec<ActiveCue> {
    let all = [
        (cue::CRASH, IconShape::Octagon, HudColor::Red),
        (cue::TOO_CLOSE, IconShape::Diamond, HudColor::Orange),
        (cue::SPEEDING, IconShape::Triangle, HudColor::Yellow),
        (cue::STAND_OFF, IconShape::Disc, HudColor::Blue),
        (cue::OFF_PATH, IconShape::Disc, HudColor::Blue),
    ];
    let on = all.into_iter().filter(|(bit, ..)| cue::displayed(hud.cues) & bit != 0);
    let active = |(bit, shape, color)| {
        let Warning { name, words } = Warning::of_text(hud.cue_texts.text(bit)?, hud.style.language, |name| name.to_uppercase())?;
        Some(ActiveCue { shape, color, warning: Warning { name, words: hud.style.units.words(&words) } })
    };
    on.filter_map(active).collect()
}

fn width(words: &str) -> f64 {
    (CAPITAL_WIDTH * words.chars().count() as f64).max(text_width(words, MEDIUM_FONT_SIZE))
}

/// Smallest right edge of the messages that leaves room for the name of every cue.
pub const MIN_RIGHT_EDGE: f64 = 0.36;

/// Returns the messages. Their right edge is at most at `limit`, the left edge of the blocks beside them.
pub fn messages(hud: &Hud, pane: Pane, limit: Option<f64>) -> Vec<DrawItem> {
    let right = limit.map_or(pane.width - EDGE_MARGIN, |left| left - BLOCK_GAP);
    let room = (right - EDGE_MARGIN - ICON_INDENT - TEXT_MARGIN).max(0.0);
    let mut bottom = pane.height - EDGE_MARGIN;
    let mut items = Vec::new();
    for ActiveCue { shape, color, warning } in warnings(hud) {
        let lines = wrap_text(&warning.words, MAX_LINES, |line| width(line) <= room);
        let top = bottom - MESSAGE_HEIGHT - LINE_HEIGHT * (lines.len() - 1) as f64;
        let wide = ICON_INDENT + lines.iter().map(|line| width(line)).fold(0.0, f64::max) + TEXT_MARGIN;
        items.push(pane.panel((EDGE_MARGIN, top), (EDGE_MARGIN + wide, bottom)));
        items.extend(pane.icon(shape, (EDGE_MARGIN + 0.5 * ICON_INDENT, 0.5 * (top + bottom)), 0.04, color));
        for (k, line) in lines.into_iter().enumerate() {
            let y = top + 0.5 * MESSAGE_HEIGHT + LINE_HEIGHT * k as f64;
            items.push(pane.text((EDGE_MARGIN + ICON_INDENT, y), TextAlign::Left, MEDIUM_FONT_SIZE, color, line));
        }
        bottom = top - BLOCK_GAP;
    }
    items
}

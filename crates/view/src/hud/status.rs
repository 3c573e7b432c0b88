//! Status at the top center: flight mode, satellites, link.

use super::metrics::{EDGE, GAP, SMALL};
use super::pane::Pane;
use super::state::{GnssStatus, Hud};
use super::{DrawItem, HudColor, TextAlign, battery};

/// Telemetry age from which the link counts as lost, s.
pub const SILENT_S: f64 = 1.5;
/// Character width: 1.5 times the font's mean; the excess is the panel's padding.
const SIGN: f64 = 0.017;
/// Height of the panel with one line, and of each additional line.
const HIGH: f64 = 0.048;
const STEP: f64 = 0.037;

fn satellites(gnss: GnssStatus) -> String {
    match (gnss.fixed, gnss.known()) {
        (true, Some(count)) => format!("GNSS {count}"),
        (true, None) => "GNSS ok".into(),
        (false, Some(count)) => format!("GNSS lost ({count})"),
        (false, None) => "GNSS lost".into(),
    }
}

fn is_lost(hud: &Hud) -> bool {
    hud.silent_s > SILENT_S
}

fn link(hud: &Hud) -> String {
    if is_lost(hud) { format!("LINK LOST {:.0} s", hud.silent_s) } else { "link ok".into() }
}

/// Returns the active alarm as a short line. With a lost link, the satellite status is unknown.
pub fn alarm(hud: &Hud) -> Option<String> {
    if is_lost(hud) { Some(link(hud)) } else { hud.gnss.filter(|gnss| !gnss.fixed).map(satellites) }
}

pub fn status(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    let place = format!("{}   {}", hud.mode, hud.gnss.map_or_else(|| "GNSS ?".to_owned(), satellites));
    // Between speed and battery; the battery panel is the wider one.
    let room = pane.width - 2.0 * (EDGE + battery::WIDE + GAP);
    let width = |words: &str| SIGN * words.chars().count() as f64;
    let whole = format!("{place}   {}", link(hud));
    let lines = if width(&whole) <= room { vec![whole] } else { vec![place, link(hud)] };
    let half = 0.5 * lines.iter().map(|line| width(line)).fold(0.0, f64::max);
    let (middle, bottom) = (0.5 * pane.width, EDGE + HIGH + STEP * (lines.len() - 1) as f64);
    let colour = if alarm(hud).is_some() { HudColor::Orange } else { HudColor::White };
    let mut items = vec![pane.panel((middle - half, EDGE), (middle + half, bottom))];
    for (k, line) in lines.into_iter().enumerate() {
        items.push(pane.text((middle, EDGE + 0.5 * HIGH + STEP * k as f64), TextAlign::Middle, SMALL, colour, line));
    }
    items
}

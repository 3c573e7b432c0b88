//! Status at the top center: flight mode, satellites, link, and in jobs with weak radio the signals.

use super::metrics::{BLOCK_GAP, EDGE_MARGIN, SMALL_FONT_SIZE};
use super::pane::Pane;
use super::signal::{self, RadioLink, is_weak};
use super::state::{GnssStatus, Hud, UNKNOWN_MODE};
use super::{DrawItem, HudColor, TextAlign, battery, speed};
use spandrel_mavlink::contract::hazards::RadioMargins;
use spandrel_text::{Language, text};

/// Minimum telemetry age for the link to count as lost, s.
pub const LINK_TIMEOUT_S: f64 = 1.5;
/// Character width: 1.5 times the font's mean; the excess is the panel's padding.
const CHAR_WIDTH: f64 = 0.017;
/// Height of the panel with one line, and of each additional line.
const PANEL_HEIGHT: f64 = 0.048;
const LINE_HEIGHT: f64 = 0.037;

fn satellites(gnss: GnssStatus, language: Language) -> String {
    match (gnss.has_fix, gnss.known()) {
        (true, Some(count)) => text!(language, "flight-status-gnss-count", count = count),
        (true, None) => text!(language, "flight-status-gnss-ok"),
        (false, Some(count)) => text!(language, "flight-status-gnss-lost-count", count = count),
        (false, None) => text!(language, "flight-status-gnss-lost"),
    }
}

fn is_lost(hud: &Hud) -> bool {
    hud.telemetry_age_s > LINK_TIMEOUT_S
}

fn link(hud: &Hud) -> String {
    let language = hud.style.language;
    match (is_lost(hud), hud.is_frozen) {
        (true, _) => text!(language, "flight-status-link-lost", age = format!("{:.0} s", hud.telemetry_age_s)),
        (false, true) => text!(language, "flight-status-frozen"),
        (false, false) => text!(language, "flight-status-link-ok"),
    }
}

/// Returns the name of the flight mode. The autopilot's names stay in English, as in its documentation.
fn mode(hud: &Hud) -> String {
    if hud.mode == UNKNOWN_MODE { text!(hud.style.language, "flight-status-no-mode") } else { hud.mode.clone() }
}

/// Alarm of the aircraft's links and satellites, the most serious first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StatusAlarm {
    /// No telemetry arrives.
    LinkLost,
    /// No position from satellites.
    GnssLost,
    /// The control link loses data.
    ControlWeak,
    /// The video link loses data.
    VideoWeak,
}

/// Set of status alarms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StatusAlarms(u8);

impl StatusAlarms {
    /// Returns the alarms for the age of the latest telemetry, s. While the link is lost, the state of the satellites and of the
    /// signals is unknown.
    #[must_use]
    pub fn new(telemetry_age_s: f64, gnss: Option<GnssStatus>, radio: Option<RadioMargins>) -> Self {
        if telemetry_age_s > LINK_TIMEOUT_S {
            return [StatusAlarm::LinkLost].into_iter().collect();
        }
        let no_fix = gnss.is_some_and(|gnss| !gnss.has_fix);
        let [control, video] = radio.map_or([false; 2], |margins| [margins.control_db, margins.video_db].map(is_weak));
        let all = [(StatusAlarm::GnssLost, no_fix), (StatusAlarm::ControlWeak, control), (StatusAlarm::VideoWeak, video)];
        all.into_iter().filter_map(|(alarm, is_on)| is_on.then_some(alarm)).collect()
    }

    /// Returns whether the set contains an alarm.
    #[must_use]
    pub fn contains(self, alarm: StatusAlarm) -> bool {
        self.0 & (1 << alarm as u8) != 0
    }

    /// Returns the alarms of this set that are not in another one.
    #[must_use]
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }
}

impl FromIterator<StatusAlarm> for StatusAlarms {
    fn from_iter<I: IntoIterator<Item = StatusAlarm>>(alarms: I) -> Self {
        Self(alarms.into_iter().fold(0, |set, alarm| set | 1 << alarm as u8))
    }
}

/// Returns the active alarm, or a freeze, as a short line.
pub fn alarm(hud: &Hud) -> Option<String> {
    status_alarm(hud).or_else(|| {
        let alarms = StatusAlarms::new(hud.telemetry_age_s, hud.gnss, hud.radio);
        let language = hud.style.language;
        if alarms.contains(StatusAlarm::ControlWeak) {
            Some(text!(language, "flight-status-control-weak"))
        } else {
            alarms.contains(StatusAlarm::VideoWeak).then(|| text!(language, "flight-status-video-weak"))
        }
    })
}

/// Returns the alarm of the status line. While the link is lost, the satellite status is unknown, so only the link is reported.
fn status_alarm(hud: &Hud) -> Option<String> {
    let lost_fix = hud.gnss.filter(|gnss| !gnss.has_fix);
    if is_lost(hud) || hud.is_frozen { Some(link(hud)) } else { lost_fix.map(|gnss| satellites(gnss, hud.style.language)) }
}

/// Returns the alarm, if there is one, below the speed. It replaces the status where that has no room.
pub fn alarm_line(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    let Some(words) = alarm(hud) else { return Vec::new() };
    let top = EDGE_MARGIN + speed::PANEL_HEIGHT + BLOCK_GAP;
    // Capitals are wider than the average character.
    let width = CHAR_WIDTH * (words.chars().count() + 1) as f64;
    vec![
        pane.panel((EDGE_MARGIN, top), (EDGE_MARGIN + width, top + PANEL_HEIGHT)),
        pane.text(
            (EDGE_MARGIN + 0.5 * width, top + 0.5 * PANEL_HEIGHT),
            TextAlign::Center,
            SMALL_FONT_SIZE,
            HudColor::Orange,
            words,
        ),
    ]
}

pub fn status(hud: &Hud, pane: Pane) -> Vec<DrawItem> {
    let language = hud.style.language;
    let gnss = hud.gnss.map_or_else(|| text!(language, "flight-status-gnss-unknown"), |gnss| satellites(gnss, language));
    let place = format!("{}   {gnss}", mode(hud));
    // Available width between speed and battery; the battery panel is the wider of the two.
    let room = pane.width - 2.0 * (EDGE_MARGIN + battery::PANEL_WIDTH + BLOCK_GAP);
    let width = |words: &str| CHAR_WIDTH * words.chars().count() as f64;
    let whole = format!("{place}   {}", link(hud));
    let lines = if width(&whole) <= room { vec![whole] } else { vec![place, link(hud)] };
    let color = if status_alarm(hud).is_some() { HudColor::Orange } else { HudColor::White };
    // Without telemetry, the signals are unknown.
    let margins = hud.radio.filter(|_| !is_lost(hud));
    let signals: Vec<RadioLink> = margins.map_or_else(Vec::new, |margins| RadioLink::both(&margins, language).into());
    // The signals are below one line, or beside the second one.
    let second = lines.get(1).map_or(0.0, |line| width(line));
    let second_width = second + signal::row_width(&signals);
    let half = 0.5 * width(&lines[0]).max(second_width);
    let rows = if second_width > 0.0 { 2.0 } else { 1.0 };
    let (middle, bottom) = (0.5 * pane.width, EDGE_MARGIN + PANEL_HEIGHT + LINE_HEIGHT * (rows - 1.0));
    let mut items = vec![pane.panel((middle - half, EDGE_MARGIN), (middle + half, bottom))];
    let middles = [middle, middle - 0.5 * second_width + 0.5 * second];
    for (k, (line, x)) in lines.into_iter().zip(middles).enumerate() {
        let y = EDGE_MARGIN + 0.5 * PANEL_HEIGHT + LINE_HEIGHT * k as f64;
        items.push(pane.text((x, y), TextAlign::Center, SMALL_FONT_SIZE, color, line));
    }
    let signals_at = (middle - 0.5 * second_width + second, bottom - 0.5 * PANEL_HEIGHT);
    items.extend(signal::row(pane, signals_at, &signals));
    items
}

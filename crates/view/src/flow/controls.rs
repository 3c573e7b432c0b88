//! Controller check before the flight (the calibration step of the TASBID questionnaire): live stick display and
//! calibration wizard.

use super::menu::{self, MenuRow};
use super::sheet::{PageWriter, SMALL_TEXT_SIZE, TEXT_SIZE, fitted};
use crate::hud::{HudColor, TextAlign};
use spandrel_text::{Language, text};

/// Current state of the controller.
#[derive(Debug, Clone, PartialEq)]
pub struct ControllerStatus {
    /// Name of the device; `None` if the keyboard is used.
    pub device: Option<String>,
    /// Whether the device has been disconnected; the keyboard is used until it returns.
    pub lost: bool,
    /// Whether the device has a profile.
    pub calibrated: bool,
    /// Stick mode, 1 to 4.
    pub mode: i64,
    /// Dead band as a fraction of the travel around the center.
    pub dead_band: f64,
    /// Expo, 0 (linear) to 1 (cubic).
    pub expo: f64,
    /// Left vertical, left horizontal, right vertical, right horizontal, each in [-1, 1]; up and right are positive.
    pub sticks: [f64; 4],
    /// Raw axes: number, value, and observed minimum and maximum, all in [-1, 1].
    pub axes: Vec<(u32, f64, (f64, f64))>,
    /// Prompt of the calibration wizard; `None` if it is not running.
    pub wizard: Option<String>,
    /// Note for the user, such as why there is no controller or where its profile is stored.
    pub note: String,
    /// Name of each key, with what it does in a few words.
    pub keys: Vec<(String, String)>,
    /// Bindings that the device's buttons have, each with the name of its button.
    pub buttons: Vec<(&'static str, String)>,
}

impl Default for ControllerStatus {
    fn default() -> Self {
        Self {
            device: None,
            lost: false,
            calibrated: false,
            mode: 2,
            dead_band: 0.0,
            expo: 0.0,
            sticks: [0.0; 4],
            axes: Vec::new(),
            wizard: None,
            note: String::new(),
            keys: Vec::new(),
            buttons: Vec::new(),
        }
    }
}

impl ControllerStatus {
    /// Checks whether a device is connected.
    #[must_use]
    pub fn is_connected(&self) -> bool {
        self.device.is_some() && !self.lost
    }

    /// Returns a line that describes the device and the active input.
    fn status_line(&self, language: Language) -> String {
        match self.device.as_deref() {
            None => text!(language, "window-controls-none"),
            Some(name) if self.lost => text!(language, "window-controls-lost", name = name),
            Some(name) if self.calibrated => text!(language, "window-controls-calibrated", name = name),
            Some(name) => text!(language, "window-controls-not-calibrated", name = name),
        }
    }
}

/// Returns the vertical and horizontal functions of the left and right stick in a mode.
fn stick_functions(mode: i64, language: Language) -> [(String, String); 2] {
    let (pitch, throttle) = (text!(language, "window-controls-pitch"), text!(language, "window-controls-throttle"));
    let (roll, yaw) = (text!(language, "window-controls-roll"), text!(language, "window-controls-yaw"));
    match mode {
        1 => [(pitch, yaw), (throttle, roll)],
        3 => [(pitch, roll), (throttle, yaw)],
        4 => [(throttle, roll), (pitch, yaw)],
        _ => [(throttle, yaw), (pitch, roll)],
    }
}

pub fn page(pen: &mut PageWriter, controls: &ControllerStatus, rows: &[MenuRow], focus: usize) {
    let (left, narrow, language) = (0.04, pen.is_narrow(), pen.style().language);
    let half = if narrow { pen.width - 2.0 * left } else { 0.42 * pen.width };
    pen.title((left, 0.08), pen.width - 2.0 * left, &text!(language, "window-controls-title"));
    let mut y = pen.lines((left, 0.165), half, TEXT_SIZE, HudColor::Yellow, &controls.status_line(language));
    if let Some(prompt) = &controls.wizard {
        y = pen.lines((left, y + 0.02), half, 1.1 * TEXT_SIZE, HudColor::White, prompt) + 0.02;
    }
    let y = menu::draw(pen, (left, y + 0.01), half, rows, focus);
    let y = pen.lines((left, y + 0.035), half, SMALL_TEXT_SIZE, HudColor::Gray, &controls.note);
    let shows_keys = !controls.is_connected() && controls.wizard.is_none();
    let y = if shows_keys { columns(pen, (left, y + 0.02), half, &controls.keys) } else { y };
    let (x, top) = if narrow { (left, y + 0.1) } else { (left + half + 0.08, 0.22) };
    let room = pen.width - x - if narrow { left } else { 0.02 };
    let below = sticks(pen, (x, top), room, controls);
    if shows_keys {
        pen.lines((x, below), room, SMALL_TEXT_SIZE, HudColor::White, &text!(language, "window-controls-press-keys"));
    } else if controls.wizard.is_some() || !controls.calibrated {
        axes(pen, (x, below), room, &controls.axes);
    } else {
        pen.lines((x, below), room, SMALL_TEXT_SIZE, HudColor::White, &text!(language, "window-controls-move-sticks"));
    }
}

/// Width by which a stick's labels may exceed the stick.
const LABEL_OVERHANG: f64 = 0.03;
/// Smallest size of two sticks side by side.
const MIN_STICK_SIZE: f64 = 0.3;

/// Draws both sticks, side by side if there is room, and returns the y position below them.
fn sticks(pen: &mut PageWriter, (x, y): (f64, f64), room: f64, controls: &ControllerStatus) -> f64 {
    let side_by_side = 0.5 * (room - 0.1);
    let is_wide = side_by_side >= MIN_STICK_SIZE || !pen.is_narrow();
    let size = if is_wide { side_by_side } else { room }.min(0.36);
    let step = if is_wide { (size + 0.1, 0.0) } else { (0.0, size + 0.2) };
    let language = pen.style().language;
    for (k, (up, across)) in stick_functions(controls.mode, language).into_iter().enumerate() {
        let name =
            if k == 0 { text!(language, "window-controls-left-stick") } else { text!(language, "window-controls-right-stick") };
        let up = text!(language, "window-controls-vertical", words = up);
        let across = text!(language, "window-controls-horizontal", words = across);
        let (right, way) = (controls.sticks[2 * k + 1], controls.sticks[2 * k]);
        let place = (x + step.0 * k as f64, y + step.1 * k as f64);
        stick(pen, place, size, (right, way), [name, up, across]);
    }
    y + step.1 + size + 0.16
}

/// Draws a square with a dot that follows the stick.
fn stick(pen: &mut PageWriter, (x, y): (f64, f64), size: f64, (right, up): (f64, f64), [name, vertical, across]: [String; 3]) {
    const DOT_RADIUS: f64 = 0.018;
    let (mx, my, r) = (x + 0.5 * size, y + 0.5 * size, 0.5 * size);
    pen.panel((x, y), (size, size), HudColor::InputField);
    pen.line(&[(x, my), (x + size, my)], 0.002, HudColor::Gray);
    pen.line(&[(mx, y), (mx, y + size)], 0.002, HudColor::Gray);
    let (dx, dy) = (mx + (r - DOT_RADIUS) * right.clamp(-1.0, 1.0), my - (r - DOT_RADIUS) * up.clamp(-1.0, 1.0));
    pen.line(&[(mx, my), (dx, dy)], 0.005, HudColor::Yellow);
    let dot: Vec<(f64, f64)> = (0..16)
        .map(|k| {
            let (s, c) = spandrel_model::math::sin_cos(spandrel_model::math::TAU * f64::from(k) / 16.0);
            (dx + DOT_RADIUS * s, dy + DOT_RADIUS * c)
        })
        .collect();
    pen.fill(&dot, HudColor::Yellow);
    let name_size = fitted(&name, TEXT_SIZE, size + LABEL_OVERHANG);
    pen.text((mx, y - 0.035), TextAlign::Center, name_size, HudColor::White, name);
    for (words, down) in [(vertical, 0.03), (across, 0.07)] {
        let height = fitted(&words, SMALL_TEXT_SIZE, size + LABEL_OVERHANG);
        pen.text((mx, y + size + down), TextAlign::Center, height, HudColor::Gray, words);
    }
}

/// Draws each raw axis as a bar with its range and value.
fn axes(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, all: &[(u32, f64, (f64, f64))]) {
    const MAX_SHOWN_AXES: usize = 7;
    const BAR_HEIGHT: f64 = 0.024;
    let (from, full) = (x + 0.16, width - 0.18);
    let at = |value: f64| from + full * (0.5 + 0.5 * value.clamp(-1.0, 1.0));
    for (k, (axis, value, (low, high))) in all.iter().take(MAX_SHOWN_AXES).enumerate() {
        let y = y + 0.042 * k as f64;
        // On Linux, the upper half of the number is the event type; users know only the lower half, which starts at 0.
        let name = text!(pen.style().language, "window-controls-axis", number = (axis & 0xffff).to_string());
        pen.text((x, y + 0.5 * BAR_HEIGHT), TextAlign::Left, SMALL_TEXT_SIZE, HudColor::Gray, name);
        pen.panel((from, y), (full, BAR_HEIGHT), HudColor::InputField);
        pen.fill(
            &[(at(*low), y), (at(*high), y), (at(*high), y + BAR_HEIGHT), (at(*low), y + BAR_HEIGHT)],
            HudColor::FocusedField,
        );
        pen.panel((at(*value) - 0.004, y - 0.004), (0.008, BAR_HEIGHT + 0.008), HudColor::Yellow);
    }
    if all.is_empty() {
        let words = text!(pen.style().language, "window-controls-no-axis");
        pen.text((x, y), TextAlign::Left, SMALL_TEXT_SIZE, HudColor::Gray, words);
    }
}

/// Smallest font size of the key bindings.
const MIN_KEY_TEXT_SIZE: f64 = 0.02;

/// Draws the key bindings in columns, each with the key and its function, and returns the y position below them. In a wide
/// window, shrinks the text to fit.
fn columns(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, keys: &[(String, String)]) -> f64 {
    const KEY_COLUMN_WIDTH: f64 = 0.17;
    const KEY_GAP: f64 = 0.01;
    const MIN_WIDTH_OF_TWO: f64 = 0.7;
    let column_count = if pen.is_narrow() && width < MIN_WIDTH_OF_TWO { 1 } else { 2 };
    let rows = keys.len().div_ceil(column_count).max(1);
    let most = if pen.is_narrow() { f64::INFINITY } else { (pen.height - 0.015 - y) / rows as f64 };
    let step = (1.3 * SMALL_TEXT_SIZE).min(most.max(MIN_KEY_TEXT_SIZE * 1.3));
    let height = step / 1.3;
    for (k, (key, duty)) in keys.iter().enumerate() {
        let place = (x + width / column_count as f64 * (k / rows) as f64, y + step * ((k % rows) as f64 + 0.5));
        let room = width / column_count as f64 - KEY_COLUMN_WIDTH;
        pen.text(place, TextAlign::Left, fitted(key, height, KEY_COLUMN_WIDTH - KEY_GAP), HudColor::Yellow, key.as_str());
        let size = fitted(duty, height, room - KEY_GAP);
        pen.text((place.0 + KEY_COLUMN_WIDTH, place.1), TextAlign::Left, size, HudColor::White, duty.as_str());
    }
    y + step * rows as f64
}

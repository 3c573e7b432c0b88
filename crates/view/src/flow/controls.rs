//! The controller is tried before the flight (the calibration of the paper's questionnaire): live sticks, and the wizard's questions.

use super::menu::{self, MenuRow};
use super::sheet::{PageWriter, SMALL, TEXT, TITLE};
use crate::hud::{HudColor, TextAlign};

/// The controller as it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct ControllerStatus {
    /// Its name; none: the keys fly.
    pub device: Option<String>,
    /// It was there and is away: the keys fly.
    pub lost: bool,
    /// It has a profile.
    pub calibrated: bool,
    /// Which stick does what, 1 to 4.
    pub mode: i64,
    /// Part of the way about the centre that counts as centred.
    pub dead_band: f64,
    /// How much flatter the middle is than the ends, 0 to 1.
    pub expo: f64,
    /// Left stick up, left stick right, right stick up, right stick right, -1 to 1.
    pub sticks: [f64; 4],
    /// Raw axes: number, where it stands, the ends that were seen; of the range -1 to 1.
    pub axes: Vec<(u32, f64, (f64, f64))>,
    /// What the wizard asks; none: it does not run.
    pub wizard: Option<String>,
    /// Something to tell: why there is no controller, where its profile is kept.
    pub note: String,
    /// What the keys do, a line each.
    pub keys: String,
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
            keys: String::new(),
        }
    }
}

impl ControllerStatus {
    /// A device is connected.
    #[must_use]
    pub fn is_connected(&self) -> bool {
        self.device.is_some() && !self.lost
    }

    /// In words: which device, and what flies.
    fn standing(&self) -> String {
        match &self.device {
            None => "No controller: the keys fly.".to_owned(),
            Some(name) if self.lost => format!("{name} is not connected: the keys fly"),
            Some(name) if self.calibrated => format!("{name}, calibrated"),
            Some(name) => format!("{name}, not calibrated: the keys fly until it is"),
        }
    }
}

/// What the ways of the left and the right stick do in a mode: up and down, left and right.
fn duties(mode: i64) -> [(&'static str, &'static str); 2] {
    let (pitch, throttle, roll, yaw) = ("forward, back", "up, down", "left, right", "turn");
    match mode {
        1 => [(pitch, yaw), (throttle, roll)],
        3 => [(pitch, roll), (throttle, yaw)],
        4 => [(throttle, roll), (pitch, yaw)],
        _ => [(throttle, yaw), (pitch, roll)],
    }
}

pub fn page(pen: &mut PageWriter, controls: &ControllerStatus, rows: &[MenuRow], focus: usize) {
    let left = 0.04;
    let half = 0.42 * pen.width;
    pen.text((left, 0.08), TextAlign::Left, TITLE, HudColor::White, "Check the controller");
    let mut y = pen.lines((left, 0.165), half, TEXT, HudColor::Yellow, &controls.standing());
    if let Some(prompt) = &controls.wizard {
        y = pen.lines((left, y + 0.02), half, 1.1 * TEXT, HudColor::White, prompt) + 0.02;
    }
    let y = menu::draw(pen, (left, y + 0.01), half, rows, focus);
    let y = pen.lines((left, y + 0.035), half, SMALL, HudColor::Grey, &controls.note);
    let x = left + half + 0.08;
    let room = pen.width - x - 0.02;
    let size = (0.5 * (room - 0.1)).min(0.36);
    for (k, (up, across)) in duties(controls.mode).into_iter().enumerate() {
        let name = if k == 0 { "left stick" } else { "right stick" };
        let (right, way) = (controls.sticks[2 * k + 1], controls.sticks[2 * k]);
        stick(pen, (x + (size + 0.1) * k as f64, 0.22), size, (right, way), [name, up, across]);
    }
    let below = 0.22 + size + 0.16;
    if !controls.is_connected() && controls.wizard.is_none() {
        columns(pen, (left, y + 0.02), half, &controls.keys);
        pen.lines(
            (x, below),
            room,
            SMALL,
            HudColor::White,
            "Press the keys that fly: the dots must follow. Tab and Enter, or the mouse, go on.",
        );
    } else if controls.wizard.is_some() || !controls.calibrated {
        axes(pen, (x, below), room, &controls.axes);
    } else {
        let words = "Move the sticks: the dots must follow, rest in the middle, and reach all edges.";
        pen.lines((x, below), room, SMALL, HudColor::White, words);
    }
}

/// A square in which a dot follows the stick.
fn stick(pen: &mut PageWriter, (x, y): (f64, f64), size: f64, (right, up): (f64, f64), [name, vertical, across]: [&str; 3]) {
    const DOT: f64 = 0.018;
    let (mx, my, r) = (x + 0.5 * size, y + 0.5 * size, 0.5 * size);
    pen.panel((x, y), (size, size), HudColor::Card);
    pen.line(&[(x, my), (x + size, my)], 0.002, HudColor::Grey);
    pen.line(&[(mx, y), (mx, y + size)], 0.002, HudColor::Grey);
    let (dx, dy) = (mx + (r - DOT) * right.clamp(-1.0, 1.0), my - (r - DOT) * up.clamp(-1.0, 1.0));
    pen.line(&[(mx, my), (dx, dy)], 0.005, HudColor::Yellow);
    let dot: Vec<(f64, f64)> = (0..16)
        .map(|k| {
            let (s, c) = spandrel_model::math::sin_cos(spandrel_model::math::TAU * f64::from(k) / 16.0);
            (dx + DOT * s, dy + DOT * c)
        })
        .collect();
    pen.fill(&dot, HudColor::Yellow);
    pen.text((mx, y - 0.035), TextAlign::Middle, TEXT, HudColor::White, name);
    pen.text((mx, y + size + 0.03), TextAlign::Middle, SMALL, HudColor::Grey, format!("vertical: {vertical}"));
    pen.text((mx, y + size + 0.07), TextAlign::Middle, SMALL, HudColor::Grey, format!("across: {across}"));
}

/// Every raw axis as a bar: the ends that were seen, and where it stands.
fn axes(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, all: &[(u32, f64, (f64, f64))]) {
    const MOST: usize = 7;
    const HIGH: f64 = 0.024;
    let (from, full) = (x + 0.16, width - 0.18);
    let at = |value: f64| from + full * (0.5 + 0.5 * value.clamp(-1.0, 1.0));
    for (k, (axis, value, (low, high))) in all.iter().take(MOST).enumerate() {
        let y = y + 0.042 * k as f64;
        // The kind of an event stands in the upper half of its number on Linux; people count axes from 0.
        pen.text((x, y + 0.5 * HIGH), TextAlign::Left, SMALL, HudColor::Grey, format!("axis {}", axis & 0xffff));
        pen.panel((from, y), (full, HIGH), HudColor::Card);
        pen.fill(&[(at(*low), y), (at(*high), y), (at(*high), y + HIGH), (at(*low), y + HIGH)], HudColor::Focus);
        pen.panel((at(*value) - 0.004, y - 0.004), (0.008, HIGH + 0.008), HudColor::Yellow);
    }
    if all.is_empty() {
        pen.text((x, y), TextAlign::Left, SMALL, HudColor::Grey, "No axis has moved yet.");
    }
}

/// Lines in two columns, as far as there is room: the key, what it does.
fn columns(pen: &mut PageWriter, (x, y): (f64, f64), width: f64, text: &str) {
    const COLUMNS: usize = 2;
    const KEY: f64 = 0.17;
    let lines: Vec<&str> = text.lines().collect();
    let rows = lines.len().div_ceil(COLUMNS).max(1);
    let step = (1.3 * SMALL).min((0.985 - y) / rows as f64);
    let height = (step / 1.3).max(0.0);
    for (k, line) in lines.iter().enumerate() {
        let place = (x + 0.5 * width * (k / rows) as f64, y + step * ((k % rows) as f64 + 0.5));
        let (key, duty) = line.split_once(' ').unwrap_or((line, ""));
        pen.text(place, TextAlign::Left, height, HudColor::Yellow, key);
        pen.text((place.0 + KEY, place.1), TextAlign::Left, height, HudColor::White, duty.trim().replace('_', " "));
    }
}

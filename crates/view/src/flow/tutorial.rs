//! Tutorial shown before the first practice session, as in the TASBID protocol: simulator pictures with labels and
//! arrows, and the HUD as it appears in flight.

use super::KeyNames;
use super::menu::{self, MenuRow, ROW_SPACING};
use super::sheet::{LINE_SPACING, PageWriter, SMALL_TEXT_SIZE, text_width, wrap_text};
use crate::flown_path::FlownPath;
use crate::hud::{
    DisplayStyle, DrawItem, GnssStatus, Hud, HudColor, ScreenPoint, SiteOutline, TaskNames, TextAlign, TextScale, instruments,
    layout,
};
use spandrel_mavlink::contract::cue::{self, CueTexts};
use spandrel_model::frames::Vec3;
use spandrel_text::{Language, message_id, text};
use std::sync::Arc;

/// Embedded JPEG pictures by name.
pub const PICTURES: [(&str, &[u8]); 9] = [
    ("job", include_bytes!("pictures/job.jpg")),
    ("inspector", include_bytes!("pictures/inspector.jpg")),
    ("camera", include_bytes!("pictures/camera.jpg")),
    ("dark", include_bytes!("pictures/dark.jpg")),
    ("lamp", include_bytes!("pictures/lamp.jpg")),
    ("crack", include_bytes!("pictures/crack.jpg")),
    ("spall", include_bytes!("pictures/spall.jpg")),
    ("efflorescence", include_bytes!("pictures/efflorescence.jpg")),
    ("corrosion", include_bytes!("pictures/corrosion.jpg")),
];

/// Aspect ratio of the large pictures.
const PICTURE_ASPECT: f64 = 16.0 / 9.0;

/// A page: its title, the function that draws the box on the left, and the text on the right.
struct TutorialPage {
    title: String,
    picture: fn(&mut PageWriter, PictureFrame, &KeyNames),
    text: String,
}

impl TutorialPage {
    /// Returns the page with this number, from 0.
    fn new(number: usize, language: Language, names: &KeyNames) -> Option<Self> {
        let page = |title: String, picture, text: String| Self { title, picture, text };
        Some(match number {
            0 => page(text!(language, "tutorial-job-title"), job, text!(language, "tutorial-job-text")),
            1 => page(text!(language, "tutorial-views-title"), views, names.fill(language, message_id!("tutorial-views-text"))),
            2 => page(text!(language, "tutorial-display-title"), display, text!(language, "tutorial-display-text")),
            3 => page(text!(language, "tutorial-warnings-title"), warnings, text!(language, "tutorial-warnings-text")),
            4 => page(
                text!(language, "tutorial-defects-title"),
                defects,
                names.fill(language, message_id!("tutorial-defects-text")),
            ),
            5 => page(text!(language, "tutorial-light-title"), light, names.fill(language, message_id!("tutorial-light-text"))),
            _ => return None,
        })
    }
}

/// Number of pages.
pub const PAGE_COUNT: usize = 6;

/// Position of a picture and font size of its labels, in units of the page.
#[derive(Debug, Clone, Copy)]
struct PictureFrame {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
    font: f64,
}

/// Font sizes of the text beside the picture relative to secondary text.
const TEXT_RATIOS: [f64; 4] = [1.0, 0.92, 0.88, 0.84];
/// Largest font size of a label relative to the width of the page's picture.
const MAX_FONT_RATIO: f64 = 0.04;

impl PictureFrame {
    fn at(self, across: f64, down: f64) -> (f64, f64) {
        (self.x + across * self.width, self.y + down * self.height)
    }

    fn part(self, (across, down): (f64, f64), (width, height): (f64, f64)) -> Self {
        let (x, y) = self.at(across, down);
        Self { x, y, width: width * self.width, height: height * self.height, font: self.font }
    }
}

pub fn page(pen: &mut PageWriter, page: usize, rows: &[MenuRow], focus: usize, names: &KeyNames) {
    let language = pen.style().language;
    let Some(TutorialPage { title, picture, text: words }) = TutorialPage::new(page, language, names) else { return };
    let (left, narrow) = (0.04, pen.is_narrow());
    let title = text!(language, "tutorial-title", page = page + 1, pages = PAGE_COUNT, title = title);
    pen.title((left, 0.07), pen.width - 2.0 * left, &title);
    let room = if narrow { pen.width - 2.0 * left } else { 0.60 * pen.width };
    let width = room.min(0.70 * PICTURE_ASPECT);
    let font = SMALL_TEXT_SIZE.min(MAX_FONT_RATIO * width);
    let frame = PictureFrame { x: left, y: 0.15, width, height: width / PICTURE_ASPECT, font };
    picture(pen, frame, names);
    let (x, top) = if narrow { (left, pen.bottom().max(frame.y + frame.height) + 0.05) } else { (left + width + 0.06, 0.17) };
    let room = pen.width - x - if narrow { left } else { 0.03 };
    let menu_top = pen.height - 0.03 - ROW_SPACING * rows.len() as f64;
    // Text beside the picture shrinks a little before the page is scrolled.
    let height = |size: f64| LINE_SPACING * size * wrap_text(&words, room, size).len() as f64;
    let sizes = TEXT_RATIOS.map(|ratio| ratio * SMALL_TEXT_SIZE);
    let fitting = sizes.into_iter().find(|size| !narrow && top + height(*size) <= menu_top);
    let bottom = pen.lines((x, top), room, fitting.unwrap_or(SMALL_TEXT_SIZE), HudColor::White, &words);
    menu::draw(pen, (x, if narrow || menu_top < bottom { bottom + 0.02 } else { menu_top }), room, rows, focus);
}

/// Draws a label with an arrow; both positions are fractions of the frame.
fn label(pen: &mut PageWriter, frame: PictureFrame, words: String, from: (f64, f64), to: (f64, f64)) {
    let unit = frame.font / SMALL_TEXT_SIZE;
    let half = 0.5 * text_width(&words, frame.font) + 0.012 * unit;
    let (x, y) = frame.at(from.0, from.1);
    // A long label stays on the page.
    let x = x.min(pen.width - half).max(half);
    let (tx, ty) = frame.at(to.0, to.1);
    // The arrow starts on the side of the label that faces its target.
    let foot = if (tx - x).abs() > half { (x + half * (tx - x).signum(), y) } else { (x, y + 0.025 * unit * (ty - y).signum()) };
    pen.arrow(foot, (tx, ty), HudColor::Yellow);
    pen.panel((x - half, y - 0.025 * unit), (2.0 * half, 0.05 * unit), HudColor::PageBackground);
    pen.text((x, y), TextAlign::Center, frame.font, HudColor::Yellow, words);
}

fn job(pen: &mut PageWriter, frame: PictureFrame, _: &KeyNames) {
    let language = pen.style().language;
    pen.picture("job", frame.at(0.0, 0.0), (frame.width, frame.height));
    label(pen, frame, text!(language, "tutorial-job-pad"), (0.26, 0.86), (0.075, 0.62));
    label(pen, frame, text!(language, "tutorial-job-suspension"), (0.62, 0.07), (0.55, 0.22));
    label(pen, frame, text!(language, "tutorial-job-arch"), (0.80, 0.86), (0.72, 0.58));
    label(pen, frame, text!(language, "tutorial-job-task"), (0.24, 0.07), (0.235, 0.355));
}

/// Width of the column with the trainee's own view and the instruments, as a fraction of the picture.
const SIDE_SHARE: f64 = 0.3;

/// Draws the window as it is in flight: the trainee's own view above the instruments, and the camera view.
fn views(pen: &mut PageWriter, frame: PictureFrame, _: &KeyNames) {
    let camera = frame.part((SIDE_SHARE, 0.0), (1.0 - SIDE_SHARE, 1.0 - SIDE_SHARE));
    let own = frame.part((0.0, 0.0), (SIDE_SHARE, SIDE_SHARE));
    let below = frame.part((0.0, SIDE_SHARE), (SIDE_SHARE, 1.0 - 2.0 * SIDE_SHARE));
    pen.picture("inspector", own.at(0.0, 0.0), (own.width, own.height));
    pen.picture("camera", camera.at(0.0, 0.0), (camera.width, camera.height));
    let language = pen.style().language;
    let display = example(0, pen.style());
    inset(pen, &layout(&display, PICTURE_ASPECT), camera);
    pen.panel(below.at(0.0, 0.0), (below.width, below.height), HudColor::PageBackground);
    // The unit is only a scale: the navigation display fills its area.
    let shape = (1_000.0 * below.width, 1_000.0 * below.height);
    inset(pen, &instruments(&display, &SiteOutline::empty(), shape), below);
    label(pen, frame, text!(language, "tutorial-views-own"), (0.48, 0.26), (0.28, 0.20));
    label(pen, frame, text!(language, "tutorial-views-navigation"), (0.20, 0.84), (0.16, 0.62));
    label(pen, frame, text!(language, "tutorial-views-camera"), (0.74, 0.84), (0.66, 0.60));
    let (x, y) = frame.at(0.0, 1.0);
    pen.lines((x, y), frame.width, frame.font, HudColor::Gray, &text!(language, "tutorial-views-note"));
}

fn display(pen: &mut PageWriter, frame: PictureFrame, _: &KeyNames) {
    pen.picture("camera", frame.at(0.0, 0.0), (frame.width, frame.height));
    let language = pen.style().language;
    inset(pen, &layout(&example(0, pen.style()), PICTURE_ASPECT), frame);
    for (words, from, to) in [
        (text!(language, "tutorial-display-speed"), (0.20, 0.30), (0.08, 0.135)),
        (text!(language, "tutorial-display-status"), (0.50, 0.20), (0.50, 0.075)),
        (text!(language, "tutorial-display-battery"), (0.70, 0.13), (0.84, 0.065)),
        (text!(language, "tutorial-display-readouts"), (0.64, 0.38), (0.885, 0.25)),
        (text!(language, "tutorial-display-corners"), (0.38, 0.80), (0.105, 0.895)),
    ] {
        label(pen, frame, words, from, to);
    }
}

fn warnings(pen: &mut PageWriter, frame: PictureFrame, _: &KeyNames) {
    pen.picture("camera", frame.at(0.0, 0.0), (frame.width, frame.height));
    let language = pen.style().language;
    let crash = format!("Crash: {}", text!(language, "tutorial-warnings-object"));
    let texts =
        [crash.as_str(), "Too close: 1.2 m, limit 2.5 m", "Too fast: 12 mph, limit 10 mph", "Off path 3.4 m: left and up"];
    let cues = cue::CRASH | cue::TOO_CLOSE | cue::SPEEDING | cue::OFF_PATH;
    let display =
        Hud { cue_texts: texts.into_iter().collect(), battery_pct: Some(24.0), speed_m_s: 5.3, ..example(cues, pen.style()) };
    inset(pen, &layout(&display, PICTURE_ASPECT), frame);
    label(pen, frame, text!(language, "tutorial-warnings-warnings"), (0.62, 0.68), (0.36, 0.80));
    label(pen, frame, text!(language, "tutorial-warnings-battery"), (0.62, 0.22), (0.86, 0.085));
}

fn defects(pen: &mut PageWriter, frame: PictureFrame, _: &KeyNames) {
    let language = pen.style().language;
    let kinds = [
        ("crack", text!(language, "tutorial-defects-crack")),
        ("spall", text!(language, "tutorial-defects-spall")),
        ("efflorescence", text!(language, "tutorial-defects-efflorescence")),
        ("corrosion", text!(language, "tutorial-defects-corrosion")),
    ];
    for (k, (name, words)) in kinds.into_iter().enumerate() {
        let strip = frame.part((0.0, 0.26 * k as f64), (1.0, 0.24));
        // The strips have an aspect ratio of 4.
        let width = (4.0 * strip.height).min(strip.width);
        pen.picture(name, strip.at(0.0, 0.0), (width, 0.25 * width));
        let end = strip.x + width;
        pen.text((end + 0.02, strip.y + 0.5 * strip.height), TextAlign::Left, frame.font, HudColor::Yellow, words);
    }
    for (k, words) in ["1 m", "3 m", "8 m"].into_iter().enumerate() {
        let width = (4.0 * 0.24 * frame.height).min(frame.width);
        let x = frame.x + width * (k as f64 + 0.5) / 3.0;
        pen.text((x, frame.y + 1.06 * frame.height), TextAlign::Center, frame.font, HudColor::Yellow, words);
    }
}

fn light(pen: &mut PageWriter, frame: PictureFrame, names: &KeyNames) {
    let language = pen.style().language;
    let first = frame.part((0.0, 0.0), (0.49, 0.49));
    let second = frame.part((0.51, 0.0), (0.49, 0.49));
    pen.picture("dark", first.at(0.0, 0.0), (first.width, first.height));
    pen.picture("lamp", second.at(0.0, 0.0), (second.width, second.height));
    label(pen, first, text!(language, "tutorial-light-without"), (0.5, 1.14), (0.5, 0.85));
    label(pen, second, text!(language, "tutorial-light-with"), (0.3, 1.14), (0.38, 0.85));
    label(pen, second, text!(language, "tutorial-light-closer"), (0.62, 0.68), (0.33, 0.33));
    let (x, y) = frame.at(0.0, 0.72);
    let words = names.fill(language, message_id!("tutorial-light-keys"));
    pen.lines((x, y), frame.width, frame.font, HudColor::Gray, &words);
}

/// Returns an example HUD in flight.
fn example(cues: i32, style: DisplayStyle) -> Hud {
    Hud {
        speed_m_s: 2.4,
        limit_m_s: 10.0 * spandrel_model::math::M_S_PER_MPH,
        battery_pct: Some(86.0),
        min_green_pct: 70.0,
        min_yellow_pct: 30.0,
        cues,
        cue_texts: CueTexts::default(),
        height_m: 12.0,
        home_distance_m: 118.0,
        mode: "Position".into(),
        gnss: Some(GnssStatus { has_fix: true, satellites: 17 }),
        radio: None,
        telemetry_age_s: 0.0,
        is_frozen: false,
        ghost: None,
        gimbal_rad: 0.1,
        zoom: 1.0,
        lamp: false,
        remaining_s: 1104.0,
        pictures: 2,
        // Red elements blink; they are visible in the first half of the period.
        shutter: false,
        time_s: if cues & cue::CRASH != 0 { 0.1 } else { 95.0 },
        position_m: Vec3::new(-60.0, 130.0, 12.0),
        heading_rad: 0.6,
        roll_rad: 0.0,
        pitch_rad: 0.0,
        obstacles: None,
        way_back: None,
        inspector: None,
        pad_m: Vec3::new(-120.0, 60.0, 5.0),
        guidance: None,
        guidance_how: String::new(),
        lesson: None,
        tasks: TaskNames::default(),
        flown: FlownPath::default(),
        tracks: Vec::new(),
        site: Arc::new(SiteOutline::empty()),
        style: DisplayStyle { text_scale: TextScale::Normal, ..style },
    }
}

/// Draws a HUD into a frame.
fn inset(pen: &mut PageWriter, items: &[DrawItem], frame: PictureFrame) {
    let place = |p: &ScreenPoint| frame.at(p.x, p.y);
    for item in items {
        match item {
            DrawItem::Panel { from, to, color } => {
                let (from, to) = (place(from), place(to));
                pen.panel(from, (to.0 - from.0, to.1 - from.1), *color);
            }
            DrawItem::Text { place: at, side, height, color, words } => {
                pen.text(place(at), *side, height * frame.height, *color, words.clone());
            }
            DrawItem::Fill { points, color } => pen.fill(&points.iter().map(place).collect::<Vec<_>>(), *color),
            DrawItem::Line { points, width, color } => {
                pen.line(&points.iter().map(place).collect::<Vec<_>>(), width * frame.height, *color);
            }
        }
    }
}

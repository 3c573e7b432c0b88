//! Tests that HUD items do not overlap, in pictures of any aspect ratio and size.

use super::contrast;
use super::tests::{ALL_CUES, crash, hud};
use super::text_metrics::text_width;
use super::*;
use crate::arrange::{ViewKind, ViewLayout, WindowShape};
use crate::flow::{ControlNames, ControllerStatus, KeyNames};
use spandrel_mavlink::contract::guidance::{Detour, DetourKind, Guidance, GuidanceStep, PathDeviation, StandOffReading, WayTo};
use spandrel_mavlink::contract::hazards::RadioMargins;
use spandrel_mavlink::contract::lesson::{LessonStatus, LessonTask};
use spandrel_model::frames::{Rotation, Vec3};
use spandrel_model::pose::Pose;
use spandrel_model::radio::RadioWay;
use spandrel_text::{Language, text};
use std::sync::Arc;

/// A rectangle: left, top, right, bottom, in units of the picture's height.
type PictureRect = [f64; 4];

/// Tolerance for rounding errors.
const TOLERANCE: f64 = 1e-9;

/// A block of the HUD: its background and contents.
#[derive(Debug)]
struct DisplayBlock {
    background: PictureRect,
    texts: Vec<(PictureRect, String)>,
    shapes: Vec<PictureRect>,
}

fn around(points: &[ScreenPoint], aspect: f64) -> PictureRect {
    let of = |pick: fn(f64, f64) -> f64, place: fn(&ScreenPoint) -> f64| points.iter().map(place).reduce(pick).unwrap();
    [of(f64::min, |p| p.x) * aspect, of(f64::min, |p| p.y), of(f64::max, |p| p.x) * aspect, of(f64::max, |p| p.y)]
}

fn text_rect(place: ScreenPoint, side: TextAlign, height: f64, words: &str, aspect: f64) -> PictureRect {
    let wide = text_width(words, height);
    let left = place.x * aspect
        - match side {
            TextAlign::Left => 0.0,
            TextAlign::Center => 0.5 * wide,
            TextAlign::Right => wide,
        };
    [left, place.y - 0.5 * height, left + wide, place.y + 0.5 * height]
}

/// Returns the HUD's blocks. Skips the crosshair and the corner marks, which are drawn below the blocks and belong to
/// the picture.
fn blocks(items: Vec<DrawItem>, aspect: f64) -> Vec<DisplayBlock> {
    let mut found: Vec<DisplayBlock> = Vec::new();
    for item in items {
        if let DrawItem::Panel { from, to, .. } = item {
            found.push(DisplayBlock { background: around(&[from, to], aspect), texts: Vec::new(), shapes: Vec::new() });
            continue;
        }
        let Some(block) = found.last_mut() else {
            assert!(matches!(item, DrawItem::Line { .. }), "{item:?} is outside all blocks");
            continue;
        };
        match item {
            DrawItem::Text { place, side, height, words, .. } => {
                block.texts.push((text_rect(place, side, height, &words, aspect), words));
            }
            DrawItem::Fill { points, .. } | DrawItem::Line { points, .. } => block.shapes.push(around(&points, aspect)),
            DrawItem::Panel { .. } => {}
        }
    }
    found
}

fn are_separate(a: &PictureRect, b: &PictureRect) -> bool {
    a[2] <= b[0] + TOLERANCE || b[2] <= a[0] + TOLERANCE || a[3] <= b[1] + TOLERANCE || b[3] <= a[1] + TOLERANCE
}

fn contains(outer: &PictureRect, inner: &PictureRect) -> bool {
    outer[0] <= inner[0] + TOLERANCE
        && outer[1] <= inner[1] + TOLERANCE
        && inner[2] <= outer[2] + TOLERANCE
        && inner[3] <= outer[3] + TOLERANCE
}

/// Converts a rectangle of a camera picture to fractions of a window with the given aspect ratio.
fn in_window(area: &PictureRect, lens: f64, window: f64) -> PictureRect {
    let places = ViewLayout::Camera.view_rects(WindowShape { window, camera: lens });
    let place = places.into_iter().find(|place| place.which == ViewKind::Camera).unwrap();
    let (x, y) = (|x: f64| place.left + place.width * x / lens, |y: f64| place.top + place.height * y);
    [x(area[0]), y(area[1]), x(area[2]), y(area[3])]
}

/// Checks whether the block is the map, whose paths and numbers may overlap.
fn is_map(block: &DisplayBlock) -> bool {
    let north = [Language::English, Language::Pseudo].map(|language| text!(language, "flight-compass-north"));
    block.texts.iter().any(|(_, words)| north.contains(words))
}

fn check_block(block: &DisplayBlock, what: &str) {
    for shape in &block.shapes {
        assert!(contains(&block.background, shape), "{what}: a shape at {shape:?} extends beyond {:?}", block.background);
    }
    if is_map(block) {
        return;
    }
    for (k, (place, words)) in block.texts.iter().enumerate() {
        assert!(contains(&block.background, place), "{what}: '{words}' at {place:?} extends beyond {:?}", block.background);
        for (other, over) in &block.texts[..k] {
            assert!(are_separate(place, other), "{what}: '{words}' overlaps '{over}'");
        }
        assert!(block.shapes.iter().all(|shape| are_separate(place, shape)), "{what}: '{words}' overlaps a shape");
    }
    for (k, one) in block.shapes.iter().enumerate() {
        // One shape may contain another: the battery outline contains the charge level.
        let fine = |other: &PictureRect| are_separate(one, other) || contains(one, other) || contains(other, one);
        assert!(block.shapes[..k].iter().all(fine), "{what}: shapes in the same block overlap");
    }
}

fn check(items: Vec<DrawItem>, aspect: f64, what: &str) {
    let found = blocks(items, aspect);
    for (k, block) in found.iter().enumerate() {
        check_block(block, what);
        assert!(contains(&[0.0, 0.0, aspect, 1.0], &block.background), "{what}: {block:?} extends beyond the picture");
        for other in &found[..k] {
            assert!(are_separate(&block.background, &other.background), "{what}: {block:?} overlaps {other:?}");
        }
    }
}

/// Returns guidance with the longest possible texts.
fn longest_guidance() -> Guidance {
    Guidance {
        step: GuidanceStep::FlyToTask,
        task: Some(12),
        way: Some(WayTo { distance_m: 4_321.0, bearing_rad: 3.1, up_m: -120.0 }),
        progress: Some(1.0),
        tasks_done: 11,
        tasks: 12,
        deviation: Some(PathDeviation { distance_m: 188.8, above_m: -188.8 }),
        stand_off: Some(StandOffReading { actual_m: 88.8, recommended_m: 18.5, tolerance_m: 10.5 }),
        flown_s: 5_999.0,
        needed_s: 5_999.0,
        detour: None,
    }
}

/// Returns guidance before the flight, which has neither a task nor a way.
fn take_off() -> Guidance {
    let before = Guidance { step: GuidanceStep::TakeOff, task: None, way: None, progress: None, ..longest_guidance() };
    Guidance { deviation: None, stand_off: None, ..before }
}

/// Returns guidance around an obstacle with the longest possible texts.
fn longest_detour() -> Guidance {
    let detour = Detour { kind: DetourKind::OutFromUnder, way: WayTo { distance_m: 4_321.0, bearing_rad: 3.1, up_m: -120.0 } };
    Guidance { detour: Some(detour), ..longest_guidance() }
}

/// Returns a step of a lesson with the longest possible texts.
fn longest_lesson() -> LessonDisplay {
    let way = Some(WayTo { distance_m: 4_321.0, bearing_rad: 3.1, up_m: -120.0 });
    let task = LessonTask::StopAt;
    let status = LessonStatus { task, step: 60, steps: 60, progress: 0.6, way, radius_m: Some(2.0), target: Some(120.0) };
    let remark = Some("too oblique: 88.8 deg, limit 60 deg, and more".to_owned());
    LessonDisplay { status, how: "Release the keys early: the drone needs room to stop. ".repeat(3), remark }
}

/// All languages, and the one with the longest texts.
const LANGUAGES: [Language; 4] = [Language::English, Language::German, Language::Spanish, Language::Pseudo];

/// Returns names of keys as long as those of the usual keys.
fn key_name(binding: &str, language: Language) -> String {
    let name = |german: &str, spanish: &str, english: &str| match language {
        Language::German => german.to_owned(),
        Language::Spanish => spanish.to_owned(),
        Language::English | Language::Pseudo => english.to_owned(),
    };
    match binding {
        "forward" => name("Auf", "Arriba", "Up"),
        "back" => name("Ab", "Abajo", "Down"),
        "left" => name("Links", "Izquierda", "Left"),
        "right" => name("Rechts", "Derecha", "Right"),
        "gimbal_up" => name("Bild auf", "Re Pág", "Page up"),
        "gimbal_down" => name("Bild ab", "Av Pág", "Page down"),
        _ => "W".to_owned(),
    }
}

/// Bindings that the steps of a lesson name.
const BINDINGS: [&str; 15] = [
    "forward",
    "back",
    "left",
    "right",
    "up",
    "down",
    "turn_left",
    "turn_right",
    "arm",
    "take_off",
    "land",
    "lamp",
    "snapshot",
    "gimbal_up",
    "gimbal_down",
];

fn key_names(language: Language) -> KeyNames {
    KeyNames::new(BINDINGS.map(|binding| (binding, key_name(binding, language))).into())
}

/// Returns no controller, and one with a button for everything.
fn controllers() -> [ControllerStatus; 2] {
    let buttons = BINDINGS.map(|binding| (binding, "your button “photograph”".to_owned())).to_vec();
    [ControllerStatus::default(), ControllerStatus { calibrated: true, buttons, ..ControllerStatus::default() }]
}

#[test]
fn exact_steps_of_a_lesson_are_not_cut_in_any_language() {
    for ((task, language), controller) in LessonTask::ALL
        .into_iter()
        .flat_map(|task| LANGUAGES[..3].iter().map(move |one| (task, *one)))
        .flat_map(|one| controllers().map(|controller| (one, controller)))
    {
        let lesson = longest_lesson();
        let status = LessonStatus { task, target: Some(if task == LessonTask::Turn { 6.2 } else { 30.0 }), ..lesson.status };
        let how = lesson_words::how_to(task, language, &ControlNames::new(&key_names(language), &controller, language));
        assert!(!how.contains('{'), "{language:?}: {how}");
        let style = DisplayStyle { language, ..DisplayStyle::default() };
        let items = layout(&Hud { lesson: Some(LessonDisplay { status, how, remark: None }), style, ..hud() }, 4.0 / 3.0);
        for item in items {
            let DrawItem::Text { words, .. } = item else { continue };
            assert!(!words.contains('…'), "{language:?}: {words}");
        }
    }
}

#[test]
fn exact_the_panel_says_how_to_take_off_and_land_in_all_languages() {
    let steps = [GuidanceStep::TakeOff, GuidanceStep::Land];
    for (step, language) in steps.into_iter().flat_map(|step| LANGUAGES[..3].iter().map(move |one| (step, *one))) {
        let keys = key_names(language);
        let guidance_how =
            lesson_words::step_how_to(step, language, &ControlNames::new(&keys, &ControllerStatus::default(), language));
        let style = DisplayStyle { language, ..DisplayStyle::default() };
        let hud = Hud { guidance: Some(Guidance { step, ..take_off() }), guidance_how: guidance_how.clone(), style, ..hud() };
        let shown = |items: Vec<DrawItem>| {
            let words =
                items.into_iter().filter_map(|item| if let DrawItem::Text { words, .. } = item { Some(words) } else { None });
            words.collect::<Vec<_>>().join(" ")
        };
        let items = shown(layout(&hud, 4.0 / 3.0));
        assert!(!guidance_how.is_empty() && items.contains(&guidance_how), "{language:?}: {items}, not {guidance_how}");
    }
    let (keys, controller) = (KeyNames::default(), ControllerStatus::default());
    let names = ControlNames::new(&keys, &controller, Language::English);
    assert!(lesson_words::step_how_to(GuidanceStep::FollowPath, Language::English, &names).is_empty());
}

#[test]
fn prop_items_do_not_overlap_in_any_language() {
    for (language, units) in LANGUAGES.into_iter().flat_map(|language| DisplayUnits::ALL.map(|units| (language, units))) {
        let style = DisplayStyle { language, units, text_scale: TextScale::Normal };
        for aspect in [0.7, 1.0, 1.2, 4.0 / 3.0, 3.0 / 2.0, 16.0 / 9.0, 2.6] {
            for height_px in [81.0, 216.0, 360.0, 720.0] {
                for (name, state) in states() {
                    let items = layout_px(&Hud { style, ..state }, (aspect * height_px, height_px));
                    check(items, aspect, &format!("{name}, {style:?}, aspect {aspect:.2}, {height_px} px high"));
                }
            }
        }
    }
}

/// Returns the margins of the radio links, dB.
fn radio(control_db: f64, video_db: f64) -> RadioMargins {
    RadioMargins { control_db, video_db, way: RadioWay::AroundEdge, losses: 0 }
}

/// Returns HUD states with the longest possible texts (telemetry texts have at most 50 bytes), with and without the
/// map.
fn states() -> Vec<(&'static str, Hud)> {
    let dark = |satellites| Some(GnssStatus { has_fix: false, satellites });
    let hit = |words: &str| Hud { cues: ALL_CUES, cue_texts: crash(words), ..hud() };
    let track =
        |id, east| MapPath { id, path_m: vec![Vec3::new(east, 150.0, 30.0), Vec3::new(-90.0, 20.0, 30.0)], closed: id == 2 };
    let tracks = [1, 2, 3, 4].map(|id| track(id, 150.0));
    let full = Hud {
        speed_m_s: 44.4,
        battery_pct: Some(100.0),
        height_m: -120.4,
        home_distance_m: 4321.0,
        mode: "mode 4294967295".into(),
        gnss: dark(99),
        radio: Some(radio(-9.0, 12.0)),
        telemetry_age_s: 86_400.0,
        gimbal_rad: -1.55,
        zoom: 10.0,
        remaining_s: 5_999.0,
        lamp: true,
        pictures: 999,
        guidance: Some(longest_guidance()),
        ghost: Some(Pose { position_m: Vec3::new(400.0, -300.0, 30.0), ned_from_frd: Rotation::identity() }),
        site: Arc::new(SiteOutline::around(tracks.iter().flat_map(|track| track.path_m.iter().copied()))),
        tracks: tracks.to_vec(),
        ..hit("bridge member suspension/hanger-left/upper/07")
    };
    let shown = [
        ("calm", hud()),
        ("good radio", Hud { radio: Some(radio(30.0, 20.0)), ..hud() }),
        ("weak radio", Hud { radio: Some(radio(1.0, -5.0)), ..hud() }),
        ("weak radio, link and GNSS lost", Hud { radio: Some(radio(1.0, -5.0)), telemetry_age_s: 12.0, gnss: dark(4), ..hud() }),
        (
            "weak radio, guidance and warnings",
            Hud { radio: Some(radio(1.0, -5.0)), guidance: Some(longest_guidance()), ..hit("bridge") },
        ),
        ("link lost", Hud { telemetry_age_s: 12.0, ..hud() }),
        ("frozen", Hud { is_frozen: true, ..hud() }),
        ("GNSS lost", Hud { gnss: dark(14), ..hud() }),
        ("GNSS unknown", Hud { gnss: None, ..hud() }),
        ("link and GNSS lost", Hud { telemetry_age_s: 12.0, gnss: dark(4), mode: "Stabilized".into(), ..hud() }),
        ("link lost for a long time", Hud { telemetry_age_s: 86_400.0, gnss: dark(99), mode: "mode 4294967295".into(), ..hud() }),
        ("no battery", Hud { battery_pct: None, ..hud() }),
        ("red battery", Hud { battery_pct: Some(9.0), time_s: 0.1, ..hud() }),
        ("red battery, blinked off", Hud { battery_pct: Some(9.0), time_s: 0.3, ..hud() }),
        ("all warnings", hit("bridge")),
        ("long name", hit("bridge member arch/rib-left/07")),
        ("name without spaces", hit(&"bridge-member-".repeat(4)[..43])),
        ("name longer than telemetry allows", hit(&"WWWW ".repeat(40))),
        ("guidance", Hud { guidance: Some(longest_guidance()), ..hud() }),
        ("detour", Hud { guidance: Some(longest_detour()), ..hud() }),
        ("take off", Hud { guidance: Some(take_off()), guidance_how: "Press 1 to arm the motors, then T. ".repeat(3), ..hud() }),
        ("lesson", Hud { lesson: Some(longest_lesson()), ..hud() }),
        ("lesson and warnings", Hud { lesson: Some(longest_lesson()), ..hit("bridge") }),
        ("zoomed", Hud { zoom: 3.1, lamp: true, ..hud() }),
        ("everything", full),
    ];
    let hidden = shown.clone().map(|(name, state)| (name, Hud { tracks: Vec::new(), ..state }));
    shown.into_iter().chain(hidden).collect()
}

#[test]
fn prop_items_do_not_overlap_at_any_aspect_ratio() {
    let steps = (0..=38).map(|k| 0.7 + 0.05 * f64::from(k));
    for aspect in steps.chain([4.0 / 3.0, 16.0 / 9.0]) {
        for (name, state) in states() {
            check(layout(&state, aspect), aspect, &format!("{name}, aspect {aspect:.2}, map {}", !state.tracks.is_empty()));
        }
    }
}

#[test]
fn prop_items_do_not_overlap_at_any_size() {
    for aspect in [0.7, 1.0, 4.0 / 3.0, 16.0 / 9.0, 2.6] {
        for height_px in [40.0, 81.0, 108.0, 162.0, 216.0, 324.0, 350.0, 360.0, 700.0] {
            for (name, state) in states() {
                let items = layout_px(&state, (aspect * height_px, height_px));
                check(items, aspect, &format!("{name}, aspect {aspect:.2}, {height_px} px high"));
            }
        }
    }
}

#[test]
fn prop_items_do_not_overlap_at_any_text_size_and_in_any_units() {
    let styles = TextScale::ALL.into_iter().flat_map(|text_scale| {
        DisplayUnits::ALL.into_iter().map(move |units| DisplayStyle { units, text_scale, ..DisplayStyle::default() })
    });
    for style in styles {
        // The camera view in windows of 1280x720, 1920x1080, 3840x2160 and 1000x1000 px.
        for window_px in [(1280.0, 720.0), (1920.0, 1080.0), (3840.0, 2160.0), (1000.0, 1000.0)] {
            for camera in [4.0 / 3.0, 3.0 / 2.0, 16.0 / 9.0] {
                for layout in [ViewLayout::Camera, ViewLayout::Inspector, ViewLayout::SideBySide, ViewLayout::Map] {
                    let places = layout.view_rects(WindowShape { window: window_px.0 / window_px.1, camera });
                    let place = places.into_iter().find(|place| place.which == ViewKind::Camera).unwrap();
                    let place = place.fit_aspect(camera, window_px.0 / window_px.1);
                    let size_px = (place.width * window_px.0, place.height * window_px.1);
                    for (name, state) in states() {
                        let items = layout_px(&Hud { style, ..state }, size_px);
                        check(items, size_px.0 / size_px.1, &format!("{name}, {style:?}, {size_px:?} px"));
                    }
                }
            }
        }
    }
}

#[test]
fn exact_larger_text_is_larger_and_keeps_speed_battery_and_warnings() {
    let state = Hud { guidance: Some(longest_guidance()), cues: ALL_CUES, cue_texts: crash("bridge"), ..hud() };
    let words = |text_scale| {
        let style = DisplayStyle { text_scale, ..DisplayStyle::default() };
        let of = |item| match item {
            DrawItem::Text { height, words, .. } => Some((words, height)),
            DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
        };
        layout(&Hud { style, ..state.clone() }, 4.0 / 3.0).into_iter().filter_map(of).collect::<Vec<_>>()
    };
    let size = |words: &[(String, f64)], part: &str| words.iter().find(|(words, _)| words.contains(part)).map(|(_, size)| *size);
    let normal = words(TextScale::Normal);
    for text_scale in TextScale::ALL {
        let large = words(text_scale);
        for part in ["3.2 m/s", "76%", "CRASH", "TOO CLOSE", "TOO FAST", "OFF PATH"] {
            let (found, usual) = (size(&large, part).unwrap(), size(&normal, part).unwrap());
            // The display for small pictures has one font size, which is smaller than the usual one of the speed.
            assert!(found >= text_scale.factor() * usual.min(0.05) - TOLERANCE, "{text_scale:?}, {part}: {found}, {usual}");
        }
    }
    let calm = Hud { cues: 0, ..state.clone() };
    for text_scale in TextScale::ALL {
        let style = DisplayStyle { text_scale, ..DisplayStyle::default() };
        let items = layout(&Hud { style, ..calm.clone() }, 4.0 / 3.0);
        let shows = |part: &str| items.iter().any(|item| matches!(item, DrawItem::Text { words, .. } if words.contains(part)));
        assert!(shows("return to task 12") && shows("down"), "{text_scale:?}: the next step stays without warnings");
    }
}

#[test]
fn prop_status_text_does_not_cover_the_hud() {
    // Height of six lines in the window's font with their background, relative to the window. They end above the center of the
    // picture, which the pilot uses for aiming.
    const STATUS_TEXT_HEIGHT: f64 = 0.2;
    for (name, state) in states() {
        for window in [1.0, 4.0 / 3.0, 16.0 / 10.0, 16.0 / 9.0, 21.0 / 9.0] {
            for lens in [4.0 / 3.0, 3.0 / 2.0, 16.0 / 9.0] {
                let words = ViewLayout::Camera.words(WindowShape { window, camera: lens }, TextScale::Normal);
                let (top, bottom) = if words.extends_down {
                    (words.edge, words.edge + STATUS_TEXT_HEIGHT)
                } else {
                    // In the inspector's view, the text shrinks until it fits.
                    (words.edge - words.height, words.edge)
                };
                assert!(!words.extends_down || bottom < 0.48, "{words:?}");
                let room = [words.left_edge, top, words.left_edge + words.width, bottom];
                for block in blocks(layout(&state, lens), lens) {
                    let covered = !are_separate(&in_window(&block.background, lens, window), &room);
                    assert!(!covered, "{name}: {block:?} is covered by the status text, lens {lens}, window {window}");
                }
            }
        }
    }
}

#[test]
fn prop_texts_have_enough_contrast_over_bright_and_dark_scenery() {
    for text_scale in TextScale::ALL {
        for (name, state) in states() {
            for (aspect, height_px) in [(4.0 / 3.0, 720.0), (16.0 / 9.0, 720.0), (1.0, 720.0), (16.0 / 9.0, 162.0)] {
                let style = DisplayStyle { text_scale, ..DisplayStyle::default() };
                let items = layout_px(&Hud { style, ..state.clone() }, (aspect * height_px, height_px));
                contrast::check(&items, aspect, &format!("{name}, {text_scale:?}, {height_px} px high"));
            }
        }
    }
}

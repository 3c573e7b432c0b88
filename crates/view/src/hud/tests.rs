//! Tests of the HUD's texts, colors, and positions.

use super::*;
use crate::flown_path::FlownPath;
use spandrel_mavlink::contract::cue::{self, CueTexts};
use spandrel_mavlink::contract::guidance::{Detour, DetourKind, Guidance, GuidanceStep, PathDeviation, StandOffReading, WayTo};
use spandrel_mavlink::contract::hazards::RadioMargins;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::radio::RadioWay;
use spandrel_text::Language;
use std::sync::Arc;

const WIDE_ASPECT: f64 = 16.0 / 9.0;
/// Path and landing pad on the map.
const PATH_M: [Vec3<Enu>; 2] = [Vec3::new(-50.0, -5.0, 30.0), Vec3::new(50.0, -5.0, 30.0)];
const PAD_M: Vec3<Enu> = Vec3::new(-100.0, 60.0, 5.0);
/// All cues shown in the lower left corner.
pub(super) const ALL_CUES: i32 = cue::SPEEDING | cue::OFF_PATH | cue::TOO_CLOSE | cue::CRASH;

/// Returns the monitor's text for a crash into an object.
pub(super) fn crash(object: &str) -> CueTexts {
    [format!("Crash: {object}").as_str()].into_iter().collect()
}

/// Returns the HUD during a normal flight.
pub(crate) fn hud() -> Hud {
    Hud {
        speed_m_s: 3.2,
        limit_m_s: 4.4704,
        battery_pct: Some(76.0),
        min_green_pct: 70.0,
        min_yellow_pct: 30.0,
        cues: 0,
        cue_texts: CueTexts::default(),
        height_m: 21.4,
        home_distance_m: 118.0,
        mode: "Position".into(),
        gnss: Some(GnssStatus { has_fix: true, satellites: 14 }),
        radio: None,
        telemetry_age_s: 0.02,
        is_frozen: false,
        ghost: None,
        gimbal_rad: 0.35,
        zoom: 1.0,
        lamp: false,
        remaining_s: 1234.5,
        pictures: 3,
        shutter: false,
        time_s: 100.0,
        position_m: Vec3::new(10.0, -4.0, 20.0),
        heading_rad: 1.2,
        roll_rad: 0.0,
        pitch_rad: 0.0,
        obstacles: None,
        way_back: None,
        inspector: None,
        pad_m: PAD_M,
        guidance: None,
        guidance_how: String::new(),
        tasks: TaskNames::default(),
        lesson: None,
        flown: FlownPath::default(),
        tracks: vec![MapPath { id: 1, path_m: PATH_M.to_vec(), closed: false }],
        site: Arc::new(SiteOutline::around(PATH_M.into_iter().chain([PAD_M]))),
        style: DisplayStyle::default(),
    }
}

fn texts(hud: &Hud) -> Vec<(ScreenPoint, HudColor, String)> {
    let of = |item| match item {
        DrawItem::Text { place, color, words, .. } => Some((place, color, words)),
        DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
    };
    layout(hud, WIDE_ASPECT).into_iter().filter_map(of).collect()
}

pub(crate) fn find(hud: &Hud, part: &str) -> Option<(ScreenPoint, HudColor)> {
    texts(hud).into_iter().find(|(_, _, words)| words.contains(part)).map(|(place, color, _)| (place, color))
}

/// Returns all of the HUD's texts with their colors and their positions as percentages of the picture.
fn snapshot(hud: &Hud) -> String {
    let line = |(place, color, words): (ScreenPoint, HudColor, String)| {
        format!("{:3.0} {:3.0} {color:?}: {words}\n", 100.0 * place.x, 100.0 * place.y)
    };
    texts(hud).into_iter().map(line).collect()
}

#[test]
fn regress_hud_in_normal_flight() {
    let expected = "  2   6 White: 3.2 m/s\n  2  11 Gray: limit 4.47 m/s\n 98   6 Green: 76%\n 50   5 White: Position   GNSS 14   link ok\n \
                    87  13 Gray: height\n 98  13 White: 21.4 m\n 87  17 Gray: home\n 98  17 White: 118 m\n 87  21 Gray: gimbal\n \
                    98  21 White: +20°\n 87  25 Gray: time left\n 98  25 White: 20:34\n 87  28 Gray: lamp\n 98  28 White: off\n \
                    87  32 Gray: pictures\n 98  32 White: 3\n 89  87 White: 1\n 84  94 White: 50 m\n 97  75 White: N\n";
    assert_eq!(snapshot(&hud()), expected, "\n{}", snapshot(&hud()));
}

#[test]
fn exact_item_positions_match_the_assessment_rules() {
    let all = Hud { cues: ALL_CUES, cue_texts: crash("bridge"), ..hud() };
    let speed = find(&all, "3.2 m/s").unwrap().0;
    assert!(speed.x < 0.3 && speed.y < 0.2, "the speed must be at the upper left");
    let battery = find(&all, "76%").unwrap().0;
    assert!(battery.x > 0.7 && battery.y < 0.2, "the battery must be at the upper right");
    for words in ["CRASH: bridge", "TOO CLOSE", "TOO FAST", "OFF PATH"] {
        let place = find(&all, words).unwrap().0;
        assert!(place.x < 0.5 && place.y > 0.5, "{words} must be at the lower left");
        assert!(find(&hud(), words).is_none(), "{words} must not appear without its cue");
    }
}

#[test]
fn exact_battery_color_changes_at_70_and_30_and_red_blinks() {
    let at = |pct: f64, time_s: f64| Hud { battery_pct: Some(pct), time_s, ..hud() };
    assert_eq!(find(&at(70.0, 0.0), "70%").unwrap().1, HudColor::Green);
    assert_eq!(find(&at(69.9, 0.0), "70%").unwrap().1, HudColor::Yellow);
    assert_eq!(find(&at(30.0, 0.0), "30%").unwrap().1, HudColor::Yellow);
    assert_eq!(find(&at(29.0, 0.0), "29%").unwrap().1, HudColor::Red);
    let fills = |hud: &Hud| layout(hud, WIDE_ASPECT).iter().filter(|i| matches!(i, DrawItem::Fill { .. })).count();
    assert!(fills(&at(29.0, 0.1)) > fills(&at(29.0, 0.3)), "red must blink");
    assert_eq!(fills(&at(50.0, 0.1)), fills(&at(50.0, 0.3)), "yellow must not blink");
    assert!(find(&Hud { battery_pct: None, ..hud() }, "no battery").is_some());
}

#[test]
fn exact_lost_link_and_lost_fix_are_shown() {
    let lost = Hud { telemetry_age_s: 3.0, ..hud() };
    assert_eq!(find(&lost, "LINK LOST 3 s").unwrap().1, HudColor::Orange);
    let dark = Hud { gnss: Some(GnssStatus { has_fix: false, satellites: 4 }), ..hud() };
    assert_eq!(find(&dark, "GNSS lost (4)").unwrap().1, HudColor::Orange);
}

/// Returns a flight with these margins of the radio links, dB.
fn with_radio(control_db: f64, video_db: f64) -> Hud {
    Hud { radio: Some(RadioMargins { control_db, video_db, way: RadioWay::AroundEdge, losses: 0 }), ..hud() }
}

#[test]
fn exact_signals_are_shown_only_in_jobs_with_radio_and_turn_orange_when_they_lose_data() {
    for words in ["control", "video"] {
        assert!(find(&hud(), words).is_none(), "the job has no radio hazard");
    }
    let color = |hud: &Hud, words: &str| find(hud, words).unwrap().1;
    let mixed = with_radio(20.0, 2.9);
    assert_eq!((color(&mixed, "control"), color(&mixed, "video")), (HudColor::White, HudColor::Orange));
    assert_eq!(color(&with_radio(3.0, 20.0), "control"), HudColor::Yellow);
    assert_eq!(color(&mixed, "GNSS 14"), HudColor::White, "the other values are fine");
    // Without colors: as many full bars as the signal has, and stubs in place of the others.
    let heights = |hud: &Hud| -> Vec<f64> {
        let plain = layout(&Hud { radio: None, ..hud.clone() }, WIDE_ASPECT);
        let bars = layout(hud, WIDE_ASPECT).into_iter().filter(|item| !plain.contains(item)).filter_map(|item| match item {
            DrawItem::Fill { points, .. } => Some((1e3 * (points[2].y - points[0].y)).round()),
            DrawItem::Panel { .. } | DrawItem::Text { .. } | DrawItem::Line { .. } => None,
        });
        bars.collect()
    };
    assert_eq!(heights(&with_radio(30.0, 4.0)), [10.0, 15.0, 20.0, 25.0, 10.0, 15.0, 3.0, 3.0]);
    assert_eq!(heights(&with_radio(10.0, -9.0)), [10.0, 15.0, 20.0, 3.0, 3.0, 3.0, 3.0, 3.0]);
}

#[test]
fn exact_small_picture_warns_of_a_weak_signal_after_a_lost_link() {
    let warning = |hud: &Hud| {
        let of = |item| match item {
            DrawItem::Text { words, .. } => Some(words),
            DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
        };
        layout_px(hud, (288.0, 216.0)).into_iter().filter_map(of).nth(2)
    };
    assert_eq!(warning(&with_radio(3.0, 3.0)), None);
    assert_eq!(warning(&with_radio(3.0, 2.0)).as_deref(), Some("VIDEO WEAK"));
    assert_eq!(warning(&with_radio(2.0, -9.0)).as_deref(), Some("CONTROL WEAK"));
    assert_eq!(warning(&Hud { telemetry_age_s: 4.0, ..with_radio(-9.0, -9.0) }).as_deref(), Some("LINK LOST 4 s"));
}

#[test]
fn prop_items_stay_inside_at_any_aspect_ratio() {
    let states = [hud(), Hud { cues: ALL_CUES, cue_texts: crash("pedestrian 3"), zoom: 2.0, ..hud() }];
    for aspect in [4.0 / 3.0, WIDE_ASPECT, 21.0 / 9.0] {
        for state in &states {
            for item in layout(state, aspect) {
                let points = match item {
                    DrawItem::Panel { from, to, .. } => vec![from, to],
                    DrawItem::Text { place, .. } => vec![place],
                    DrawItem::Fill { points, .. } | DrawItem::Line { points, .. } => points,
                };
                for p in points {
                    assert!((0.0..=1.0).contains(&p.x) && (0.0..=1.0).contains(&p.y), "{p:?} at {aspect}");
                }
            }
        }
    }
}

#[test]
fn exact_icons_differ_in_shape_and_color() {
    let corners = |pct: f64| {
        layout(&Hud { battery_pct: Some(pct), tracks: vec![], ..hud() }, WIDE_ASPECT).into_iter().find_map(|item| match item {
            DrawItem::Fill { points, .. } => Some(points.len()),
            DrawItem::Panel { .. } | DrawItem::Text { .. } | DrawItem::Line { .. } => None,
        })
    };
    assert_eq!([corners(90.0), corners(50.0), corners(10.0)], [Some(16), Some(3), Some(8)]);
}

/// Returns the texts and colors in which a state differs from a normal flight.
fn changed_texts(hud: &Hud) -> Vec<String> {
    let said = |hud: &Hud| texts(hud).into_iter().map(|(_, color, words)| format!("{color:?}: {words}")).collect::<Vec<_>>();
    let calm = said(&self::hud());
    said(hud).into_iter().filter(|line| !calm.contains(line)).collect()
}

#[test]
fn exact_texts_are_correct_in_every_abnormal_state() {
    let gnss = |fixed, satellites| Hud { gnss: Some(GnssStatus { has_fix: fixed, satellites }), ..hud() };
    let warned = |cues| Hud { cues, ..hud() };
    let said = |text: &str, cues| Hud { cue_texts: [text].into_iter().collect(), ..warned(cues) };
    let member = crash("bridge member arch/rib-left/07");
    let hit = "Red: CRASH: bridge member arch/rib-left/07";
    let states: [(Hud, &[&str]); 24] = [
        (hud(), &[]),
        (Hud { battery_pct: Some(52.4), ..hud() }, &["Yellow: 52%"]),
        (Hud { battery_pct: Some(17.0), ..hud() }, &["Red: 17%"]),
        (Hud { battery_pct: None, ..hud() }, &["Gray: no battery data"]),
        (warned(cue::SPEEDING), &["Yellow: 3.2 m/s", "Yellow: TOO FAST"]),
        (
            said("Too fast: 11 mph, limit 10 mph", cue::SPEEDING),
            &["Yellow: 3.2 m/s", "Yellow: TOO FAST: 4.92 m/s, limit 4.47 m/s"],
        ),
        (warned(cue::OFF_PATH), &["Blue: OFF PATH"]),
        (said("Off path 3.4 m: left and up", cue::OFF_PATH), &["Blue: OFF PATH 3.4 m: left and up"]),
        (warned(cue::STAND_OFF | cue::OFF_PATH), &["Blue: STAND-OFF"]),
        (Hud { limit_m_s: 4.5, ..hud() }, &["Gray: limit 4.5 m/s"]),
        (warned(cue::TOO_CLOSE), &["Orange: TOO CLOSE"]),
        (warned(cue::CRASH), &["Red: CRASH"]),
        (Hud { cue_texts: member.clone(), ..warned(cue::CRASH) }, &[hit]),
        (
            Hud { cue_texts: member, ..warned(ALL_CUES) },
            &["Yellow: 3.2 m/s", hit, "Orange: TOO CLOSE", "Yellow: TOO FAST", "Blue: OFF PATH"],
        ),
        (warned(cue::BATTERY_RED), &[]),
        (gnss(true, 255), &["White: Position   GNSS ok   link ok"]),
        (gnss(false, 4), &["Orange: Position   GNSS lost (4)   link ok"]),
        (gnss(false, 255), &["Orange: Position   GNSS lost   link ok"]),
        (Hud { gnss: None, ..hud() }, &["White: Position   GNSS ?   link ok"]),
        (Hud { is_frozen: true, ..hud() }, &["Orange: Position   GNSS 14   FROZEN"]),
        (Hud { telemetry_age_s: 12.3, is_frozen: true, ..hud() }, &["Orange: Position   GNSS 14   LINK LOST 12 s"]),
        (Hud { telemetry_age_s: 12.3, ..hud() }, &["Orange: Position   GNSS 14   LINK LOST 12 s"]),
        (Hud { telemetry_age_s: 12.3, ..gnss(false, 4) }, &["Orange: Position   GNSS lost (4)   LINK LOST 12 s"]),
        (Hud { zoom: 2.0, lamp: true, ..hud() }, &["Yellow: on", "Gray: zoom", "White: 2.0 x"]),
    ];
    for (state, words) in states {
        assert_eq!(changed_texts(&state), words, "{state:?}");
    }
}

#[test]
fn exact_the_display_is_translated() {
    let everything = Hud {
        cues: ALL_CUES,
        cue_texts: ["Crash: bridge", "Too close: 1.2 m, limit 2.5 m"].into_iter().collect(),
        zoom: 2.0,
        lamp: true,
        radio: with_radio(20.0, 2.0).radio,
        guidance: Some(Guidance {
            step: GuidanceStep::FlyToTask,
            task: Some(2),
            way: Some(WayTo { distance_m: 6.2, bearing_rad: -0.5, up_m: 2.0 }),
            progress: Some(0.357),
            tasks_done: 1,
            tasks: 4,
            deviation: None,
            stand_off: None,
            flown_s: 75.0,
            needed_s: 480.0,
            detour: None,
        }),
        ..hud()
    };
    let in_language = |language| {
        let style = DisplayStyle { language, ..DisplayStyle::default() };
        texts(&Hud { style, ..everything.clone() }).into_iter().map(|(.., words)| words).collect::<Vec<_>>()
    };
    let german = in_language(Language::German);
    let title = "Bahn verlassen: zurück zu Aufgabe 2 von 4";
    for words in ["KOLLISION: Brücke", "ZU NAH: 1.2 m, mindestens 2.5 m", title, "6 m, 29° links", "Höhe", "ein", "Steuerung"]
    {
        assert!(german.iter().any(|one| one == words), "{words}: {german:?}");
    }
    let spanish = in_language(Language::Spanish);
    assert!(spanish.iter().any(|one| one == "Fuera de la trayectoria: vuelva a la tarea 2 de 4"), "{spanish:?}");
    // Values with units, the name of the flight mode, and GNSS are not in the catalog; some letters have no accented form.
    let is_plain = |words: &String| {
        words.chars().filter(|sign| sign.is_ascii_lowercase() && !"mqvx".contains(*sign)).count() > 3
            && !words.starts_with("Position")
    };
    let plain: Vec<String> = in_language(Language::Pseudo).into_iter().filter(is_plain).collect();
    assert!(plain.is_empty(), "not in the catalog: {plain:?}");
}

#[test]
fn regress_task_panel_leads_around_an_obstacle_first() {
    let detour = Detour { kind: DetourKind::OutFromUnder, way: WayTo { distance_m: 12.2, bearing_rad: 1.2, up_m: -3.0 } };
    let guidance = Guidance {
        step: GuidanceStep::FlyToTask,
        task: Some(2),
        way: Some(WayTo { distance_m: 5.0, bearing_rad: 0.0, up_m: 9.0 }),
        progress: Some(0.0),
        tasks_done: 1,
        tasks: 4,
        deviation: Some(PathDeviation { distance_m: 7.0, above_m: -7.0 }),
        stand_off: None,
        flown_s: 75.0,
        needed_s: 480.0,
        detour: Some(detour),
    };
    let guided = Hud { guidance: Some(guidance), ..hud() };
    for words in ["Fly to task 2 of 4", "Fly out from under the bridge first", "12 m, 69° right", "3 m down"] {
        assert!(find(&guided, words).is_some(), "{words}\n{}", snapshot(&guided));
    }
    for words in ["5 m, ahead", "9 m up", "7.0 m"] {
        assert!(find(&guided, words).is_none(), "{words} leads through the deck");
    }
}

#[test]
fn exact_small_picture_shows_speed_battery_and_warnings() {
    let words = |hud: &Hud, size_px| {
        let of = |item| match item {
            DrawItem::Text { height, words, .. } => Some((height, words)),
            DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
        };
        layout_px(hud, size_px).into_iter().filter_map(of).collect::<Vec<_>>()
    };
    // Sizes of the reference pictures, and of the camera view in a small window.
    for (width, height) in [(640.0, 360.0), (480.0, 360.0), (1280.0, 720.0)] {
        assert_eq!(layout_px(&hud(), (width, height)), layout(&hud(), width / height), "{width} x {height}");
    }
    let wrong = Hud { cues: ALL_CUES, telemetry_age_s: 4.0, battery_pct: Some(17.0), ..hud() };
    for size_px in [(432.0, 324.0), (288.0, 216.0), (192.0, 144.0)] {
        let calm = words(&hud(), size_px);
        assert_eq!(calm.iter().map(|(_, words)| words.as_str()).collect::<Vec<_>>(), ["3.2 m/s", "76%"]);
        let all = words(&wrong, size_px);
        assert_eq!(
            all.iter().map(|(_, words)| words.as_str()).collect::<Vec<_>>(),
            ["3.2 m/s", "17%", "LINK LOST 4 s", "CRASH", "TOO CLOSE", "TOO FAST", "OFF PATH"]
        );
        assert!(all.iter().all(|(height, _)| height * size_px.1 > 11.99), "{size_px:?}: {all:?}");
    }
    let least = words(&wrong, (144.0, 81.0));
    assert_eq!(least.last().map(|(_, words)| words.as_str()), Some("CRASH"), "the most serious warning must stay: {least:?}");
}

#[test]
fn exact_task_panel_shows_the_next_step() {
    let guidance = Guidance {
        step: GuidanceStep::FollowPath,
        task: Some(2),
        way: Some(WayTo { distance_m: 6.2, bearing_rad: -0.5, up_m: 2.0 }),
        progress: Some(0.357),
        tasks_done: 1,
        tasks: 4,
        deviation: Some(PathDeviation { distance_m: 1.24, above_m: -0.4 }),
        stand_off: Some(StandOffReading { actual_m: 7.1, recommended_m: 5.0, tolerance_m: 1.5 }),
        flown_s: 75.0,
        needed_s: 480.0,
        detour: None,
    };
    let guided = Hud { guidance: Some(guidance), ..hud() };
    for words in ["Inspect task 2 of 4", "35%", "6 m, 29° left", "2 m up", "1.2 m, 0.4 m below", "1:15 of 8:00"] {
        assert!(find(&guided, words).is_some(), "{words}\n{}", snapshot(&guided));
        assert!(find(&hud(), words).is_none(), "{words}");
    }
    assert_eq!(find(&guided, "7.1 m (5.0 ± 1.5)").unwrap().1, HudColor::Yellow, "outside the tolerance");
    let left = Guidance { step: GuidanceStep::FlyToTask, ..guidance };
    let title = "Path left: return to task 2 of 4";
    assert_eq!(find(&Hud { guidance: Some(left), ..hud() }, title).unwrap().1, HudColor::Yellow);
    let level = Guidance { way: Some(WayTo { distance_m: 6.2, bearing_rad: -0.5, up_m: -0.4 }), ..guidance };
    assert!(find(&Hud { guidance: Some(level), ..hud() }, "level").is_some());
    let inside = StandOffReading { actual_m: 6.4, recommended_m: 5.0, tolerance_m: 1.5 };
    let guided = Hud { guidance: Some(Guidance { stand_off: Some(inside), ..guidance }), ..hud() };
    assert_eq!(find(&guided, "6.4 m (5.0 ± 1.5)").unwrap().1, HudColor::White);
}

#[test]
fn exact_the_task_panel_names_the_task_in_the_language_of_the_window() {
    let text = spandrel_model::shipped::TWO_BRIDGES;
    let job = spandrel_model::scenario::read("job.toml", text, &|file| Err(file.to_owned())).unwrap();
    let guidance = |step| Guidance {
        step,
        task: Some(job.tasks[1].id),
        way: (step == GuidanceStep::FlyToTask).then_some(WayTo { distance_m: 40.0, bearing_rad: 0.7, up_m: 3.0 }),
        progress: None,
        tasks_done: 1,
        tasks: 4,
        deviation: None,
        stand_off: None,
        flown_s: 10.0,
        needed_s: 300.0,
        detour: None,
    };
    for step in [GuidanceStep::FlyToTask, GuidanceStep::FollowPath] {
        for language in Language::ALL {
            let style = DisplayStyle { language, ..DisplayStyle::default() };
            let hud = Hud { guidance: Some(guidance(step)), tasks: TaskNames::of(&job), style, ..hud() };
            let name = hud.tasks.title(job.tasks[1].id, language).unwrap();
            assert!(find(&hud, &name).is_some(), "{name} is missing: {:?}", texts(&hud));
            assert_eq!(name == job.tasks[1].name, language == Language::English, "{name}");
        }
    }
    let own = spandrel_model::scenario::Scenario { name: "my-bridge".into(), ..job };
    assert_eq!(TaskNames::of(&own).title(own.tasks[1].id, Language::German), Some(own.tasks[1].name.clone()));
}

//! Tests of the instruments.

use super::super::contrast;
use super::super::tests::hud;
use super::super::text_metrics::text_width;
use super::super::{DisplayStyle, DisplayUnits, HudColor, InspectorMarks, LessonDisplay, Obstacles, TextAlign, TextScale};
use super::*;
use crate::arrange::{ViewKind, ViewLayout, ViewRect, WindowShape};
use crate::flown_path::FlownPath;
use spandrel_mavlink::contract::guidance::{Guidance, GuidanceStep, WayTo};
use spandrel_mavlink::contract::lesson::{LessonStatus, LessonTask};
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::{self, Scenario};
use spandrel_model::shipped;
use spandrel_model::site::Site;
use spandrel_text::Language;

/// Tolerance for rounding errors, px.
const TOLERANCE_PX: f64 = 1e-6;

fn job() -> (Scenario, SiteOutline) {
    let job = scenario::read("job.toml", shipped::TWO_BRIDGES, &|file| Err(file.to_owned())).unwrap();
    let site = SiteOutline::new(&job, &Site::without_defects(&job));
    (job, site)
}

/// Returns the HUD over the job with every mark on the instruments.
fn flying(job: &Scenario) -> Hud {
    let guidance = Guidance {
        step: GuidanceStep::FlyToTask,
        task: Some(1),
        way: Some(WayTo { distance_m: 40.0, bearing_rad: 0.7, up_m: 3.0 }),
        progress: Some(0.0),
        tasks_done: 0,
        tasks: 4,
        deviation: None,
        stand_off: None,
        flown_s: 10.0,
        needed_s: 300.0,
        detour: None,
    };
    let mut sectors_m = vec![f64::INFINITY; 8];
    (sectors_m[0], sectors_m[1]) = (1.2, 7.5);
    let (pad_m, here_m) = (job.ground_team.pad_m, Vec3::new(20.0, -10.0, 30.0));
    let mut flown = FlownPath::default();
    (0..=200).for_each(|k| flown.push(pad_m + (here_m - pad_m) * (f64::from(k) / 200.0)));
    Hud {
        guidance: Some(guidance),
        obstacles: Some(Obstacles { sectors_m, nearest_m: None, range_m: 12.0, too_close_m: 1.5 }),
        pad_m: job.ground_team.pad_m,
        inspector: Some(InspectorMarks {
            position_m: job.ground_team.inspector_m,
            places_m: job.ground_team.inspector_places_m().collect(),
        }),
        position_m: Vec3::new(20.0, -10.0, 30.0),
        roll_rad: 0.3,
        pitch_rad: -0.2,
        flown,
        tracks: super::super::MapPath::all(job),
        ..hud()
    }
}

/// Returns the texts with their rectangles, px.
fn texts(items: &[DrawItem], (width, height): (f64, f64)) -> Vec<(String, [f64; 4])> {
    let of = |item: &DrawItem| match item {
        DrawItem::Text { place, side, height: size, words, .. } => {
            let (wide, tall) = (text_width(words, size * height), size * height);
            let left = place.x * width
                - match side {
                    TextAlign::Left => 0.0,
                    TextAlign::Center => 0.5 * wide,
                    TextAlign::Right => wide,
                };
            Some((words.clone(), [left, place.y * height - 0.5 * tall, left + wide, place.y * height + 0.5 * tall]))
        }
        DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
    };
    items.iter().filter_map(of).collect()
}

#[test]
fn prop_texts_do_not_overlap_and_everything_is_inside_in_any_window() {
    let (job, site) = job();
    let hud = flying(&job);
    let windows = [(1280.0, 720.0), (1920.0, 1080.0), (3840.0, 2160.0), (1000.0, 1000.0), (1600.0, 560.0), (800.0, 600.0)];
    let styles = TextScale::ALL
        .into_iter()
        .flat_map(|text_scale| DisplayUnits::ALL.map(|units| DisplayStyle { units, text_scale, ..DisplayStyle::default() }));
    let languages = [Language::German, Language::Spanish, Language::Pseudo];
    let styles = styles.chain(languages.map(|language| DisplayStyle { language, ..DisplayStyle::default() }));
    for (window_px, style) in styles.flat_map(|style| windows.map(|window_px| (window_px, style))) {
        let shape = WindowShape { window: window_px.0 / window_px.1, camera: 4.0 / 3.0 };
        let places = ViewLayout::Camera.view_rects(shape);
        let place = places.into_iter().find(|place| place.which == ViewKind::Instruments).unwrap();
        let size_px = (place.width * window_px.0, place.height * window_px.1);
        let items = instruments(&Hud { style, ..hud.clone() }, &site, size_px);
        check_layout(&items, size_px, &format!("{window_px:?}, {style:?}"));
        let places = ViewLayout::Map.view_rects(shape);
        for (name, hud) in large_map_states(&hud) {
            let hud = Hud { style, ..hud };
            let what = format!("large map, {name}, {window_px:?}, {style:?}");
            let size_px = place_px(&places, ViewKind::Map, window_px);
            check_layout(&large_map(&hud, &site, size_px), size_px, &what);
            // The other instruments show no map then.
            let size_px = place_px(&places, ViewKind::Instruments, window_px);
            check_layout(&instruments(&Hud { tracks: Vec::new(), ..hud }, &site, size_px), size_px, &what);
        }
    }
}

/// Returns the size of a view in a window, px.
fn place_px(places: &[ViewRect], which: ViewKind, window_px: (f64, f64)) -> (f64, f64) {
    let place = places.iter().find(|place| place.which == which).unwrap();
    (place.width * window_px.0, place.height * window_px.1)
}

/// Returns flights with the different texts above the large map, one of them at the landing pad and one far outside the map.
fn large_map_states(hud: &Hud) -> [(&'static str, Hud); 4] {
    let status = LessonStatus {
        task: LessonTask::StopAt,
        step: 60,
        steps: 60,
        progress: 0.6,
        way: Some(WayTo { distance_m: 4_321.0, bearing_rad: 3.1, up_m: -120.0 }),
        radius_m: Some(2.0),
        target: Some(120.0),
    };
    let remark = Some("too oblique: 88.8 deg, limit 60 deg, and more".to_owned());
    let lesson = LessonDisplay { status, how: "Release the keys early: the drone needs room to stop. ".repeat(3), remark };
    let mut flown = hud.flown.clone();
    (0..2_000).for_each(|k| flown.push(Vec3::new(-3_000.0 + 3.0 * f64::from(k), 20.0, 30.0)));
    let far_m = Vec3::new(3_000.0, 20.0, 30.0);
    [
        ("on the way", hud.clone()),
        ("at home", Hud { position_m: hud.pad_m, guidance: None, ..hud.clone() }),
        ("far away", Hud { position_m: far_m, flown, ..hud.clone() }),
        ("lesson", Hud { lesson: Some(lesson), ..hud.clone() }),
    ]
}

/// Checks that no text covers another one, and that everything is inside.
fn check_layout(items: &[DrawItem], size_px: (f64, f64), what: &str) {
    let found = texts(items, size_px);
    for (k, (words, a)) in found.iter().enumerate() {
        for (other, b) in &found[..k] {
            let apart = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
            assert!(apart, "{what}: '{words}' overlaps '{other}'");
        }
        let inside = a[0] >= -TOLERANCE_PX && a[1] >= 0.0 && a[2] <= size_px.0 + TOLERANCE_PX && a[3] <= size_px.1;
        assert!(inside, "{what}: '{words}' at {a:?} is outside {size_px:?}");
    }
    for item in items {
        let (DrawItem::Fill { points, .. } | DrawItem::Line { points, .. }) = item else { continue };
        let inside = |p: &super::super::ScreenPoint| (-1e-9..=1.0 + 1e-9).contains(&p.x) && (-1e-9..=1.0 + 1e-9).contains(&p.y);
        assert!(points.iter().all(inside), "{what}: {item:?}");
    }
}

#[test]
fn exact_the_large_map_has_everything_that_a_pilot_needs_to_find_the_way() {
    let (job, site) = job();
    let hud = flying(&job);
    let size_px = (960.0, 720.0);
    let items = large_map(&hud, &site, size_px);
    let words: Vec<String> = texts(&items, size_px).into_iter().map(|(words, _)| words).collect();
    let shows = |part: &str| words.iter().any(|words| words.contains(part));
    for part in ["1", "2", "3", "4", "H", "N"] {
        assert!(words.iter().any(|words| words == part), "'{part}' is missing: {words:?}");
    }
    assert!(shows("Fly to task 1 of 4") && shows("40 m, 40° right") && shows("3 m up"), "the next step: {words:?}");
    assert!(shows("height 21.4 m") && shows("home 118 m"), "{words:?}");
    assert!(words.iter().any(|words| *words == "200 m") && words.iter().any(|words| *words == "20 m"), "both scales: {words:?}");
    for color in [HudColor::Structure, HudColor::Water, HudColor::Earth] {
        assert!(has_color(&items, color), "{color:?}");
    }
    let lines = |hud: &Hud, wanted: HudColor| {
        let of = |item: &DrawItem| match item {
            DrawItem::Line { points, color, .. } if *color == wanted => Some(points.len()),
            DrawItem::Line { .. } | DrawItem::Fill { .. } | DrawItem::Panel { .. } | DrawItem::Text { .. } => None,
        };
        large_map(hud, &site, size_px).iter().filter_map(of).collect::<Vec<usize>>()
    };
    let is_yellow = |item: &DrawItem| matches!(item, DrawItem::Text { words, color: HudColor::Black, .. } if words == "1");
    assert!(items.iter().any(is_yellow), "the present task's number stands on yellow");
    let current = lines(&hud, HudColor::Yellow).len();
    assert!(current > lines(&Hud { guidance: None, ..hud.clone() }, HudColor::Yellow).len(), "the present task is yellow");
    // On the map and in the profile.
    let long = |hud: &Hud| lines(hud, HudColor::White).into_iter().filter(|count| *count > 20).count();
    assert_eq!((long(&hud), long(&Hud { flown: FlownPath::default(), ..hud.clone() })), (2, 0), "the flown path");
    let small = instruments(&Hud { flown: FlownPath::default(), ..hud.clone() }, &site, (320.0, 480.0));
    assert!(!texts(&small, (320.0, 480.0)).iter().any(|(words, _)| words == "H"), "a small map has no room for the sign");
}

#[test]
fn prop_texts_of_the_large_map_have_enough_contrast() {
    let (job, site) = job();
    for (name, hud) in large_map_states(&flying(&job)) {
        for text_scale in TextScale::ALL {
            for (width, height) in [(960.0, 720.0), (2_880.0, 2_160.0), (1_000.0, 700.0)] {
                let style = DisplayStyle { text_scale, ..DisplayStyle::default() };
                let items = large_map(&Hud { style, ..hud.clone() }, &site, (width, height));
                contrast::check(&items, width / height, &format!("{name}, {text_scale:?}, {width} x {height} px"));
            }
        }
    }
}

fn has_color(items: &[DrawItem], wanted: HudColor) -> bool {
    items.iter().any(|item| match item {
        DrawItem::Panel { color, .. }
        | DrawItem::Text { color, .. }
        | DrawItem::Fill { color, .. }
        | DrawItem::Line { color, .. } => *color == wanted,
    })
}

#[test]
fn exact_an_assessment_shows_neither_map_nor_profile() {
    let (job, site) = job();
    let size_px = (320.0, 480.0);
    let practice = instruments(&flying(&job), &site, size_px);
    assert!(has_color(&practice, HudColor::Structure) && has_color(&practice, HudColor::Water));
    let assessment = instruments(&Hud { tracks: Vec::new(), guidance: None, ..flying(&job) }, &site, size_px);
    assert!(!has_color(&assessment, HudColor::Structure) && has_color(&assessment, HudColor::Sky));
    let words: Vec<String> = texts(&assessment, size_px).into_iter().map(|(words, _)| words).collect();
    assert_eq!(words, ["N", "E", "S", "W", "069°", "obstacle 1.2 m"]);
}

#[test]
fn exact_places_of_the_inspector_are_numbered_on_the_map() {
    let (mut job, site) = job();
    let here_m = job.ground_team.inspector_m;
    job.ground_team.places_m = vec![here_m + Vec3::new(0.0, -60.0, 0.0), here_m + Vec3::new(0.0, 60.0, 0.0)];
    let size_px = (320.0, 480.0);
    let marks = |hud: &Hud| {
        let squares = instruments(hud, &site, size_px).into_iter().filter_map(|item| match item {
            DrawItem::Fill { points, color: HudColor::Gray } if points.len() == 4 => Some(points[0]),
            DrawItem::Fill { .. } | DrawItem::Panel { .. } | DrawItem::Text { .. } | DrawItem::Line { .. } => None,
        });
        squares.collect::<Vec<_>>()
    };
    let hud = flying(&job);
    let found = marks(&hud);
    assert_eq!(found.len(), 3);
    assert!(found[1].y > found[0].y && found[2].y < found[0].y, "north is up: {found:?}");
    assert!(marks(&Hud { inspector: None, ..hud.clone() }).is_empty(), "a job with only one place");
    let walked = Hud {
        inspector: Some(InspectorMarks { position_m: job.ground_team.places_m[0], ..hud.inspector.clone().unwrap() }),
        ..hud.clone()
    };
    assert_ne!(instruments(&walked, &site, size_px), instruments(&hud, &site, size_px));
}

#[test]
fn exact_near_obstacles_are_red_and_missing_range_finders_are_not_free_space() {
    let (job, site) = job();
    let words = |hud: &Hud| {
        // In a high area, both words stand below the display.
        let size_px = (200.0, 600.0);
        let items = instruments(hud, &site, size_px);
        let found = texts(&items, size_px).into_iter().map(|(words, _)| words).find(|words| words.contains("obstacle"));
        (found, has_color(&items, HudColor::Red))
    };
    assert_eq!(words(&flying(&job)), (Some("obstacle 1.2 m".to_owned()), true));
    let free = Obstacles { sectors_m: vec![f64::INFINITY; 72], nearest_m: Some(12.1), range_m: 12.0, too_close_m: 1.5 };
    assert_eq!(words(&Hud { obstacles: Some(free), ..flying(&job) }), (Some("obstacle none near".to_owned()), false));
    assert_eq!(words(&Hud { obstacles: None, ..flying(&job) }), (None, false));
}

#[test]
fn regress_a_surface_above_or_below_is_an_obstacle_as_for_the_too_close_cue() {
    let (job, site) = job();
    let words = |sectors_m: Vec<f64>, nearest_m| {
        let obstacles = Obstacles { sectors_m, nearest_m, range_m: 12.0, too_close_m: 2.5 };
        let items = instruments(&Hud { obstacles: Some(obstacles), ..flying(&job) }, &site, (200.0, 600.0));
        texts(&items, (200.0, 600.0)).into_iter().map(|(words, _)| words).find(|words| words.contains("obstacle"))
    };
    assert_eq!(words(vec![f64::INFINITY; 8], Some(1.8)).as_deref(), Some("obstacle 1.8 m"), "the deck above");
    let beside = vec![f64::INFINITY, 3.1, f64::NAN, f64::INFINITY];
    assert_eq!(words(beside.clone(), Some(2.2)).as_deref(), Some("obstacle 2.2 m"), "nearer than the arc");
    assert_eq!(words(beside, None).as_deref(), Some("obstacle 3.1 m"), "without this telemetry, the arcs remain");
}

#[test]
fn exact_the_profile_of_a_dry_site_shows_its_ground_and_no_water() {
    let job = scenario::read("job.toml", shipped::DRILL_HOVER, &|file| Err(file.to_owned())).unwrap();
    let site = SiteOutline::new(&job, &Site::without_defects(&job));
    let side = site.side(None).unwrap();
    let ((_, low), (_, high)) = side.bounds;
    let ground_up_m = side.ground[0].1;
    assert!(low < ground_up_m && ground_up_m < high && high - low < 20.0, "{low} m, {ground_up_m} m, {high} m");
    let items = instruments(&flying(&job), &site, (320.0, 480.0));
    assert!(!has_color(&items, HudColor::Water) && has_color(&items, HudColor::Earth));
}

#[test]
fn exact_the_horizon_tilts_against_the_roll_and_sinks_when_the_nose_rises() {
    let (job, site) = job();
    // The ground is the polygon in the color of earth that is drawn first, in the navigation display.
    let ground = |roll_rad: f64, pitch_rad: f64| {
        let items = instruments(&Hud { roll_rad, pitch_rad, tracks: Vec::new(), ..flying(&job) }, &site, (400.0, 400.0));
        items.into_iter().find_map(|item| match item {
            DrawItem::Fill { points, color: HudColor::Earth } => Some(points),
            DrawItem::Panel { .. } | DrawItem::Text { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
        })
    };
    let top = |points: &[super::super::ScreenPoint]| points.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let level = top(&ground(0.0, 0.0).unwrap());
    assert!((level - 0.5).abs() < 0.01, "{level}");
    assert!(top(&ground(0.0, 0.3).unwrap()) > level + 0.05);
    let highest = |points: Vec<super::super::ScreenPoint>| points.into_iter().min_by(|a, b| a.y.total_cmp(&b.y)).unwrap();
    // Rolled right, the ground is higher on the right side of the display.
    assert!(highest(ground(0.5, 0.0).unwrap()).x > 0.6);
}

#[test]
fn prop_texts_of_the_instruments_have_enough_contrast() {
    let (job, site) = job();
    let state = flying(&job);
    let assessed = Hud { tracks: Vec::new(), ..state.clone() };
    for text_scale in TextScale::ALL {
        for state in [&state, &assessed] {
            for (width, height) in [(300.0, 720.0), (600.0, 1080.0), (900.0, 240.0), (250.0, 250.0)] {
                for east_m in [-60.0, 20.0, 90.0] {
                    let style = DisplayStyle { text_scale, ..DisplayStyle::default() };
                    let hud = Hud { style, position_m: Vec3::new(east_m, -10.0, 12.0), ..state.clone() };
                    let items = instruments(&hud, &site, (width, height));
                    contrast::check(&items, width / height, &format!("{text_scale:?}, {width} x {height} px, {east_m} m east"));
                }
            }
        }
    }
}

#[test]
fn exact_the_profile_has_a_scale_of_heights_above_the_pad() {
    /// Rounding of positions, fraction of the picture.
    const ROUNDING: f64 = 1e-9;
    let (job, site) = job();
    let (pane, area) = (Pane { width: 400.0, height: 200.0 }, Area { x: 0.0, y: 0.0, width: 400.0, height: 200.0 });
    // The middle of the aircraft's symbol and a mark at its height must agree.
    for height_m in [10.0, 20.0] {
        let hud = Hud { position_m: job.ground_team.pad_m + Vec3::new(0.0, 0.0, height_m), ..flying(&job) };
        let items = profile::profile(&hud, &site, pane, area, 12.0);
        let mark = items.iter().find_map(|item| match item {
            DrawItem::Text { place, words, height, .. } if *words == format!("{height_m:.0} m") && *height < 12.0 / 200.0 => {
                Some(place.y)
            }
            DrawItem::Text { .. } | DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
        });
        let drone = items.iter().find_map(|item| match item {
            DrawItem::Fill { points, color: HudColor::Yellow } if points.len() == 4 => Some(points[1].y),
            DrawItem::Text { .. } | DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
        });
        let (mark, drone) = (mark.unwrap(), drone.unwrap());
        assert!((mark - drone).abs() < ROUNDING, "{height_m} m: mark at {mark}, aircraft at {drone}");
    }
}

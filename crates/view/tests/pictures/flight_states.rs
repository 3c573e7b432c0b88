//! What the pilot reads in each state of a flight, in every language, compared with committed pictures. With `SPANDREL_ALBUM`, the
//! views are also saved in the usual sizes of windows, to be looked at.

use super::compare::{check_picture, save_in, side_by_side};
use super::gallery::calm;
use super::pages::ALBUM_PX;
use spandrel_mavlink::contract::cue;
use spandrel_mavlink::contract::guidance::{Detour, DetourKind, Guidance, GuidanceStep, PathDeviation, StandOffReading, WayTo};
use spandrel_mavlink::contract::hazards::RadioMargins;
use spandrel_mavlink::contract::lesson::{LessonStatus, LessonTask};
use spandrel_model::frames::Vec3;
use spandrel_model::radio::RadioWay;
use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, at, sunny_job};
use spandrel_text::Language;
use spandrel_view::arrange::{ViewKind, ViewLayout, WindowShape};
use spandrel_view::flow::{ControlNames, ControllerStatus, KeyNames};
use spandrel_view::gpu::{Overlay, picture_texture, read};
use spandrel_view::hud::lesson_words::how_to;
use spandrel_view::hud::{self, DisplayStyle, Hud, LessonDisplay, MapPath, Obstacles};
use std::path::Path;

/// Sizes of one language's view in the committed pictures, px.
const VIEWS_PX: [(&str, (u32, u32)); 3] = [("", VIEW_PX), ("-square", (480, 480)), ("-wide", (860, 360))];
const VIEW_PX: (u32, u32) = (480, 360);

fn guidance(step: GuidanceStep, (distance_m, bearing_deg, up_m): (f64, f64, f64)) -> Guidance {
    Guidance {
        step,
        task: Some(2),
        way: Some(WayTo { distance_m, bearing_rad: f64::to_radians(bearing_deg), up_m }),
        progress: None,
        tasks_done: 1,
        tasks: 4,
        deviation: None,
        stand_off: None,
        flown_s: 342.0,
        needed_s: 557.0,
        detour: None,
    }
}

/// Returns the guidance along a path.
fn along_path(progress: f64, stand_off_m: f64) -> Guidance {
    let stand_off = StandOffReading { actual_m: stand_off_m, recommended_m: 5.0, tolerance_m: 1.5 };
    Guidance { progress: Some(progress), stand_off: Some(stand_off), ..guidance(GuidanceStep::FollowPath, (38.0, -12.0, -1.0)) }
}

fn lesson(task: LessonTask, step: u32, target: f64, remark: Option<&str>) -> LessonDisplay {
    let way = matches!(task, LessonTask::StopAt).then_some(WayTo { distance_m: 24.0, bearing_rad: 0.2, up_m: 0.0 });
    let status = LessonStatus { task, step, steps: 11, progress: 0.4, way, radius_m: Some(2.0), target: Some(target) };
    LessonDisplay { status, how: String::new(), remark: remark.map(str::to_owned) }
}

/// A state and the changes that it makes to the display of a calm flight.
type State = (&'static str, fn(&mut Hud));

const STATES: [State; 12] = [
    ("take-off", |hud| {
        let upward = Guidance { task: Some(1), tasks_done: 0, flown_s: 0.0, ..guidance(GuidanceStep::TakeOff, (0.0, 0.0, 5.0)) };
        (hud.guidance, hud.height_m, hud.home_distance_m) = (Some(upward), 0.0, 0.0);
    }),
    ("way-to-task", |hud| hud.guidance = Some(guidance(GuidanceStep::FlyToTask, (140.0, -30.0, 12.0)))),
    ("detour", |hud| {
        let way = WayTo { distance_m: 18.0, bearing_rad: 1.4, up_m: -3.0 };
        let detour = Some(Detour { kind: DetourKind::OutFromUnder, way });
        hud.guidance = Some(Guidance { detour, ..guidance(GuidanceStep::FlyToTask, (140.0, -30.0, 12.0)) });
        hud.gnss = Some(hud::GnssStatus { has_fix: false, satellites: 3 });
    }),
    ("on-path", |hud| {
        let mut sectors_m = vec![f64::INFINITY; 8];
        (sectors_m[0], sectors_m[1]) = (4.8, 6.0);
        hud.obstacles = Some(Obstacles { sectors_m, nearest_m: Some(4.8), range_m: 12.0, too_close_m: 2.5 });
        hud.guidance = Some(along_path(0.35, 4.8));
    }),
    ("off-path-and-speeding", |hud| {
        let deviation = Some(PathDeviation { distance_m: 3.4, above_m: -1.6 });
        hud.guidance = Some(Guidance { deviation, ..along_path(0.6, 7.4) });
        hud.cues = cue::SPEEDING | cue::OFF_PATH;
        hud.cue_texts = ["Too fast: 14 mph, limit 10 mph", "Off path 3.4 m: left and up"].into_iter().collect();
        (hud.speed_m_s, hud.battery_pct) = (6.1, Some(52.0));
    }),
    ("crash-with-empty-battery", |hud| {
        hud.guidance = Some(guidance(GuidanceStep::FlyHome, (212.0, 175.0, -24.0)));
        hud.cues = cue::CRASH | cue::TOO_CLOSE;
        hud.cue_texts = ["Crash: bridge", "Too close: 1.2 m, limit 2.5 m"].into_iter().collect();
        (hud.battery_pct, hud.remaining_s) = (Some(17.0), 71.0);
    }),
    ("landing", |hud| {
        let home = Guidance { task: None, tasks_done: 4, flown_s: 571.0, ..guidance(GuidanceStep::Land, (1.2, 90.0, -6.0)) };
        (hud.guidance, hud.height_m, hud.home_distance_m) = (Some(home), 6.0, 1.2);
    }),
    ("lesson-take-off", |hud| hud.lesson = Some(lesson(LessonTask::TakeOff, 2, 10.0, None))),
    ("lesson-wall", |hud| hud.lesson = Some(lesson(LessonTask::StopAt, 6, 5.0, None))),
    ("lesson-photograph", |hud| {
        hud.lesson = Some(lesson(LessonTask::Photograph, 9, 0.0, Some("too oblique: 71.3 deg, limit 60 deg")));
        (hud.lamp, hud.zoom, hud.shutter) = (true, 2.0, true);
    }),
    ("weak-radio", |hud| {
        hud.radio = Some(RadioMargins { control_db: 10.0, video_db: 1.5, way: RadioWay::AroundEdge, losses: 0 });
        hud.guidance = Some(along_path(0.35, 4.8));
    }),
    ("link-lost", |hud| (hud.telemetry_age_s, hud.battery_pct, hud.gnss) = (3.4, None, None)),
];

/// Returns the display of a state in a language.
fn display(studio: &Studio, language: Language, change: fn(&mut Hud)) -> Hud {
    let mut hud = calm(studio, at(-30.0, -9.0, 33.0));
    hud.style = DisplayStyle { language, ..DisplayStyle::default() };
    change(&mut hud);
    if let Some(lesson) = &mut hud.lesson {
        let keys = KeyNames::new(
            ["take_off", "up", "turn_left", "turn_right", "snapshot"].map(|binding| (binding, "K".to_owned())).into(),
        );
        lesson.how = how_to(lesson.status.task, language, &ControlNames::new(&keys, &ControllerStatus::default(), language));
    }
    hud
}

#[test]
fn regress_flight_states_look_as_committed_in_every_language() {
    let mut studio = Studio::new(sunny_job(), 7, "low", SimTime::from_ms(95_000));
    let moment = studio.moment(at(-30.0, -9.0, 33.0), at(-30.0, 0.0, 32.5), false, Vec3::new(0.5, 0.0, 0.0));
    let album = std::env::var_os("SPANDREL_ALBUM");
    let mut problems = Vec::new();
    for (name, change) in STATES {
        let displays = Language::ALL.map(|language| display(&studio, language, change));
        let mut view = |hud: &Hud, size_px: (u32, u32)| {
            let shot = studio.stage().camera(&moment, size_px);
            studio.draw_with(&shot, &hud::layout_px(hud, (f64::from(size_px.0), f64::from(size_px.1))))
        };
        for (shape, size_px) in VIEWS_PX {
            let views = displays.each_ref().map(|hud| view(hud, size_px));
            problems.extend(check_picture(&format!("flight-{name}{shape}"), &side_by_side(&views)).err());
        }
        for (hud, size_px) in album.iter().flat_map(|_| displays.iter().flat_map(|hud| ALBUM_PX.map(|size_px| (hud, size_px)))) {
            let file = format!("flight-{name}-{}-{}x{}.png", hud.style.language.tag(), size_px.0, size_px.1);
            save_in(Path::new(album.as_deref().unwrap()), &file, &view(hud, size_px));
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// Returns the flight on the way to task 2, with the path flown from the pad around the west end of the arch bridge.
fn on_the_map(studio: &Studio, language: Language) -> Hud {
    let mut hud = display(studio, language, |hud| hud.guidance = Some(guidance(GuidanceStep::FlyToTask, (140.0, -30.0, 12.0))));
    let (pad_m, here_m) = (studio.scenario.ground_team.pad_m, hud.position_m);
    let corners_m = [pad_m, pad_m + Vec3::new(0.0, 0.0, 20.0), pad_m + Vec3::new(-60.0, 30.0, 28.0), here_m];
    for ends in corners_m.windows(2) {
        (0..=50).for_each(|k| hud.flown.push(ends[0] + (ends[1] - ends[0]) * (f64::from(k) / 50.0)));
    }
    hud.tracks = MapPath::all(&studio.scenario);
    hud
}

#[test]
fn regress_the_large_map_looks_as_committed_in_every_language() {
    let studio = Studio::new(sunny_job(), 7, "low", SimTime::from_ms(95_000));
    let mut overlay = Overlay::new(&studio.gpu);
    let mut view = |hud: &Hud, size_px: (u32, u32)| {
        let texture = picture_texture(&studio.gpu, size_px);
        let target = texture.create_view(&Default::default());
        let items = hud::large_map(hud, &studio.scene.outline, (f64::from(size_px.0), f64::from(size_px.1)));
        overlay.draw(&studio.gpu, &items, &target, size_px);
        read(&studio.gpu, &texture).unwrap()
    };
    let displays = Language::ALL.map(|language| on_the_map(&studio, language));
    let views = displays.each_ref().map(|hud| view(hud, VIEW_PX));
    let found = check_picture("large-map", &side_by_side(&views));
    let square = check_picture("large-map-square", &view(&displays[0], (300, 300)));
    for (album, hud) in std::env::var_os("SPANDREL_ALBUM").iter().flat_map(|album| displays.each_ref().map(|hud| (album, hud))) {
        for (width, height) in ALBUM_PX {
            // The map's view in a window of this size.
            let places =
                ViewLayout::Map.view_rects(WindowShape { window: f64::from(width) / f64::from(height), camera: 4.0 / 3.0 });
            let place = places.iter().find(|place| place.which == ViewKind::Map).unwrap();
            let px = |share: f64, of: u32| (share * f64::from(of)).round() as u32;
            let file = format!("large-map-{}-{width}x{height}.png", hud.style.language.tag());
            save_in(Path::new(album), &file, &view(hud, (px(place.width, width), px(place.height, height))));
        }
    }
    assert!(found.is_ok() && square.is_ok(), "{found:?}, {square:?}");
}

//! Every page of the window in every language, compared with committed pictures. With `SPANDREL_ALBUM`, the pages are also saved
//! in the usual sizes of windows, to be looked at.

use super::compare::{check_picture, save_in};
use spandrel_model::site::Site;
use spandrel_model::{scenario, shipped};
use spandrel_text::{Language, text};
use spandrel_view::flow::pipe::{
    AircraftOffer, BriefingImage, FinalScore, FlightChoice, FlightMoment, FlightOptions, FlightStarted, FlightSummary, FlownBy,
    FromWindow, JobBriefing, JobOffer, NextJob, Purpose, SchoolPage, SchoolRequest, ToWindow, TraineeSummary,
};
use spandrel_view::flow::{
    ControllerStatus, KeyFunction, KeyPress, Page, PictureSource, SettingsStatus, WindowFlow, WindowRequest,
};
use spandrel_view::gpu::{Gpu, Overlay, PageImage, PageTextures, picture_texture, read};
use spandrel_view::hud::{DisplayStyle, JobDrawing};
use spandrel_view::path_guide::PathAids;
use spandrel_view::picture::Picture;
use spandrel_view::scene::LoadingStep;
use std::net::SocketAddr;
use std::path::Path;

/// Sizes of the committed pictures, small, because there are many: the shape of most displays, a square window, and a very wide one.
const COMMITTED_PX: [((u32, u32), &str); 3] = [(USUAL_PX, ""), ((240, 240), "-square"), ((420, 180), "-wide")];
const USUAL_PX: (u32, u32) = (400, 226);
/// Sizes of the album's pictures.
pub(super) const ALBUM_PX: [(u32, u32); 4] = [(1280, 720), (1920, 1080), (3840, 2160), (900, 900)];
/// Functions whose keys the pages mention.
const KEYS: [&str; 19] = [
    "up",
    "down",
    "turn_left",
    "turn_right",
    "forward",
    "back",
    "left",
    "right",
    "pause",
    "lamp",
    "snapshot",
    "swap",
    "follow",
    "arm",
    "take_off",
    "land",
    "gimbal_up",
    "gimbal_down",
    "camera_zoom_in",
];
/// Number of pages of the tutorial.
const TUTORIAL_PAGES: usize = 6;

/// Aircraft, wind and light of a job.
const CONDITIONS: &str = "Aircraft: Phantom 2 class · Wind: 4.0 m/s from 250° · Light: 12:05 solar time, sun 41° high";

fn job(name: &str, title: &str) -> JobOffer {
    let briefing = JobBriefing {
        notes: vec!["Begin with the arch bridge.".into()],
        tasks: vec!["1  Arch soffit: north arch, 152 m long, 12 to 24 m above the pad, stand-off 5.0 ± 1.5 m".into()],
        hazards: vec!["Wind: 4 m/s from 250°, gusts up to 7 m/s.".into(), "Traffic on both bridges.".into()],
        site_check: vec!["Battery at least 95%".into(), "Landing pad free of people".into()],
        conditions: vec!["Aircraft: Phantom 2 class".into(), "Speed: 1.0 m/s for inspection, limit 10 mph".into()],
        counts: vec!["Safety: touch nothing.".into(), "To be certified: conformity of at least 80%.".into()],
        pictures: Vec::new(),
    };
    JobOffer {
        name: name.into(),
        title: title.into(),
        kind: "4 tasks, 10 defects".into(),
        conditions: CONDITIONS.into(),
        is_lesson: false,
        briefing,
        vehicle: "phantom2".into(),
    }
}

fn options() -> FlightOptions {
    let next = NextJob {
        scenario: "drill-hover".into(),
        title: "Drill: hover".into(),
        due: Some("2026-12-04".into()),
        from_last_session: false,
    };
    let last = "You flew 2 m too far from the arch for 80 s.".to_owned();
    FlightOptions {
        trainees: vec![TraineeSummary { name: "anna".into(), sessions: 3, practices: 2, last: Some(last), next: Some(next) }],
        scenarios: vec![job("two-bridges", "Two bridges"), job("drill-hover", "Drill: hover")],
        choice: choice(Purpose::Practice),
        web: Some("http://127.0.0.1:8080".into()),
        lesson: None,
        vehicles: aircraft(),
    }
}

fn aircraft() -> Vec<AircraftOffer> {
    let offer = |name: &str, title: &str| AircraftOffer { name: name.into(), title: title.into() };
    vec![offer("phantom2", "Phantom 2 class"), offer("elios3", "Elios 3 class, caged")]
}

fn choice(purpose: Purpose) -> FlightChoice {
    FlightChoice {
        trainee: "anna".into(),
        scenario: "two-bridges".into(),
        purpose,
        by: FlownBy::Trainee,
        vehicle: "phantom2".into(),
    }
}

fn flying(purpose: Purpose) -> ToWindow {
    let here = SocketAddr::from(([127, 0, 0, 1], 14280));
    ToWindow::Flying(FlightStarted {
        choice: choice(purpose),
        seed: 7,
        connect: here,
        fly: Some(here),
        path_aids: PathAids::Full,
        ghost: None,
        is_ghost_outdated: false,
    })
}

fn ended() -> FlightSummary {
    let score = |pct: f64| Some(FinalScore { raw: pct, pct });
    FlightSummary {
        scores: [score(81.0), score(100.0), score(91.0), None],
        overall: Some((272.0, 300.0)),
        completion: Some("Complete: 4 of 4 tasks, 98% of the path".into()),
        complete: true,
        verdict: Some("Not certified".into()),
        unmet: vec!["12% battery at landing, 20% needed".into()],
        why: "landed after 12 min 30 s".into(),
        standing: Some("Personal best on this job: 281 of 300. Change since last time: 12 points up.".into()),
        advice: vec!["You flew up to 6.2 m/s in tasks 1, 2 and 4, over the 4.5 m/s limit for 2 min 34 s: slow down.".into()],
        moments: vec![FlightMoment { time: "12:10".into(), address: "http://127.0.0.1:8080/sessions/a/report#t=730".into() }],
        next: None,
        watched: false,
        lesson: None,
        report: Some("file:///sessions/a/report.html".into()),
        questionnaire: "http://127.0.0.1:8080/sessions/a/questions".into(),
    }
}

fn question() -> SchoolPage {
    SchoolPage {
        title: "1 of 12".into(),
        lines: vec!["What does this picture show? It was taken from 3 m.".into()],
        answers: ["Crack", "Spall", "Corrosion", "No defect"].map(str::to_owned).to_vec(),
        ..SchoolPage::default()
    }
}

fn drawing() -> JobDrawing {
    let scenario = scenario::read("two-bridges.toml", shipped::TWO_BRIDGES, &|file| Err(file.to_owned())).unwrap();
    JobDrawing::new(&scenario, &Site::without_defects(&scenario))
}

/// Returns the window with its start page.
fn started(language: Language) -> WindowFlow {
    let mut flow = WindowFlow::new();
    let key = |binding: &'static str| KeyFunction { binding, title: binding.replace('_', " "), key: "K".to_owned() };
    let style = DisplayStyle { language, ..DisplayStyle::default() };
    flow.update_settings(SettingsStatus { style, is_sound_on: true, keys: KEYS.map(key).to_vec(), ..SettingsStatus::default() });
    flow.handle_message(ToWindow::Offers(options()));
    flow
}

/// Returns the window with a page that is at most two clicks away from the start page.
fn on_page(language: Language, wanted: impl Fn(Page) -> bool) -> WindowFlow {
    // Tries the rows of the start page, and of the pages behind them, until one leads to the page.
    for first in 0..ROWS {
        for second in 0..ROWS {
            let mut flow = started(language);
            for row in [first, second] {
                flow.press(KeyPress::Row(row));
                if wanted(flow.page()) {
                    return flow;
                }
            }
        }
    }
    panic!("the page is more than two clicks away from the start page")
}

/// Maximum number of rows of a page that are tried.
const ROWS: usize = 16;

/// Returns all pages with their names.
fn pages(language: Language) -> Vec<(String, WindowFlow)> {
    let mut pages = vec![
        ("start".to_owned(), started(language)),
        ("settings".to_owned(), on_page(language, |page| matches!(page, Page::Settings { .. }))),
        ("keys".to_owned(), on_page(language, |page| matches!(page, Page::Keys { .. }))),
        ("controls".to_owned(), on_page(language, |page| page == Page::Controls)),
    ];
    let mut tutorial = on_page(language, |page| matches!(page, Page::Tutorial(..)));
    for number in 1..=TUTORIAL_PAGES {
        pages.push((format!("tutorial-{number}"), tutorial.clone()));
        tutorial.press(KeyPress::Enter);
    }
    let mut briefing = on_page(language, |page| page == Page::Controls);
    briefing.press(KeyPress::Enter);
    assert_eq!(briefing.page(), Page::Briefing);
    let job = briefing.job_to_draw().unwrap().to_owned();
    briefing.add_job_drawing(job, drawing());
    pages.push(("briefing".to_owned(), briefing));
    pages.push(("briefing-pictures".to_owned(), pictured(language)));
    let flight = |purpose| {
        let mut flow = started(language);
        flow.handle_message(flying(purpose));
        flow
    };
    let mut paused = flight(Purpose::Practice);
    paused.handle_message(ToWindow::Paused { on: true });
    pages.push(("paused".to_owned(), paused));
    let mut confirm = flight(Purpose::Assessment);
    confirm.pause();
    pages.push(("confirm-end".to_owned(), confirm));
    let mut results = flight(Purpose::Practice);
    results.handle_message(ToWindow::Ended(ended()));
    pages.push(("results".to_owned(), results));
    let mut scoring = flight(Purpose::Assessment);
    scoring.pause();
    scoring.press(KeyPress::Row(1));
    assert_eq!(scoring.page(), Page::Waiting);
    pages.push(("waiting-scoring".to_owned(), scoring));
    pages.push(("calibrating".to_owned(), calibrating(language)));
    pages.extend(school(language));
    pages
}

/// Returns the calibration of a controller, with the axes that it has found.
fn calibrating(language: Language) -> WindowFlow {
    let mut flow = on_page(language, |page| page == Page::Controls);
    flow.update_controls(ControllerStatus {
        device: Some("Test pad".into()),
        axes: vec![(0, 0.2, (-1.0, 1.0)), (1, -0.6, (-0.8, 0.9)), (3, 0.0, (0.0, 0.3)), (4, 0.9, (-1.0, 1.0))],
        wizard: Some(text!(language, "keys-wizard-push-left-vertical")),
        ..ControllerStatus::default()
    });
    assert_eq!(flow.page(), Page::Calibrating);
    flow
}

/// Returns whether the window asks for a round of the defect school.
fn begins_school(mut flow: WindowFlow) -> bool {
    std::iter::from_fn(|| flow.poll())
        .any(|request| matches!(request, WindowRequest::Send(FromWindow::School(SchoolRequest::Begin(_)))))
}

/// Returns the pages of the defect school: loading, a question and its verdict.
fn school(language: Language) -> Vec<(String, WindowFlow)> {
    let mut loading = (0..ROWS)
        .map(|row| {
            let mut flow = started(language);
            flow.press(KeyPress::Row(row));
            flow
        })
        .find(|flow| begins_school(flow.clone()))
        .unwrap();
    loading.handle_message(ToWindow::Loading { words: LoadingStep::Ground.words(language) });
    let shown = |page: SchoolPage| {
        let mut flow = loading.clone();
        flow.handle_message(ToWindow::School(page));
        assert_eq!(flow.page(), Page::School);
        flow
    };
    let picture = Some("320x240".to_owned());
    let lines = vec!["Wrong: this is not abrasion.".into(), "Spall: a hollow with a sharp edge.".into()];
    let verdict = SchoolPage { picture: picture.clone(), lines, answers: Vec::new(), right: Some(false), ..question() };
    vec![
        ("school".to_owned(), shown(SchoolPage { picture, ..question() })),
        ("school-verdict".to_owned(), shown(verdict)),
        ("waiting-school".to_owned(), loading),
    ]
}

/// Returns the briefing with the instructor's pictures, scrolled to its end.
fn pictured(language: Language) -> WindowFlow {
    let picture = |(size_px, caption): ((u32, u32), &str)| BriefingImage {
        path: format!("{}x{}", size_px.0, size_px.1),
        caption: caption.into(),
        size_px,
    };
    let pictures = [((400, 300), "The gate, seen from the road"), ((300, 400), "Begin at this pier"), ((900, 300), "The arch")];
    let mut options = options();
    for job in &mut options.scenarios {
        job.briefing.pictures = pictures.map(picture).to_vec();
    }
    let mut flow = on_page(language, |page| page == Page::Controls);
    flow.handle_message(ToWindow::Offers(options));
    flow.press(KeyPress::Enter);
    assert_eq!(flow.page(), Page::Briefing);
    flow.scroll(100.0, f64::from(USUAL_PX.0) / f64::from(USUAL_PX.1));
    flow
}

/// Returns a picture of this size that shows which of its corners is which.
fn corners(size: &str) -> Option<Picture> {
    let (width, height) = size.split_once('x')?;
    let (width, height): (u32, u32) = (width.parse().ok()?, height.parse().ok()?);
    let shade = |k: u32, of: u32| (255 * k / of) as u8;
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [shade(x, width), shade(y, height), 128, 255]));
    Some(Picture { width, height, rgba: pixels.flatten().collect() })
}

/// Renders a page.
fn drawn(gpu: &Gpu, overlay: &mut Overlay, flow: &WindowFlow, size_px: (u32, u32)) -> Picture {
    let texture = picture_texture(gpu, size_px);
    let target = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let sheet = flow.sheet(f64::from(size_px.0) / f64::from(size_px.1));
    let mut textures = PageTextures::default();
    for picture in &sheet.pictures {
        if let (PictureSource::Job(name), Some(picture)) = (&picture.source, corners("320x180")) {
            textures.add_job(name.clone(), PageImage::new(&picture));
        }
    }
    for path in textures.missing_files(&sheet) {
        let picture = corners(&path).map(|picture| PageImage::new(&picture));
        textures.add_file(path, picture);
    }
    overlay.draw_page(gpu, &sheet, &mut textures, &target, size_px);
    read(gpu, &texture).unwrap()
}

#[test]
fn regress_pages_look_as_committed_in_every_language_and_shape() {
    let gpu = Gpu::open_software().unwrap();
    let mut overlay = Overlay::new(&gpu);
    let album = std::env::var_os("SPANDREL_ALBUM");
    let mut problems = Vec::new();
    for language in Language::ALL {
        for (name, flow) in pages(language) {
            let name = format!("page-{name}-{}", language.tag());
            for (size_px, shape) in COMMITTED_PX {
                let picture = drawn(&gpu, &mut overlay, &flow, size_px);
                problems.extend(check_picture(&format!("{name}{shape}"), &picture).err());
            }
            for size_px in album.iter().flat_map(|_| ALBUM_PX) {
                let picture = drawn(&gpu, &mut overlay, &flow, size_px);
                let file = format!("{name}-{}x{}.png", size_px.0, size_px.1);
                save_in(Path::new(album.as_deref().unwrap()), &file, &picture);
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

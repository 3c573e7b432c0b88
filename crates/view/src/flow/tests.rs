//! Tests of keyboard navigation, rejected actions, and page contents.

use super::pipe::{
    AircraftOffer, BriefingImage, FinalScore, FlightChoice, FlightMoment, FlightOptions, FlightStarted, FlightSummary, FlownBy,
    FromWindow, GhostFlight, JobBriefing, JobOffer, LessonProgress, NextJob, OrderedFlight, Purpose, SCORE_NAMES, SchoolPage,
    SchoolRequest, ToWindow, TraineeSummary,
};
use super::sheet::{PageLayout, PictureSource};
use super::{
    ControllerStatus, KeyFunction, KeyPress, MenuAction, PICTURES, Page, ProfileChange, Setting, SettingChange, SettingsStatus,
    WindowFlow, WindowRequest,
};
use crate::arrange::ViewLayout;
use crate::hud::contrast;
use crate::hud::text_metrics::text_width;
use crate::hud::{DisplayStyle, DisplayUnits, DrawItem, HudColor, JobDrawing, ScreenPoint, TextAlign, TextScale};
use crate::path_guide::PathAids;
use spandrel_model::site::Site;
use spandrel_model::{scenario, shipped};
use spandrel_text::Language;
use std::net::SocketAddr;

fn offers() -> FlightOptions {
    let job = |name: &str, title: &str| JobOffer {
        name: name.into(),
        title: title.into(),
        kind: "1 task".into(),
        conditions: String::new(),
        is_lesson: false,
        briefing: JobBriefing::default(),
        vehicle: "phantom2".into(),
    };
    FlightOptions {
        trainees: vec![
            TraineeSummary { name: "anna".into(), sessions: 2, practices: 1, last: None, next: None },
            TraineeSummary { name: "bert".into(), sessions: 0, practices: 0, last: None, next: None },
        ],
        scenarios: vec![job("drill-hover", "Drill: hover"), job("two-bridges", "Two bridges")],
        choice: FlightChoice {
            trainee: "anna".into(),
            scenario: "two-bridges".into(),
            purpose: Purpose::Practice,
            by: FlownBy::Trainee,
            vehicle: "phantom2".into(),
        },
        web: Some("http://127.0.0.1:8080".into()),
        lesson: None,
        vehicles: Vec::new(),
    }
}

fn flying(choice: &FlightChoice) -> ToWindow {
    let here = SocketAddr::from(([127, 0, 0, 1], 14280));
    ToWindow::Flying(FlightStarted {
        path_aids: PathAids::Full,
        ghost: None,
        is_ghost_outdated: false,
        choice: choice.clone(),
        seed: 7,
        connect: here,
        fly: Some(here),
    })
}

fn ended() -> FlightSummary {
    let score = |pct: f64| Some(FinalScore { raw: pct, pct });
    FlightSummary {
        scores: [score(81.25), score(100.0), score(91.0), None],
        overall: Some((272.25, 300.0)),
        completion: Some("Complete: 4 of 4 tasks, 98% of the path".into()),
        complete: true,
        verdict: Some("Not certified".into()),
        unmet: vec!["12% battery at landing, 20% needed".into()],
        why: "landed after 12 min 30 s".into(),
        standing: Some("Personal best on this job: 281 of 300. Change since last time: 12 points up.".into()),
        advice: [
            "You flew up to 6.2 m/s in tasks 1, 2 and 4, over the 4.5 m/s limit for 2 min 34 s, longest from 12:10: slow down.",
            "You hit the bridge 14 times in task 3, first at 5:40, hardest at 16:02 (2.1 m/s): slow down near it and keep your distance.",
            "You missed 6 of 10 defects; at 15:12 you were nearest to a view of defect 10: search slowly there.",
        ]
        .map(str::to_owned)
        .to_vec(),
        moments: Vec::new(),
        next: None,
        watched: false,
        lesson: None,
        report: Some("file:///sessions/a/report.html".into()),
        questionnaire: "http://127.0.0.1:8080/sessions/a/questions".into(),
    }
}

/// Returns settings with key names that do not occur elsewhere on a page.
fn settings() -> SettingsStatus {
    let sticks = ["up", "down", "turn_left", "turn_right", "forward", "back", "left", "right"];
    let rest =
        ["swap", "follow", "pause", "arm", "take_off", "land", "lamp", "snapshot", "gimbal_up", "gimbal_down", "camera_zoom_in"];
    let function = |binding: &'static str| KeyFunction { binding, title: binding.replace('_', " "), key: format!("<{binding}>") };
    let keys = sticks.into_iter().chain(rest).map(function).collect();
    SettingsStatus { is_sound_on: true, keys, ..SettingsStatus::default() }
}

fn opened() -> WindowFlow {
    let mut flow = WindowFlow::new();
    flow.update_settings(settings());
    flow
}

fn started() -> WindowFlow {
    let mut flow = opened();
    flow.handle_message(ToWindow::Offers(offers()));
    flow
}

fn pending_requests(flow: &mut WindowFlow) -> Vec<WindowRequest> {
    std::iter::from_fn(|| flow.poll()).collect()
}

fn press(flow: &mut WindowFlow, all: &[KeyPress]) {
    all.iter().for_each(|one| flow.press(*one));
}

fn in_flight(purpose: Purpose) -> WindowFlow {
    let mut flow = started();
    flow.handle_message(flying(&FlightChoice { purpose, ..flow.choice().clone() }));
    pending_requests(&mut flow);
    flow
}

#[test]
fn exact_keys_navigate_from_selection_through_flight_to_scores() {
    let mut flow = started();
    assert_eq!(flow.page(), Page::Start);
    press(&mut flow, &[KeyPress::Down, KeyPress::Left, KeyPress::Enter, KeyPress::Enter, KeyPress::Enter]);
    assert_eq!((flow.page(), flow.choice().scenario.as_str()), (Page::Controls, "drill-hover"));
    press(&mut flow, &[KeyPress::Enter]);
    assert_eq!(flow.page(), Page::Waiting, "a returning trainee must not see the tutorial");
    let wanted = FlightChoice {
        trainee: "anna".into(),
        scenario: "drill-hover".into(),
        purpose: Purpose::Practice,
        by: FlownBy::Trainee,
        vehicle: "phantom2".into(),
    };
    assert_eq!(pending_requests(&mut flow), [WindowRequest::Send(FromWindow::Chosen(wanted.clone()))]);
    flow.handle_message(flying(&wanted));
    assert_eq!(flow.page(), Page::Flight);
    assert!(matches!(pending_requests(&mut flow).as_slice(), [WindowRequest::ShowFlight(flying)] if flying.choice == wanted));
    flow.handle_message(ToWindow::Ended(ended()));
    assert_eq!((flow.page(), pending_requests(&mut flow)), (Page::Results, vec![WindowRequest::LeaveFlight]));
    press(&mut flow, &[KeyPress::Enter, KeyPress::Down, KeyPress::Enter, KeyPress::Down, KeyPress::Enter]);
    let told = pending_requests(&mut flow);
    assert!(matches!(&told[0], WindowRequest::Open(address) if address.starts_with("file:")), "{told:?}");
    assert!(matches!(&told[1], WindowRequest::Open(address) if address.ends_with("/questions")), "{told:?}");
    assert_eq!(told[2..], [WindowRequest::LeaveFlight, WindowRequest::Send(FromWindow::Again)]);
}

#[test]
fn exact_the_recommended_job_is_one_key_away_before_and_after_a_flight() {
    let job = |scenario: &str, title: &str| {
        Some(NextJob { scenario: scenario.into(), title: title.into(), due: None, from_last_session: false })
    };
    let mut offers = offers();
    offers.lesson = job("first-flight", "Lesson: first flight");
    offers.trainees[0].next = job("drill-hover", "Drill: hover");
    offers.trainees[0].last = Some("You hit the bridge twice.".into());
    let mut flow = opened();
    flow.handle_message(ToWindow::Offers(offers));
    assert!(words(&flow).contains("Recommended: Drill: hover") && words(&flow).contains("Last flight:"));
    press(&mut flow, &[KeyPress::Down, KeyPress::Enter]);
    assert_eq!((flow.page(), flow.choice().scenario.as_str()), (Page::Controls, "drill-hover"));
    press(&mut flow, &[KeyPress::Escape, KeyPress::Right]);
    assert_eq!(flow.choice().trainee, "bert");
    assert!(words(&flow).contains("Recommended: Lesson: first flight"), "a trainee without sessions starts with the lesson");
    flow.handle_message(flying(&flow.choice().clone()));
    flow.handle_message(ToWindow::Ended(FlightSummary { next: job("two-bridges", "Two bridges"), ..ended() }));
    pending_requests(&mut flow);
    press(&mut flow, &[KeyPress::Enter]);
    let wanted = FlightChoice {
        trainee: "bert".into(),
        scenario: "two-bridges".into(),
        purpose: Purpose::Practice,
        by: FlownBy::Trainee,
        vehicle: "phantom2".into(),
    };
    assert_eq!(pending_requests(&mut flow), [WindowRequest::Send(FromWindow::Chosen(wanted))]);
}

#[test]
fn exact_watching_an_expert_does_not_count_as_practice() {
    let mut flow = started();
    press(&mut flow, &[KeyPress::Right]);
    assert!(flow.choice().trainee == "bert" && flow.needs_tutorial());
    let at = flow.rows().iter().position(|row| row.action == MenuAction::WatchExpert).unwrap();
    press(&mut flow, &[KeyPress::Row(at)]);
    let wanted = FlightChoice { by: FlownBy::Expert, ..flow.choice().clone() };
    assert_eq!(flow.choice().by, FlownBy::Trainee, "the trainee's own choice stays");
    assert_eq!(pending_requests(&mut flow), [WindowRequest::Send(FromWindow::Chosen(wanted.clone()))]);
    flow.handle_message(flying(&wanted));
    flow.handle_message(ToWindow::Ended(ended()));
    assert!(flow.needs_tutorial(), "bert has not flown");
    // The next flight is the trainee's own.
    let at = flow.rows().iter().position(|row| row.action == MenuAction::ChooseOther).unwrap();
    press(&mut flow, &[KeyPress::Row(at)]);
    let at = flow.rows().iter().position(|row| row.action == MenuAction::CheckController).unwrap();
    press(&mut flow, &[KeyPress::Row(at)]);
    assert_eq!(flow.choice().by, FlownBy::Trainee);
}

#[test]
fn exact_new_trainee_gets_the_tutorial_and_may_skip_it() {
    let mut flow = started();
    press(&mut flow, &[KeyPress::Backspace; 4]);
    "n3w".chars().for_each(|sign| flow.press(KeyPress::Char(sign)));
    press(&mut flow, &[KeyPress::Enter, KeyPress::Enter, KeyPress::Enter, KeyPress::Enter]);
    assert_eq!((flow.page(), flow.choice().trainee.as_str()), (Page::Controls, "n3w"));
    press(&mut flow, &[KeyPress::Enter, KeyPress::Enter]);
    assert_eq!(flow.page(), Page::Tutorial(1, true));
    press(&mut flow, &[KeyPress::Escape, KeyPress::Up, KeyPress::Enter]);
    assert_eq!(flow.page(), Page::Waiting, "the last row must skip the tutorial");
    assert!(
        matches!(pending_requests(&mut flow).as_slice(), [WindowRequest::Send(FromWindow::Chosen(choice))] if choice.trainee == "n3w")
    );
    flow.handle_message(ToWindow::Refused { words: "the port is taken".into() });
    assert_eq!((flow.page(), flow.notice()), (Page::Start, Some("the port is taken")));
    // Reopens the tutorial from the start page and reads it to the end.
    press(&mut flow, &[KeyPress::Row(5)]);
    (0..6).for_each(|_| flow.press(KeyPress::Enter));
    assert_eq!((flow.page(), pending_requests(&mut flow).len()), (Page::Start, 0));
}

fn choose_practice(flow: &mut WindowFlow) {
    if flow.choice().purpose == Purpose::Assessment {
        press(flow, &[KeyPress::Row(2), KeyPress::Right]);
    }
}

#[test]
fn exact_tutorial_precedes_each_trainees_first_practice() {
    let mut flow = in_flight(Purpose::Assessment);
    flow.handle_message(ToWindow::Ended(ended()));
    // Goes from the start page to the flight: enters the name, checks the controller, and starts.
    let named = |flow: &mut WindowFlow, name: &str| {
        flow.press(KeyPress::Row(0));
        press(flow, &[KeyPress::Backspace; 32]);
        name.chars().for_each(|sign| flow.press(KeyPress::Char(sign)));
        press(flow, &[KeyPress::Row(3), KeyPress::Enter]);
        flow.page()
    };
    press(&mut flow, &[KeyPress::Row(3)]);
    assert_eq!(flow.page(), Page::Start);
    choose_practice(&mut flow);
    assert_eq!(named(&mut flow, "cora"), Page::Tutorial(0, true), "an assessment must not replace the tutorial");
    press(&mut flow, &[KeyPress::Row(2)]);
    flow.handle_message(flying(&flow.choice().clone()));
    flow.handle_message(ToWindow::Ended(ended()));
    press(&mut flow, &[KeyPress::Row(3), KeyPress::Row(3), KeyPress::Enter]);
    assert_eq!(flow.page(), Page::Waiting, "a trainee who has practiced must not see the tutorial");
    flow.handle_message(ToWindow::Refused { words: String::new() });
    assert_eq!(named(&mut flow, "dan"), Page::Tutorial(0, true), "a new trainee must see the tutorial");
}

#[test]
fn exact_the_end_page_opens_the_report_at_the_chosen_moment() {
    let mut flow = in_flight(Purpose::Practice);
    let moments =
        ["5:40", "9:00"].map(|time| FlightMoment { time: time.into(), address: format!("http://a/report#{time}") }).to_vec();
    flow.handle_message(ToWindow::Ended(FlightSummary { moments, ..ended() }));
    pending_requests(&mut flow);
    let opened = |address: &str| vec![WindowRequest::Open(format!("http://a/report#{address}"))];
    press(&mut flow, &[KeyPress::Row(1)]);
    assert_eq!(pending_requests(&mut flow), opened("5:40"));
    press(&mut flow, &[KeyPress::Right, KeyPress::Enter]);
    assert_eq!(pending_requests(&mut flow), opened("9:00"));
    press(&mut flow, &[KeyPress::Right, KeyPress::Enter]);
    assert_eq!(pending_requests(&mut flow), opened("5:40"), "from the last to the first");
}

#[test]
fn exact_flight_keys_have_no_effect_on_a_newly_opened_page() {
    let mut flow = in_flight(Purpose::Practice);
    flow.handle_message(ToWindow::Ended(ended()));
    pending_requests(&mut flow);
    press(&mut flow, &[KeyPress::Left, KeyPress::Right, KeyPress::Down, KeyPress::Right, KeyPress::Up]);
    assert_eq!((flow.page(), pending_requests(&mut flow).len()), (Page::Results, 0));
    let mut flow = started();
    assert!(!flow.is_key_test());
    press(&mut flow, &[KeyPress::Row(3), KeyPress::Right, KeyPress::Left]);
    assert_eq!(flow.page(), Page::Controls);
    assert!(flow.is_key_test(), "without a controller, this page must test the flight keys");
    assert!(flow.only_tests("w", true) && !flow.only_tests("w", false));
    assert!(["enter", "tab"].into_iter().all(|key| !flow.only_tests(key, true)), "the page can be left without a mouse");
    flow.update_controls(ControllerStatus { device: Some("Pad".into()), ..ControllerStatus::default() });
    assert!(!flow.is_key_test(), "with a controller, keys must select rows and values");
}

#[test]
fn exact_unplugged_controller_is_reported_and_can_be_searched_for() {
    let mut flow = started();
    press(&mut flow, &[KeyPress::Row(3)]);
    let there = ControllerStatus { device: Some("Pad".into()), calibrated: true, ..ControllerStatus::default() };
    let lost = ControllerStatus { lost: true, keys: vec![("w".into(), "climbs".into())], ..there.clone() };
    let deeds = |flow: &WindowFlow| flow.rows().into_iter().map(|row| row.action).collect::<Vec<_>>();
    flow.update_controls(there);
    assert!(words(&flow).contains("Pad, calibrated") && !deeds(&flow).contains(&MenuAction::FindController));
    press(&mut flow, &[KeyPress::Up]);
    flow.update_controls(lost);
    assert!(flow.focus < flow.rows().len(), "the focus must stay on a row");
    let told = words(&flow);
    assert!(
        told.contains("Pad not connected: using keyboard") && !told.contains("calibrated") && told.contains("climbs"),
        "{told}"
    );
    assert_eq!(deeds(&flow), [MenuAction::Fly, MenuAction::FindController, MenuAction::Back]);
    assert!(flow.is_key_test(), "without a controller, this page must test the flight keys");
}

#[test]
fn regress_flight_end_clears_the_restart_request() {
    let mut flow = in_flight(Purpose::Practice);
    flow.restart();
    flow.handle_message(ToWindow::Ended(ended()));
    let mut next = in_flight(Purpose::Practice);
    next.handle_message(ToWindow::Paused { on: true });
    let harmless = next.focus;
    let flying = next.flying.clone().unwrap();
    flow.handle_message(ToWindow::Flying(flying));
    flow.handle_message(ToWindow::Paused { on: true });
    assert_eq!(flow.focus, harmless);
}

#[test]
fn exact_pages_show_bound_keys_and_the_pending_operation() {
    let (mut flight, mut seen) = (in_flight(Purpose::Practice), String::new());
    for (name, flow) in every_page() {
        assert!(!words(&flow).contains('{'), "{name}: {}", words(&flow));
        seen.push_str(&words(&flow));
    }
    assert!(["<swap>", "<follow>", "<lamp>", "<pause>"].into_iter().all(|key| seen.contains(key)), "{seen}");
    flight.handle_message(ToWindow::Paused { on: true });
    press(&mut flight, &[KeyPress::Row(3)]);
    assert!(words(&flight).contains("Scoring"), "{}", words(&flight));
    flight.handle_message(ToWindow::Refused { words: "a word ".repeat(80) });
    let lines = words(&flight).lines().filter(|line| line.contains("a word")).count();
    assert!(lines > 2, "a long message must wrap: {lines} lines");
}

#[test]
fn exact_typing_replaces_the_name_in_use_and_continues_one_that_was_begun() {
    let mut flow = started();
    let before = flow.choice().trainee.clone();
    assert!(!before.is_empty());
    press(&mut flow, &[KeyPress::Char('-')]);
    assert_eq!(flow.choice().trainee, before, "no name begins with a hyphen");
    "ida-2".chars().for_each(|sign| flow.press(KeyPress::Char(sign)));
    assert_eq!(flow.choice().trainee, "ida-2");
    press(&mut flow, &[KeyPress::Backspace, KeyPress::Char('3')]);
    assert_eq!(flow.choice().trainee, "ida-3");
    press(&mut flow, &[KeyPress::Down, KeyPress::Up, KeyPress::Char('x')]);
    assert_eq!(flow.choice().trainee, "x");
}

#[test]
fn exact_names_accept_only_valid_characters() {
    let mut flow = started();
    press(&mut flow, &[KeyPress::Backspace; 9]);
    for sign in "-_ /é.".chars() {
        flow.press(KeyPress::Char(sign));
        assert!(flow.notice().is_some() && flow.choice().trainee.is_empty(), "{sign}");
    }
    press(&mut flow, &[KeyPress::Row(3)]);
    assert_eq!(flow.page(), Page::Start, "a flight must require a name");
    "a".repeat(40).chars().for_each(|sign| flow.press(KeyPress::Char(sign)));
    assert!(flow.choice().trainee.is_empty(), "typed characters must go to the focused row");
    flow.press(KeyPress::Row(0));
    "a".repeat(40).chars().for_each(|sign| flow.press(KeyPress::Char(sign)));
    assert_eq!(flow.choice().trainee.len(), 32);
}

#[test]
fn exact_pause_and_restart_are_available_only_in_practice() {
    let mut flow = in_flight(Purpose::Practice);
    flow.pause();
    assert_eq!(pending_requests(&mut flow), [WindowRequest::Send(FromWindow::Pause)]);
    assert!(!flow.is_paused(), "the simulator must confirm the pause");
    flow.handle_message(ToWindow::Paused { on: true });
    assert!(flow.is_paused());
    flow.press(KeyPress::Escape);
    assert_eq!(pending_requests(&mut flow), [WindowRequest::Send(FromWindow::Resume)]);
    flow.handle_message(ToWindow::Paused { on: false });
    assert_eq!(flow.page(), Page::Flight);
    flow.restart();
    flow.handle_message(ToWindow::Paused { on: true });
    flow.press(KeyPress::Enter);
    assert_eq!(
        pending_requests(&mut flow),
        [WindowRequest::Send(FromWindow::Pause), WindowRequest::LeaveFlight, WindowRequest::Send(FromWindow::Restart)],
        "a restart must be confirmed in the focused row"
    );
    assert_eq!(flow.page(), Page::Waiting);

    let mut flow = in_flight(Purpose::Assessment);
    assert!(!flow.shows_map());
    flow.restart();
    assert!(flow.notice().is_some_and(|words| words.contains("restarted")));
    flow.pause();
    assert!(flow.page() == Page::ConfirmEnd && !flow.is_paused(), "the flight must continue");
    flow.press(KeyPress::Escape);
    assert_eq!(flow.page(), Page::Flight);
    flow.pause();
    flow.press(KeyPress::Enter);
    assert_eq!((flow.page(), pending_requests(&mut flow)), (Page::Flight, vec![]), "the first row must continue the flight");
    let mut given_up = flow.clone();
    given_up.pause();
    press(&mut given_up, &[KeyPress::Down, KeyPress::Enter]);
    assert_eq!(pending_requests(&mut given_up), [WindowRequest::LeaveFlight, WindowRequest::Send(FromWindow::End)]);
    assert_eq!(given_up.page(), Page::Waiting);
    flow.pause();
    flow.handle_message(ToWindow::Ended(ended()));
    flow.pause();
    flow.restart();
    assert_eq!(
        pending_requests(&mut flow),
        [WindowRequest::LeaveFlight],
        "pause and restart must have no effect after the flight has ended"
    );
}

#[test]
fn exact_profile_changes_in_steps_within_its_range() {
    let mut flow = started();
    press(&mut flow, &[KeyPress::Row(3)]);
    flow.update_controls(ControllerStatus {
        device: Some("Pad".into()),
        calibrated: true,
        mode: 4,
        dead_band: 0.5,
        expo: 0.05,
        ..ControllerStatus::default()
    });
    press(&mut flow, &[KeyPress::Row(2), KeyPress::Right, KeyPress::Row(3), KeyPress::Right, KeyPress::Row(4), KeyPress::Left]);
    let told = pending_requests(&mut flow);
    assert_eq!(told[0], WindowRequest::ChangeProfile(ProfileChange::Mode(1)), "mode 4 must wrap around to 1");
    assert_eq!(told[1], WindowRequest::ChangeProfile(ProfileChange::DeadBand(0.5)), "the dead band must be at most 0.5");
    assert_eq!(told[2], WindowRequest::ChangeProfile(ProfileChange::Expo(0.0)));
    flow.update_controls(ControllerStatus { wizard: Some("Let go.".into()), ..flow.controls.clone() });
    assert_eq!(flow.page(), Page::Calibrating);
    press(&mut flow, &[KeyPress::Enter, KeyPress::Escape]);
    assert_eq!(pending_requests(&mut flow), [WindowRequest::Confirm, WindowRequest::Cancel]);
    flow.update_controls(ControllerStatus { wizard: None, ..flow.controls.clone() });
    assert_eq!(flow.page(), Page::Controls);
}

#[test]
fn regress_ending_a_flight_of_more_than_ten_seconds_needs_a_second_press() {
    let paused = |flown_s: f64| {
        let mut flow = in_flight(Purpose::Practice);
        flow.flown_s = flown_s;
        flow.handle_message(ToWindow::Paused { on: true });
        pending_requests(&mut flow);
        flow
    };
    let row = |flow: &WindowFlow, action| flow.rows().iter().position(|row| row.action == action).unwrap();
    for (action, message) in [(MenuAction::Restart, FromWindow::Restart), (MenuAction::End, FromWindow::End)] {
        let ended = [WindowRequest::LeaveFlight, WindowRequest::Send(message)];
        let mut flow = paused(10.1);
        let click = KeyPress::Row(row(&flow, action));
        flow.press(click);
        assert_eq!((flow.page(), pending_requests(&mut flow)), (Page::Paused, vec![]), "the first click asks");
        assert!(flow.rows()[row(&flow, action)].label.contains("Press again"));
        press(&mut flow, &[KeyPress::Down, KeyPress::Up, KeyPress::Enter]);
        assert_eq!(pending_requests(&mut flow), [], "another key withdraws the first press");
        flow.press(KeyPress::Enter);
        assert_eq!(pending_requests(&mut flow), ended);
        let mut short = paused(9.9);
        short.press(click);
        assert_eq!(pending_requests(&mut short), ended, "a short flight ends at once");
    }
    let mut flow = in_flight(Purpose::Practice);
    flow.flown_s = 60.0;
    flow.restart();
    flow.handle_message(ToWindow::Paused { on: true });
    pending_requests(&mut flow);
    flow.restart();
    assert_eq!(
        pending_requests(&mut flow),
        [WindowRequest::LeaveFlight, WindowRequest::Send(FromWindow::Restart)],
        "key pressed twice"
    );
}

/// Returns the start page with all rows: with a recommendation and a choice of aircraft.
fn full_start() -> WindowFlow {
    let mut offers = offers_for("phantom2");
    offers.trainees[0].next =
        Some(NextJob { scenario: "drill-hover".into(), title: "Drill: hover".into(), due: None, from_last_session: false });
    let mut flow = opened();
    flow.handle_message(ToWindow::Offers(offers));
    flow
}

/// Returns every page.
fn every_page() -> Vec<(String, WindowFlow)> {
    let mut all =
        vec![("opening".to_owned(), opened()), ("start".to_owned(), started()), ("start-full".to_owned(), full_start())];
    let mut controls = started();
    controls.press(KeyPress::Row(3));
    controls.controls.keys =
        [("w", "up"), ("s", "down"), ("1", "arm")].map(|(key, duty)| (key.to_owned(), duty.to_owned())).to_vec();
    all.push(("controls-keys".into(), controls.clone()));
    let device = ControllerStatus {
        device: Some("Radiomaster TX16S".into()),
        calibrated: true,
        dead_band: 0.05,
        expo: 0.3,
        sticks: [0.4, -0.2, 1.0, -1.0],
        note: "Kept in /home/anna/.config/spandrel/controllers/radiomaster-tx16s-1209-4f54.toml".into(),
        ..ControllerStatus::default()
    };
    controls.update_controls(device.clone());
    all.push(("controls-device".into(), controls.clone()));
    let axes = vec![(0, 0.3, (-0.9, 0.95)), (1, -0.2, (-1.0, 1.0))];
    controls.update_controls(ControllerStatus {
        wizard: Some("Push the LEFT stick fully UP and hold it there.".into()),
        axes,
        ..device
    });
    all.push(("calibrating".into(), controls));
    let mut tutorial = started();
    tutorial.press(KeyPress::Row(5));
    for page in 1..=6 {
        all.push((format!("tutorial-{page}"), tutorial.clone()));
        tutorial.press(KeyPress::Enter);
    }
    let mut paused = in_flight(Purpose::Practice);
    all.push(("flight".into(), paused.clone()));
    paused.handle_message(ToWindow::Paused { on: true });
    all.push(("paused".into(), paused.clone()));
    let mut leaving = in_flight(Purpose::Assessment);
    leaving.pause();
    all.push(("leaving".into(), leaving));
    paused.handle_message(ToWindow::Ended(ended()));
    all.push(("over".into(), paused));
    let mut settings = started();
    open(&mut settings, MenuAction::Settings);
    all.push(("settings".into(), settings.clone()));
    open(&mut settings, MenuAction::Keys);
    all.push(("keys".into(), settings.clone()));
    open(&mut settings, MenuAction::Key(3));
    all.push(("keys-awaiting".into(), settings));
    let mut briefed = started();
    briefed.handle_message(ToWindow::Offers(briefed_offers()));
    open(&mut briefed, MenuAction::CheckController);
    open(&mut briefed, MenuAction::Fly);
    all.push(("briefing".into(), briefed));
    all.extend(school_pages());
    all
}

/// Path of the picture in the tests of the defect school.
const SCHOOL_PICTURE: &str = "/tmp/1.png";

/// Returns a question of the defect school.
fn school_question() -> SchoolPage {
    SchoolPage {
        picture: Some(SCHOOL_PICTURE.into()),
        title: "Defect school: picture 3 of 10".into(),
        lines: vec![
            "Arch, reinforced concrete, element 144. The middle of a photograph at full resolution, taken from 3 m with the lamp on.".into(),
            "What is in the middle?".into(),
        ],
        answers: ["Delamination or spall", "Exposed rebar", "Efflorescence or rust staining", "Cracking", "Abrasion", "No defect can be seen from here"]
            .map(str::to_owned)
            .to_vec(),
        ..SchoolPage::default()
    }
}

/// Returns the pages of the defect school.
fn school_pages() -> Vec<(String, WindowFlow)> {
    let question = school_question();
    let lines = vec![
        "Wrong: this is not abrasion.".into(),
        "Spall: a hollow with a sharp edge. The concrete in it is lighter and rougher.".into(),
    ];
    let verdict = SchoolPage { lines, answers: Vec::new(), right: Some(false), ..question.clone() };
    let over = SchoolPage { picture: None, over: true, answers: Vec::new(), ..question.clone() };
    let shown = |name: &str, page: SchoolPage| {
        let mut flow = started();
        flow.press(KeyPress::Row(SCHOOL_ROW));
        flow.handle_message(ToWindow::School(page));
        (name.to_owned(), flow)
    };
    vec![shown("school-question", question), shown("school-verdict", verdict), shown("school-over", over)]
}

/// Row of the defect school on the start page.
const SCHOOL_ROW: usize = 6;

#[test]
fn exact_school_asks_until_the_trainee_leaves() {
    let mut flow = started();
    flow.press(KeyPress::Row(SCHOOL_ROW));
    let school = |request| vec![WindowRequest::Send(FromWindow::School(request))];
    assert_eq!(pending_requests(&mut flow), school(SchoolRequest::Begin(flow.choice().trainee.clone())));
    assert_eq!(flow.page(), Page::Waiting);
    flow.handle_message(ToWindow::School(school_question()));
    press(&mut flow, &[KeyPress::Down, KeyPress::Enter]);
    assert_eq!((flow.page(), pending_requests(&mut flow)), (Page::School, school(SchoolRequest::Answer(1))));
    flow.handle_message(ToWindow::School(SchoolPage { answers: Vec::new(), right: Some(true), ..school_question() }));
    flow.press(KeyPress::Enter);
    assert_eq!(pending_requests(&mut flow), school(SchoolRequest::Continue));
    flow.press(KeyPress::Escape);
    assert_eq!((flow.page(), pending_requests(&mut flow)), (Page::Start, school(SchoolRequest::Leave)));
    flow.handle_message(ToWindow::School(school_question()));
    assert_eq!(flow.page(), Page::Start, "a late page must not return");
}

/// Clicks the row with this action.
fn open(flow: &mut WindowFlow, action: MenuAction) {
    let row = flow.rows().iter().position(|row| row.action == action).unwrap();
    flow.press(KeyPress::Row(row));
}

/// Returns the offers with a long briefing.
fn briefed_offers() -> FlightOptions {
    let mut offers = offers();
    offers.scenarios[1].briefing = long_briefing();
    offers
}

/// Returns the same page with these units and this text size.
fn styled(flow: &WindowFlow, style: DisplayStyle) -> WindowFlow {
    let mut flow = flow.clone();
    flow.update_settings(SettingsStatus { style, ..settings() });
    flow
}

/// Returns the texts of a page with their rectangles: left, top, right, bottom, in units of the window's height.
fn text_places(page: &PageLayout, aspect: f64) -> Vec<([f64; 4], String)> {
    let of = |item: &DrawItem| match item {
        DrawItem::Text { place, side, height, words, .. } => {
            let wide = text_width(words, *height);
            let left = place.x * aspect
                - match side {
                    TextAlign::Left => 0.0,
                    TextAlign::Center => 0.5 * wide,
                    TextAlign::Right => wide,
                };
            Some(([left, place.y - 0.5 * height, left + wide, place.y + 0.5 * height], words.clone()))
        }
        DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
    };
    page.items.iter().filter_map(of).collect()
}

/// Window shapes: 1280x720, 1920x1080 and 3840x2160 px, 1000x1000 px, and some more.
const ASPECTS: [f64; 5] = [1.0, 4.0 / 3.0, 16.0 / 9.0, 1600.0 / 560.0, 1280.0 / 360.0];

/// Returns every text size in all units, and every language at normal text size.
fn tested_styles() -> Vec<DisplayStyle> {
    let styles = TextScale::ALL
        .into_iter()
        .flat_map(|text_scale| DisplayUnits::ALL.map(|units| DisplayStyle { units, text_scale, ..DisplayStyle::default() }));
    styles.chain(OTHER_LANGUAGES.map(|language| DisplayStyle { language, ..DisplayStyle::default() })).collect()
}

/// Languages besides English.
const OTHER_LANGUAGES: [Language; 3] = [Language::German, Language::Spanish, Language::Pseudo];

#[test]
fn prop_words_stay_apart_and_in_the_window_at_any_text_size() {
    let mut problems = Vec::new();
    for (name, flow) in every_page() {
        // Labels on the tutorial's pictures and the numbers of the display in them may cover each other.
        let may_overlap = name.starts_with("tutorial");
        for (style, aspect) in tested_styles().into_iter().flat_map(|style| ASPECTS.map(|aspect| (style, aspect))) {
            let flow = styled(&flow, style);
            let texts = text_places(&flow.sheet(aspect), aspect);
            let what = format!("{name}, {style:?}, aspect {aspect:.2}");
            for (k, (place, words)) in texts.iter().enumerate() {
                if place[0] < -0.005 || place[2] > aspect + 0.005 {
                    problems.push(format!("{what}: '{words}' at {place:?} leaves the window"));
                }
                for (other, over) in texts[..k].iter().filter(|_| !may_overlap) {
                    let gaps = [place[0] - other[2], other[0] - place[2], place[1] - other[3], other[1] - place[3]];
                    if gaps.iter().all(|gap| *gap < -1e-3) {
                        problems.push(format!("{what}: '{words}' overlaps '{over}'"));
                    }
                }
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn prop_the_focused_row_is_visible_and_everything_can_be_scrolled_to_at_any_text_size() {
    for (name, flow) in every_page() {
        for (text_scale, aspect) in TextScale::ALL.into_iter().flat_map(|scale| ASPECTS.map(|aspect| (scale, aspect))) {
            let mut flow = styled(&flow, DisplayStyle { text_scale, ..DisplayStyle::default() });
            let what = format!("{name}, {}%, aspect {aspect:.2}", text_scale.pct());
            if !flow.is_awaiting_key() {
                for _ in 0..flow.rows().len() {
                    flow.press(KeyPress::Down);
                    let page = flow.sheet(aspect);
                    let row = page.click_areas.iter().find(|area| area.press == KeyPress::Row(flow.focus)).unwrap();
                    assert!(row.from.y >= 0.0 && row.to.y <= 1.0, "{what}: row {} at {row:?}", flow.focus);
                }
            }
            flow.scroll(100.0, aspect);
            let bottom = flow.sheet(aspect).bottom();
            assert!(bottom <= 1.0 + 1e-9, "{what}: the page ends at {bottom}");
            flow.scroll(-100.0, aspect);
            let top = text_places(&flow.sheet(aspect), aspect).iter().map(|(place, _)| place[1]).fold(f64::INFINITY, f64::min);
            assert!(flow.page() == Page::Flight || top >= 0.0, "{what}: the page begins at {top}");
        }
    }
}

#[test]
fn prop_pages_without_scrolling_fit_in_german_and_spanish() {
    let mut problems = Vec::new();
    for (name, flow) in every_page() {
        for language in [Language::German, Language::Spanish] {
            let bottom = styled(&flow, DisplayStyle { language, ..DisplayStyle::default() }).sheet(16.0 / 9.0).bottom();
            if bottom > 1.0 + 1e-9 {
                problems.push(format!("{name}, {language:?}: the page ends at {bottom}"));
            }
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn exact_the_language_row_changes_the_language_of_all_pages() {
    let mut flow = started();
    let row = flow.rows().iter().position(|row| row.action == MenuAction::Setting(Setting::Language)).unwrap();
    assert_eq!((flow.rows()[row].label.as_str(), flow.rows()[row].value.as_str()), ("Language / Sprache / Idioma", "English"));
    for (language, name) in [(Language::German, "Deutsch"), (Language::Spanish, "Español"), (Language::English, "English")] {
        flow.press(KeyPress::Step(row, true));
        let style = DisplayStyle { language, ..DisplayStyle::default() };
        assert_eq!(pending_requests(&mut flow), [WindowRequest::ChangeSetting(SettingChange::Style(style))]);
        flow = styled(&flow, style);
        assert_eq!((flow.rows()[row].label.as_str(), flow.rows()[row].value.as_str()), ("Language / Sprache / Idioma", name));
    }
    let german = styled(&flow, DisplayStyle { language: Language::German, ..DisplayStyle::default() });
    assert!(words(&german).contains("Einstellungen") && words(&german).contains("2 Sitzungen"), "{}", words(&german));
    open(&mut flow, MenuAction::Settings);
    assert_eq!(flow.rows()[0].action, MenuAction::Setting(Setting::Language));
}

#[test]
fn exact_all_texts_of_the_pages_are_in_the_catalog() {
    // Other pages show texts of the user or of `spandrel train`.
    let is_tested = |name: &str| ["settings", "paused", "leaving", "flight"].contains(&name) || name.starts_with("tutorial");
    let pseudo = DisplayStyle { language: Language::Pseudo, ..DisplayStyle::default() };
    let pages: Vec<_> = every_page().into_iter().filter(|(name, _)| is_tested(name)).collect();
    assert_eq!(pages.len(), 10);
    for (name, flow) in pages {
        for line in words(&styled(&flow, pseudo)).lines() {
            // Names of keys stand in angle brackets, "Position" is the name of a flight mode; some letters have no accented form.
            let own = line.split('<').map(|part| part.split_once('>').map_or(part, |(_, rest)| rest)).collect::<String>();
            let letters = own
                .replace("Position", "")
                .replace("mph", "")
                .chars()
                .filter(|sign| sign.is_ascii_lowercase() && !"mqvx".contains(*sign))
                .count();
            assert!(letters <= 3, "{name}: '{line}' is not in the catalog");
        }
    }
}

/// Texts that are the same in every language: the product's name, the row of the language itself, and the name of a flight mode.
const SAME_IN_EVERY_LANGUAGE: [&str; 3] = ["Spandrel", "Language / Sprache / Idioma", "Position"];
/// Number of letters from which a word is checked: shorter ones are also units and parts of other words.
const WORD_LETTERS: usize = 4;

#[test]
fn exact_a_text_that_no_language_changes_is_one_of_the_user_or_of_the_training_program() {
    let shown = |flow: &WindowFlow, language| -> Vec<String> {
        let page = styled(flow, DisplayStyle { language, ..DisplayStyle::default() }).sheet(16.0 / 9.0);
        let words = |item: DrawItem| if let DrawItem::Text { words, .. } = item { Some(words) } else { None };
        page.items.into_iter().filter_map(words).collect()
    };
    let mut unknown = Vec::new();
    for (name, flow) in every_page() {
        // The state of the window holds only texts that it was sent.
        let sent = format!("{flow:?}");
        let english = shown(&flow, Language::English);
        for words in shown(&flow, Language::Pseudo).into_iter().filter(|words| english.contains(words)) {
            let is_fixed = SAME_IN_EVERY_LANGUAGE.iter().any(|same| words.contains(same));
            let mut plain = words.split(|sign: char| !sign.is_ascii_alphabetic()).filter(|word| word.len() >= WORD_LETTERS);
            if !is_fixed && plain.any(|word| !sent.contains(word)) {
                unknown.push(format!("{name}: '{words}' is not in the catalog"));
            }
        }
    }
    assert!(unknown.is_empty(), "{}", unknown.join("\n"));
}

#[test]
fn exact_a_notice_does_not_cover_the_focused_row() {
    for text_scale in TextScale::ALL {
        let mut flow = styled(&started(), DisplayStyle { text_scale, ..DisplayStyle::default() });
        open(&mut flow, MenuAction::Settings);
        open(&mut flow, MenuAction::Keys);
        for _ in 0..11 {
            flow.press(KeyPress::Down);
        }
        flow.show_notice("L: take off. The key was taken: land now has T.".to_owned());
        for aspect in ASPECTS {
            let page = flow.sheet(aspect);
            let row = page.click_areas.iter().find(|area| area.press == KeyPress::Row(11)).unwrap();
            let notice = text_places(&page, aspect).into_iter().find(|(_, words)| words.starts_with("L: take")).unwrap();
            assert!(row.from.y >= 0.0 && row.to.y <= notice.0[1], "{text_scale:?}, {aspect}: {row:?}, {notice:?}");
        }
    }
}

#[test]
fn exact_a_key_is_bound_after_enter_and_escape_cancels() {
    let mut flow = started();
    open(&mut flow, MenuAction::Settings);
    open(&mut flow, MenuAction::Keys);
    assert_eq!((flow.page(), flow.is_awaiting_key()), (Page::Keys { in_flight: false }, false));
    flow.bind_key(Some("x"));
    press(&mut flow, &[KeyPress::Down, KeyPress::Enter]);
    assert!(flow.is_awaiting_key() && words(&flow).contains("press a key"), "{}", words(&flow));
    flow.bind_key(None);
    assert!(flow.is_awaiting_key() && flow.notice().is_some_and(|words| words.contains("cannot be used")));
    flow.bind_key(Some("escape"));
    assert!(!flow.is_awaiting_key() && pending_requests(&mut flow).is_empty(), "nothing has changed yet");
    press(&mut flow, &[KeyPress::Enter]);
    flow.bind_key(Some("x"));
    assert!(!flow.is_awaiting_key());
    let wanted = WindowRequest::ChangeSetting(SettingChange::Key(1, "x".into()));
    assert_eq!(pending_requests(&mut flow), [wanted]);
    // A click elsewhere also cancels.
    press(&mut flow, &[KeyPress::Enter, KeyPress::Row(0)]);
    assert!(!flow.is_awaiting_key() && pending_requests(&mut flow).is_empty());
    open(&mut flow, MenuAction::RestoreKeys);
    assert_eq!(pending_requests(&mut flow), [WindowRequest::ChangeSetting(SettingChange::RestoreKeys)]);
    press(&mut flow, &[KeyPress::Escape, KeyPress::Escape]);
    assert_eq!(flow.page(), Page::Start);
}

#[test]
fn exact_pages_name_the_new_key_after_a_change() {
    let mut changed = settings();
    let lamp = changed.keys.iter_mut().find(|function| function.binding == "lamp").unwrap();
    lamp.key = "<new lamp key>".into();
    let mut seen = String::new();
    for (_, mut flow) in every_page() {
        flow.update_settings(changed.clone());
        seen.push_str(&words(&flow));
    }
    assert!(seen.contains("<new lamp key>") && !seen.contains("<lamp>"), "{seen}");
}

#[test]
fn exact_keys_of_a_file_on_the_command_line_are_shown_but_not_changed() {
    let mut flow = started();
    flow.update_settings(SettingsStatus { fixed_keys: Some("mine.toml".into()), ..settings() });
    open(&mut flow, MenuAction::Settings);
    open(&mut flow, MenuAction::Keys);
    for action in [MenuAction::Key(0), MenuAction::RestoreKeys] {
        open(&mut flow, action);
        assert!(!flow.is_awaiting_key() && pending_requests(&mut flow).is_empty(), "{action:?}");
        assert!(flow.notice().is_some_and(|words| words.contains("mine.toml")), "{action:?}");
    }
}

#[test]
fn exact_settings_change_in_steps_and_stop_at_the_ends() {
    let mut flow = started();
    open(&mut flow, MenuAction::Settings);
    let step = |flow: &mut WindowFlow, setting: Setting, on: bool| {
        let row = flow.rows().iter().position(|row| row.action == MenuAction::Setting(setting)).unwrap();
        flow.press(KeyPress::Step(row, on));
        let requests = pending_requests(flow);
        for request in &requests {
            if let WindowRequest::ChangeSetting(SettingChange::Style(style)) = request {
                flow.update_settings(SettingsStatus { style: *style, ..flow.settings.clone() });
            }
            if let WindowRequest::ChangeSetting(SettingChange::Sounds(sounds)) = request {
                flow.update_settings(SettingsStatus { sounds: *sounds, ..flow.settings.clone() });
            }
        }
        requests
    };
    for wanted in [125, 150, 200, 200] {
        step(&mut flow, Setting::TextScale, true);
        assert_eq!(flow.style().text_scale.pct(), wanted);
    }
    step(&mut flow, Setting::Units, true);
    assert_eq!(flow.style().units, DisplayUnits::UsCustomary);
    for wanted in [0.8, 0.9, 1.0, 1.0] {
        step(&mut flow, Setting::Volume, true);
        assert_eq!(flow.settings.sounds.volume, wanted);
    }
    let quality = |quality| vec![WindowRequest::ChangeSetting(SettingChange::Quality(quality))];
    assert_eq!(step(&mut flow, Setting::Quality, true), quality(Some("low")));
    assert_eq!(step(&mut flow, Setting::Quality, false), quality(None));
    assert_eq!(step(&mut flow, Setting::Sound, true), [WindowRequest::Sound(false)]);
}

#[test]
fn exact_settings_behind_a_pause_keep_the_flight_paused() {
    let mut flow = in_flight(Purpose::Practice);
    flow.handle_message(ToWindow::Paused { on: true });
    open(&mut flow, MenuAction::Settings);
    assert!(flow.page() == Page::Settings { in_flight: true } && flow.is_paused());
    open(&mut flow, MenuAction::Keys);
    assert!(flow.page() == Page::Keys { in_flight: true } && flow.is_paused());
    press(&mut flow, &[KeyPress::Escape, KeyPress::Escape]);
    assert!(flow.page() == Page::Paused && flow.is_paused() && pending_requests(&mut flow).is_empty());
}

#[test]
fn prop_pages_fit_windows_of_any_aspect_ratio() {
    for aspect in [4.0 / 3.0, 16.0 / 9.0, 1600.0 / 560.0, 1280.0 / 360.0] {
        for (name, flow) in every_page() {
            // The longest briefings are scrolled in windows that are not wide.
            if name == "briefing" && aspect < 1.5 {
                continue;
            }
            let sheet = flow.sheet(aspect);
            let inside = |p: &ScreenPoint| (-1e-9..=1.0 + 1e-9).contains(&p.x) && (-1e-9..=1.0 + 1e-9).contains(&p.y);
            for item in &sheet.items {
                let points: Vec<ScreenPoint> = match item {
                    DrawItem::Panel { from, to, .. } => vec![*from, *to],
                    DrawItem::Text { place, .. } => vec![*place],
                    DrawItem::Fill { points, .. } | DrawItem::Line { points, .. } => points.clone(),
                };
                assert!(points.iter().all(inside), "{name} at {aspect}: {item:?}");
            }
            assert!(sheet.click_areas.iter().all(|spot| inside(&spot.from) && inside(&spot.to)), "{name} at {aspect}");
            let is_known = |source: &PictureSource| match source {
                PictureSource::Embedded(name) => PICTURES.iter().any(|known| known.0 == *name),
                PictureSource::File(path) => path == SCHOOL_PICTURE,
                PictureSource::Job(job) => offers().scenarios.iter().any(|known| known.name == *job),
            };
            assert!(sheet.pictures.iter().all(|picture| is_known(&picture.source)), "{name}");
            assert!(
                flow.rows().is_empty() || sheet.click_areas.len() >= flow.rows().len(),
                "{name}: every row must be clickable"
            );
        }
    }
}

/// Returns all of a page's texts with their positions as percentages of the window.
fn words(flow: &WindowFlow) -> String {
    let line = |item: &DrawItem| match item {
        DrawItem::Text { place, words, .. } => Some(format!("{:3.0} {:3.0} {words}\n", 100.0 * place.x, 100.0 * place.y)),
        DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
    };
    flow.sheet(16.0 / 9.0).items.iter().filter_map(line).collect()
}

#[test]
fn regress_start_and_result_pages() {
    let (start, end) = (include_str!("snapshots/start.txt"), include_str!("snapshots/over.txt"));
    let mut over = in_flight(Purpose::Practice);
    over.handle_message(ToWindow::Ended(ended()));
    assert_eq!(words(&started()), start, "\n{}", words(&started()));
    assert_eq!(words(&over), end, "\n{}", words(&over));
}

/// Returns a briefing as long as the one of the paper's job.
fn long_briefing() -> JobBriefing {
    let repeated = |words: &str, count: usize| vec![words.to_owned(); count];
    JobBriefing {
        notes: repeated("Meet at the gate, and bring a vest.", 1),
        tasks: repeated(
            "3  Interlayer between deck and arch: 59 m long, 27 m above the pad, within 1.8 m of the path, lamp needed",
            4,
        ),
        hazards: repeated("Wind: 1.0 m/s. The wind changes or gusts during the flight. Expect turbulence behind piers.", 6),
        site_check: repeated("Battery: full. I land with at least 20%, and fly home at the low-battery warning (30%).", 3),
        conditions: repeated(
            "Aircraft: Phantom 2 class · Time: about 21 min needed, 30 min allowed · Sky: 40% clouds, sun 41° high",
            2,
        ),
        counts: repeated("Safety: touch nothing. A person or a vehicle that is hit ends the session.", 4),
        pictures: Vec::new(),
    }
}

#[test]
fn exact_a_flight_starts_only_after_the_briefing_is_acknowledged() {
    let mut flow = started();
    flow.handle_message(ToWindow::Offers(briefed_offers()));
    press(&mut flow, &[KeyPress::Down, KeyPress::Down, KeyPress::Down, KeyPress::Enter]);
    assert_eq!(flow.page(), Page::Controls);
    press(&mut flow, &[KeyPress::Enter]);
    assert_eq!((flow.page(), pending_requests(&mut flow)), (Page::Briefing, vec![]), "nothing starts yet");
    press(&mut flow, &[KeyPress::Escape]);
    assert_eq!(flow.page(), Page::Controls);
    press(&mut flow, &[KeyPress::Enter, KeyPress::Enter]);
    assert_eq!(flow.page(), Page::Waiting);
    let choice = flow.choice().clone();
    assert_eq!(pending_requests(&mut flow), acknowledged(choice));
}

#[test]
fn exact_a_printed_briefing_opens_in_the_browser_or_says_why_not() {
    let mut flow = opened();
    flow.handle_message(ToWindow::Offers(briefed_offers()));
    flow.handle_message(ToWindow::Briefing);
    open(&mut flow, MenuAction::PrintBriefing);
    let choice = flow.choice().clone();
    assert_eq!(pending_requests(&mut flow), [WindowRequest::Send(FromWindow::PrintBriefing(choice))]);
    flow.handle_message(ToWindow::OpenPage { address: "file:///a/briefing.html".into() });
    assert_eq!(pending_requests(&mut flow), [WindowRequest::Open("file:///a/briefing.html".into())]);
    flow.handle_message(ToWindow::Refused { words: "a picture is missing".into() });
    assert_eq!((flow.page(), flow.notice()), (Page::Briefing, Some("a picture is missing")));
}

/// Returns the messages with which the window starts a flight after its briefing.
fn acknowledged(choice: FlightChoice) -> [WindowRequest; 2] {
    [FromWindow::Acknowledged(choice.clone()), FromWindow::Chosen(choice)].map(WindowRequest::Send)
}

#[test]
fn exact_a_flight_from_the_command_line_begins_with_its_briefing() {
    let mut flow = opened();
    flow.handle_message(ToWindow::Offers(briefed_offers()));
    flow.handle_message(ToWindow::Briefing);
    assert_eq!((flow.page(), pending_requests(&mut flow)), (Page::Briefing, vec![]), "nothing starts yet");
    let choice = flow.choice().clone();
    press(&mut flow, &[KeyPress::Enter]);
    assert_eq!((flow.page(), pending_requests(&mut flow)), (Page::Waiting, acknowledged(choice).to_vec()));
    // A job without a briefing has nothing to acknowledge.
    let mut flow = started();
    flow.handle_message(ToWindow::Briefing);
    let choice = flow.choice().clone();
    assert_eq!(pending_requests(&mut flow), [WindowRequest::Send(FromWindow::Chosen(choice))]);
}

/// Returns offers with two aircraft, with the briefings for one of them.
fn offers_for(vehicle: &str) -> FlightOptions {
    let offer = |name: &str, title: &str| AircraftOffer { name: name.into(), title: title.into() };
    let mut offers = briefed_offers();
    offers.vehicles = vec![offer("phantom2", "Phantom 2 class"), offer("elios3", "Elios 3 class, caged")];
    for job in &mut offers.scenarios {
        (job.vehicle, job.conditions) = (vehicle.into(), format!("flown with {vehicle}"));
        job.briefing.conditions = vec![job.conditions.clone()];
    }
    offers
}

#[test]
fn exact_another_aircraft_needs_its_own_briefing_and_flies() {
    let request = |name: &str| WindowRequest::Send(FromWindow::Aircraft { name: name.into() });
    let mut flow = opened();
    flow.handle_message(ToWindow::Offers(offers_for("phantom2")));
    let row = flow.rows().iter().position(|row| row.action == MenuAction::Aircraft).unwrap();
    assert_eq!(flow.rows()[row].value, "Phantom 2 class");
    press(&mut flow, &[KeyPress::Row(row), KeyPress::Right]);
    assert_eq!(flow.choice().vehicle, "elios3");
    assert_eq!(pending_requests(&mut flow), [request("elios3")]);
    assert_eq!(flow.rows()[row].value, "Elios 3 class, caged");
    assert!(!words(&flow).contains("flown with"), "conditions of another aircraft: {}", words(&flow));
    // The briefing cannot be acknowledged before it is there.
    open(&mut flow, MenuAction::CheckController);
    press(&mut flow, &[KeyPress::Enter]);
    assert_eq!(flow.page(), Page::Briefing);
    assert!(words(&flow).contains("Preparing briefing") && !words(&flow).contains("flown with"), "{}", words(&flow));
    assert!(flow.rows().iter().all(|row| row.action != MenuAction::Acknowledge && row.action != MenuAction::PrintBriefing));
    assert_eq!(pending_requests(&mut flow), [], "one request is enough");
    flow.handle_message(ToWindow::Offers(offers_for("elios3")));
    assert!(words(&flow).contains("flown with elios3"), "{}", words(&flow));
    press(&mut flow, &[KeyPress::Enter]);
    let choice = flow.choice().clone();
    assert_eq!(choice.vehicle, "elios3");
    assert_eq!(pending_requests(&mut flow), acknowledged(choice));
}

#[test]
fn prop_the_latest_aircraft_gets_its_briefings_however_fast_it_is_chosen() {
    let request = |name: &str| WindowRequest::Send(FromWindow::Aircraft { name: name.into() });
    let mut flow = opened();
    flow.handle_message(ToWindow::Offers(offers_for("phantom2")));
    let row = flow.rows().iter().position(|row| row.action == MenuAction::Aircraft).unwrap();
    press(&mut flow, &[KeyPress::Row(row), KeyPress::Right, KeyPress::Right]);
    assert_eq!(pending_requests(&mut flow), [request("elios3")], "then back at the offered one");
    flow.handle_message(ToWindow::Offers(offers_for("elios3")));
    assert_eq!(pending_requests(&mut flow), [request("phantom2")], "the answer to the first request came late");
    flow.handle_message(ToWindow::Refused { words: "cannot read the file".into() });
    assert_eq!(pending_requests(&mut flow), [], "an aircraft that cannot be read is requested once");
}

/// Returns an assessment of a job that is not among the offers, as an instructor orders it.
fn ordered_flight() -> OrderedFlight {
    let (trainee, scenario) = ("bert".to_owned(), "from-server/windy.toml".to_owned());
    let choice = FlightChoice {
        trainee,
        scenario: scenario.clone(),
        purpose: Purpose::Assessment,
        by: FlownBy::Trainee,
        vehicle: "phantom2".into(),
    };
    let job = JobOffer {
        name: scenario,
        title: "Windy".into(),
        kind: "1 task".into(),
        conditions: String::new(),
        is_lesson: false,
        briefing: long_briefing(),
        vehicle: "phantom2".into(),
    };
    OrderedFlight { choice, job }
}

#[test]
fn exact_an_ordered_flight_needs_the_controller_check_and_the_briefing() {
    let mut flow = started();
    let order = ordered_flight();
    flow.handle_message(ToWindow::Ordered(order.clone()));
    assert_eq!(flow.page(), Page::Controls);
    assert!(flow.notice().is_some_and(|notice| notice.contains("bert: Windy (assessment)")));
    press(&mut flow, &[KeyPress::Enter]);
    assert_eq!(flow.page(), Page::Briefing);
    assert!(words(&flow).contains("Briefing: Windy"));
    assert_eq!(pending_requests(&mut flow), [], "nothing starts before the briefing is acknowledged");
    press(&mut flow, &[KeyPress::Enter]);
    assert_eq!(pending_requests(&mut flow), acknowledged(order.choice));
    assert_eq!(flow.page(), Page::Waiting);
}

#[test]
fn exact_a_trainee_who_goes_back_declines_the_ordered_flight_once() {
    let mut flow = started();
    flow.handle_message(ToWindow::Ordered(ordered_flight()));
    press(&mut flow, &[KeyPress::Enter, KeyPress::Escape]);
    assert_eq!((flow.page(), pending_requests(&mut flow)), (Page::Controls, vec![]));
    press(&mut flow, &[KeyPress::Escape]);
    assert_eq!((flow.page(), pending_requests(&mut flow)), (Page::Start, vec![WindowRequest::Send(FromWindow::Declined)]));
    open(&mut flow, MenuAction::CheckController);
    press(&mut flow, &[KeyPress::Escape]);
    assert_eq!(pending_requests(&mut flow), [], "the trainee's own choice");
}

#[test]
fn exact_an_ordered_flight_ends_the_school_and_the_calibration() {
    for (name, mut flow) in school_pages() {
        flow.handle_message(ToWindow::Ordered(ordered_flight()));
        let left = WindowRequest::Send(FromWindow::School(SchoolRequest::Leave));
        assert!(flow.page() == Page::Controls && pending_requests(&mut flow).contains(&left), "{name}");
    }
    let mut flow = started();
    open(&mut flow, MenuAction::CheckController);
    flow.update_controls(ControllerStatus { wizard: Some(String::new()), ..ControllerStatus::default() });
    flow.handle_message(ToWindow::Ordered(ordered_flight()));
    assert_eq!(pending_requests(&mut flow), [WindowRequest::Cancel]);
}

/// Returns the window's briefing page without and with drawings of the site.
fn briefings() -> [WindowFlow; 2] {
    briefings_of(briefed_offers())
}

fn briefings_of(offers: FlightOptions) -> [WindowFlow; 2] {
    let mut flow = started();
    flow.handle_message(ToWindow::Offers(offers));
    press(&mut flow, &[KeyPress::Down, KeyPress::Down, KeyPress::Down, KeyPress::Enter, KeyPress::Enter]);
    let scenario = scenario::read("job.toml", shipped::TWO_BRIDGES, &|file| Err(file.to_owned())).unwrap();
    let mut drawn = flow.clone();
    let job = drawn.job_to_draw().unwrap().to_owned();
    drawn.add_job_drawing(job, JobDrawing::new(&scenario, &Site::without_defects(&scenario)));
    [flow, drawn]
}

#[test]
fn prop_drawings_of_the_briefing_overlap_neither_each_other_nor_the_menu() {
    let [_, flow] = briefings();
    for aspect in [1.0, 4.0 / 3.0, 16.0 / 9.0, 21.0 / 9.0] {
        let panel = |item: &DrawItem| match item {
            DrawItem::Panel { from, to, color } => Some((*from, *to, *color)),
            DrawItem::Text { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
        };
        let panels: Vec<(ScreenPoint, ScreenPoint, HudColor)> = flow.sheet(aspect).items.iter().filter_map(panel).collect();
        let is_drawing = |panel: &&(ScreenPoint, ScreenPoint, HudColor)| panel.2 == HudColor::TextBackground;
        // The map and two bridges.
        assert_eq!(panels.iter().filter(is_drawing).count(), 3, "aspect {aspect}: {panels:?}");
        for drawing in panels.iter().filter(is_drawing) {
            let (from, to, _) = drawing;
            let apart =
                |(a, b, _): &(ScreenPoint, ScreenPoint, HudColor)| b.x <= from.x || to.x <= a.x || b.y <= from.y || to.y <= a.y;
            assert!(panels.iter().all(|other| other == drawing || apart(other)), "aspect {aspect}: {panels:?}");
            assert!(to.y - from.y > 0.03, "aspect {aspect}: {panels:?}");
        }
    }
}

#[test]
fn prop_briefing_is_complete_and_does_not_overlap_at_any_aspect_ratio() {
    let aspects = [1.0, 4.0 / 3.0, 16.0 / 9.0, 21.0 / 9.0];
    for (flow, aspect) in briefings().into_iter().flat_map(|flow| aspects.map(|aspect| (flow.clone(), aspect))) {
        let sheet = flow.sheet(aspect);
        let texts: Vec<(ScreenPoint, f64, String)> = sheet
            .items
            .iter()
            .filter_map(|item| match item {
                DrawItem::Text { place, height, words, .. } => Some((*place, *height, words.clone())),
                DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
            })
            .collect();
        let all: String = texts.iter().map(|(.., words)| words.as_str()).collect::<Vec<_>>().join(" ");
        let briefing = long_briefing();
        let (tasks, hazards) = (briefing.tasks.len(), briefing.hazards.len());
        assert_eq!((all.matches("Interlayer").count(), all.matches("Wind:").count()), (tasks, hazards), "aspect {aspect}: {all}");
        for (k, (a, height, words)) in texts.iter().enumerate() {
            let near = |(b, other, _): &&(ScreenPoint, f64, String)| {
                (a.y - b.y).abs() < 0.5 * (height + other) - 1e-9 && (a.x - b.x).abs() < 0.01
            };
            assert!(!texts[..k].iter().any(|one| near(&one)), "aspect {aspect}: '{words}' overlaps another line");
        }
    }
}

/// Returns the briefing pages with this number of the instructor's pictures: photographs, a panorama, and a portrait.
fn pictured(count: usize) -> [WindowFlow; 2] {
    let sizes = [(4000, 3000), (8000, 900), (3000, 4000), (1, 1), (800, 8000), (1024, 768)];
    let picture = |k: usize| BriefingImage {
        path: format!("/tmp/{k}.jpg"),
        caption: format!("Picture {k}: the gate, where you meet the inspector and put on the vest").repeat(1 + k % 3),
        size_px: sizes[k],
    };
    let mut offers = briefed_offers();
    offers.scenarios[1].briefing.pictures = (0..count).map(picture).collect();
    briefings_of(offers)
}

#[test]
fn prop_pictures_of_the_briefing_keep_their_shape_and_overlap_nothing() {
    let styles = TextScale::ALL.map(|text_scale| DisplayStyle { text_scale, ..DisplayStyle::default() });
    let shown = [1, 2, 4, 6].into_iter().flat_map(pictured).flat_map(|flow| styles.map(|style| styled(&flow, style)));
    for (flow, aspect) in shown.flat_map(|flow| ASPECTS.map(|aspect| (flow.clone(), aspect))) {
        let sheet = flow.sheet(aspect);
        let pictures = &flow.chosen_job().unwrap().briefing.pictures;
        let what = format!("{} pictures, {:?}, aspect {aspect:.2}", pictures.len(), flow.style().text_scale);
        let rect = |from: &ScreenPoint, to: &ScreenPoint| [from.x * aspect, from.y, to.x * aspect, to.y];
        let mut taken: Vec<[f64; 4]> = text_places(&sheet, aspect).into_iter().map(|(place, _)| place).collect();
        taken.extend(sheet.items.iter().filter_map(|item| match item {
            // The scroll bar is at the right edge of the window.
            DrawItem::Panel { from, to, .. } if to.x < 1.0 => Some(rect(from, to)),
            DrawItem::Panel { .. } | DrawItem::Text { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
        }));
        assert_eq!(sheet.pictures.len(), pictures.len(), "{what}");
        for (placed, picture) in sheet.pictures.iter().zip(pictures) {
            assert_eq!(placed.source, PictureSource::File(picture.path.clone()), "{what}");
            let [left, top, right, bottom] = rect(&placed.from, &placed.to);
            assert!(left >= 0.0 && right <= aspect, "{what}: {placed:?}");
            let ratio = (bottom - top) / (right - left);
            assert!((ratio / picture.height_ratio() - 1.0).abs() < 1e-6, "{what}: {placed:?}");
            let covers = |other: &[f64; 4]| left < other[2] && other[0] < right && top < other[3] && other[1] < bottom;
            assert!(!taken.iter().any(covers), "{what}: {placed:?}");
            taken.push([left, top, right, bottom]);
        }
    }
}

#[test]
fn prop_pages_with_pictures_can_be_scrolled_to_their_end() {
    for (mut flow, aspect) in pictured(6).into_iter().flat_map(|flow| ASPECTS.map(|aspect| (flow.clone(), aspect))) {
        // The buttons come first, so that they are seen before anybody scrolls.
        let first = flow.sheet(aspect);
        let visible = first.click_areas.iter().filter(|area| area.from.y >= 0.0 && area.to.y <= 1.0).count();
        assert!(first.bottom() > 1.0 && visible == flow.rows().len(), "aspect {aspect}: {visible} rows");
        flow.scroll(100.0, aspect);
        assert!(flow.sheet(aspect).bottom() <= 1.0 + 1e-9, "aspect {aspect}");
    }
}

#[test]
fn exact_large_map_is_for_practice_only_and_its_key_returns_to_the_layout_before() {
    let mut flow = started();
    let practice = offers().choice;
    flow.handle_message(flying(&practice));
    flow.arrangement = ViewLayout::SideBySide;
    flow.toggle_large_map(true);
    assert_eq!((flow.arrangement, flow.take_notice()), (ViewLayout::Map, None));
    flow.toggle_large_map(true);
    assert_eq!(flow.arrangement, ViewLayout::SideBySide);
    flow.toggle_large_map(false);
    assert_eq!(flow.arrangement, ViewLayout::SideBySide);
    assert!(flow.take_notice().is_some_and(|words| words.contains("--no-map")));
    flow.toggle_large_map(true);
    assert_eq!(flow.arrangement.next(), ViewLayout::Camera, "the key for the layouts leaves the map, too");
    flow.handle_message(flying(&FlightChoice { purpose: Purpose::Assessment, ..practice }));
    assert_eq!(flow.arrangement, ViewLayout::SideBySide, "the next flight begins without it");
    flow.toggle_large_map(true);
    assert_eq!(flow.arrangement, ViewLayout::SideBySide);
    assert!(flow.take_notice().is_some_and(|words| words.contains("assessment")));
}

#[test]
fn exact_ghost_is_for_practice_only() {
    let ghost = GhostFlight { telemetry: "a.tlog".into(), words: "the expert's flight".into() };
    let mut flow = in_flight(Purpose::Practice);
    pending_requests(&mut flow);
    assert_eq!(flow.ghost(), None);
    flow.explain_missing_ghost();
    assert!(flow.take_notice().is_some_and(|words| words.contains("not ready yet")));
    let ToWindow::Flying(started) = flying(flow.choice()) else { panic!("another message") };
    flow.handle_message(ToWindow::Flying(FlightStarted { is_ghost_outdated: true, ..started }));
    pending_requests(&mut flow);
    flow.explain_missing_ghost();
    assert!(flow.take_notice().is_some_and(|words| words.contains("this job has changed since")));
    flow.handle_message(ToWindow::Ghost(ghost.clone()));
    assert_eq!(pending_requests(&mut flow), [WindowRequest::LoadGhost("a.tlog".into())]);
    assert_eq!(flow.ghost(), Some(&ghost));
    let mut flow = in_flight(Purpose::Assessment);
    flow.handle_message(ToWindow::Ghost(ghost));
    assert_eq!(flow.ghost(), None);
    flow.explain_missing_ghost();
    assert_eq!(flow.take_notice().as_deref(), Some("No ghost in an assessment."));
}

#[test]
fn exact_result_of_a_lesson_shows_its_steps_and_no_scores() {
    for (done, title) in [(7, "7 of 11 steps of the lesson done"), (11, "Lesson done")] {
        let mut flow = in_flight(Purpose::Practice);
        let lesson = Some(LessonProgress { done, steps: 11 });
        flow.handle_message(ToWindow::Ended(FlightSummary { lesson, advice: Vec::new(), ..ended() }));
        let shown = words(&flow);
        assert!(shown.contains(title), "{shown}");
        assert!(SCORE_NAMES.iter().all(|name| !shown.contains(name)) && !shown.contains("overall"), "{shown}");
    }
}

#[test]
fn prop_texts_of_every_page_have_enough_contrast() {
    for (name, flow) in every_page() {
        for focus in 0..flow.rows().len().max(1) {
            let mut flow = flow.clone();
            flow.focus = focus;
            for aspect in [16.0 / 9.0, 1.0] {
                contrast::check(&flow.sheet(aspect).items, aspect, &format!("{name}, row {focus}, aspect {aspect:.2}"));
            }
        }
    }
}

#[test]
fn exact_the_lesson_needs_no_tutorial_before_it() {
    let mut options = offers();
    options.scenarios[0].is_lesson = true;
    let mut flow = opened();
    flow.handle_message(ToWindow::Offers(options));
    press(&mut flow, &[KeyPress::Right]);
    assert_eq!((flow.choice().trainee.as_str(), flow.choice().scenario.as_str()), ("bert", "two-bridges"));
    assert!(flow.needs_tutorial(), "a trainee without practice, before another job");
    let controls = |flow: &WindowFlow, scenario: &str| {
        let mut flow = flow.clone();
        flow.choice.scenario = scenario.into();
        open(&mut flow, MenuAction::CheckController);
        press(&mut flow, &[KeyPress::Enter]);
        flow.page()
    };
    assert_eq!(controls(&flow, "two-bridges"), Page::Tutorial(0, true));
    assert_eq!(controls(&flow, "drill-hover"), Page::Waiting, "the lesson begins at once");
}

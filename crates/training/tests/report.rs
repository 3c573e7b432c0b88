//! Tests of the session report: it must match the scorer, escape user-provided text, make no network requests and stay
//! small.
#![allow(clippy::unwrap_used, reason = "a test")]

use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::contract::hazards::{HazardReport, RadioMargins, WaterSensors};
use spandrel_mavlink::dialect::{
    BATTERY_STATUS_DATA, GLOBAL_POSITION_INT_DATA, GPS_RAW_INT_DATA, GpsFixType, MavMessage, WIND_COV_DATA,
};
use spandrel_mavlink::instructor_note;
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::frames::Vec3;
use spandrel_model::radio::RadioWay;
use spandrel_model::scenario::{BatteryModel, Scenario, SelectedForm, WindModel};
use spandrel_model::site::visibility::MAX_INCIDENCE_RAD;
use spandrel_model::site::wakes::WakeField;
use spandrel_model::site::wind::WindField;
use spandrel_model::time::SimTime;
use spandrel_monitor::assess_log;
use spandrel_monitor::sidecar::{MONITOR_COMPONENT_ID, build_site};
use spandrel_testkit::inspection::{phantom, record_inspection, two_bridges};
use spandrel_testkit::job::*;
use spandrel_text::Language;
use spandrel_training::cohort::{MeasureReliability, Selection, cohort};
use spandrel_training::marks::{TimelineMark, marks_key};
use spandrel_training::record::IncompletePolicy;
use spandrel_training::report::bridge_air::BridgeAir;
use spandrel_training::report::coverage::{REQUIRED_GSD_M, SurfaceOutcome};
use spandrel_training::report::disturbed_air::DisturbedAir;
use spandrel_training::report::feedback::KINDS;
use spandrel_training::report::formatting;
use spandrel_training::report::navigation_errors::NavigationErrors;
use spandrel_training::report::plots::air_section::AirPlane;
use spandrel_training::report::radio_losses::RadioLosses;
use spandrel_training::report::water_losses::WaterLosses;
use spandrel_training::report::{Jpeg, Review, SessionMetadata, page};
use spandrel_training::standing::SessionStanding;
use spandrel_training::terms::job_title;
use spandrel_training::testing::perfect_record;
use std::sync::OnceLock;

/// Maximum size of a report page, bytes.
const MAX_PAGE_BYTES: usize = 10_000_000;
/// Maximum flight time for the TASBID job, s.
const MAX_FLIGHT_S: f64 = 1500.0;

fn metadata() -> SessionMetadata {
    SessionMetadata {
        trainee: "anna".into(),
        started_utc: "2026-08-01T10:00:00Z".into(),
        folder: "a-session".into(),
        ..SessionMetadata::default()
    }
}

fn review(tape: &Tape, job: &Scenario) -> Review {
    Review::of(&tape.log(0), job, &phantom(), metadata()).expect("a session")
}

/// Returns the review of a 240 s flight of the TASBID job, computed once for all tests.
fn short_review() -> &'static Review {
    static SHORT_REVIEW: OnceLock<Review> = OnceLock::new();
    SHORT_REVIEW.get_or_init(|| review(&record_inspection(&two_bridges(), 240.0, 6), &two_bridges()))
}

/// Inserts an instructor's note in the middle of a tape.
fn with_note(mut tape: Tape, text: &str) -> Tape {
    let middle = tape.datagrams.len() / 2;
    tape.datagrams.insert(middle, instructor_note::encode(&mut Encoder::new(252, 192), 1, MONITOR_COMPONENT_ID, text));
    tape
}

#[test]
fn exact_instructor_note_is_reported_separately_from_messages() {
    let (tape, job) = (record_inspection(&two_bridges(), 200.0, 9), two_bridges());
    let plain = review(&tape, &job);
    assert_eq!(plain.feedback.notes, []);
    assert!(!page::session(&plain).contains("instructor's notes"));
    let review = review(&with_note(tape, "watch the pier"), &job);
    let [(t_s, text)] = review.feedback.notes.as_slice() else { panic!("{:?}", review.feedback.notes) };
    assert!(text == "watch the pier" && (20.0..180.0).contains(t_s), "{t_s}");
    assert_eq!(review.feedback.texts, plain.feedback.texts, "the note is not among the messages");
    let page = page::session(&review);
    assert!(page.contains("instructor's notes") && page.contains("note: watch the pier") && page.contains("class=\"note-dot\""));
}

/// Inserts a walk of the inspector, as the vehicle sends it, after a share of a tape.
fn with_walk(mut tape: Tape, share: f64, from_s: i32, places: i32) -> Tape {
    let at = (share * tape.datagrams.len() as f64) as usize;
    let rest = tape.datagrams.split_off(at);
    tape.int("walk", 10_000 * from_s + places);
    tape.datagrams.extend(rest);
    tape
}

/// The slab side of the arch bridge is hidden from the pad. From place 3, most of it is in sight.
#[test]
fn exact_walk_of_the_inspector_changes_only_the_time_out_of_sight() {
    let (tape, job) = (record_inspection(&two_bridges(), 240.0, 9), two_bridges());
    let plain = review(&tape, &job);
    let walked = review(&with_walk(tape, 0.1, 20, 13), &job);
    assert_eq!((&walked.assessment, &walked.frames), (&plain.assessment, &plain.frames), "scores do not depend on walks");
    let (before, after) = (plain.out_of_sight, walked.out_of_sight);
    assert!(before.total_s > 0.0 && after.total_s != before.total_s, "{before:?}, {after:?}");
    let inspector = walked.site.inspector();
    assert_eq!(inspector.at(walked.frames.last().unwrap().time).feet_m, job.ground_team.places_m[1]);
    let (plain, walked) = (page::session(&plain), page::session(&walked));
    let drawn = |page: &str| (page.matches("class=\"place\"").count(), page.matches("walks to place 3").count());
    assert_eq!((drawn(&plain), drawn(&walked)), ((4, 0), (4, 1)));
    assert!(walked.contains("Walks of the inspector: to place 3 at 0:") && !plain.contains("Walks of the inspector"));
}

/// Inserts a report of the GNSS receiver after a share of a tape.
fn with_gnss(mut tape: Tape, share: f64, has_fix: bool) -> Tape {
    let rest = tape.datagrams.split_off((share * tape.datagrams.len() as f64) as usize);
    let fix_type = if has_fix { GpsFixType::GPS_FIX_TYPE_3D_FIX } else { GpsFixType::GPS_FIX_TYPE_NO_FIX };
    let satellites_visible = if has_fix { 14 } else { 3 };
    tape.send(&MavMessage::GPS_RAW_INT(GPS_RAW_INT_DATA { fix_type, satellites_visible, ..GPS_RAW_INT_DATA::default() }));
    tape.datagrams.extend(rest);
    tape
}

/// Inserts an estimate of the autopilot after a share of a tape: at the origin of the site, heading north. Its clock is wrong, so that
/// it gets the time of the truth before it.
fn with_estimate(mut tape: Tape, share: f64) -> Tape {
    let rest = tape.datagrams.split_off((share * tape.datagrams.len() as f64) as usize);
    let origin = two_bridges().origin;
    tape.send(&MavMessage::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA {
        time_boot_ms: u32::MAX,
        lat: (origin.latitude_deg * 1e7).round() as i32,
        lon: (origin.longitude_deg * 1e7).round() as i32,
        alt: (origin.altitude_m * 1e3).round() as i32,
        hdg: 0,
        ..GLOBAL_POSITION_INT_DATA::default()
    }));
    tape.datagrams.extend(rest);
    tape
}

#[test]
fn exact_report_says_how_wrong_the_drones_own_position_was_and_when_gnss_was_lost() {
    let (tape, job) = (record_inspection(&two_bridges(), 240.0, 9), two_bridges());
    let plain = review(&tape, &job);
    assert_eq!(plain.navigation, NavigationErrors::default(), "without reports, there are no errors");
    let flown = review(&with_estimate(with_gnss(with_gnss(tape, 0.9, true), 0.6, false), 0.5), &job);
    assert_eq!((&flown.assessment, &flown.frames), (&plain.assessment, &plain.frames), "scores do not depend on estimates");
    let errors = flown.navigation;
    // A report counts for at most 3 s, and the next one is much later.
    assert!((errors.gnss_lost.total_s - 3.0).abs() < 1e-9 && errors.fewest_satellites == Some(3), "{errors:?}");
    let first = flown.frames[0].time.s();
    let late = |frame: &&Frame| frame.time.s() - first >= errors.position_m.at_s;
    let true_m = flown.frames.iter().find(late).unwrap().position_m;
    // The time of a frame is within 33 ms of the estimate's, at less than 6 m/s.
    assert!((errors.position_m.value - true_m.horizontal_norm()).abs() < 0.2, "{errors:?} {true_m:?}");
    assert!((errors.height_m.value - true_m.up().abs()).abs() < 0.2 && errors.height_m.value > 1.5, "{errors:?}");
    let pages = [&plain, &flown].map(page::session);
    assert!(pages[1].contains("No GNSS position for 0:03") && pages[1].contains("position was wrong by up to"));
    assert!(!pages[0].contains("No GNSS position") && !pages[0].contains("position was wrong"));
}

/// Inserts a report on the radio and one of the wind after a share of a tape. The wind blows toward the east.
fn with_radio(mut tape: Tape, share: f64, video_db: f64, losses: u32) -> Tape {
    let rest = tape.datagrams.split_off((share * tape.datagrams.len() as f64) as usize);
    let radio = RadioMargins { control_db: video_db + 20.0, video_db, way: RadioWay::AroundEdge, losses };
    tape.send(&HazardReport { radio: Some(radio), ..HazardReport::default() }.message(0));
    tape.send(&MavMessage::WIND_COV(WIND_COV_DATA { time_usec: u64::MAX, wind_y: 4.5, ..WIND_COV_DATA::default() }));
    tape.datagrams.extend(rest);
    tape
}

#[test]
fn exact_report_says_when_the_radio_was_weak_and_draws_the_wind() {
    let (tape, job) = (record_inspection(&two_bridges(), 240.0, 9), two_bridges());
    let plain = review(&tape, &job);
    assert_eq!((plain.radio, plain.has_wind()), (RadioLosses::default(), false), "without reports, there is nothing to say");
    let flown = review(&with_radio(with_radio(with_radio(tape, 0.9, 5.0, 2), 0.7, -1.0, 2), 0.5, -9.0, 0), &job);
    assert_eq!((&flown.assessment, &flown.frames), (&plain.assessment, &plain.frames), "scores do not depend on reports");
    // Each report counts for at most 1.5 s, and the next one is much later.
    let RadioLosses { video_poor, control_losses } = flown.radio;
    assert!((video_poor.total_s - 3.0).abs() < 1e-9 && control_losses == 2, "{:?}", flown.radio);
    let winds: Vec<(f64, f64)> = (0..flown.frames.len()).filter_map(|frame| flown.wind(frame)).collect();
    assert!(!winds.is_empty() && winds.iter().all(|wind| *wind == (4.5, 270.0)), "{winds:?}");
    let pages = [&plain, &flown].map(page::session);
    assert!(pages[1].contains("Video link poor for 0:03") && pages[1].contains("Control link lost 2 times."));
    assert!(!pages[0].contains("Video link") && !pages[0].contains("Control link"));
    let has_chart = |page: &str| (page.contains("id=\"chart-wind\""), page.contains("wind from (deg)"));
    assert_eq!((has_chart(&pages[0]), has_chart(&pages[1])), ((false, false), (true, true)));
}

/// Inserts a message after a share of a tape.
fn with_message(mut tape: Tape, share: f64, message: &MavMessage) -> Tape {
    let rest = tape.datagrams.split_off((share * tape.datagrams.len() as f64) as usize);
    tape.send(message);
    tape.datagrams.extend(rest);
    tape
}

#[test]
fn exact_report_says_when_and_where_the_bridges_disturbed_the_air() {
    let (tape, job) = (record_inspection(&two_bridges(), 240.0, 9), two_bridges());
    let plain = review(&tape, &job);
    assert_eq!(plain.air, DisturbedAir::default(), "older vehicles don't report the air");
    // The reports are inserted from the end, so that the shares hold.
    let added = [(0.8, 0.2), (0.7, 1.5), (0.6, 4.0), (0.5, 0.3)];
    let flown = added.iter().fold(tape, |tape, (share, east_m_s)| {
        let wake_m_s = Some(Vec3::new(0.0, -*east_m_s, 0.0));
        with_message(tape, *share, &HazardReport { wake_m_s, ..HazardReport::default() }.message(0))
    });
    let flown = review(&flown, &job);
    assert_eq!((&flown.assessment, &flown.frames), (&plain.assessment, &plain.frames), "scores do not depend on reports");
    let air = &flown.air;
    // A report counts for at most 1.5 s, and those below half a meter per second don't.
    assert!((air.time.total_s - 3.0).abs() < 1e-9 && (air.time.longest_s - 1.5).abs() < 1e-9, "{:?}", air.time);
    assert_eq!(air.places.iter().map(|place| place.added_m_s.east()).collect::<Vec<_>>(), [-4.0, -1.5]);
    let strongest = air.places[0];
    let frame = flown.frames.iter().find(|frame| frame.time.s() - flown.frames[0].time.s() >= strongest.at_s - 1e-9).unwrap();
    assert_eq!(frame.position_m, strongest.position_m);
    let words = strongest.zone.unwrap().words(&job, Language::English);
    let [plain, page] = [&plain, &flown].map(page::session);
    let moment = formatting::clock(strongest.at_s);
    let expected = format!("It was strongest at {moment}, {words}: 4.0 m/s different from the undisturbed wind.");
    assert!(page.contains("for 0:03; longest for 0:02") && page.contains(&expected), "{expected}");
    assert!(!plain.contains("different from the undisturbed wind") && page.contains("class=\"air-place\""));
    let list = page.split("class=\"air-places\"").nth(1).unwrap().split("</ol>").next().unwrap();
    assert_eq!(list.matches("class=\"moment-link\"").count(), 2, "{list}");
}

#[test]
fn exact_air_in_the_drawings_is_that_of_the_flights_model() {
    let review = short_review();
    let (job, site) = (&review.scenario, &review.site);
    assert!(job.hazards.wakes && review.site.members().len() > 10);
    let mut drawn = 0;
    for air in job.bridges.iter().filter_map(|bridge| BridgeAir::of(review, bridge)) {
        let mut wakes = WakeField::averaged(site.members(), &job.bridges);
        let mut disturbed = 0;
        for section in [&air.level, &air.across] {
            for arrow in section.arrows() {
                let at = arrow.position_m;
                let surface_up_m = site.ground_up_m(at.east(), at.north()).max(job.terrain.water_level_m);
                let mut wind = WindField::new(&job.wind, 1);
                wind.set_over_ground(surface_up_m > job.terrain.water_level_m);
                // The job's only event is a gust, which the mean excludes: it is over at this time.
                let free = wind.mean_velocity(SimTime::from_s(1.0), (at.up() - surface_up_m).max(0.3));
                wakes.advance(free, SimTime::ZERO);
                // An arrow at the water's edge stands for the air just above the surface.
                if at.up() < surface_up_m {
                    continue;
                }
                let expected = wakes.air(at, surface_up_m);
                assert!((arrow.air.velocity_m_s - (free + expected.velocity_m_s).enu()).norm() < 1e-9, "{arrow:?}");
                assert!((arrow.air.turbulence_m_s - expected.turbulence_m_s).abs() < 1e-9, "{arrow:?}");
                disturbed += usize::from(expected.velocity_m_s.norm() > 0.1);
                let (right, down) = section.extent(&arrow, air.speeds);
                // The same length for the same speed, in the direction of the air.
                let (scale, speed_m_s) = (air.speeds.top_m_s() / section.longest_arrow(), section.speed_m_s(&arrow.air));
                assert!(((right * right + down * down).sqrt() * scale - speed_m_s).abs() < 1e-9, "{arrow:?}");
                let (upward_m_s, is_upright) = (arrow.air.velocity_m_s.up(), section.plane == AirPlane::Across);
                assert!(!is_upright || (-down * scale - upward_m_s).abs() < 1e-9, "{arrow:?}");
            }
        }
        assert!(disturbed > 20, "{}: {disturbed}", air.bridge.name);
        drawn += 1;
    }
    assert!(drawn > 0, "the flight is near no bridge");
    let page = page::session(review);
    assert_eq!(page.matches("<path class=\"air-arrows\" d=\"M1 7").count(), drawn, "one legend for each bridge");
    assert_eq!(page.matches("<path class=\"air-arrows\"").count(), 3 * drawn);
    let start = page.find("Air around the bridges").unwrap();
    let bytes = page[start..].find("id=\"model\"").or_else(|| page[start..].find("class=\"strips\"")).unwrap();
    println!("{drawn} bridges, {bytes} bytes");
    assert!(bytes < 120_000 * drawn, "{bytes}");
}

#[test]
fn exact_report_has_no_air_without_wind_or_wakes() {
    let changes: [fn(&mut Scenario); 3] =
        [|job| job.wind.speed_m_s = 0.0, |job| job.hazards.wakes = false, |job| job.wind.model = WindModel::Paper];
    for change in changes {
        let mut job = two_bridges();
        change(&mut job);
        let review = review(&record_inspection(&job, 200.0, 9), &job);
        assert!(job.bridges.iter().all(|bridge| BridgeAir::of(&review, bridge).is_none()));
        assert!(!page::session(&review).contains("Air around the bridges"));
    }
}

#[test]
fn exact_report_says_how_sensors_failed_over_water() {
    let (tape, job) = (record_inspection(&two_bridges(), 240.0, 9), two_bridges());
    let report = |flow_lost, ranges, lost_ranges| {
        let water = Some(WaterSensors { flow_lost, ranges, lost_ranges });
        HazardReport { water, ..HazardReport::default() }.message(0)
    };
    let over = [(0.9, report(false, 130, 61)), (0.6, report(true, 90, 40)), (0.5, report(true, 30, 11))];
    let flown = review(&over.iter().fold(tape, |tape, (share, message)| with_message(tape, *share, message)), &job);
    let WaterLosses { flow_lost, ranges, lost_ranges } = flown.water;
    assert!((flow_lost.total_s - 3.0).abs() < 1e-9 && (ranges, lost_ranges) == (130, 61), "{:?}", flown.water);
    let page = page::session(&flown);
    assert!(page.contains("No optical flow over water for 0:03"), "time without flow");
    assert!(page.contains("The downward range finder failed in 61 of 130 readings over water."));
    assert!(!page::session(short_review()).contains("over water for") && short_review().water == WaterLosses::default());
}

#[test]
fn exact_report_says_what_a_cold_battery_cost() {
    let (tape, mut job) = (record_inspection(&two_bridges(), 240.0, 9), two_bridges());
    (job.rules.battery, job.rules.battery_temperature_c) = (BatteryModel::Physical, -5.0);
    let report = |cell_mv: u16, current_ca| {
        let mut voltages = [u16::MAX; 10];
        voltages[..3].fill(cell_mv);
        let battery_remaining = 80;
        MavMessage::BATTERY_STATUS(BATTERY_STATUS_DATA {
            voltages,
            current_battery: current_ca,
            battery_remaining,
            ..Default::default()
        })
    };
    let tape = with_message(with_message(tape, 0.6, &report(3500, 2000)), 0.5, &report(3800, 800));
    let flown = review(&tape, &job);
    let cold = flown.cold_battery.unwrap();
    let battery = &phantom().battery;
    let (present, warm) = (battery.resistance_ohm(-5.0), battery.internal_resistance_ohm);
    // The power of both reports at 25 °C, by the definition of the model: P = (OCV - I R) I.
    let warm_current = |voltage_v: f64, current_a: f64| {
        let open_v = voltage_v + present * current_a;
        (open_v - (open_v * open_v - 4.0 * warm * voltage_v * current_a).sqrt()) / (2.0 * warm)
    };
    let warm_a = [warm_current(10.5, 20.0), warm_current(11.4, 8.0)];
    assert!((cold.extra_charge - (28.0 / (warm_a[0] + warm_a[1]) - 1.0)).abs() < 1e-6 && cold.extra_charge > 0.01, "{cold:?}");
    let missing_v = 10.5 * 20.0 / warm_a[0] - 10.5;
    assert!((cold.missing_v - missing_v).abs() < 1e-6 && (cold.voltage_v - 10.5).abs() < 1e-9, "{cold:?} {missing_v}");
    let expected = format!("Cold battery (-5 °C): up to {missing_v:.1} V less than at 25 °C");
    assert!(page::session(&flown).contains(&expected), "{expected}");
    job.rules.battery = BatteryModel::Paper;
    assert_eq!(review(&tape, &job).cold_battery, None, "the paper's battery knows no cold");
}

#[test]
fn exact_marks_are_on_the_timeline_and_change_nothing_else() {
    let (tape, job) = (record_inspection(&two_bridges(), 200.0, 9), two_bridges());
    let mark = TimelineMark { t_s: 61.5, text: "turn the camera earlier".into(), by: "ida".into(), added_unix_us: 1 };
    let marks = vec![mark];
    let marked =
        Review::of(&tape.log(0), &job, &phantom(), SessionMetadata { marks: marks.clone(), ..metadata() }).expect("a session");
    let plain = review(&tape, &job);
    assert_eq!((&marked.assessment, &marked.advice), (&plain.assessment, &plain.advice));
    let (page, plain) = (page::session(&marked), page::session(&plain));
    assert!(page.contains("class=\"mark-dot\"") && page.contains("<title>mark: turn the camera earlier</title>"));
    assert!(page.contains("data-t=\"61.50\">1:02</a> turn the camera earlier"), "the list links to the moment");
    let key = format!("name=\"{}\" content=\"{}\"", page::MARKS_META_NAME, marks_key(&marks).unwrap());
    assert!(page.contains(&key) && !plain.contains(page::MARKS_META_NAME) && !plain.contains("Instructor's marks"));
}

#[test]
fn exact_the_first_section_has_the_personal_best_and_titles_of_drills() {
    let (tape, job) = (record_inspection(&two_bridges(), 200.0, 9), two_bridges());
    let standing = SessionStanding::new((2, 310.0, 400.0), &[(1, 340.0)]);
    let metadata = SessionMetadata { standing, language: Language::German, ..metadata() };
    let review = Review::of(&tape.log(0), &job, &phantom(), metadata).expect("a session");
    let page = page::session(&review);
    let better = page.split("id=\"better\"").nth(1).unwrap().split("</section>").next().unwrap();
    let best = "Persönliche Bestleistung bei diesem Auftrag: 340 von 400. Änderung seit dem letzten Mal: 30 Punkte weniger.";
    assert!(better.contains(best), "{better}");
    let next = page.split("id=\"next\"").nth(1).unwrap().split("<details").next().unwrap();
    let drills: Vec<&str> = review.advice.points.iter().map(|point| point.drill.as_str()).collect();
    assert!(!drills.is_empty() && !review.next.is_empty());
    for (section, drills) in [(better, drills), (next, review.next.iter().map(|step| step.scenario.as_str()).collect())] {
        for drill in drills {
            let title = job_title(drill, Language::German);
            assert!(title != drill && section.contains(&title) && !section.contains(&format!(">{drill}<")), "{drill}: {section}");
        }
    }
}

/// Returns the values of all attributes that cause a browser to load a resource.
fn resource_urls(page: &str) -> Vec<&str> {
    let starts = [" src=\"", " href=\"", " action=\"", " poster=\"", " data=\"", " srcset=\""];
    let values = |start: &'static str| page.split(start).skip(1).map(|rest| rest.split('"').next().unwrap_or_default());
    starts.into_iter().flat_map(values).collect()
}

/// Returns the page without scripts and styles, both Spandrel's and those of libraries.
fn without_assets(page: &str) -> String {
    use spandrel_training::report::assets::{
        COMMON_SCRIPT, COMPARE_SCRIPT, SCRIPT, STYLE, THREE_CORE_SCRIPT, THREE_SCRIPT, UPLOT_SCRIPT, UPLOT_STYLE,
    };
    [COMMON_SCRIPT, COMPARE_SCRIPT, SCRIPT, STYLE, THREE_SCRIPT, THREE_CORE_SCRIPT, UPLOT_SCRIPT, UPLOT_STYLE]
        .iter()
        .fold(page.to_owned(), |page, text| page.replacen(text, "", 1))
}

#[test]
fn exact_review_contains_scorer_assessment() {
    let (tape, job) = (record_inspection(&two_bridges(), 200.0, 9), two_bridges());
    let assessed_session = assess_log(&tape.log(0), &job, &phantom(), build_site).unwrap();
    let review = review(&tape, &job);
    assert_eq!(
        (&review.assessment, &review.frames, review.seed),
        (&assessed_session.assessment, &assessed_session.frames, assessed_session.seed)
    );
    let each = &assessed_session.assessment.snapshots.each;
    assert!(each.len() > 5, "the test requires several pictures");
    let verdicts: Vec<bool> = review
        .pictures
        .iter()
        .map(|picture| picture.verdict == spandrel_training::report::pictures::PictureVerdict::Hit)
        .collect();
    assert_eq!(verdicts, each.iter().map(|picture| picture.hit).collect::<Vec<_>>());
    let found = review.defects.iter().filter(|outcome| outcome.found_by.is_some()).count();
    assert_eq!(found, assessed_session.assessment.snapshots.defects_found);
    let missed: Vec<String> = review
        .defects
        .iter()
        .filter(|outcome| outcome.found_by.is_none())
        .map(|outcome| outcome.description(Language::English))
        .collect();
    assert!(
        missed.iter().all(|words| !words.is_empty())
            && review.defects.iter().all(|f| f.found_by.is_some() != f.best_approach.is_some())
    );
}

#[test]
fn exact_report_is_reproducible() {
    let job = two_bridges();
    let again = review(&record_inspection(&job, 240.0, 6), &job);
    assert_eq!(page::session(short_review()), page::session(&again));
}

#[test]
fn exact_page_makes_no_network_requests() {
    let page = without_assets(&page::session(short_review()));
    for value in resource_urls(&page) {
        let inside = value.starts_with('#') || value.starts_with("data:");
        assert!(inside, "{value}");
    }
    assert_eq!(page.matches("<script").count(), 7, "expected scripts: data, two for three.js, uPlot, three of Spandrel's own");
    assert!(!page.contains(" style=\"") && !page.contains(" onclick"), "the policy blocks styles and scripts in attributes");
    assert!(page.contains("Content-Security-Policy"));
}

#[test]
fn exact_user_text_is_escaped_everywhere() {
    const HOSTILE_TEXT: &str = "</script><script>alert(1)</script>\"'><img src=x onerror=alert(2)>{{7*7}}<!--";
    let mut job = two_bridges();
    job.title = HOSTILE_TEXT.into();
    for task in &mut job.tasks {
        task.name = HOSTILE_TEXT.into();
    }
    let metadata = SessionMetadata {
        trainee: HOSTILE_TEXT.into(),
        purpose: Some(HOSTILE_TEXT.into()),
        started_utc: HOSTILE_TEXT.into(),
        folder: HOSTILE_TEXT.into(),
        marks: vec![TimelineMark { t_s: 1.0, text: HOSTILE_TEXT.into(), by: HOSTILE_TEXT.into(), added_unix_us: 1 }],
        ..SessionMetadata::default()
    };
    let mut vehicle = phantom();
    vehicle.name = HOSTILE_TEXT.into();
    let tape = with_note(record_inspection(&job, 200.0, 9), HOSTILE_TEXT);
    let evil = Review::of(&tape.log(0), &job, &vehicle, metadata).unwrap();
    assert_eq!(evil.feedback.notes.len(), 1);
    for page in [page::session(&evil), page::comparison(&evil, short_review(), &[])] {
        let page = without_assets(&page);
        assert!(page.contains("alert(1)"), "the text should appear in escaped form");
        for raw in ["<script>alert", "<img src=x", "<!--"] {
            assert!(!page.contains(raw), "{raw}");
        }
        // The data block is JSON and contains quotes. Nothing else on the page contains a quote that could end an
        // attribute.
        let before = page.split("<script type=\"application/json\"").next().unwrap_or_default();
        assert!(!before.contains("\"'>"));
    }
}

#[test]
fn exact_defects_are_ringed_on_photographs() {
    let (job, tape) = (two_bridges(), record_inspection(&two_bridges(), 240.0, 6));
    let pictures = short_review().pictures.iter().filter_map(|picture| u32::try_from(picture.index).ok());
    let pictures: Vec<(u32, Jpeg)> = pictures.map(|index| (index, Jpeg { bytes: vec![0xff, 0xd8] })).collect();
    let review = Review::of(&tape.log(0), &job, &phantom(), SessionMetadata { pictures, ..metadata() }).unwrap();
    let page = page::session(&review);
    let seen = review.pictures.iter().flat_map(|picture| &picture.views).count();
    assert!(seen > 0, "the flight shows no defect");
    let mut ringed = 0;
    for picture in &review.pictures {
        let card = page.split(&format!("id=\"picture-{}\"", picture.number)).nth(1).unwrap().split("</li>").next().unwrap();
        assert!(card.contains("data:image/jpeg;base64,"), "{card}");
        ringed += card.matches("<g class=\"ring ").count();
        assert_eq!(card.matches("<g class=\"ring found\"").count(), picture.views.iter().filter(|view| view.hit).count());
    }
    assert_eq!(ringed, seen);
}

/// Returns the reliability from three people with two sessions each, of which only the safety varies.
fn reliability_of_safety() -> Vec<MeasureReliability> {
    let mut records = Vec::new();
    for (trainee, offset) in [("anna", 0.0), ("ben", 12.0), ("cleo", 25.0)] {
        for number in 1..=2 {
            let mut record = perfect_record(trainee, number);
            record.scores.safety = 50.0 + offset + number as f64 * (1.0 + 0.1 * offset);
            records.push(record);
        }
    }
    let selection = Selection { scenarios: Vec::new(), repetitions: 2, incomplete: IncompletePolicy::Exclude };
    cohort(&records, &selection).reliability
}

#[test]
fn exact_compared_changes_are_labeled_with_the_measurement_error() {
    let reliability = reliability_of_safety();
    let first = short_review();
    let mut second = review(&record_inspection(&two_bridges(), 240.0, 6), &two_bridges());
    second.assessment.scores.safety.pct -= 60.0;
    let page = page::comparison(first, &second, &reliability);
    // Only safety varies in the records, so it is the only labeled measure.
    assert_eq!((page.matches(">beyond error<").count(), page.matches(">within error<").count()), (1, 0));
    let page = page::comparison(first, first, &reliability);
    assert_eq!((page.matches(">beyond error<").count(), page.matches(">within error<").count()), (0, 1));
    let page = page::comparison(first, &second, &[]);
    assert!(!page.contains("beyond error") && page.contains("The changes are not labeled"));
}

#[test]
fn exact_comparison_names_different_forms_and_labels_only_equated_ones() {
    let reliability = reliability_of_safety();
    let on_form = |name: &str, detection: f64| {
        let mut review = review(&record_inspection(&two_bridges(), 240.0, 6), &two_bridges());
        let available = ["A", "B", "H"].map(str::to_owned).to_vec();
        review.scenario.form = Some(SelectedForm { name: name.into(), available });
        review.scenario.defects.mean_detection = Some(detection);
        // Each form has a checksum of its own.
        review.scenario.crc ^= u32::from(name.as_bytes()[0]);
        review
    };
    let (a, b, h) = (on_form("A", 0.95), on_form("B", 0.95), on_form("H", 0.25));
    let page = page::comparison(&a, &b, &reliability);
    assert!(page.contains("different forms: A and B, which are equally difficult") && page.contains(">within error<"));
    let page = page::comparison(&b, &h, &reliability);
    assert!(page.contains("different forms: B and H, which are not equally difficult"));
    assert!(!page.contains(">within error<") && !page.contains(">beyond error<"));
}

#[test]
fn exact_every_surface_area_has_one_outcome() {
    let coverage = &short_review().coverage;
    assert!(coverage.elements.len() > 3 && coverage.total().area_m2(SurfaceOutcome::Shown) > 0.0);
    for element in coverage.elements.values().chain([&coverage.total()]) {
        let sum: f64 = SurfaceOutcome::ALL.iter().map(|outcome| element.area_m2(*outcome)).sum();
        assert!((sum - element.inspectable_m2).abs() < 1e-6 * element.inspectable_m2, "{element:?}");
        assert!(
            element.pictured_m2() <= element.inspectable_m2 && element.area_m2(SurfaceOutcome::Shown) <= element.pictured_m2()
        );
        assert_eq!(element.average_picture().is_some(), element.pictured_m2() > 0.0);
        if let Some(like) = element.average_picture() {
            assert!(like.gsd_m <= REQUIRED_GSD_M && like.incidence_rad <= MAX_INCIDENCE_RAD && like.lux > 0.0, "{like:?}");
        }
    }
    let job = two_bridges();
    let more = review(&record_inspection(&job, 240.0, 2), &job);
    assert!(
        more.coverage.total().pictured_m2() > coverage.total().pictured_m2(),
        "three times as many pictures should show more surface"
    );
}

#[test]
fn exact_night_changes_only_light_outcomes() {
    let mut job = two_bridges();
    job.light.start_unix_s += 10 * 3600;
    let (day, night) = (short_review().coverage.total(), review(&record_inspection(&job, 240.0, 6), &job).coverage.total());
    for outcome in
        [SurfaceOutcome::TooOblique, SurfaceOutcome::TooFar, SurfaceOutcome::NotPhotographed, SurfaceOutcome::NeverInView]
    {
        assert!((night.area_m2(outcome) - day.area_m2(outcome)).abs() < 1e-6 * day.inspectable_m2, "{outcome:?}");
    }
    // The lamp lights the remaining surface; it is on only during the dark task.
    assert!(night.area_m2(SurfaceOutcome::Shown) < day.area_m2(SurfaceOutcome::Shown));
    assert!(night.area_m2(SurfaceOutcome::DarkLampOff) > day.area_m2(SurfaceOutcome::DarkLampOff));
    assert!(night.average_picture().unwrap().lux < day.average_picture().unwrap().lux);
}

/// On the tape, the forward stick moves by 0.01 of full travel per 100 ms, so it takes up to 1 s to move by 0.1.
#[test]
fn exact_speeding_cue_is_reported_with_reaction_time() {
    let job = scenario(vec![task(1, line((0.0, 0.0, 10.0), (90.0, 0.0, 10.0)), 3.0)]);
    let mut tape = Tape::of(&job);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.fly((30.0, 0.0, 10.0), 3.0);
    let fast_from_s = f64::from(tape.now_ms) / 1000.0;
    tape.fly((60.0, 0.0, 10.0), 6.0);
    let fast_to_s = f64::from(tape.now_ms) / 1000.0;
    tape.fly((90.0, 0.0, 10.0), 3.0);
    tape.land();
    let review = Review::of(&tape.log(0), &job, &vehicle(), metadata()).unwrap();
    let lift_off_s = review.frames[0].time.s();
    let speeding: Vec<_> = review.feedback.episodes.iter().filter(|e| KINDS[e.kind].name == "speeding").collect();
    assert_eq!(speeding.len(), 1, "{:?}", review.feedback.episodes);
    // Truth messages arrive every 20 ms. The cue stays on for a hold time after its cause ends.
    assert!((speeding[0].from_s + lift_off_s - fast_from_s).abs() <= 0.021, "{:?}", speeding[0]);
    assert!((-0.021..=2.5).contains(&(speeding[0].to_s + lift_off_s - fast_to_s)), "{:?}", speeding[0]);
    assert!(speeding[0].reaction_s.is_some_and(|s| s <= 1.1), "{:?}", speeding[0]);
    assert!(review.feedback.texts.iter().any(|(_, text)| text.starts_with("Too fast")));
    assert_eq!(speeding[0].task, Some(0));
}

#[test]
fn exact_empty_job_has_a_report() {
    let job = scenario(Vec::new());
    let mut tape = Tape::of(&job);
    tape.fly((0.0, 0.0, 5.0), 2.0);
    tape.hold_unrecorded(2500);
    tape.hold(1.0);
    tape.land();
    let review = Review::of(&tape.log(0), &job, &vehicle(), metadata()).unwrap();
    let page = page::session(&review);
    for words in [
        "No pictures were taken",
        "This job has no defects",
        "No contacts",
        "n/a",
        "Telemetry gaps longer than 0.2 s: 1",
        "no telemetry for",
    ] {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn exact_longest_flight_report_is_below_ten_megabytes() {
    let job = two_bridges();
    let review = review(&record_inspection(&job, MAX_FLIGHT_S - 20.0, 17), &job);
    assert!(review.pictures.len() >= 100, "{}", review.pictures.len());
    let size = page::session(&review).len();
    assert!(size < MAX_PAGE_BYTES, "{size}");
}

/// Returns the texts of all elements with a tag, without the tags inside.
fn element_texts(page: &str, tag: &str) -> Vec<String> {
    let (start, end) = (format!("<{tag}"), format!("</{tag}>"));
    let elements = page.split(&start).skip(1).filter(|rest| rest.starts_with([' ', '>']));
    let body = |rest: &str| {
        let element = rest.split(&end).next().unwrap_or_default();
        let pieces = element.split('<').map(|piece| piece.split_once('>').map_or(piece, |(_, text)| text));
        pieces.collect::<String>()
    };
    elements.map(body).collect()
}

/// Letters that the pseudo language does not change.
const UNCHANGED_LETTERS: &str = "mqvxMQVX";

/// Length of the longest unit in a sentence, such as `min`.
const LONGEST_UNIT: usize = 3;

/// Returns whether a text has a word without accents that is longer than a unit and not part of a member's name, which has slashes.
fn has_plain_word(text: &str) -> bool {
    let words = text.split_whitespace().filter(|piece| !piece.contains('/'));
    let letters = words.flat_map(|piece| piece.split(|letter: char| !letter.is_alphabetic()));
    letters.into_iter().any(|word| word.len() > LONGEST_UNIT && word.chars().all(is_plain))
}

/// Returns true for letters that do not occur in texts of the pseudo language.
fn is_plain(letter: char) -> bool {
    letter.is_ascii_alphabetic() && !UNCHANGED_LETTERS.contains(letter)
}

/// Returns the downloads of a page.
fn downloads(page: &str) -> Vec<&str> {
    page.split("href=\"data:text/csv").skip(1).map(|rest| rest.split('"').next().unwrap_or_default()).collect()
}

#[test]
fn exact_report_is_in_its_language_and_downloads_are_in_english() {
    let mut review = review(&record_inspection(&two_bridges(), 240.0, 6), &two_bridges());
    let english = without_assets(&page::session(&review));
    review.metadata.language = Language::German;
    let german = without_assets(&page::session(&review));
    for words in [
        "<html lang=\"de\">",
        "<title>Sitzungsbericht: anna",
        ">Besser machen</h2>",
        "Von oben, Norden oben",
        "zwischen den Aufgaben",
        "Tabelle: Wertungen",
        "\"play\":\"Abspielen\"",
    ] {
        assert!(german.contains(words) && !english.contains(words), "{words}");
    }
    assert_eq!(downloads(&german), downloads(&english));
    review.metadata.language = Language::Spanish;
    let spanish = without_assets(&page::session(&review));
    assert!(spanish.contains("<html lang=\"es\">") && spanish.contains(">Qué mejorar</h2>"));
    let comparison = without_assets(&page::comparison(&review, &review, &[]));
    assert!(comparison.contains("Comparación de sesiones") && comparison.contains("\"notFlying\":\"sin volar\""));
}

#[test]
fn exact_labels_of_a_report_are_in_the_catalog() {
    let mut review = review(&record_inspection(&two_bridges(), 240.0, 6), &two_bridges());
    review.metadata.language = Language::Pseudo;
    let session = without_assets(&page::session(&review));
    let comparison = without_assets(&page::comparison(&review, short_review(), &[]));
    // Names of the site and of tasks are the scenario's.
    let names = review.scenario.bridges.iter().map(|bridge| bridge.name.clone());
    let names = names.chain(review.scenario.tasks.iter().map(|task| task.name.clone()));
    // The header names the trainee, the time zone and the aircraft; advice names jobs by their files.
    let jobs = spandrel_model::shipped::SCENARIOS.iter().map(|(file, _)| file.trim_end_matches(".toml").to_owned());
    let names: Vec<String> = names.chain(["anna", "UTC", "Phantom 2 class"].map(str::to_owned)).chain(jobs).collect();
    for (page, tags) in [
        (session, ["h2", "h3", "p", "caption", "summary", "figcaption", "legend", "button", "dt", "nav"].as_slice()),
        (comparison, ["h2", "caption", "summary", "option", "label"].as_slice()),
    ] {
        for tag in tags {
            let texts = element_texts(&page, tag);
            assert!(!texts.is_empty(), "{tag}");
            for text in texts {
                let rest = names.iter().fold(text.clone(), |rest, name| rest.replace(name.as_str(), ""));
                let plain = if *tag == "p" { has_plain_word(&rest) } else { rest.contains(is_plain) };
                assert!(!plain, "{tag}: {text}");
            }
        }
    }
}

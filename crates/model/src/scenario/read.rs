//! Parses scenario files into [`Scenario`]. Defines each key with its unit, range and default.

use super::bridges::element_map::ElementMap;
use super::bridges::model::{MAX_MODEL_BYTES, Model};
use super::bridges::{Bridge, BridgeKind, BridgeType};
use super::defect_cause::DefectPlacement;
use super::job::{
    AfterCrash, BatteryModel, DefectSpec, Difficulty, FeedbackThresholds, GroundTeam, GuidancePolicy, HazardSpec, LightSpec,
    MAX_DEFECTS, Scenario, ScoringParams, SessionRules, TrafficSpec,
};
use super::names::read_name;
use super::point::point;
use super::siblings::{SiblingLoader, sibling_text};
use crate::defect_codes;
use crate::elements::Element;
use crate::geodesy::{Geo, LocalPlane};
use crate::math::M_S_PER_MPH;
use crate::satellites::{self, Almanac};
use crate::speed_unit::SpeedUnit;
use crate::stick_response::StickResponse;
use crate::time::SimTime;
use crate::toml::{DocumentedKey, Problems, Reader, Section};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Latest supported format version.
pub const FORMAT: i64 = 1;
/// Maximum number of bridges per site (estimate: far more than one flight can reach).
const MAX_BRIDGES: usize = 16;
/// Maximum length of a paragraph of the briefing, characters (estimate: longer ones belong in a document of their own).
const MAX_BRIEFING_CHARS: usize = 1_000;

/// Value of `hazards.almanac` for the orbits that ship with Spandrel.
const NOMINAL_ALMANAC: &str = "nominal";

/// Parses a scenario file. `file` is the file name used in messages.
///
/// # Errors
/// Returns all problems in the file, each with line, key, value and allowed range.
pub fn read(file: &str, text: &str, siblings: SiblingLoader) -> Result<Scenario, Problems> {
    read_with_keys(file, text, siblings).0
}

/// Parses a scenario file. Also returns the keys that were read, for the documentation test.
pub fn read_with_keys(
    file: &str,
    text: &str,
    siblings: SiblingLoader,
) -> (Result<Scenario, Problems>, BTreeMap<String, DocumentedKey>) {
    let (result, keys) = read_level(file, text, siblings);
    let levels = result.as_ref().ok().and_then(|scenario| scenario.difficulty.as_ref()).map(Difficulty::levels);
    let Some(levels) = levels else { return (result, keys) };
    let ends = super::difficulty::check_ends(file, text, levels, |text| read_level(file, text, siblings).0);
    (ends.and(result), keys)
}

/// Parses a scenario file at its selected difficulty level only.
fn read_level(file: &str, text: &str, siblings: SiblingLoader) -> (Result<Scenario, Problems>, BTreeMap<String, DocumentedKey>) {
    let mut reader = Reader::new(file, text);
    let scenario = reader.parse().map(|document| {
        let mut root = reader.root(&document);
        let mut scenario = read_scenario(&mut reader, &mut root, siblings);
        reader.finish(&root);
        scenario.crc = super::resolve::crc_with_files(text, siblings);
        scenario
    });
    let result = match scenario {
        Some(scenario) if reader.problems.is_empty() => Ok(scenario),
        _ => Err(Problems(reader.problems)),
    };
    (result, reader.documented_keys)
}

fn read_scenario(r: &mut Reader, root: &mut Section, siblings: SiblingLoader) -> Scenario {
    r.integer(root, "format", (1, FORMAT), None);
    let difficulty = super::difficulty::read(r, root);
    let name = read_name(r, root, "name");
    let title = r.text(root, "title", None);
    let briefing = read_briefing(r, root);
    let briefing_pictures = super::briefing_pictures::read(r, root);
    // The protocol transmits the seed in a signed 32-bit field.
    let seed = r.optional_integer(root, "seed", (0, i64::from(i32::MAX))).map(|seed| seed as u64);
    let origin = origin(r, root);
    let terrain = super::terrain::read(r, root, &LocalPlane::new(origin), siblings);
    let ground_team = ground_team(r, root);
    let bridges = read_bridges(r, root, siblings);
    if bridges.len() > MAX_BRIDGES {
        r.add_problem(root, "bridges", &bridges.len().to_string(), "at most 16 [[bridges]]", "too many");
    }
    let tasks = super::tasks::read(r, root, &bridges);
    let mut defects = defects(r, root);
    let form = super::forms::read(r, root, &mut defects);
    let lesson = super::lesson::read(r, root, (tasks.len(), super::tasks::MAX_TASKS), defects.number() > 0);
    let mut scenario = Scenario {
        name,
        title,
        briefing,
        briefing_pictures,
        seed,
        origin,
        terrain,
        ground_team,
        bridges,
        tasks,
        defects,
        form,
        difficulty: None,
        lesson,
        traffic: traffic(r, root),
        drones: super::drones::read(r, root),
        ropes: super::ropes::read(r, root),
        wind: super::weather::read(r, root),
        light: light(r, root),
        weather: super::weather::read_visible(r, root),
        rules: rules(r, root),
        hazards: hazards(r, root, siblings),
        feedback: feedback(r, root),
        scoring: scoring(r, root),
        certification: super::certification::read(r, root),
        crc: 0,
    };
    scenario.difficulty = difficulty.map(|table| table.finish(r, &scenario));
    scenario
}

/// Reads the instructor's words for the briefing.
fn read_briefing(r: &mut Reader, root: &mut Section) -> Vec<String> {
    let words = r.texts(root, "briefing");
    for paragraph in words.iter().filter(|paragraph| paragraph.chars().count() > MAX_BRIEFING_CHARS) {
        let length = format!("{} characters", paragraph.chars().count());
        r.add_problem(root, "briefing", &length, &format!("at most {MAX_BRIEFING_CHARS} characters a paragraph"), "too long");
    }
    words
}

fn origin(r: &mut Reader, root: &mut Section) -> Geo {
    let mut s = r.section(root, "origin");
    let geo = Geo {
        latitude_deg: r.number(&mut s, "latitude_deg", (-85.0, 85.0), None),
        longitude_deg: r.number(&mut s, "longitude_deg", (-180.0, 180.0), None),
        altitude_m: r.number(&mut s, "altitude_m", (-400.0, 5_000.0), None),
    };
    r.finish(&s);
    geo
}

fn ground_team(r: &mut Reader, root: &mut Section) -> GroundTeam {
    let mut s = r.section(root, "ground_team");
    let before = r.problems.len();
    let mut team = GroundTeam {
        pad_m: point(r, &mut s, "pad_m", None),
        pad_heading_deg: r.number(&mut s, "pad_heading_deg", (0.0, 360.0), Some(0.0)),
        pad_half_m: r.number(&mut s, "pad_half_m", (0.5, 5.0), Some(1.0)),
        inspector_m: point(r, &mut s, "inspector_m", None),
        places_m: Vec::new(),
        truck_m: point(r, &mut s, "truck_m", None),
        truck_heading_deg: r.number(&mut s, "truck_heading_deg", (0.0, 360.0), Some(0.0)),
        home_radius_m: r.number(&mut s, "home_radius_m", (1.0, 50.0), Some(5.0)),
    };
    let is_valid = r.problems.len() == before;
    team.places_m = super::places::read(r, &mut s, is_valid.then_some(&team));
    r.finish(&s);
    team
}

fn read_bridges(r: &mut Reader, root: &mut Section, siblings: SiblingLoader) -> Vec<Bridge> {
    let mut out: Vec<Bridge> = Vec::new();
    for mut s in r.sections(root, "bridges") {
        let bridge_name = read_name(r, &mut s, "name");
        if out.iter().any(|b| b.name == bridge_name) {
            r.add_problem(&s, "name", &bridge_name, "a unique name", "duplicate name");
        }
        let center_m = point(r, &mut s, "centre_m", None);
        let heading_deg = r.number(&mut s, "heading_deg", (0.0, 360.0), Some(90.0));
        let with_dimensions = BridgeKind::TYPES.iter().map(|bridge| (bridge.name, Some(bridge)));
        let types: Vec<_> = with_dimensions.chain([(Model::TYPE, None)]).collect();
        let before = r.problems.len();
        let bridge_type = r.keyword(&mut s, "type", &types, None);
        if r.problems.len() > before {
            // It is unknown which of the types' tables belongs to a bridge without a valid type, and which tasks it has.
            for (name, _) in &types {
                r.section(&mut s, name);
            }
            r.finish(&s);
            out.push(Bridge { name: bridge_name, center_m, heading_deg, kind: BridgeKind::Model(Model::default()) });
            continue;
        }
        let kind = match bridge_type {
            Some(bridge) => read_dimensions(r, &mut s, bridge),
            None => BridgeKind::Model(read_model(r, &mut s, siblings)),
        };
        r.finish(&s);
        out.push(Bridge { name: bridge_name, center_m, heading_deg, kind });
    }
    out
}

/// Reads the dimensions table of a bridge and checks that the dimensions are consistent with each other.
fn read_dimensions(r: &mut Reader, s: &mut Section, bridge: &BridgeType) -> BridgeKind {
    let mut s = r.section(s, bridge.name);
    let values: Vec<f64> = bridge.fields.iter().map(|f| r.number(&mut s, f.key, (f.min, f.max), Some(f.default))).collect();
    let kind = (bridge.create)(&values);
    for misfit in kind.inconsistencies() {
        r.add_problem(&s, misfit.key, &misfit.value.to_string(), &misfit.allowed, "inconsistent with other values");
    }
    r.finish(&s);
    kind
}

/// Reads an imported bridge from the files that its table names. Problems in the elements file have that file's name and lines.
fn read_model(r: &mut Reader, s: &mut Section, siblings: SiblingLoader) -> Model {
    let mut s = r.section(s, Model::TYPE);
    let before = r.problems.len();
    let file = r.text(&mut s, "file", None);
    let elements = r.text(&mut s, "elements", Some(""));
    r.describe_default(&s, "elements", "none");
    r.finish(&s);
    let map = if elements.is_empty() { ElementMap::default() } else { read_elements(r, &s, &elements, siblings) };
    if r.problems.len() > before {
        return Model::default();
    }
    siblings(&file).and_then(|bytes| Model::read(&file, &bytes, &map)).unwrap_or_else(|problem| {
        let allowed = format!("a file written by `spandrel import`, at most {MAX_MODEL_BYTES} bytes");
        r.add_problem(&s, "file", &file, &allowed, &problem);
        Model::default()
    })
}

fn read_elements(r: &mut Reader, s: &Section, file: &str, siblings: SiblingLoader) -> ElementMap {
    let text = match sibling_text(siblings, file) {
        Ok(text) => text,
        Err(problem) => {
            r.add_problem(s, "elements", file, "an elements file in the scenario's folder", &problem);
            return ElementMap::default();
        }
    };
    ElementMap::read(file, &text).unwrap_or_else(|Problems(problems)| {
        r.problems.extend(problems);
        ElementMap::default()
    })
}

fn defects(r: &mut Reader, root: &mut Section) -> DefectSpec {
    let mut s = r.section(root, "defects");
    let with_defects = Element::ALL.iter().filter(|element| !element.permitted_defects().is_empty());
    let elements: Vec<i64> = with_defects.map(|element| i64::from(element.number())).collect();
    let kinds: Vec<i64> = defect_codes::ALL.iter().copied().map(i64::from).collect();
    let defects = DefectSpec {
        count: r.integer(&mut s, "count", (0, MAX_DEFECTS as i64), Some(10)) as usize,
        placement: r.keyword(&mut s, "placement", &DefectPlacement::WORDS, Some(0)),
        size_factor: r.number(&mut s, "size_factor", (0.2, 5.0), Some(1.0)),
        elements: r.integers_among(&mut s, "elements", &elements).into_iter().map(|i| Element::from_number(i as u16)).collect(),
        kinds: r.integers_among(&mut s, "kinds", &kinds).into_iter().map(|i| i as u32).collect(),
        seed: r.optional_integer(&mut s, "seed", (0, i64::from(i32::MAX))).map(|seed| seed as u64),
        mean_detection: r.optional_number(&mut s, "detection_pct", super::forms::DETECTION_RANGE_PCT).map(|pct| pct / 100.0),
        line_count: r.optional_integer(&mut s, "lines", (0, MAX_DEFECTS as i64)).map(|lines| lines as usize),
        placed: super::resolve::read_placed_defects(r, &mut s),
    };
    if let Some(lines) = defects.line_count.filter(|lines| *lines > defects.count) {
        r.add_problem(&s, "lines", &lines.to_string(), "at most count", "too many");
    }
    r.finish(&s);
    defects
}

fn traffic(r: &mut Reader, root: &mut Section) -> TrafficSpec {
    let mut s = r.section(root, "traffic");
    let traffic = TrafficSpec {
        cars: r.integer(&mut s, "cars", (0, 400), Some(0)) as usize,
        trucks: r.integer(&mut s, "trucks", (0, 200), Some(0)) as usize,
        pedestrians: r.integer(&mut s, "pedestrians", (0, 400), Some(0)) as usize,
        car_speed_m_s: r.number(&mut s, "car_speed_m_s", (1.0, 35.0), Some(13.4)),
    };
    r.finish(&s);
    traffic
}

fn light(r: &mut Reader, root: &mut Section) -> LightSpec {
    let mut s = r.section(root, "light");
    let start = r.text(&mut s, "start_utc", Some("2026-06-21T10:00:00Z"));
    let start_unix_s = super::weather::parse_unix_s(&start).unwrap_or_else(|| {
        r.add_problem(&s, "start_utc", &start, "YYYY-MM-DDTHH:MM:SSZ", "not a UTC time");
        0
    });
    let light = LightSpec {
        start_unix_s,
        cloud_cover: r.number(&mut s, "cloud_cover", (0.0, 1.0), Some(0.2)),
        water_albedo: r.number(&mut s, "water_albedo", (0.0, 1.0), Some(0.08)),
        ground_albedo: r.number(&mut s, "ground_albedo", (0.0, 1.0), Some(0.25)),
    };
    r.finish(&s);
    light
}

fn rules(r: &mut Reader, root: &mut Section) -> SessionRules {
    let mut s = r.section(root, "rules");
    let after = [("continue", AfterCrash::Continue), ("respawn", AfterCrash::Respawn), ("end", AfterCrash::End)];
    let rules = SessionRules {
        after_crash: r.keyword(&mut s, "after_crash", &after, Some(1)),
        battery: r.keyword(&mut s, "battery", &[("paper", BatteryModel::Paper), ("physical", BatteryModel::Physical)], Some(0)),
        low_battery_return: r.boolean(&mut s, "low_battery_return", false),
        low_battery_pct: r.number(&mut s, "low_battery_pct", (1.0, 90.0), Some(30.0)),
        critical_battery_pct: r.number(&mut s, "critical_battery_pct", (0.0, 50.0), Some(10.0)),
        battery_temperature_c: r.number(&mut s, "battery_temperature_c", (-20.0, 45.0), Some(25.0)),
        gnss_shadow: r.boolean(&mut s, "gnss_shadow", false),
        respawn_after: SimTime::from_s(r.number(&mut s, "respawn_after_s", (0.5, 60.0), Some(3.0))),
        stick_response: r.keyword(&mut s, "stick_response", &StickResponse::ALL, Some(0)),
    };
    if rules.critical_battery_pct > rules.low_battery_pct {
        let critical = rules.critical_battery_pct.to_string();
        r.add_problem(&s, "critical_battery_pct", &critical, "at most low_battery_pct", "too large");
    }
    r.finish(&s);
    rules
}

fn hazards(r: &mut Reader, root: &mut Section, siblings: SiblingLoader) -> HazardSpec {
    let mut s = r.section(root, "hazards");
    let hazards = HazardSpec {
        compass: r.boolean(&mut s, "compass", false),
        wakes: r.boolean(&mut s, "wakes", false),
        water: r.boolean(&mut s, "water", false),
        sky: r.boolean(&mut s, "sky", false),
        almanac: read_almanac(r, &mut s, siblings),
        radio: r.boolean(&mut s, "radio", false),
        severity: r.number(&mut s, "severity", HazardSpec::SEVERITY_RANGE, Some(1.0)),
    };
    r.finish(&s);
    hazards
}

/// Reads the almanac file that the job names. Its own problems have the almanac's name and lines.
fn read_almanac(r: &mut Reader, s: &mut Section, siblings: SiblingLoader) -> Option<Arc<Almanac>> {
    let file = r.text(s, "almanac", Some(NOMINAL_ALMANAC));
    if file == NOMINAL_ALMANAC {
        return None;
    }
    let text = match sibling_text(siblings, &file) {
        Ok(text) => text,
        Err(problem) => {
            r.add_problem(s, "almanac", &file, "nominal, or a YUMA almanac file in the scenario's folder", &problem);
            return None;
        }
    };
    match satellites::read(&file, &text) {
        Ok(almanac) => Some(Arc::new(almanac)),
        Err(Problems(problems)) => {
            r.problems.extend(problems);
            None
        }
    }
}

fn feedback(r: &mut Reader, root: &mut Section) -> FeedbackThresholds {
    let mut s = r.section(root, "feedback");
    let mut n = |key: &'static str, range: (f64, f64), default: f64| r.number(&mut s, key, range, Some(default));
    let feedback = FeedbackThresholds {
        too_close_m: n("too_close_m", (0.2, 20.0), 2.5),
        too_close_clear_m: n("too_close_clear_m", (0.2, 25.0), 2.8),
        off_path_max_m: n("off_path_max_m", (1.0, 50.0), 8.0),
        off_path_delay: SimTime::from_s(n("off_path_after_s", (0.0, 10.0), 1.0)),
        off_path_hold_time: SimTime::from_s(n("off_path_hold_s", (0.0, 10.0), 2.0)),
        leave_delay: SimTime::from_s(n("leave_after_s", (0.5, 30.0), 2.0)),
        visit_delay: SimTime::from_s(n("visit_after_s", (0.0, 30.0), 3.0)),
        speeding_margin: n("speeding_margin_pct", (0.0, 100.0), 5.0) / 100.0,
        speeding_hold_time: SimTime::from_s(n("speeding_hold_s", (0.0, 10.0), 1.0)),
        battery_green_pct: n("battery_green_pct", (1.0, 100.0), 70.0),
        battery_yellow_pct: n("battery_yellow_pct", (1.0, 100.0), 30.0),
        text_interval: SimTime::from_s(n("text_interval_s", (0.5, 60.0), 2.0)),
        guidance: r.keyword(
            &mut s,
            "guidance",
            &[("always", GuidancePolicy::Always), ("practice", GuidancePolicy::Practice), ("never", GuidancePolicy::Never)],
            Some(1),
        ),
    };
    if feedback.too_close_clear_m < feedback.too_close_m {
        r.add_problem(
            &s,
            "too_close_clear_m",
            &feedback.too_close_clear_m.to_string(),
            "at least too_close_m",
            "the warning would never clear",
        );
    }
    if feedback.battery_yellow_pct > feedback.battery_green_pct {
        let yellow = feedback.battery_yellow_pct.to_string();
        r.add_problem(&s, "battery_yellow_pct", &yellow, "at most battery_green_pct", "too large");
    }
    r.finish(&s);
    feedback
}

/// Reads the speed limit in m/s, and the unit in which the file states it.
fn speed_limit(r: &mut Reader, s: &mut Section) -> (f64, SpeedUnit) {
    let limit_mph = r.number(s, "speed_limit_mph", (1.0, 60.0), Some(10.0));
    match r.optional_number(s, "speed_limit_m_s", (0.4, 27.0)) {
        None => (limit_mph * M_S_PER_MPH, SpeedUnit::MilesPerHour),
        Some(limit_m_s) => {
            if s.has("speed_limit_mph") {
                r.add_problem(s, "speed_limit_m_s", &limit_m_s.to_string(), "only one of the two", "speed_limit_mph is also set");
            }
            (limit_m_s, SpeedUnit::MetersPerSecond)
        }
    }
}

fn scoring(r: &mut Reader, root: &mut Section) -> ScoringParams {
    let mut s = r.section(root, "scoring");
    let (speed_limit_m_s, speed_limit_unit) = speed_limit(r, &mut s);
    let mut n = |key: &'static str, range: (f64, f64), default: f64| r.number(&mut s, key, range, Some(default));
    let frame_rate_hz = n("frame_rate_hz", (10.0, 120.0), 30.0);
    let max_speed_mph = n("max_speed_mph", (2.0, 100.0), 30.0);
    let (time_best_min, time_max_min) = (n("time_best_min", (0.1, 120.0), 15.0), n("time_max_min", (0.2, 240.0), 25.0));
    let scoring = ScoringParams {
        frame_rate_hz,
        speed_limit_m_s,
        speed_limit_unit,
        max_speed_m_s: max_speed_mph * M_S_PER_MPH,
        time_best_s: 60.0 * time_best_min,
        time_max_s: 60.0 * time_max_min,
        beta: n("beta", (0.0, f64::INFINITY), 1.0),
        clearance_m: n("clearance_m", (0.1, 20.0), 2.0),
        task_completion_fraction: n("task_done_pct", (1.0, 100.0), 80.0) / 100.0,
        exact_path: r.boolean(&mut s, "exact_path", false),
    };
    if scoring.max_speed_m_s <= speed_limit_m_s {
        let allowed = format!("more than the speed limit, which is {}", speed_limit_unit.format_limit(speed_limit_m_s));
        r.add_problem(&s, "max_speed_mph", &max_speed_mph.to_string(), &allowed, "too small");
    }
    if time_max_min <= time_best_min {
        let allowed = format!("more than time_best_min, which is {time_best_min}");
        r.add_problem(&s, "time_max_min", &time_max_min.to_string(), &allowed, "too small");
    }
    r.finish(&s);
    scoring
}

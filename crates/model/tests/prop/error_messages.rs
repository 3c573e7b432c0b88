//! Error messages for typical mistakes in a scenario file, one mistake per test.

use spandrel_model::toml::Problems;
use std::path::Path;

fn shipped_scenario() -> String {
    std::fs::read_to_string(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("scenarios/two-bridges.toml")).unwrap()
}

fn read_problems(text: &str) -> Problems {
    let result = spandrel_model::scenario::read("job.toml", text, &|name| Err(format!("no file {name}")));
    result.err().unwrap_or(Problems(Vec::new()))
}

/// Returns the line index and the key of each line that sets a key.
fn key_lines(text: &str) -> Vec<(usize, String)> {
    let key = |(k, line): (usize, &str)| line.split_once(" = ").map(|(key, _)| (k, key.to_string()));
    text.lines().enumerate().filter(|(_, line)| !line.starts_with('#')).filter_map(key).collect()
}

fn replace_line(text: &str, at: usize, new: Option<&str>) -> String {
    let lines = text.lines().enumerate();
    lines.filter_map(|(k, line)| if k == at { new } else { Some(line) }).collect::<Vec<_>>().join("\n")
}

#[test]
fn prop_misspelled_keys_are_reported_with_line_and_suggestion() {
    let text = shipped_scenario();
    for (at, key) in key_lines(&text) {
        let line = text.lines().nth(at).unwrap();
        // Repeating the last letter never yields another valid key.
        let wrong = format!("{key}{}", key.chars().last().unwrap());
        let problems = read_problems(&replace_line(&text, at, Some(&line.replacen(&key, &wrong, 1))));
        let suggestion = format!("unknown key; did you mean {key}?");
        let named = problems.0.iter().any(|p| p.line == at + 1 && p.key.ends_with(&wrong) && p.message == suggestion);
        assert!(named, "line {}: {wrong}: {problems}", at + 1);
    }
}

#[test]
fn prop_only_missing_required_keys_are_reported() {
    let text = shipped_scenario();
    let siblings = |_: &str| Err(String::new());
    let asked = spandrel_model::scenario::read_with_keys("job.toml", &text, &siblings).1;
    let mut required = 0;
    for (at, key) in key_lines(&text) {
        let section = text.lines().take(at).filter(|l| l.starts_with('[')).last().unwrap_or("");
        let prefix = section.replace("[[", "").replace("]]", "[].").replace('[', "").replace(']', ".");
        let prefix = if section.starts_with("[[") { section[2..section.len() - 2].to_string() + "[]." } else { prefix };
        let path = format!("{prefix}{key}");
        let is_required = asked[&path].default == "required";
        let found = read_problems(&replace_line(&text, at, None));
        let named = found.0.iter().any(|p| p.key == path && p.message == "missing");
        assert_eq!(named, is_required, "{path}: {found}");
        required += usize::from(is_required);
    }
    assert!(required > 20, "{required} required keys");
}

#[track_caller]
fn assert_message(from: &str, to: &str, expected: &str) {
    let text = shipped_scenario();
    assert!(text.contains(from), "{from}");
    assert_eq!(read_problems(&text.replacen(from, to, 1)).to_string(), expected);
}

#[test]
fn regress_unknown_key_is_reported_with_a_suggestion() {
    assert_message(
        "cloud_cover = 0.9",
        "cloud_covr = 0.9",
        "job.toml:92: light.cloud_covr = 0.9: unknown key; did you mean cloud_cover? \
         (allowed: start_utc, cloud_cover, water_albedo, ground_albedo)",
    );
}

#[test]
fn regress_number_out_of_range_is_reported() {
    assert_message(
        "latitude_deg = 46.7052",
        "latitude_deg = 467.052",
        "job.toml:7: origin.latitude_deg = 467.052: out of range (allowed: -85 to 85)",
    );
}

#[test]
fn regress_wrong_type_is_reported() {
    assert_message(
        "altitude_m = 430.0",
        "altitude_m = \"high\"",
        "job.toml:9: origin.altitude_m = \"high\": not a number (allowed: -400 to 5000)",
    );
    assert_message(
        "pad_m = [-112.0, 78.0, 5.0]",
        "pad_m = [-112.0, 78.0]",
        "job.toml:23: ground_team.pad_m = [-112.0, 78.0]: not a valid list (allowed: 3 numbers, each -5000 to 5000)",
    );
}

#[test]
fn exact_wrong_places_of_the_inspector_are_reported() {
    let problems = |list: &str| {
        let text = shipped_scenario();
        let old = text.lines().find(|line| line.starts_with("places_m")).unwrap();
        let text = text.replace(old, &format!("places_m = {list}"));
        read_problems(&text).0.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let head = "job.toml:27: ground_team.places_m = ";
    let many = format!("[{}]", (0..8).map(|k| format!("[-130.0, {}.0, 5.0]", 10 * k)).collect::<Vec<_>>().join(", "));
    assert_eq!(problems(&many), [format!("{head}8 places: too many (allowed: at most 7 places)")]);
    assert_eq!(
        problems("[[-112.0, 579.0, 5.0], [-110.6, 78.0, 5.0], [-118.0, 75.0, 5.0], [-130.0, 70.0, 9.0], [-130.0, 71.0, 5.0]]"),
        [
            format!("{head}[-112, 579, 5]: place 2 is 501 m from the landing pad (allowed: at most 500 m from the landing pad)"),
            format!(
                "{head}[-110.6, 78, 5]: place 3 is on the landing pad (allowed: at least 0.5 m from the edge of the landing pad)"
            ),
            format!("{head}[-118, 75, 5]: place 4 is 1.0 m from place 1 (allowed: at least 2 m from every other place)"),
            format!("{head}[-130, 71, 5]: place 6 is 1.0 m from place 5 (allowed: at least 2 m from every other place)"),
        ]
    );
    let shape = "not a valid list (allowed: list of [east, north, up], each -5000 to 5000)";
    assert_eq!(problems("[-130.0, 70.0, 9.0]"), [format!("{head}[-130.0, 70.0, 9.0]: {shape}")]);
}

#[test]
fn regress_missing_key_is_reported() {
    assert_message("longitude_deg = 8.3814\n", "", "job.toml:6: origin.longitude_deg: missing (allowed: -180 to 180)");
}

#[test]
fn regress_unknown_bridge_is_reported() {
    assert_message(
        "bridge = \"suspension\"",
        "bridge = \"suspenson\"",
        "job.toml:65: tasks[].bridge = suspenson: unknown bridge (allowed: a bridge in this file: arch, suspension)",
    );
}

#[test]
fn regress_elements_and_kinds_without_defects_are_reported() {
    let problems = |keys: &str| {
        let text = shipped_scenario();
        assert!(text.contains("[defects]\ncount = 10\n"));
        let text = text.replace("[defects]\ncount = 10\n", &format!("[defects]\ncount = 10\n{keys}\n"));
        read_problems(&text).0.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(problems("elements = [12, 334]\nkinds = [1000, 1620]"), Vec::<String>::new());
    let found = problems("elements = [12, 999]\nkinds = [1130, 6000]");
    assert_eq!(found.len(), 2, "{found:?}");
    let elements =
        "job.toml:70: defects.elements = [12, 999]: not a valid list (allowed: list of whole numbers among 12, 13, 15, ";
    assert!(found[0].starts_with(elements) && found[0].ends_with(", 331, 334)"), "{}", found[0]);
    assert_eq!(
        found[1],
        "job.toml:71: defects.kinds = [1130, 6000]: not a valid list (allowed: list of whole numbers among 1000, 1010, 1020, 1080, 1090, \
         1110, 1120, 1130, 1190, 1610, 1620)"
    );
    // A timber deck and a joint are elements, but have no defects in the catalog.
    assert_eq!(problems("elements = [31]").len(), 1);
    assert_eq!(problems("elements = [300]").len(), 1);
}

/// The type determines which tables and tasks a bridge can have, so that an unknown one makes no other error.
#[test]
fn regress_unknown_type_of_bridge_is_a_single_problem() {
    let mut types = 0;
    for (name, text) in spandrel_model::shipped::SCENARIOS {
        let Some(line) = text.lines().find(|line| line.starts_with("type = ")) else { continue };
        let problems = read_problems(&text.replace(line, "type = \"swing\""));
        assert!(!problems.0.is_empty(), "{name}");
        for problem in &problems.0 {
            assert_eq!((problem.key.as_str(), problem.value.as_str()), ("bridges[].type", "\"swing\""), "{name}: {problem}");
        }
        types += 1;
    }
    assert!(types > 8, "{types} jobs with bridges");
}

#[test]
fn regress_inconsistent_numbers_are_reported() {
    assert_message("spacing_m = 4.0", "spacing_m = 1.0", "");
    assert_message(
        "size_m = 800.0\nspacing_m = 4.0",
        "size_m = 4000.0\nspacing_m = 1.0",
        "job.toml:13: terrain.spacing_m = 1: more than 2000 cells per side (allowed: at least 2 for this size_m)",
    );
    assert_message(
        "centre_m = [0.0, 0.0, 34.0]\n",
        "centre_m = [0.0, 0.0, 34.0]\narch = { floorbeam_depth_m = 3.0 }\n",
        "job.toml:36: bridges[].arch.floorbeam_depth_m = 3: inconsistent with other values \
         (allowed: crown_gap_m minus 0.5 m: at most 2.90)",
    );
}

#[test]
fn regress_overlong_path_is_reported() {
    let far: Vec<String> = (0..200).map(|k| format!("[{}, 0.0, 50.0]", if k % 2 == 0 { -4000.0 } else { 4000.0 })).collect();
    let text = shipped_scenario() + &format!("\n[[tasks]]\nname = \"far\"\nkind = \"free\"\npoints_m = [{}]\n", far.join(", "));
    let problems = read_problems(&text);
    assert!(problems.to_string().ends_with("1592000 m long: too long (allowed: at most 20000 m of path)"), "{problems}");
}

#[test]
fn regress_inline_tables_work_like_regular_tables() {
    let text =
        shipped_scenario().replace("[defects]\ncount = 10\n", "").replacen("[origin]", "defects = { count = 2 }\n\n[origin]", 1);
    let read =
        |text: &str| spandrel_model::scenario::read("job.toml", text, &|_| Err(String::new())).unwrap_or_else(|p| panic!("{p}"));
    let scenario = read(&text);
    let site = spandrel_model::site::Site::build(&scenario, 5);
    assert_eq!(site.defects().len(), 2);
    let again = read(&spandrel_model::scenario::resolve(&text, 5, site.defects()));
    assert_eq!(again.crc, scenario.crc);
    assert_eq!(again.defects.placed.as_deref(), Some(site.defects()));
}

/// Without feet below its spherical cage, an aircraft would rest on the cage and roll.
#[test]
fn regress_caged_vehicle_requires_feet_below_its_cage() {
    let text = spandrel_model::shipped::ELIOS3;
    let short = text.replace("0.24]", "0.22]");
    assert_ne!(short, text);
    let problems = spandrel_model::vehicle::read("elios3.toml", &short).unwrap_err().to_string();
    assert!(problems.contains("feet_m") && problems.contains("at least 0.24 m below the center"), "{problems}");
}

#[test]
fn exact_keys_of_aerodynamics_have_ranges_and_are_off_by_default() {
    use spandrel_model::vehicle::{AirDensity, SurfaceEffects, read};
    let base = spandrel_model::shipped::PHANTOM2;
    let base = base.split_once("[aerodynamics]\n").map_or(base.to_owned(), |(before, rest)| {
        let (_, after) = rest.split_once("\n[").unwrap();
        format!("{before}[{after}")
    });
    assert_eq!(read("a.toml", &base).unwrap().aerodynamics, spandrel_model::vehicle::Aerodynamics::default());
    let with = |keys: &str| read("a.toml", &format!("{base}\n[aerodynamics]\n{keys}\n"));
    let keys = "inflow_coefficient_n_s2_m = 3e-4\ntranslational_lift_n_s2_m2 = 5e-3\nvortex_ring_loss = 0.2\n\
                air_density = \"altitude\"\nsurface_effects = \"multirotor\"";
    let air = with(keys).unwrap().aerodynamics;
    assert_eq!((air.inflow_coefficient_n_s2_m, air.translational_lift_n_s2_m2, air.vortex_ring_loss), (3e-4, 5e-3, 0.2));
    assert_eq!((air.air_density, air.surface_effects), (AirDensity::Altitude, SurfaceEffects::Multirotor));
    let line = base.lines().count() + 3;
    for (keys, problem) in [
        ("inflow_coefficient_n_s2_m = 0.02", "aerodynamics.inflow_coefficient_n_s2_m = 0.02: out of range (allowed: 0 to 0.01)"),
        ("translational_lift_n_s2_m2 = -1.0", "aerodynamics.translational_lift_n_s2_m2 = -1.0: out of range (allowed: 0 to 0.5)"),
        ("vortex_ring_loss = 0.6", "aerodynamics.vortex_ring_loss = 0.6: out of range (allowed: 0 to 0.5)"),
        ("air_density = \"high\"", "aerodynamics.air_density = \"high\": unknown keyword (allowed: sea-level, altitude)"),
        ("surface_effects = 4", "aerodynamics.surface_effects = 4: unknown keyword (allowed: single-rotor, multirotor)"),
        ("inflow = 1.0", "aerodynamics.inflow"),
    ] {
        let problems = with(keys).unwrap_err().to_string();
        assert!(problems.contains(&format!("a.toml:{line}: {problem}")), "{problems}");
    }
}

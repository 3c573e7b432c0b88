//! Randomly mutated scenario and vehicle files: each file is either rejected with a line number and a reason, or can be
//! built.

use spandrel_model::frames::Vec3;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::bridges::BridgeField;
use spandrel_model::scenario::bridges::arch::Arch;
use spandrel_model::scenario::bridges::box_girder::BoxGirder;
use spandrel_model::scenario::bridges::cable_stayed::CableStayed;
use spandrel_model::scenario::bridges::girder::Girder;
use spandrel_model::scenario::bridges::masonry_arch::MasonryArch;
use spandrel_model::scenario::bridges::prestressed::Prestressed;
use spandrel_model::scenario::bridges::suspension::Suspension;
use spandrel_model::scenario::bridges::truss::Truss;
use spandrel_model::scenario::{DefectSpec, Scenario, TerrainSpec};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::toml::Problems;
use std::path::Path;

const SCENARIO_MUTANT_COUNT: usize = 2_000;
const VEHICLE_MUTANT_COUNT: usize = 500;
/// Number of bridges with random dimensions per bridge type.
const RANDOM_BRIDGE_COUNT: usize = 150;
/// Maximum number of mutations applied to one file.
const MAX_MUTATIONS: usize = 3;

/// Extreme or malformed values that could cause errors in the parser.
const EXTREME_VALUES: [&str; 14] = [
    "1e999",
    "-1e999",
    "nan",
    "inf",
    "-inf",
    "-1",
    "0",
    "-0.0",
    "1e-320",
    "9223372036854775807",
    "-9223372036854775808",
    "99999999999999999999",
    "0x7fffffff",
    "1979-05-27",
];

fn file_texts(folder: &str) -> Vec<String> {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(folder);
    let mut paths: Vec<_> = std::fs::read_dir(root).unwrap().map(|e| e.unwrap().path()).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    paths.into_iter().map(|p| std::fs::read_to_string(p).unwrap()).collect()
}

fn read(text: &str) -> Result<Scenario, Problems> {
    spandrel_model::scenario::read("job.toml", text, &|name| Err(format!("no file {name}")))
}

fn mutate(text: &str, random: &mut RandomStream) -> String {
    let mut text = text.to_string();
    for _ in 0..=random.below(MAX_MUTATIONS) {
        text = mutate_once(&text, random);
    }
    text
}

fn mutate_once(text: &str, random: &mut RandomStream) -> String {
    let mut lines: Vec<String> = text.lines().map(String::from).collect();
    if lines.is_empty() {
        return text.into();
    }
    let k = random.below(lines.len());
    let other = random.below(lines.len());
    match random.below(7) {
        0 => return flip_bit(text, random),
        1 => return String::from_utf8_lossy(&text.as_bytes()[..random.below(text.len() + 1)]).into_owned(),
        2 => drop(lines.remove(k)),
        3 => lines.insert(other, lines[k].clone()),
        4 => swap_values(&mut lines, k, other),
        _ => insert_extreme_value(&mut lines, random),
    }
    lines.join("\n")
}

fn flip_bit(text: &str, random: &mut RandomStream) -> String {
    let mut bytes = text.as_bytes().to_vec();
    if !bytes.is_empty() {
        let k = random.below(bytes.len());
        bytes[k] ^= 1 << random.below(8);
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn split_key_value(line: &str) -> Option<(String, String)> {
    line.split_once(" = ").map(|(key, value)| (key.to_string(), value.to_string()))
}

fn swap_values(lines: &mut [String], a: usize, b: usize) {
    if let (Some((key_a, value_a)), Some((key_b, value_b))) = (split_key_value(&lines[a]), split_key_value(&lines[b])) {
        lines[a] = format!("{key_a} = {value_b}");
        lines[b] = format!("{key_b} = {value_a}");
    }
}

fn insert_extreme_value(lines: &mut [String], random: &mut RandomStream) {
    let keyed: Vec<usize> = (0..lines.len()).filter(|k| split_key_value(&lines[*k]).is_some()).collect();
    if keyed.is_empty() {
        return;
    }
    let k = keyed[random.below(keyed.len())];
    let extreme = EXTREME_VALUES[random.below(EXTREME_VALUES.len())];
    if let Some((key, value)) = split_key_value(&lines[k]) {
        let inside = value.starts_with('[').then(|| value.split_once(',')).flatten();
        lines[k] = inside.map_or_else(|| format!("{key} = {extreme}"), |(_, rest)| format!("{key} = [{extreme},{rest}"));
    }
}

fn assert_problems_are_explained(problems: &Problems, file: &str, text: &str) {
    assert!(!problems.0.is_empty(), "rejected without a reason:\n{text}");
    let last = text.lines().count().max(1) + 1;
    for problem in &problems.0 {
        let placed = problem.file == file && (1..=last).contains(&problem.line);
        assert!(placed && !problem.key.is_empty() && !problem.message.is_empty(), "{problem:?}\n{text}");
        assert_eq!(problem.to_string().lines().count(), 1, "{problem:?}");
    }
}

/// Returns the scenario with a coarser height grid and at most one defect, so that thousands of sites can be built quickly.
/// Bridges and tasks are unchanged.
fn simplified_scenario(scenario: Scenario) -> Scenario {
    let spacing_m = scenario.terrain.spacing_m.max(scenario.terrain.size_m / 25.0);
    let count = scenario.defects.count.min(1);
    Scenario {
        terrain: TerrainSpec { spacing_m, ..scenario.terrain.clone() },
        defects: DefectSpec { count, ..scenario.defects.clone() },
        ..scenario
    }
}

fn assert_builds(scenario: Scenario, text: &str) {
    let pad = scenario.ground_team.pad_m;
    let site = Site::build(&simplified_scenario(scenario), 3);
    let near = site.nearest(pad + Vec3::new(0.0, 0.0, 5.0), 100.0, SimTime::from_s(1.0));
    assert!(near.is_none_or(|n| n.distance_m.is_finite() && n.normal.norm().is_finite()), "{near:?}\n{text}");
    let finite = |v: Vec3<_>| v.array().iter().all(|c| c.is_finite());
    assert!(site.members().iter().all(|m| m.solid.vertices_m.iter().all(|v| finite(*v))), "{text}");
    assert!(site.defects().iter().all(|d| finite(d.position_m) && finite(d.normal)), "{text}");
}

#[test]
fn prop_mutated_scenarios_build_or_are_rejected_with_a_line() {
    let texts = file_texts("scenarios");
    let mut random = RandomStream::new(1, "prop.scenario-files");
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..SCENARIO_MUTANT_COUNT {
        let text = mutate(&texts[random.below(texts.len())], &mut random);
        match read(&text) {
            Ok(scenario) => {
                accepted += 1;
                assert_builds(scenario, &text);
            }
            Err(problems) => {
                refused += 1;
                assert_problems_are_explained(&problems, "job.toml", &text);
            }
        }
    }
    // The test is meaningful only if both outcomes occur often.
    assert!(
        accepted > SCENARIO_MUTANT_COUNT / 20 && refused > SCENARIO_MUTANT_COUNT / 4,
        "{accepted} accepted, {refused} rejected"
    );
}

#[test]
fn prop_mutated_vehicles_are_valid_or_rejected_with_a_line() {
    let texts = file_texts("vehicle-params");
    let mut random = RandomStream::new(1, "prop.vehicle-files");
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..VEHICLE_MUTANT_COUNT {
        let text = mutate(&texts[random.below(texts.len())], &mut random);
        match spandrel_model::vehicle::read("aircraft.toml", &text) {
            Ok(vehicle) => {
                accepted += 1;
                let flies = vehicle.rotor.idle_speed_rad_s < vehicle.rotor.max_speed_rad_s && vehicle.mass_kg > 0.0;
                assert!(flies && (3..=8).contains(&vehicle.rotors.len()), "{text}");
            }
            Err(problems) => {
                refused += 1;
                assert_problems_are_explained(&problems, "aircraft.toml", &text);
            }
        }
    }
    assert!(
        accepted > VEHICLE_MUTANT_COUNT / 20 && refused > VEHICLE_MUTANT_COUNT / 4,
        "{accepted} accepted, {refused} rejected"
    );
}

fn bridge_text(kind: &str, values: &[(&str, f64)]) -> String {
    let task = match kind {
        "arch" => "interlayer",
        "suspension" => "pier_circle",
        "truss" | "cable_stayed" => "floor_system",
        "masonry_arch" => "barrel_soffit",
        _ => "girder_soffit",
    };
    let numbers: Vec<String> = values.iter().map(|(key, value)| format!("{key} = {value:?}")).collect();
    format!(
        "format = 1\nname = \"one\"\ntitle = \"One\"\n\
         [origin]\nlatitude_deg = 46.0\nlongitude_deg = 8.0\naltitude_m = 400.0\n\
         [terrain]\nsize_m = 200.0\nspacing_m = 50.0\n\
         [ground_team]\npad_m = [0.0, 300.0, 5.0]\ninspector_m = [4.0, 300.0, 5.0]\ntruck_m = [9.0, 300.0, 5.0]\n\
         [[bridges]]\nname = \"b\"\ntype = \"{kind}\"\ncentre_m = [0.0, 0.0, 150.0]\n[bridges.{kind}]\n{}\n\
         [[tasks]]\nname = \"t\"\nkind = \"{task}\"\nbridge = \"b\"\n[defects]\ncount = 1\n",
        numbers.join("\n")
    )
}

/// Returns sets of dimensions: each dimension alone at its minimum and maximum, then random sets. Dimensions that must be
/// integers are rounded.
fn dimension_sets(fields: &'static [BridgeField]) -> Vec<Vec<(&'static str, f64)>> {
    let mut random = RandomStream::new(2, "prop.bridges");
    let mut sets: Vec<Vec<(&str, f64)>> = fields.iter().flat_map(|f| [vec![(f.key, f.min)], vec![(f.key, f.max)]]).collect();
    for _ in 0..RANDOM_BRIDGE_COUNT {
        // A cubed random number is often close to the default, which makes enough of the sets consistent.
        let mut near = |f: &BridgeField| {
            let draw = random.range(-1.0, 1.0);
            let towards = if draw < 0.0 { f.min } else { f.max };
            let value = f.default + (towards - f.default) * (draw * draw * draw).abs();
            if f.meaning.ends_with("a whole number.") { value.round() } else { value }
        };
        sets.push(fields.iter().map(|f| (f.key, near(f))).collect());
    }
    sets
}

fn assert_positive_volumes(scenario: &Scenario) {
    for member in scenario.bridges.iter().flat_map(spandrel_model::scenario::Bridge::members) {
        let solid = &member.solid;
        let at = |k: u32| solid.vertices_m[k as usize];
        let fan = |face: &Vec<u32>| -> f64 {
            (1..face.len() - 1).map(|k| at(face[0]).cross(at(face[k])).dot(at(face[k + 1])) / 6.0).sum()
        };
        let volume_m3: f64 = solid.faces.iter().map(fan).sum();
        assert!(volume_m3 > 0.0, "{} has a volume of {volume_m3} m3", member.name);
    }
}

fn assert_random_bridges_build(kind: &str, fields: &'static [BridgeField]) {
    let mut accepted = 0;
    let sets = dimension_sets(fields);
    for values in &sets {
        let text = bridge_text(kind, values);
        match read(&text) {
            Ok(scenario) => {
                accepted += 1;
                assert_positive_volumes(&scenario);
                assert_builds(scenario, &text);
            }
            Err(problems) => assert_problems_are_explained(&problems, "job.toml", &text),
        }
    }
    assert!(accepted > sets.len() / 10, "{accepted} of {} sets of dimensions accepted", sets.len());
}

#[test]
fn prop_all_valid_arches_build_with_positive_volumes() {
    assert_random_bridges_build("arch", Arch::FIELDS);
}

#[test]
fn prop_all_valid_suspension_bridges_build_with_positive_volumes() {
    assert_random_bridges_build("suspension", Suspension::FIELDS);
}

#[test]
fn prop_all_valid_girder_bridges_build_with_positive_volumes() {
    assert_random_bridges_build("girder", Girder::FIELDS);
}

#[test]
fn prop_all_valid_prestressed_bridges_build_with_positive_volumes() {
    assert_random_bridges_build("prestressed", Prestressed::FIELDS);
}

#[test]
fn prop_all_valid_truss_bridges_build_with_positive_volumes() {
    assert_random_bridges_build("truss", Truss::FIELDS);
}

#[test]
fn prop_all_valid_box_girder_bridges_build_with_positive_volumes() {
    assert_random_bridges_build("box_girder", BoxGirder::FIELDS);
}

#[test]
fn prop_all_valid_masonry_arches_build_with_positive_volumes() {
    assert_random_bridges_build("masonry_arch", MasonryArch::FIELDS);
}

#[test]
fn prop_all_valid_cable_stayed_bridges_build_with_positive_volumes() {
    assert_random_bridges_build("cable_stayed", CableStayed::FIELDS);
}

//! Tests that all shipped scenario and vehicle files can be read, and that task paths have sufficient clearance.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{INSPECTOR_EYE_HEIGHT_M, Scenario, TaskKind};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use std::path::{Path, PathBuf};

pub fn toml_files(folder: &str) -> Vec<PathBuf> {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(folder);
    let mut files: Vec<PathBuf> = std::fs::read_dir(root).unwrap().map(|e| e.unwrap().path()).collect();
    files.retain(|p| p.extension().is_some_and(|e| e == "toml"));
    files.sort();
    assert!(!files.is_empty());
    files
}

pub fn read_scenario(path: &Path) -> Scenario {
    let text = std::fs::read_to_string(path).unwrap();
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    spandrel_model::scenario::read(&name, &text, &|f| Err(format!("no file {f}"))).unwrap_or_else(|problems| panic!("{problems}"))
}

pub fn read_vehicle(path: &Path) -> Vehicle {
    let text = std::fs::read_to_string(path).unwrap();
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    spandrel_model::vehicle::read(&name, &text).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn val_shipped_aircraft_meet_the_reference_camera() {
    for path in toml_files("vehicle-params") {
        let vehicle = read_vehicle(&path);
        let short = spandrel_model::site::defects::reference_shortfalls(&vehicle.camera, &vehicle.lamp);
        assert!(short.is_empty(), "{}: {short:?}", path.display());
    }
}

#[test]
fn val_all_numbers_in_vehicle_files_have_a_source() {
    for path in toml_files("vehicle-params") {
        for (k, line) in std::fs::read_to_string(&path).unwrap().lines().enumerate() {
            let number = line.split_once(" = ").is_some_and(|(key, value)| {
                key != "format" && value.starts_with(['[', '-', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9'])
            });
            assert!(!number || line.contains("# source:") || line.contains("# estimate"), "{}:{}: {line}", path.display(), k + 1);
        }
    }
}

/// Objects this near in front of the drone do not count as hiding it, m (the same as in the report).
const DRONE_CLEARANCE_M: f64 = 0.5;

#[test]
fn val_places_of_the_inspector_show_what_is_hidden_from_the_pad() {
    // Least share of the hidden part of the paths that another place of the job shows.
    const MIN_SHOWN: f64 = 0.9;
    for path in toml_files("scenarios") {
        let (name, scenario) = (path.display(), read_scenario(&path));
        let site = Site::without_defects(&scenario);
        let sees = |place: Vec3<Enu>, point: Vec3<Enu>| {
            let eye_m = place + Vec3::new(0.0, 0.0, INSPECTOR_EYE_HEIGHT_M);
            !site.geometry().hides(eye_m, point, DRONE_CLEARANCE_M)
        };
        let team = &scenario.ground_team;
        let points = scenario.tasks.iter().flat_map(|task| task.path_m.iter().copied());
        let hidden: Vec<Vec3<Enu>> = points.filter(|point| !sees(team.inspector_m, *point)).collect();
        assert_eq!(hidden.is_empty(), !team.can_walk(), "{name}: {} hidden points", hidden.len());
        let shown = hidden.iter().filter(|point| team.places_m.iter().any(|place| sees(*place, **point))).count();
        assert!(shown as f64 >= MIN_SHOWN * hidden.len() as f64, "{name}: {shown} of {} hidden points", hidden.len());
    }
}

#[test]
fn val_inspector_can_stand_at_and_walk_between_the_places() {
    // Largest height of the feet above or below the ground, m: heights have two decimals.
    const MAX_HEIGHT_M: f64 = 0.01;
    // Steepest way, as rise over run, averaged over two meters (estimate: a steep meadow).
    const MAX_SLOPE: f64 = 0.5;
    for path in toml_files("scenarios") {
        let (name, scenario) = (path.display(), read_scenario(&path));
        let site = Site::without_defects(&scenario);
        let places: Vec<Vec3<Enu>> = scenario.ground_team.inspector_places_m().collect();
        for place in &places[1..] {
            assert_eq!(site.place_obstacle(*place), None, "{name}: {place:?}");
            let over_m = place.up() - site.ground_up_m(place.east(), place.north());
            assert!(over_m.abs() < MAX_HEIGHT_M, "{name}: {place:?} is {over_m} m over the ground");
        }
        for (from, to) in places.iter().zip(places.iter().cycle().skip(1)) {
            assert_eq!(site.way_obstacle(*from, *to), None, "{name}: {from:?} to {to:?}");
            let steps = (0.5 * (*to - *from).horizontal_norm()).ceil().max(1.0);
            let height = |k: f64| {
                let at = from.lerp(*to, k / steps);
                site.ground_up_m(at.east(), at.north())
            };
            let steepest = (0..steps as u32).map(|k| 0.5 * (height(f64::from(k) + 1.0) - height(f64::from(k))).abs());
            let steepest = steepest.fold(0.0, f64::max);
            assert!(steepest < MAX_SLOPE, "{name}: {steepest} from {from:?} to {to:?}");
        }
    }
}

#[test]
fn val_shipped_paths_clear_the_default_aircraft() {
    let aircraft = read_vehicle(&Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("vehicle-params/phantom2.toml"));
    for path in toml_files("scenarios") {
        let scenario = read_scenario(&path);
        let site = Site::build(
            &Scenario {
                traffic: spandrel_model::scenario::TrafficSpec { cars: 0, trucks: 0, pedestrians: 0, ..scenario.traffic.clone() },
                ..scenario.clone()
            },
            7,
        );
        for task in &scenario.tasks {
            // The minimum stand-off is 4 m, or 0.5 m more than the task's own warning. In the interlayer, it is the minimum
            // that `check` requires.
            let least = match task.kind {
                TaskKind::Interlayer => 0.5 * aircraft.hull.tip_to_tip_m + 0.5,
                TaskKind::Free => 1.0,
                _ => task.too_close_m.map_or(4.0, |limit_m| limit_m + 0.5) - 1e-6,
            };
            // The path around the pier is intentionally close to the water, so only members are checked there.
            let near = |p| match task.kind {
                TaskKind::PierCircle => site.geometry().nearest_member(p, 50.0),
                _ => site.nearest(p, 50.0, SimTime::ZERO),
            };
            let gap = |p: &_| near(*p).map_or(50.0, |n| n.distance_m);
            let (worst, at) = task.path_m.iter().map(|p| (gap(p), *p)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
            assert!(
                worst >= least,
                "{} task {}: {worst} m at {at:?}, nearest {:?}",
                scenario.name,
                task.id,
                site.nearest(at, 50.0, SimTime::ZERO).map(|n| site.object_name(n.object))
            );
            assert!(task.path_m.windows(2).all(|w| (w[1] - w[0]).norm() <= 1.0 + 1e-9));
            assert_eq!(task.path_m.len(), task.viewing_directions.len());
        }
    }
}

#[test]
fn val_two_bridges_job_places_ten_defects() {
    let scenario = read_scenario(&Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("scenarios/two-bridges.toml"));
    for seed in [1, 7] {
        let site = Site::build(&scenario, seed);
        assert_eq!(site.defects().len(), 10, "seed {seed}");
        let text =
            std::fs::read_to_string(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("scenarios/two-bridges.toml"))
                .unwrap();
        let resolved = spandrel_model::scenario::resolve(&text, seed, site.defects());
        let again = spandrel_model::scenario::read("resolved", &resolved, &|_| Err(String::new())).unwrap();
        assert_eq!(again.crc, scenario.crc);
        assert_eq!(again.seed, Some(seed));
        assert_eq!(Site::build(&again, seed).defects(), site.defects());
    }
}

/// Illuminance below which photos need the lamp, lx: f/2.8, ISO 1600 and an exposure of 1/100 s.
const REQUIRED_ILLUMINANCE_LUX: f64 = 122.5;

#[test]
fn val_default_job_requires_the_lamp_only_in_the_interlayer() {
    let scenario = read_scenario(&Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("scenarios/two-bridges.toml"));
    let phantom = read_vehicle(&Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join("vehicle-params/phantom2.toml"));
    assert!((spandrel_model::site::visibility::required_illuminance_lux(&phantom.camera) - REQUIRED_ILLUMINANCE_LUX).abs() < 0.1);
    let (mut dark, mut inside) = (0, 0);
    for seed in 1..=10 {
        let site = Site::build(&scenario, seed);
        for defect in site.defects() {
            let reach = |k: &usize| {
                let path = scenario.tasks[*k].path_m.iter();
                path.map(|point| (*point - defect.position_m).norm()).fold(f64::INFINITY, f64::min)
            };
            let task = (0..scenario.tasks.len()).min_by(|a, b| reach(a).total_cmp(&reach(b))).unwrap();
            let lux = site.ambient_lux(defect.position_m, Some(defect.normal), SimTime::ZERO);
            if scenario.tasks[task].dark {
                inside += 1;
                dark += i32::from(lux < REQUIRED_ILLUMINANCE_LUX);
            } else {
                assert!(lux > REQUIRED_ILLUMINANCE_LUX, "{} in task {}: {lux} lx", defect.member, task + 1);
            }
        }
    }
    assert!(4 * dark > inside, "only {dark} of {inside} defects in the interlayer are too dark without the lamp");
}

#[test]
fn val_camera_drills_place_all_defects_and_only_the_lamp_drill_needs_the_lamp() {
    use spandrel_model::site::defects::REFERENCE_CAMERA;
    use spandrel_model::site::visibility::required_illuminance_lux;
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."));
    let needed_lux = required_illuminance_lux(&REFERENCE_CAMERA);
    for (drill, dark) in [("stand-off", false), ("framing", false), ("search", false), ("lamp", true)] {
        let scenario = read_scenario(&root.join(format!("scenarios/drill-{drill}.toml")));
        for seed in 1..=3 {
            let site = Site::build(&scenario, seed);
            assert_eq!(site.defects().len(), scenario.defects.count, "{drill}, seed {seed}");
            for defect in site.defects() {
                let ambient_lux = site.ambient_lux(defect.position_m, Some(defect.normal), SimTime::ZERO);
                assert_eq!(ambient_lux < needed_lux, dark, "{drill}, seed {seed}: {ambient_lux} lx on {defect:?}");
            }
        }
    }
}

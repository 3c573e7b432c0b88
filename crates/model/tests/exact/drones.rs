//! Tables `[[drones]]` of a scenario.

use spandrel_model::frames::Vec3;
use spandrel_model::scenario::{self, DroneSpec};
use spandrel_model::shipped::DRILL_HOVER;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::toml::Problem;

fn read(tables: &str) -> Result<Vec<DroneSpec>, Vec<Problem>> {
    let job = scenario::read("job.toml", &format!("{DRILL_HOVER}\n{tables}"), &|_| Err("none".into()));
    job.map(|job| job.drones).map_err(|problems| problems.0)
}

#[test]
fn exact_keys_have_their_defaults() {
    let drones = read("[[drones]]\nname = \"survey\"\npoints_m = [[1, 2, 30]]\n").unwrap();
    let expected = DroneSpec {
        name: "survey".into(),
        vehicle: "phantom2",
        points_m: vec![Vec3::new(1.0, 2.0, 30.0)],
        speed_m_s: 3.0,
        heading_deg: 0.0,
        at_s: 0.0,
        spread_s: 0.0,
        wait_s: 0.0,
        repeat: false,
    };
    assert_eq!(drones, [expected]);
}

#[test]
fn exact_problems_have_file_line_key_and_value() {
    let lines = DRILL_HOVER.lines().count();
    for (table, key, value, message) in [
        ("points_m = [[0, 0, 30]]", "name", "", "missing"),
        ("name = \"A drone\"\npoints_m = [[0, 0, 30]]", "name", "A drone", "invalid name"),
        ("name = \"a\"", "points_m", "", "missing"),
        ("name = \"a\"\npoints_m = [[0, 0]]", "points_m", "[[0, 0]]", "not a valid list"),
        ("name = \"a\"\npoints_m = [[0, 0, 30], [0, 0, 30]]", "points_m", "[0, 0, 30]", "point 2 is where point 1 is"),
        ("name = \"a\"\npoints_m = [[0, 0, 30]]\nspeed_m_s = 16", "speed_m_s", "16", "out of range"),
        ("name = \"a\"\npoints_m = [[0, 0, 30]]\nvehicle = \"kite\"", "vehicle", "kite", "unknown keyword"),
    ] {
        let problems = read(&format!("[[drones]]\n{table}\n")).unwrap_err();
        assert_eq!(problems.len(), 1, "{problems:?}");
        let Problem { file, line, location, value: given, message: words, .. } = &problems[0];
        assert_eq!((file.as_str(), location.as_str()), ("job.toml", format!("drones[0].{key}").as_str()));
        assert_eq!((given.trim_matches('"'), words.as_str()), (value, message), "{table}");
        assert!((lines + 1..lines + 7).contains(line), "{table}: line {line} after {lines}");
    }
    let twice = "[[drones]]\nname = \"a\"\npoints_m = [[0, 0, 30]]\n".repeat(2);
    assert_eq!(read(&twice).unwrap_err()[0].message, "duplicate name");
    let nine: String = (0..9).map(|k| format!("[[drones]]\nname = \"d{k}\"\npoints_m = [[0, {k}, 30]]\n")).collect();
    assert_eq!(read(&nine).unwrap_err()[0].message, "too many");
}

#[test]
fn exact_drones_are_part_of_the_checksum_and_leave_the_traffic_alone() {
    let job = |tables: &str| scenario::read("job.toml", &format!("{DRILL_HOVER}\n{tables}"), &|_| Err("none".into())).unwrap();
    let (without, with) = (job(""), job("[[drones]]\nname = \"a\"\npoints_m = [[0, 0, 30]]\nspread_s = 20\n"));
    assert_ne!(without.crc, with.crc);
    let (plain, shared) = (Site::build(&without, 3), Site::build(&with, 3));
    assert_eq!(plain.traffic().solids(SimTime::from_s(9.0)), shared.traffic().solids(SimTime::from_s(9.0)));
    assert_eq!((plain.drones().len(), shared.drones().len()), (0, 1));
}

//! Tables `[[ropes]]` of a scenario.

use spandrel_model::frames::Vec3;
use spandrel_model::scenario::{self, RopeSpec};
use spandrel_model::shipped::DRILL_HOVER;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::toml::Problem;

fn read(tables: &str) -> Result<Vec<RopeSpec>, Vec<Problem>> {
    let job = scenario::read("job.toml", &format!("{DRILL_HOVER}\n{tables}"), &|_| Err("none".into()));
    job.map(|job| job.ropes).map_err(|problems| problems.0)
}

#[test]
fn exact_keys_have_their_defaults() {
    let ropes = read("[[ropes]]\nname = \"line\"\npoints_m = [[1, 2, 30]]\nlength_m = 5\n").unwrap();
    let points_m = vec![Vec3::new(1.0, 2.0, 30.0)];
    assert_eq!(ropes, [RopeSpec { name: "line".into(), points_m, length_m: 5.0, diameter_m: 0.012, mass_kg_m: 0.1 }]);
}

#[test]
fn exact_problems_have_file_line_key_and_value() {
    let lines = DRILL_HOVER.lines().count();
    for (table, key, value, message) in [
        ("points_m = [[0, 0, 30]]\nlength_m = 5", "name", "", "missing"),
        ("name = \"a\"\nlength_m = 5", "points_m", "", "missing"),
        ("name = \"a\"\npoints_m = [[0, 0, 30]]", "length_m", "", "missing"),
        ("name = \"a\"\npoints_m = [[0, 0, 30]]\nlength_m = 201", "length_m", "201", "out of range"),
        ("name = \"a\"\npoints_m = [[0, 0, 30], [10, 0, 30]]\nlength_m = 10", "length_m", "10", "too short"),
        (
            "name = \"a\"\npoints_m = [[0, 0, 30], [0, 0, 40]]\nlength_m = 20",
            "points_m",
            "[0, 0, 40]",
            "the points are above each other",
        ),
        ("name = \"a\"\npoints_m = [[0, 0, 30], [9, 0, 30], [9, 9, 30]]\nlength_m = 50", "points_m", "3 points", "too many"),
        ("name = \"a\"\npoints_m = [[0, 0, 30]]\nlength_m = 5\ndiameter_mm = 1", "diameter_mm", "1", "out of range"),
    ] {
        let problems = read(&format!("[[ropes]]\n{table}\n")).unwrap_err();
        assert_eq!(problems.len(), 1, "{problems:?}");
        let Problem { file, line, location, value: given, message: words, .. } = &problems[0];
        assert_eq!((file.as_str(), location.as_str()), ("job.toml", format!("ropes[0].{key}").as_str()));
        assert_eq!((given.trim_matches('"'), words.as_str()), (value, message), "{table}");
        assert!((lines + 1..lines + 7).contains(line), "{table}: line {line} after {lines}");
    }
    let rope = |name: &str| format!("[[ropes]]\nname = \"{name}\"\npoints_m = [[0, 0, 30]]\nlength_m = 5\n");
    assert_eq!(read(&rope("a").repeat(2)).unwrap_err()[0].message, "duplicate name");
    let nine: String = (0..9).map(|k| rope(&format!("r{k}"))).collect();
    assert_eq!(read(&nine).unwrap_err()[0].message, "too many");
}

#[test]
fn exact_ropes_are_part_of_the_checksum_and_leave_everything_else_alone() {
    let job = |tables: &str| scenario::read("job.toml", &format!("{DRILL_HOVER}\n{tables}"), &|_| Err("none".into())).unwrap();
    let (without, with) = (job(""), job("[[ropes]]\nname = \"line\"\npoints_m = [[0, 0, 30]]\nlength_m = 5\n"));
    assert_ne!(without.crc, with.crc);
    let (plain, roped) = (Site::build(&without, 3), Site::build(&with, 3));
    assert_eq!(plain.traffic().solids(SimTime::from_s(9.0)), roped.traffic().solids(SimTime::from_s(9.0)));
    assert_eq!((plain.ropes().all().len(), roped.ropes().all().len()), (0, 1));
    // The whole site sees the rope: its upper end does not move.
    let near = roped.nearest(Vec3::new(0.5, 0.0, 30.0), 1.0, SimTime::ZERO).unwrap();
    assert!((near.distance_m - 0.494).abs() < 0.02, "{near:?}");
    assert_eq!(roped.object_name(near.object), "rope line");
}

//! Ropes and cables that hang at the site. This reader checks what the file alone shows; `spandrel check` also builds the site and checks that
//! the tasks' paths are clear of them.

use super::job::RopeSpec;
use super::names::read_name;
use super::places::shown;
use super::point::MAX_COORDINATE_M;
use crate::frames::{Enu, Vec3};
use crate::toml::{Reader, Section};

/// Maximum number of ropes (estimate: more than hang at one bridge).
pub const MAX_ROPES: usize = 8;
/// Length of a rope, m.
const LENGTH_M: (f64, f64) = (0.5, 200.0);
/// Minimum length relative to the distance of the points between which a rope hangs (estimate: a rope has some sag).
const MIN_SLACK: f64 = 1.001;
/// Minimum horizontal distance of the points between which a rope hangs, m (estimate: closer, it is a loop).
const MIN_SPAN_M: f64 = 0.5;
/// Key with the points.
const POINTS_KEY: &str = "points_m";

/// Reads the tables `[[ropes]]`.
pub(super) fn read(r: &mut Reader, root: &mut Section) -> Vec<RopeSpec> {
    let mut ropes: Vec<RopeSpec> = Vec::new();
    for mut s in r.sections(root, "ropes") {
        let rope = read_rope(r, &mut s);
        if ropes.iter().any(|other| other.name == rope.name) {
            r.add_problem(&s, "name", &rope.name, "a unique name", "duplicate name");
        }
        r.finish(&s);
        ropes.push(rope);
    }
    if ropes.len() > MAX_ROPES {
        r.add_problem(root, "ropes", &ropes.len().to_string(), &format!("at most {MAX_ROPES} [[ropes]]"), "too many");
    }
    ropes
}

fn read_rope(r: &mut Reader, s: &mut Section) -> RopeSpec {
    let name = read_name(r, s, "name");
    let points_m = read_points(r, s);
    let length_m = r.number(s, "length_m", LENGTH_M, None);
    if let [from, to] = points_m[..]
        && length_m < MIN_SLACK * (to - from).norm()
    {
        let needed_m = MIN_SLACK * (to - from).norm();
        r.add_problem(
            s,
            "length_m",
            &length_m.to_string(),
            &format!("at least {needed_m:.2} m between these points"),
            "too short",
        );
    }
    RopeSpec {
        name,
        points_m,
        length_m,
        diameter_m: 1e-3 * r.number(s, "diameter_mm", (3.0, 100.0), Some(12.0)),
        mass_kg_m: r.number(s, "mass_kg_m", (0.01, 50.0), Some(0.1)),
    }
}

fn read_points(r: &mut Reader, s: &mut Section) -> Vec<Vec3<Enu>> {
    let before = r.problems.len();
    let list = r.points(s, POINTS_KEY, (-MAX_COORDINATE_M, MAX_COORDINATE_M));
    let points: Vec<Vec3<Enu>> = list.into_iter().map(|[east, north, up]| Vec3::new(east, north, up)).collect();
    match points[..] {
        [] if r.problems.len() == before => r.add_problem(s, POINTS_KEY, "", "one or two [east, north, up]", "missing"),
        [from, to] if (to - from).horizontal_norm() < MIN_SPAN_M => {
            let allowed = format!("at least {MIN_SPAN_M} m beside the first point");
            r.add_problem(s, POINTS_KEY, &shown(to), &allowed, "the points are above each other");
        }
        [] | [_] | [_, _] => {}
        [..] => {
            r.add_problem(s, POINTS_KEY, &format!("{} points", points.len()), "one or two [east, north, up]", "too many");
        }
    }
    points
}

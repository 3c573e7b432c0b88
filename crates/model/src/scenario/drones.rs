//! Drones that fly along a given path, beside the trainee's. This reader checks what the file alone shows; `spandrel check` also builds
//! the site and checks that the paths are clear of it.

use super::job::DroneSpec;
use super::names::read_name;
use super::point::MAX_COORDINATE_M;
use crate::frames::{Enu, Vec3};
use crate::shipped;
use crate::toml::{Reader, Section};

/// Maximum number of drones (estimate: more than fly at one bridge).
pub const MAX_DRONES: usize = 8;
/// Maximum number of points of a path.
pub const MAX_POINTS: usize = 200;
/// Minimum distance between two points in succession, m (estimate: a drone does not fly less).
pub const MIN_SPACING_M: f64 = 0.1;
/// Maximum speed, m/s. A drone moves at most half the width of its thinnest part in one step of the physics.
pub const MAX_SPEED_M_S: f64 = 15.0;
/// Key with the path.
pub const POINTS_KEY: &str = "points_m";
/// Aircraft if the file names none.
const DEFAULT_VEHICLE: &str = "phantom2";

/// Reads the tables `[[drones]]`.
pub(super) fn read(r: &mut Reader, root: &mut Section) -> Vec<DroneSpec> {
    let mut drones: Vec<DroneSpec> = Vec::new();
    for mut s in r.sections(root, "drones") {
        let drone = read_drone(r, &mut s);
        if drones.iter().any(|other| other.name == drone.name) {
            r.add_problem(&s, "name", &drone.name, "a unique name", "duplicate name");
        }
        r.finish(&s);
        drones.push(drone);
    }
    if drones.len() > MAX_DRONES {
        r.add_problem(root, "drones", &drones.len().to_string(), &format!("at most {MAX_DRONES} [[drones]]"), "too many");
    }
    drones
}

fn read_drone(r: &mut Reader, s: &mut Section) -> DroneSpec {
    let vehicles: Vec<(&'static str, &'static str)> = shipped::VEHICLES.iter().map(|(id, _)| (*id, *id)).collect();
    let default = vehicles.iter().position(|(id, _)| *id == DEFAULT_VEHICLE);
    DroneSpec {
        name: read_name(r, s, "name"),
        vehicle: r.keyword(s, "vehicle", &vehicles, default),
        points_m: read_points(r, s),
        speed_m_s: r.number(s, "speed_m_s", (0.1, MAX_SPEED_M_S), Some(3.0)),
        heading_deg: r.number(s, "heading_deg", (0.0, 360.0), Some(0.0)),
        at_s: r.number(s, "at_s", (0.0, 86_400.0), Some(0.0)),
        spread_s: r.number(s, "spread_s", (0.0, 3_600.0), Some(0.0)),
        wait_s: r.number(s, "wait_s", (0.0, 3_600.0), Some(0.0)),
        repeat: r.boolean(s, "repeat", false),
    }
}

fn read_points(r: &mut Reader, s: &mut Section) -> Vec<Vec3<Enu>> {
    let before = r.problems.len();
    let list = r.points(s, POINTS_KEY, (-MAX_COORDINATE_M, MAX_COORDINATE_M));
    let points: Vec<Vec3<Enu>> = list.into_iter().map(|[east, north, up]| Vec3::new(east, north, up)).collect();
    if points.is_empty() && r.problems.len() == before {
        r.add_problem(s, POINTS_KEY, "", "one or more [east, north, up]", "missing");
    }
    if points.len() > MAX_POINTS {
        r.add_problem(s, POINTS_KEY, &format!("{} points", points.len()), &format!("at most {MAX_POINTS} points"), "too many");
    }
    let close = points.windows(2).position(|pair| (pair[1] - pair[0]).norm() < MIN_SPACING_M);
    if let Some(k) = close {
        let (value, allowed) =
            (super::places::shown(points[k + 1]), format!("at least {MIN_SPACING_M} m from the point before it"));
        r.add_problem(s, POINTS_KEY, &value, &allowed, &format!("point {} is where point {} is", k + 2, k + 1));
    }
    points
}

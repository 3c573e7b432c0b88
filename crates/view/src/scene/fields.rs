//! Selects the ground triangles to draw: all, or fewer where the difference is invisible.

use super::sparse::{self, GridSquare};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;

/// Maximum side of a square drawn as two triangles, cells.
const MAX_SQUARE_CELLS: usize = 8;
/// Maximum angular error of the ground as seen from people and aircraft, rad: four pixels of a view 640 px and 84
/// degrees wide, on rolling hills.
const MAX_ANGULAR_ERROR_RAD: f64 = 0.012;
/// Minimum and maximum height tolerance, m (estimates: the thickness of grass, and a barely noticeable step).
const HEIGHT_TOLERANCE_M: (f64, f64) = (0.15, 3.0);
/// Tolerance factor near the shore, where a small height error moves the waterline a long way, and its range above and
/// below the water, m.
const SHORE_TOLERANCE: (f64, f64) = (0.4, 1.0);
/// Maximum depth of a visible lake bed, m (in the `water` shader, 99% of the light is lost on the way down and back).
pub const MAX_VISIBLE_DEPTH_M: f64 = 5.0;
/// Range around a bridge within which the light varies between cells, m, and the maximum square size there, cells.
const BRIDGE_DETAIL: (f64, usize) = (30.0, 2);

/// Returns all ground triangles.
pub fn all(site: &Site) -> Vec<[u32; 3]> {
    site.geometry().terrain.ground.triangles().1
}

/// Returns the ground with fewer triangles; the error tolerance is `tolerance_factor` times that of the direct view.
pub fn sparse(scenario: &Scenario, site: &Site, tolerance_factor: f64) -> Vec<[u32; 3]> {
    let (points, triangles) = site.geometry().terrain.ground.triangles();
    let side = points.len().isqrt();
    if side * side != points.len() {
        return triangles;
    }
    let field = GroundField { scenario, site, points: &points, side, viewpoints_m: viewpoints_m(scenario), tolerance_factor };
    sparse::triangles(side, MAX_SQUARE_CELLS, &|square| field.is_flat(square))
}

/// Returns the triangles that are at most `under_m` below the lake's surface.
pub fn shallow_triangles(scenario: &Scenario, site: &Site, triangles: &[[u32; 3]], under_m: f64) -> Vec<[u32; 3]> {
    let (points, _) = site.geometry().terrain.ground.triangles();
    let bottom_m = scenario.terrain.water_level_m - under_m;
    triangles.iter().filter(|corners| corners.iter().any(|k| points[*k as usize].up() > bottom_m)).copied().collect()
}

/// Returns the viewpoints of people and aircraft.
fn viewpoints_m(scenario: &Scenario) -> Vec<Vec3<Enu>> {
    let team = &scenario.ground_team;
    let paths = scenario.tasks.iter().flat_map(|task| task.path_m.iter().step_by(4).copied());
    paths.chain([team.pad_m, team.truck_m]).chain(team.inspector_places_m()).collect()
}

struct GroundField<'a> {
    scenario: &'a Scenario,
    site: &'a Site,
    points: &'a [Vec3<Enu>],
    side: usize,
    viewpoints_m: Vec<Vec3<Enu>>,
    tolerance_factor: f64,
}

impl GroundField<'_> {
    /// Checks whether a square is flat enough to draw from its corners alone.
    fn is_flat(&self, square: &GridSquare) -> bool {
        let corners = square.corners(self.side).map(|k| self.points[k]);
        let middle = corners[0].lerp(corners[2], 0.5);
        let half_m = 0.5 * (corners[2] - corners[0]).horizontal_norm();
        if square.size > BRIDGE_DETAIL.1 && self.site.geometry().nearest_member(middle, BRIDGE_DETAIL.0 + half_m).is_some() {
            return false;
        }
        let over_water_m = |p: &Vec3<Enu>| p.up() - self.scenario.terrain.water_level_m;
        if self.inside(square).all(|p| over_water_m(&p) < -MAX_VISIBLE_DEPTH_M) {
            return true;
        }
        let from_m = |eye: &Vec3<Enu>| math::hypot(eye.east() - middle.east(), eye.north() - middle.north()) - half_m;
        let nearest_m = self.viewpoints_m.iter().map(from_m).fold(f64::INFINITY, f64::min);
        let shore = self.inside(square).any(|p| over_water_m(&p).abs() < SHORE_TOLERANCE.1);
        let tolerance_m = self.tolerance_factor
            * (MAX_ANGULAR_ERROR_RAD * nearest_m).clamp(HEIGHT_TOLERANCE_M.0, HEIGHT_TOLERANCE_M.1)
            * if shore { SHORE_TOLERANCE.0 } else { 1.0 };
        self.inside(square).all(|p| (p.up() - surface_height_m(&corners, p)).abs() <= tolerance_m)
    }

    /// Returns all grid points in a square.
    fn inside(&self, square: &GridSquare) -> impl Iterator<Item = Vec3<Enu>> {
        let (first, size) = (square.row * self.side + square.column, square.size);
        (0..=size).flat_map(move |row| (0..=size).map(move |column| self.points[first + row * self.side + column]))
    }
}

/// Returns the height, in meters, at a point on the two triangles of a square.
fn surface_height_m([sw, se, ne, nw]: &[Vec3<Enu>; 4], p: Vec3<Enu>) -> f64 {
    let (x, y) = ((p.east() - sw.east()) / (ne.east() - sw.east()), (p.north() - sw.north()) / (ne.north() - sw.north()));
    if x >= y {
        sw.up() + x * (se.up() - sw.up()) + y * (ne.up() - se.up())
    } else {
        sw.up() + y * (nw.up() - sw.up()) + x * (ne.up() - nw.up())
    }
}

//! Chooses where to photograph a noticed defect from: close enough, not too oblique, with a clear view, not too close to
//! anything, and near the task's path.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{PlacedDefect, Scenario, Task};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Vehicle};

/// Fractions of the task's threshold by which candidate spots leave the path toward the defect or its normal. The pilot stays
/// on the path's corridor.
const LEAVING_FRACTIONS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];
/// Height above the surface at which lines of sight end, m.
const SURFACE_OFFSET_M: f64 = 0.02;
/// Clearance beyond the hull at the spot, m (estimate).
const EXTRA_CLEARANCE_M: f64 = 0.6;
/// Millimeters per meter.
const MM_PER_M: f64 = 1_000.0;
/// Cost per meter of distance from the pilot's present position, which prefers near spots among equally good ones (estimate).
const TRAVEL_COST_PER_M: f64 = 0.05;
/// Cost per meter of leaving the path (estimate).
const LEAVING_COST_PER_M: f64 = 0.15;
/// Cost of twice the wanted distance, and of twice the wanted incidence (estimate: both matter more than the way there).
const QUALITY_COST: f64 = 10.0;

/// Requirements for a spot from which to photograph.
#[derive(Debug, Clone, Copy)]
pub struct SpotWishes {
    /// Largest distance to the defect, m.
    pub distance_m: f64,
    /// Largest incidence angle, rad.
    pub incidence_rad: f64,
}

/// Returns the largest distance at which the camera reaches the ground sampling distance that the job asks for, m.
#[must_use]
pub fn job_distance_m(scenario: &Scenario, camera: &Camera) -> f64 {
    scenario.certification.max_gsd_mm / MM_PER_M * camera.focal_px()
}

/// Returns the distance from a defect to the nearest point of a task's path in front of it, m; infinity if there is none.
#[must_use]
pub fn distance_to_path_m(task: &Task, defect: &PlacedDefect) -> f64 {
    let in_front = task.path_m.iter().map(|p| *p - defect.position_m).filter(|line| line.dot(defect.normal) > 0.0);
    in_front.map(Vec3::norm).fold(f64::INFINITY, f64::min)
}

/// Returns the best spot for a pilot at a position; `None` if the defect is visible from none. `avoid` excludes spots within a
/// distance of a point.
#[must_use]
pub fn choose_spot(
    (site, task, vehicle): (&Site, &Task, &Vehicle),
    defect: &PlacedDefect,
    wishes: SpotWishes,
    (from_m, avoid): (Vec3<Enu>, Option<(Vec3<Enu>, f64)>),
    at: SimTime,
) -> Option<Vec3<Enu>> {
    let reach_m = wishes.distance_m + task.threshold_m;
    let near = |p: &&Vec3<Enu>| (**p - defect.position_m).norm() < reach_m.max(super::visual_search::MAX_SEARCH_DISTANCE_M);
    let mut candidates: Vec<(f64, Vec3<Enu>)> = Vec::new();
    for point in task.path_m.iter().filter(near) {
        for fraction in LEAVING_FRACTIONS {
            // Toward the defect, and toward the line on which the camera looks straight at it.
            let straight_m = defect.position_m + defect.normal * wishes.distance_m.min((*point - defect.position_m).norm());
            for goal in [defect.position_m, straight_m] {
                let leaving = (goal - *point).limited(fraction * task.threshold_m);
                let spot = *point + leaving;
                candidates.push((cost(spot, leaving.norm(), defect, wishes, from_m), spot));
            }
        }
    }
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    let allowed = |spot: &Vec3<Enu>| avoid.is_none_or(|(poor, radius_m)| (*spot - poor).norm() >= radius_m);
    candidates.into_iter().map(|(_, spot)| spot).filter(allowed).find(|spot| is_usable(site, vehicle, defect, *spot, at))
}

fn cost(spot: Vec3<Enu>, leaving_m: f64, defect: &PlacedDefect, wishes: SpotWishes, from_m: Vec3<Enu>) -> f64 {
    let line = spot - defect.position_m;
    let incidence_rad = math::acos((line.unit().dot(defect.normal)).clamp(-1.0, 1.0));
    let too_far = (line.norm() / wishes.distance_m - 1.0).max(0.0);
    let too_oblique = (incidence_rad / wishes.incidence_rad - 1.0).max(0.0);
    QUALITY_COST * (too_far + too_oblique) + LEAVING_COST_PER_M * leaving_m + TRAVEL_COST_PER_M * (spot - from_m).norm()
}

fn is_usable(site: &Site, vehicle: &Vehicle, defect: &PlacedDefect, spot: Vec3<Enu>, at: SimTime) -> bool {
    let eye = defect.position_m + defect.normal * SURFACE_OFFSET_M;
    let line = spot - eye;
    let (_, elevation) = super::stick_command::heading_and_elevation(-line.unit());
    let camera = &vehicle.camera;
    let reachable = (camera.gimbal_pitch_min_rad..=camera.gimbal_pitch_max_rad).contains(&elevation);
    let clearance_m = 0.5 * vehicle.hull.tip_to_tip_m + EXTRA_CLEARANCE_M;
    reachable
        && line.dot(defect.normal) > 0.0
        && site.nearest(spot, clearance_m, at).is_none()
        && site.ray(eye, line.unit(), line.norm(), at).is_none()
}

/// Checks whether the pilot can fly straight from one point to another without coming close to anything.
#[must_use]
pub fn is_way_clear(site: &Site, vehicle: &Vehicle, (from, to): (Vec3<Enu>, Vec3<Enu>), at: SimTime) -> bool {
    const STEP_M: f64 = 0.5;
    let clearance_m = 0.5 * vehicle.hull.tip_to_tip_m + 0.3;
    let steps = ((to - from).norm() / STEP_M).ceil().max(1.0) as usize;
    (1..=steps).all(|k| site.nearest(from.lerp(to, k as f64 / steps as f64), clearance_m, at).is_none())
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::{scenario, shipped, vehicle};

    /// Rounding of a limited step, m.
    const ROUNDING_M: f64 = 1e-9;
    const SEEDS: [u64; 3] = [1, 2, 3];

    /// Spots stay in the corridor of their task, keep clear of everything, and see the defect's front.
    #[test]
    fn prop_spots_are_in_the_corridor_with_a_clear_view() {
        let no_files = |name: &str| Err(format!("{name}: not found"));
        let job = scenario::read("two-bridges.toml", shipped::TWO_BRIDGES, &no_files).expect("valid");
        let aircraft = vehicle::read("phantom2.toml", shipped::PHANTOM2).expect("valid");
        let wishes = SpotWishes { distance_m: job_distance_m(&job, &aircraft.camera), incidence_rad: 0.9 };
        let at = SimTime::ZERO;
        let mut found = 0;
        for seed in SEEDS {
            let site = Site::build(&job, seed);
            for (defect, task) in site.defects().iter().flat_map(|d| job.tasks.iter().map(move |t| (d, t))) {
                let start = (task.path_m[0], None);
                let Some(spot) = choose_spot((&site, task, &aircraft), defect, wishes, start, at) else { continue };
                found += 1;
                let off_m = task.path_m.iter().map(|p| (*p - spot).norm()).fold(f64::INFINITY, f64::min);
                assert!(off_m <= 0.75 * task.threshold_m + ROUNDING_M, "defect {}, seed {seed}: {off_m} m", defect.id);
                assert!((spot - defect.position_m).dot(defect.normal) > 0.0, "defect {}, seed {seed}", defect.id);
                assert!(site.nearest(spot, 0.5 * aircraft.hull.tip_to_tip_m + EXTRA_CLEARANCE_M, at).is_none());
                let other = choose_spot((&site, task, &aircraft), defect, wishes, (task.path_m[0], Some((spot, 1.0))), at);
                assert!(other.is_none_or(|other| (other - spot).norm() >= 1.0));
            }
        }
        assert!(found >= 20, "only {found} of {} defects have a spot", 10 * SEEDS.len());
    }

    #[test]
    fn exact_job_distance_follows_from_the_focal_length() {
        let no_files = |name: &str| Err(format!("{name}: not found"));
        let job = scenario::read("two-bridges.toml", shipped::TWO_BRIDGES, &no_files).expect("valid");
        let aircraft = vehicle::read("phantom2.toml", shipped::PHANTOM2).expect("valid");
        // 2.54 mm/px with 4000 px over 84 degrees: 2000 px / tan(42 deg) = 2221 px.
        const TOLERANCE_M: f64 = 0.01;
        assert!((job_distance_m(&job, &aircraft.camera) - 5.642).abs() < TOLERANCE_M);
    }
}

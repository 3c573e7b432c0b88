//! Obstacle-free routes: an A* search on a grid, with the result straightened. Models a person who plans by sight.

use rustc_hash::{FxHashMap, FxHashSet};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

/// Grid spacing, m: finer than the height of the interlayer.
const GRID_SPACING_M: f64 = 2.0;
/// Preferred clearance, m (typical practice: 3 to 5 m, docs/src/reference/domain.md, "Stand-off and clearance").
const PREFERRED_CLEARANCE_M: f64 = 4.0;
/// Radius around an endpoint with too little clearance, m; within it, the route may come as close to obstacles as the
/// endpoint (estimate: within the task's "too close" distance).
const ENDPOINT_RADIUS_M: f64 = 8.0;
/// Clearance tolerance at such an endpoint, m (estimate: stand-offs are rounded).
const ENDPOINT_CLEARANCE_TOLERANCE_M: f64 = 0.1;
/// Clearances to try, in order, as fractions of the range from the minimum to the preferred clearance.
const CLEARANCE_FRACTIONS: [f64; 3] = [1.0, 0.7, 0.4];
/// Search margin around the two endpoints, m.
const SEARCH_MARGIN_M: f64 = 40.0;
/// Maximum number of expanded cells; the two-bridge site needs about a tenth.
const MAX_EXPANSIONS: usize = 400_000;
/// Expanded cells after which the search checks whether the goal is in a closed pocket; most searches end sooner.
const PROBE_AFTER_EXPANSIONS: usize = 1_000;

type GridCell = [i32; 3];

/// Returns a polyline from `from` to `to`, including both, that keeps `clearance_m` where possible. If
/// `required_clearance_m` is given, the route keeps that clearance, including from traffic at any time, except near an
/// endpoint that has less. Falls back to a smaller clearance if no such route exists, and to a straight line if no
/// route is found.
#[must_use]
pub fn route(
    site: &Site,
    (from, to): (Vec3<Enu>, Vec3<Enu>),
    clearance_m: f64,
    required_clearance_m: Option<f64>,
    ceiling_height_m: f64,
    at: SimTime,
) -> Vec<Vec3<Enu>> {
    let mut space = SearchSpace { site, clearance_m, at, origin: from, to, ceiling_height_m, rule: None };
    let found = match required_clearance_m {
        Some(required_clearance_m) => CLEARANCE_FRACTIONS.into_iter().find_map(|share| {
            space.rule = Some(space.clearance_rule(clearance_m + share * (required_clearance_m - clearance_m).max(0.0)));
            space.is_line_clear(from, to, PREFERRED_CLEARANCE_M).then(Vec::new).or_else(|| space.search())
        }),
        None => None,
    };
    let found = found.or_else(|| {
        space.rule = None;
        if space.is_line_clear(from, to, PREFERRED_CLEARANCE_M) { Some(Vec::new()) } else { space.search() }
    });
    let cells = found.unwrap_or_default();
    let mut points = vec![from];
    points.extend(cells.iter().map(|c| space.center(*c)));
    points.push(to);
    straighten(&space, &points)
}

/// A clearance that applies except near constrained endpoints.
struct ClearanceRule {
    required_clearance_m: f64,
    /// Required clearance near the origin and near the goal, m.
    endpoint_clearances_m: [f64; 2],
}

struct SearchSpace<'a> {
    rule: Option<ClearanceRule>,
    site: &'a Site,
    clearance_m: f64,
    at: SimTime,
    origin: Vec3<Enu>,
    to: Vec3<Enu>,
    ceiling_height_m: f64,
}

impl SearchSpace<'_> {
    fn center(&self, cell: GridCell) -> Vec3<Enu> {
        self.origin + Vec3::new(f64::from(cell[0]), f64::from(cell[1]), f64::from(cell[2])) * GRID_SPACING_M
    }

    /// Returns the clearance rule for `required_clearance_m`, relaxed where an endpoint has less.
    fn clearance_rule(&self, required_clearance_m: f64) -> ClearanceRule {
        let still =
            |end| self.site.nearest(end, required_clearance_m, self.at).map_or(required_clearance_m, |near| near.distance_m);
        ClearanceRule {
            required_clearance_m,
            endpoint_clearances_m: [self.origin, self.to]
                .map(|end| (still(end) - ENDPOINT_CLEARANCE_TOLERANCE_M).max(self.clearance_m)),
        }
    }

    fn clearance(&self, p: Vec3<Enu>) -> f64 {
        let Some(keep) = &self.rule else {
            return self.site.nearest(p, PREFERRED_CLEARANCE_M, self.at).map_or(PREFERRED_CLEARANCE_M, |near| near.distance_m);
        };
        let reach_m = keep.required_clearance_m.max(PREFERRED_CLEARANCE_M);
        let still = self.site.nearest(p, reach_m, self.at).map_or(reach_m, |near| near.distance_m);
        self.site.traffic().min_distance_over_time_m(p, still).unwrap_or(still)
    }

    /// Returns the clearance at a cell's center, in meters; `None` if the route may not pass there. The goal is always allowed.
    fn cell_clearance_m(&self, cell: GridCell, goal: GridCell) -> Option<f64> {
        let p = self.center(cell);
        if !self.is_inside(p) {
            return None;
        }
        let clearance_m = self.clearance(p);
        (cell == goal || clearance_m >= self.required_clearance_at_m(p)).then_some(clearance_m)
    }

    fn search(&self) -> Option<Vec<GridCell>> {
        let d = (self.to - self.origin) / GRID_SPACING_M;
        let goal = [d.east().round() as i32, d.north().round() as i32, d.up().round() as i32];
        search_grid(goal, |cell| self.cell_clearance_m(cell, goal))
    }

    /// Returns the required clearance at a point, in meters.
    fn required_clearance_at_m(&self, p: Vec3<Enu>) -> f64 {
        let Some(keep) = &self.rule else { return self.clearance_m };
        let near = [self.origin, self.to].map(|end| (p - end).norm() < ENDPOINT_RADIUS_M);
        let ends = keep.endpoint_clearances_m.into_iter().zip(near).filter_map(|(end_m, near)| near.then_some(end_m));
        ends.fold(keep.required_clearance_m, f64::min).max(self.clearance_m)
    }

    fn is_inside(&self, p: Vec3<Enu>) -> bool {
        let low = |a: f64, b: f64| a.min(b) - SEARCH_MARGIN_M;
        let high = |a: f64, b: f64| a.max(b) + SEARCH_MARGIN_M;
        let (a, b) = (self.origin, self.to);
        p.east() >= low(a.east(), b.east())
            && p.east() <= high(a.east(), b.east())
            && p.north() >= low(a.north(), b.north())
            && p.north() <= high(a.north(), b.north())
            && p.up() <= self.ceiling_height_m.max(a.up().max(b.up()) + SEARCH_MARGIN_M)
            && p.up() >= low(a.up(), b.up())
    }

    fn is_line_clear(&self, a: Vec3<Enu>, b: Vec3<Enu>, clearance_m: f64) -> bool {
        let length = (b - a).norm();
        let steps = (length / 0.75).ceil().max(1.0) as usize;
        (0..=steps).all(|k| {
            let p = a.lerp(b, k as f64 / steps as f64);
            // Near its ends, the line may be as close to obstacles as the endpoints.
            let near_end = (p - a).norm().min((p - b).norm()) < PREFERRED_CLEARANCE_M;
            let least = if near_end { self.clearance_m.min(clearance_m) } else { clearance_m };
            self.clearance(p) >= if self.rule.is_some() { self.required_clearance_at_m(p) } else { least }
        })
    }
}

/// Searches for a route from cell [0, 0, 0] to the goal. `clearance` returns a cell's clearance, m, or `None` if the cell is
/// blocked or outside the search box. It is called at most once per cell, because a distance query costs far more than
/// the rest of the search.
fn search_grid(goal: GridCell, mut clearance: impl FnMut(GridCell) -> Option<f64>) -> Option<Vec<GridCell>> {
    let mut known: FxHashMap<GridCell, Option<f64>> = FxHashMap::default();
    let mut clearance = |cell: GridCell| *known.entry(cell).or_insert_with(|| clearance(cell));
    let mut open = BinaryHeap::new();
    let mut best: FxHashMap<GridCell, (f64, GridCell)> = FxHashMap::default();
    let mut pocket = PocketProbe::new(goal);
    best.insert([0, 0, 0], (0.0, [0, 0, 0]));
    open.push(Reverse((0u64, [0, 0, 0])));
    for expansions in 0..MAX_EXPANSIONS {
        let Reverse((_, cell)) = open.pop()?;
        if cell == goal {
            return Some(reconstruct_path(&best, goal));
        }
        if expansions >= PROBE_AFTER_EXPANSIONS && pocket.step(&mut clearance, |cell| best.contains_key(cell)) {
            return None;
        }
        let cost = best[&cell].0;
        for next in neighbors(cell) {
            let Some(clearance_m) = clearance(next) else { continue };
            let total = cost + step_cost(cell, next, clearance_m);
            if best.get(&next).is_none_or(|(known, _)| total < *known) {
                best.insert(next, (total, cell));
                let estimate = total + distance(next, goal);
                // Uses integer millimeters as the key, because floats have no total order.
                open.push(Reverse(((estimate * 1000.0) as u64, next)));
            }
        }
    }
    None
}

/// Flood from the goal, one cell at a time, that finds out whether the goal is in a closed pocket. Without it, the search would
/// first visit every cell outside of the pocket.
struct PocketProbe {
    queue: VecDeque<GridCell>,
    seen: FxHashSet<GridCell>,
    connected: bool,
}

impl PocketProbe {
    fn new(goal: GridCell) -> Self {
        Self { queue: [goal].into(), seen: FxHashSet::from_iter([goal]), connected: false }
    }

    /// Visits the next cell. Returns true if every cell that can be reached from the goal has been visited without meeting
    /// a cell reached by the search.
    fn step(&mut self, mut clearance: impl FnMut(GridCell) -> Option<f64>, reached: impl Fn(&GridCell) -> bool) -> bool {
        if self.connected {
            return false;
        }
        let Some(cell) = self.queue.pop_front() else { return true };
        for next in neighbors(cell) {
            self.connected |= reached(&next);
            if clearance(next).is_some() && self.seen.insert(next) {
                self.queue.push_back(next);
            }
        }
        false
    }
}

fn step_cost(from: GridCell, to: GridCell, clearance_m: f64) -> f64 {
    let closeness = (PREFERRED_CLEARANCE_M - clearance_m).max(0.0) / PREFERRED_CLEARANCE_M;
    distance(from, to) * (1.0 + 6.0 * closeness * closeness)
}

fn neighbors(c: GridCell) -> impl Iterator<Item = GridCell> {
    (-1..=1)
        .flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| [x, y, z])))
        .filter(|d| *d != [0, 0, 0])
        .map(move |d| [c[0] + d[0], c[1] + d[1], c[2] + d[2]])
}

fn distance(a: GridCell, b: GridCell) -> f64 {
    let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]].map(f64::from);
    GRID_SPACING_M * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
}

fn reconstruct_path(best: &FxHashMap<GridCell, (f64, GridCell)>, goal: GridCell) -> Vec<GridCell> {
    let mut cells = vec![goal];
    let mut at = goal;
    while let Some((_, from)) = best.get(&at) {
        if *from == at {
            break;
        }
        at = *from;
        cells.push(at);
    }
    cells.reverse();
    cells
}

/// Removes every point that an unobstructed straight line can bypass.
fn straighten(space: &SearchSpace, points: &[Vec3<Enu>]) -> Vec<Vec3<Enu>> {
    let mut kept = vec![points[0]];
    let mut at = 0;
    while at + 1 < points.len() {
        let wish = 0.75 * PREFERRED_CLEARANCE_M;
        let far = (at + 1..points.len()).rev().find(|k| space.is_line_clear(points[at], points[*k], wish)).unwrap_or(at + 1);
        kept.push(points[far]);
        at = far;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Half the edge of the cube-shaped search box, in cells.
    const HALF_EDGE: i32 = 20;

    /// Returns a cell's clearance in an empty box, and `None` outside of it.
    fn in_box(cell: GridCell) -> Option<f64> {
        cell.iter().all(|c| c.abs() <= HALF_EDGE).then_some(PREFERRED_CLEARANCE_M)
    }

    /// Returns whether a cell belongs to a closed shell around `center`, two cells away from it.
    fn is_shell(cell: GridCell, center: GridCell) -> bool {
        (0..3).map(|k| (cell[k] - center[k]).abs()).max() == Some(2)
    }

    /// Runs a search; returns the route and how often the clearance of each cell was queried.
    fn search_counted(
        goal: GridCell,
        clear: impl Fn(GridCell) -> Option<f64>,
    ) -> (Option<Vec<GridCell>>, BTreeMap<GridCell, usize>) {
        let mut queries: BTreeMap<GridCell, usize> = BTreeMap::new();
        let found = search_grid(goal, |cell| {
            *queries.entry(cell).or_default() += 1;
            clear(cell)
        });
        (found, queries)
    }

    #[test]
    fn regress_each_cell_is_queried_once() {
        // A wall with one opening far from the straight line.
        let wall = |cell: GridCell| if cell[0] == 5 && cell[1] != 12 { None } else { in_box(cell) };
        let (found, queries) = search_counted([10, 0, 0], wall);
        let route = found.expect("the opening is passable");
        assert!(route.iter().any(|cell| cell[0] == 5 && cell[1] == 12), "{route:?}");
        assert!(queries.len() > 1_000, "only {} cells", queries.len());
        assert!(queries.values().all(|count| *count == 1));
    }

    #[test]
    fn regress_goal_in_a_pocket_ends_the_search_early() {
        let goal = [12, 0, 0];
        let (found, queries) = search_counted(goal, |cell| if is_shell(cell, goal) { None } else { in_box(cell) });
        assert_eq!(found, None);
        let all = (2 * HALF_EDGE as usize + 1).pow(3);
        assert!(queries.len() < all / 4, "{} of {all} cells", queries.len());
    }

    #[test]
    fn regress_start_in_a_pocket_ends_the_search_at_its_walls() {
        let (found, queries) = search_counted([12, 0, 0], |cell| if is_shell(cell, [0, 0, 0]) { None } else { in_box(cell) });
        assert_eq!(found, None);
        assert_eq!(queries.len(), 5 * 5 * 5, "the pocket and its walls");
    }

    #[test]
    fn exact_open_route_is_straight() {
        let (found, _) = search_counted([3, 3, 0], in_box);
        assert_eq!(found, Some(vec![[0, 0, 0], [1, 1, 0], [2, 2, 0], [3, 3, 0]]));
    }
}

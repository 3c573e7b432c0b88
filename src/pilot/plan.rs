//! The way from here to there around what stands: A* on a grid, pulled straight. A person plans this by looking.

use crate::base::frames::{Enu, Vec3};
use crate::base::time::SimTime;
use crate::site::Site;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Grid spacing, m: finer than the interlayer is high.
const CELL_M: f64 = 2.0;
/// Clearance that a person likes to keep, m (practice: 3 to 5 m, domain.md 3e).
const COMFORT_M: f64 = 4.0;
/// Room around the two ends for the search, m.
const MARGIN_M: f64 = 40.0;
/// Cells looked at before giving up; the two-bridge site needs about a tenth.
const MAX_EXPANSIONS: usize = 400_000;

type Cell = [i32; 3];

/// A flyable polyline from `from` to `to`, both included, that keeps `clearance_m` where it can; a straight line when no way
/// is found.
#[must_use]
pub fn route(site: &Site, from: Vec3<Enu>, to: Vec3<Enu>, clearance_m: f64, ceiling_up_m: f64, at: SimTime) -> Vec<Vec3<Enu>> {
    let space = Space { site, clearance_m, at, origin: from, to, ceiling_up_m };
    if space.line_is_free(from, to, COMFORT_M) {
        return vec![from, to];
    }
    let cells = search(&space).unwrap_or_default();
    let mut points = vec![from];
    points.extend(cells.iter().map(|c| space.centre(*c)));
    points.push(to);
    pull_straight(&space, &points)
}

struct Space<'a> {
    site: &'a Site,
    clearance_m: f64,
    at: SimTime,
    origin: Vec3<Enu>,
    to: Vec3<Enu>,
    ceiling_up_m: f64,
}

impl Space<'_> {
    fn centre(&self, cell: Cell) -> Vec3<Enu> {
        self.origin + Vec3::new(f64::from(cell[0]), f64::from(cell[1]), f64::from(cell[2])) * CELL_M
    }

    fn clearance(&self, p: Vec3<Enu>) -> f64 {
        self.site.nearest(p, COMFORT_M, self.at).map_or(COMFORT_M, |near| near.distance_m)
    }

    fn inside(&self, p: Vec3<Enu>) -> bool {
        let low = |a: f64, b: f64| a.min(b) - MARGIN_M;
        let high = |a: f64, b: f64| a.max(b) + MARGIN_M;
        let (a, b) = (self.origin, self.to);
        p.east() >= low(a.east(), b.east())
            && p.east() <= high(a.east(), b.east())
            && p.north() >= low(a.north(), b.north())
            && p.north() <= high(a.north(), b.north())
            && p.up() <= self.ceiling_up_m.max(a.up().max(b.up()) + MARGIN_M)
            && p.up() >= low(a.up(), b.up())
    }

    fn line_is_free(&self, a: Vec3<Enu>, b: Vec3<Enu>, clearance_m: f64) -> bool {
        let length = (b - a).norm();
        let steps = (length / 0.75).ceil().max(1.0) as usize;
        (0..=steps).all(|k| {
            let p = a.lerp(b, k as f64 / steps as f64);
            // Near the two ends the line may start or finish as near to things as they are.
            let near_end = (p - a).norm().min((p - b).norm()) < COMFORT_M;
            self.clearance(p) >= if near_end { self.clearance_m.min(clearance_m) } else { clearance_m }
        })
    }
}

fn search(space: &Space) -> Option<Vec<Cell>> {
    let goal = {
        let d = (space.to - space.origin) / CELL_M;
        [d.east().round() as i32, d.north().round() as i32, d.up().round() as i32]
    };
    let mut open = BinaryHeap::new();
    let mut best: BTreeMap<Cell, (f64, Cell)> = BTreeMap::new();
    best.insert([0, 0, 0], (0.0, [0, 0, 0]));
    open.push(Reverse((0u64, [0, 0, 0])));
    for _ in 0..MAX_EXPANSIONS {
        let Reverse((_, cell)) = open.pop()?;
        if cell == goal {
            return Some(trace(&best, goal));
        }
        let cost = best[&cell].0;
        for next in neighbours(cell) {
            let Some(step) = step_cost(space, cell, next, goal) else { continue };
            let total = cost + step;
            if best.get(&next).is_none_or(|(known, _)| total < *known) {
                best.insert(next, (total, cell));
                let estimate = total + distance(next, goal);
                // Millimetres as an integer key: total order without floats.
                open.push(Reverse(((estimate * 1000.0) as u64, next)));
            }
        }
    }
    None
}

fn step_cost(space: &Space, from: Cell, to: Cell, goal: Cell) -> Option<f64> {
    let p = space.centre(to);
    if !space.inside(p) {
        return None;
    }
    let clearance = space.clearance(p);
    if clearance < space.clearance_m && to != goal {
        return None;
    }
    let closeness = (COMFORT_M - clearance).max(0.0) / COMFORT_M;
    Some(distance(from, to) * (1.0 + 6.0 * closeness * closeness))
}

fn neighbours(c: Cell) -> impl Iterator<Item = Cell> {
    (-1..=1)
        .flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| [x, y, z])))
        .filter(|d| *d != [0, 0, 0])
        .map(move |d| [c[0] + d[0], c[1] + d[1], c[2] + d[2]])
}

fn distance(a: Cell, b: Cell) -> f64 {
    let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2]].map(f64::from);
    CELL_M * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
}

fn trace(best: &BTreeMap<Cell, (f64, Cell)>, goal: Cell) -> Vec<Cell> {
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

/// Leaves out every point that a free straight line can skip.
fn pull_straight(space: &Space, points: &[Vec3<Enu>]) -> Vec<Vec3<Enu>> {
    let mut kept = vec![points[0]];
    let mut at = 0;
    while at + 1 < points.len() {
        let wish = 0.75 * COMFORT_M;
        let far = (at + 1..points.len()).rev().find(|k| space.line_is_free(points[at], points[*k], wish)).unwrap_or(at + 1);
        kept.push(points[far]);
        at = far;
    }
    kept
}

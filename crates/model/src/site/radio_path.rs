//! The radio path between the pilot and the aircraft: straight through concrete, or around the nearest edge.
//!
//! Estimates: the signal takes the better of the two ways, one edge stands for all that is in the way, and traffic, reflections and the
//! ground's reflection have no effect. Metal, ground and water let nothing through.

use super::geometry::{Geometry, Passage};
use crate::elements::ElementMaterial;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::radio::{self, RadioWay};

/// Height of the pilot's antenna above the feet, m (estimate: a controller held in front of the body).
pub const PILOT_ANTENNA_HEIGHT_M: f64 = 1.2;
/// Number of directions across the straight line in which an edge is searched, and the distances of the search, m. Beyond the last
/// one, hardly any signal remains (a loss of 44 dB at 2.4 GHz, 32 m behind an edge that is 14 m away).
const EDGE_DIRECTIONS: u32 = 8;
const EDGE_DISTANCES_M: [f64; 8] = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
/// Number of halvings between two of these distances: the edge is found within 1/16 of their difference.
const EDGE_REFINEMENTS: usize = 4;
/// Smallest distance of an edge from an antenna, m: nearer, the formula does not hold.
const MIN_EDGE_DISTANCE_M: f64 = 0.5;

/// The edge around which a signal bends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadioEdge {
    /// Distance of the edge from the straight line between the antennas, m.
    pub height_m: f64,
    /// Distances of the edge from the antennas along the straight line, m.
    pub distances_m: (f64, f64),
}

/// The path between two antennas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadioPath {
    /// Distance between the antennas, m.
    pub distance_m: f64,
    /// Number of concrete bodies on the straight line, and the length inside them, m; `None` if metal, ground or water is in the way.
    pub concrete: Option<(u32, f64)>,
    /// Nearest edge; `None` if the straight line is free, or if no edge is near.
    pub edge: Option<RadioEdge>,
}

impl RadioPath {
    /// Finds the path. The aircraft's antenna is outside of all solids.
    #[must_use]
    pub fn between(geometry: &Geometry, pilot_m: Vec3<Enu>, aircraft_m: Vec3<Enu>) -> Self {
        let line = aircraft_m - pilot_m;
        let distance_m = line.norm();
        if distance_m <= 2.0 * MIN_EDGE_DISTANCE_M {
            return Self { distance_m, concrete: Some((0, 0.0)), edge: None };
        }
        let direction = line.unit();
        let passages = geometry.passages(pilot_m, direction, distance_m);
        let ground_m = geometry.ground_hit_m(pilot_m, direction, distance_m);
        let blocked = blocked_range(&passages, ground_m.map(|from_m| (from_m, distance_m)));
        let edge = blocked.and_then(|(from_m, to_m)| {
            let at_m = (0.5 * (from_m + to_m)).clamp(MIN_EDGE_DISTANCE_M, distance_m - MIN_EDGE_DISTANCE_M);
            let height_m = edge_height_m(geometry, (pilot_m, aircraft_m), at_m)?;
            Some(RadioEdge { height_m, distances_m: (at_m, distance_m - at_m) })
        });
        let lets_through = |passage: &Passage| !is_metal(geometry, passage.member);
        let concrete = (ground_m.is_none() && passages.iter().all(lets_through)).then(|| bodies(&passages));
        Self { distance_m, concrete, edge }
    }

    /// Returns the loss between the antennas in excess of free space, dB, and the way that has it; infinite if nothing arrives.
    #[must_use]
    pub fn excess_loss_db(&self, frequency_ghz: f64) -> (f64, RadioWay) {
        if self.concrete == Some((0, 0.0)) {
            return (0.0, RadioWay::LineOfSight);
        }
        let through = self.concrete.map(|(count, length_m)| {
            f64::from(count) * radio::concrete_faces_db() + length_m * radio::concrete_db_per_m(frequency_ghz)
        });
        let around = self
            .edge
            .map(|edge| radio::knife_edge_loss_db(radio::diffraction_parameter(edge.height_m, edge.distances_m, frequency_ghz)));
        let ways = [(around, RadioWay::AroundEdge), (through, RadioWay::ThroughConcrete)];
        let known = ways.into_iter().filter_map(|(loss_db, way)| loss_db.map(|loss_db| (loss_db, way)));
        known.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, RadioWay::Blocked))
    }

    /// Returns the loss between the antennas, dB, and the way that has it.
    #[must_use]
    pub fn loss_db(&self, frequency_ghz: f64) -> (f64, RadioWay) {
        let (excess_db, way) = self.excess_loss_db(frequency_ghz);
        (radio::free_space_loss_db(self.distance_m, frequency_ghz) + excess_db, way)
    }
}

fn is_metal(geometry: &Geometry, member: usize) -> bool {
    geometry.members().get(member).is_some_and(|member| member.element.material() == ElementMaterial::Steel)
}

/// Returns the range from the first to the last obstacle, m from the pilot.
fn blocked_range(passages: &[Passage], ground: Option<(f64, f64)>) -> Option<(f64, f64)> {
    let ranges = passages.iter().map(|passage| (passage.enter_m, passage.leave_m)).chain(ground);
    ranges.reduce(|all, one| (all.0.min(one.0), all.1.max(one.1)))
}

/// Returns the number of bodies that sorted passages form, and the length inside them, m. Members that touch or overlap are one body.
fn bodies(passages: &[Passage]) -> (u32, f64) {
    let (mut count, mut length_m, mut end_m) = (0, 0.0, f64::NEG_INFINITY);
    for Passage { enter_m, leave_m, .. } in passages {
        count += u32::from(*enter_m > end_m);
        length_m += (leave_m - enter_m.max(end_m)).max(0.0);
        end_m = end_m.max(*leave_m);
    }
    (count, length_m)
}

/// Returns the distance from the straight line, at `at_m` from the first point, beyond which the way to both points is free, m; `None`
/// if it is longer than the last distance of the search.
fn edge_height_m(geometry: &Geometry, (from, to): (Vec3<Enu>, Vec3<Enu>), at_m: f64) -> Option<f64> {
    let direction = (to - from).unit();
    let foot = from + direction * at_m;
    let across = across(direction);
    let is_free = |angle: u32, height_m: f64| {
        let (sin, cos) = math::sin_cos(math::TAU * f64::from(angle) / f64::from(EDGE_DIRECTIONS));
        let via = foot + (across.0 * cos + across.1 * sin) * height_m;
        !geometry.hides(from, via, 0.0) && !geometry.hides(via, to, 0.0)
    };
    let mut blocked_m = 0.0;
    for free_m in EDGE_DISTANCES_M {
        let found = (0..EDGE_DIRECTIONS).filter(|angle| is_free(*angle, free_m));
        let heights = found.map(|angle| refined(|height_m| is_free(angle, height_m), blocked_m, free_m));
        if let Some(height_m) = heights.min_by(f64::total_cmp) {
            return Some(height_m);
        }
        blocked_m = free_m;
    }
    None
}

/// Returns the smallest free distance between a blocked and a free one.
fn refined(is_free: impl Fn(f64) -> bool, mut blocked_m: f64, mut free_m: f64) -> f64 {
    for _ in 0..EDGE_REFINEMENTS {
        let middle_m = 0.5 * (blocked_m + free_m);
        if is_free(middle_m) {
            free_m = middle_m;
        } else {
            blocked_m = middle_m;
        }
    }
    free_m
}

/// Returns two unit vectors across a direction: a level one, and one that points up.
fn across(direction: Vec3<Enu>) -> (Vec3<Enu>, Vec3<Enu>) {
    let level = Vec3::new(direction.north(), -direction.east(), 0.0);
    let side = if level.norm() > f64::EPSILON { level.unit() } else { Vec3::new(1.0, 0.0, 0.0) };
    (side, side.cross(direction))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radio::{CONTROL, VIDEO};
    use crate::scenario::bridges::Member;
    use crate::site::Site;
    use crate::{scenario, shipped};

    /// Error of the edge's height: 1/16 of the difference between two distances of the search, m.
    const EDGE_ERROR_M: f64 = 0.13;

    fn site(text: &str) -> Site {
        Site::without_defects(&scenario::read("job.toml", text, &|file| Err(format!("no {file}"))).unwrap())
    }

    /// Returns the middle, and the lowest and highest corners, of a deck slab of the shipped job with two bridges.
    fn deck(site: &Site) -> (Vec3<Enu>, Vec3<Enu>, Vec3<Enu>) {
        let is_deck = |member: &&Member| member.name.contains("slab/");
        let slabs: Vec<_> = site.members().iter().filter(is_deck).collect();
        let corners = &slabs[slabs.len() / 2].solid.vertices_m;
        let ranges = [0, 1, 2].map(|k| math::range(corners.iter().map(|corner| corner.array()[k])));
        let at = |pick: fn((f64, f64)) -> f64| Vec3::new(pick(ranges[0]), pick(ranges[1]), pick(ranges[2]));
        (at(|(low, high)| 0.5 * (low + high)), at(|(low, _)| low), at(|(_, high)| high))
    }

    #[test]
    fn exact_free_line_has_only_the_loss_of_free_space() {
        let site = site(shipped::TWO_BRIDGES);
        let pilot_m = site.inspector().at(crate::time::SimTime::ZERO).feet_m + Vec3::new(0.0, 0.0, PILOT_ANTENNA_HEIGHT_M);
        let path = RadioPath::between(site.geometry(), pilot_m, pilot_m + Vec3::new(0.0, 0.0, 80.0));
        assert_eq!(path, RadioPath { distance_m: 80.0, concrete: Some((0, 0.0)), edge: None });
        assert_eq!(path.loss_db(2.4), (radio::free_space_loss_db(80.0, 2.4), RadioWay::LineOfSight));
        // So near, nothing is between the antennas.
        assert_eq!(RadioPath::between(site.geometry(), pilot_m, pilot_m).loss_db(2.4).1, RadioWay::LineOfSight);
    }

    #[test]
    fn exact_touching_and_overlapping_members_are_one_body() {
        let of = |ranges: &[(f64, f64)]| {
            bodies(
                &ranges
                    .iter()
                    .map(|(enter_m, leave_m)| Passage { member: 0, enter_m: *enter_m, leave_m: *leave_m })
                    .collect::<Vec<_>>(),
            )
        };
        assert_eq!(of(&[]), (0, 0.0));
        assert_eq!(of(&[(1.0, 2.0), (2.0, 3.5), (3.0, 3.25)]), (1, 2.5));
        assert_eq!(of(&[(1.0, 2.0), (4.0, 4.5)]), (2, 1.5));
    }

    #[test]
    fn exact_slab_between_the_antennas_attenuates_by_its_thickness() {
        let site = site(shipped::TWO_BRIDGES);
        let (middle, low, high) = deck(&site);
        let above = Vec3::new(middle.east(), middle.north(), high.up() + 3.0);
        let below = Vec3::new(middle.east(), middle.north(), low.up() - 0.3);
        let path = RadioPath::between(site.geometry(), above, below);
        let (count, length_m) = path.concrete.unwrap();
        // The deck has layers, which are one body.
        assert_eq!(count, 1, "{path:?}");
        assert!(length_m >= high.up() - low.up() - 1e-9 && length_m < 1.0, "{path:?}");
        let through_db = radio::concrete_faces_db() + length_m * radio::concrete_db_per_m(2.4);
        assert!(path.excess_loss_db(2.4).0 <= through_db);
    }

    #[test]
    fn val_deck_edge_between_the_antennas_attenuates_as_a_knife_edge() {
        let site = site(shipped::TWO_BRIDGES);
        let (middle, low, high) = deck(&site);
        // Both antennas are outside of the bridge's width, and the line between them passes 1 m above and then below the deck's edge.
        let wide_m = high.east() - low.east();
        let pilot_m = Vec3::new(high.east() + 0.5 * wide_m, middle.north(), high.up() + 12.0);
        let aircraft_m = Vec3::new(middle.east(), middle.north(), low.up() - 3.0);
        let path = RadioPath::between(site.geometry(), pilot_m, aircraft_m);
        let edge = path.edge.unwrap();
        assert!(edge.height_m > 0.0 && edge.height_m <= 32.0, "{path:?}");
        let (control_db, video_db) = (path.excess_loss_db(CONTROL.frequency_ghz).0, path.excess_loss_db(VIDEO.frequency_ghz).0);
        assert!(control_db > 6.0 && video_db > control_db, "{control_db} {video_db} {path:?}");
    }

    #[test]
    fn prop_edge_is_found_within_the_error_of_the_search() {
        for wanted_m in [0.1, 0.3, 0.9, 1.7, 3.1] {
            let above = EDGE_DISTANCES_M.into_iter().find(|free_m| *free_m >= wanted_m).unwrap();
            let below = EDGE_DISTANCES_M.into_iter().rev().find(|free_m| *free_m < wanted_m).unwrap_or(0.0);
            let found_m = refined(|height_m| height_m >= wanted_m, below, above);
            assert!((0.0..=EDGE_ERROR_M).contains(&(found_m - wanted_m)), "{wanted_m} {found_m}");
        }
    }

    #[test]
    fn prop_more_obstruction_never_means_less_loss() {
        let path = |height_m: f64, length_m: f64| RadioPath {
            distance_m: 100.0,
            concrete: Some((1, length_m)),
            edge: Some(RadioEdge { height_m, distances_m: (80.0, 20.0) }),
        };
        for link in [CONTROL, VIDEO] {
            let loss_db = |k: u32| path(0.1 * f64::from(k), 0.01 * f64::from(k)).loss_db(link.frequency_ghz).0;
            assert!((1..160).all(|k| loss_db(k) >= loss_db(k - 1)));
        }
        assert_eq!(path(16.0, 0.1).excess_loss_db(2.4).1, RadioWay::ThroughConcrete);
        assert_eq!(path(0.1, 2.0).excess_loss_db(2.4).1, RadioWay::AroundEdge);
    }

    #[test]
    fn exact_metal_and_ground_let_nothing_through() {
        let path = RadioPath { distance_m: 100.0, concrete: None, edge: None };
        assert_eq!(path.loss_db(2.4), (f64::INFINITY, RadioWay::Blocked));
        let site = site(shipped::GIRDER);
        let is_steel = |member: &&Member| member.element.material() == ElementMaterial::Steel;
        let girder = site.members().iter().find(is_steel).unwrap();
        let count = girder.solid.vertices_m.len() as f64;
        let middle = girder.solid.vertices_m.iter().fold(Vec3::zero(), |sum, corner| sum + *corner) * (1.0 / count);
        let side = Vec3::new(6.0, 6.0, 0.0);
        assert_eq!(RadioPath::between(site.geometry(), middle - side, middle + side).concrete, None);
        let ground_m = Vec3::new(0.0, 0.0, site.ground_up_m(0.0, 0.0));
        let (above, below) = (ground_m + Vec3::new(0.0, 0.0, 4.0), ground_m - Vec3::new(0.0, 0.0, 4.0));
        assert_eq!(RadioPath::between(site.geometry(), above, below).concrete, None);
    }
}

//! Tracks of moving objects: lanes as polylines that are parameterized by arc length.

use super::movers::MoverPlacement;
use crate::frames::{Enu, Vec3};

/// A lane with its arc lengths, and the objects that move along it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct LaneTrack {
    pub(super) points_m: Vec<Vec3<Enu>>,
    pub(super) arc_lengths_m: Vec<f64>,
    pub(super) length_m: f64,
    pub(super) loop_length_m: f64,
    pub(super) speed_m_s: f64,
    pub(super) first: usize,
    pub(super) count: usize,
    pub(super) reach_m: f64,
    /// Corners of the lane's bounding box, m.
    pub(super) bounds_m: (Vec3<Enu>, Vec3<Enu>),
}

impl LaneTrack {
    /// Returns the placement of an object at an arc length, given in meters. The lane continues straight beyond its
    /// ends.
    pub(super) fn at(&self, s_m: f64) -> MoverPlacement {
        let last = self.points_m.len() - 2;
        let k = self.arc_lengths_m[1..=last].partition_point(|arc| *arc <= s_m).min(last);
        let forward = (self.points_m[k + 1] - self.points_m[k]).unit();
        let position_m = self.points_m[k] + forward * (s_m - self.arc_lengths_m[k]);
        MoverPlacement { position_m, forward, velocity_m_s: forward * self.speed_m_s }
    }

    /// Returns the arc length, in meters, of the track point nearest to a point, at most `beyond_m` beyond the ends.
    pub(super) fn nearest_arc_length_m(&self, point_m: Vec3<Enu>, beyond_m: f64) -> f64 {
        let last = self.points_m.len() - 2;
        let place = |k: usize| {
            let (line, to) = (self.points_m[k + 1] - self.points_m[k], point_m - self.points_m[k]);
            let length = line.norm().max(1e-9);
            let low = if k == 0 { -beyond_m } else { 0.0 };
            let high = if k == last { length + beyond_m } else { length };
            let along = (to.dot(line) / length).clamp(low, high);
            ((to - line * (along / length)).norm(), self.arc_lengths_m[k] + along)
        };
        (0..=last).map(place).min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0.0, |(_, arc)| arc)
    }

    pub(super) fn distance_m(&self, point_m: Vec3<Enu>) -> f64 {
        let squared = self.points_m.windows(2).map(|w| {
            let (line, to) = (w[1] - w[0], point_m - w[0]);
            let t = (to.dot(line) / line.norm_squared().max(1e-12)).clamp(0.0, 1.0);
            (to - line * t).norm_squared()
        });
        squared.fold(f64::INFINITY, f64::min).sqrt()
    }

    /// Returns false only if a ray misses all objects in this lane. Compares the bounding boxes of ray and lane, extended by the
    /// reach.
    pub(super) fn ray_may_hit(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> bool {
        let (origin, end) = (origin_m.array(), (origin_m + direction * max_m).array());
        let (low, high) = (self.bounds_m.0.array(), self.bounds_m.1.array());
        (0..3).all(|k| {
            let (first, last) = (origin[k].min(end[k]), origin[k].max(end[k]));
            last >= low[k] - self.reach_m && first <= high[k] + self.reach_m
        })
    }
}

/// Returns a polyline without collinear points, so that a straight deck is one segment regardless of its point spacing.
pub(super) fn without_collinear_points(points_m: &[Vec3<Enu>]) -> Vec<Vec3<Enu>> {
    /// Maximum deviation of a point from a straight segment, m.
    const COLLINEAR_TOLERANCE_M: f64 = 1e-4;
    let mut kept: Vec<Vec3<Enu>> = Vec::new();
    for p in points_m {
        if kept.last().is_some_and(|l| (*p - *l).norm() < 1e-9) {
            continue;
        }
        if let [.., a, b] = kept[..] {
            let line = (*p - a).unit();
            let off = (b - a) - line * (b - a).dot(line);
            if off.norm() < COLLINEAR_TOLERANCE_M {
                kept.pop();
            }
        }
        kept.push(*p);
    }
    kept
}

pub(super) fn arc_lengths(points_m: &[Vec3<Enu>]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut arc = vec![0.0];
    for w in points_m.windows(2) {
        sum += (w[1] - w[0]).norm();
        arc.push(sum);
    }
    arc
}

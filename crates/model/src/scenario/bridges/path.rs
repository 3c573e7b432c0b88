//! Derives the tasks' reference paths from a bridge's dimensions, in bridge axes. The paths of girder bridges are in
//! `girder_path.rs`.

use super::arch::Arch;
use super::solid::{LocalPoint, Placement};
use super::suspension::Suspension;
use crate::frames::{Enu, Vec3};
use crate::math;

/// Maximum spacing of reference points, m (at most 1 m is allowed: docs/src/reference/assessment.md, "On path").
pub const SPACING_M: f64 = 0.8;

/// Type of task path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TaskKind {
    /// A straight line along one side of the deck slab.
    SlabSide,
    /// A curve below the arch.
    ArchBottom,
    /// A straight line through the space between the deck and the arch.
    Interlayer,
    /// A closed loop around a pier near the water.
    PierCircle,
    /// A line under the girders of a span, out and back if the bridge is wide.
    GirderSoffit,
    /// A straight line along the bearings on a pier or abutment.
    BearingLine,
    /// A closed loop around a pier cap.
    PierCap,
    /// A path through points listed in the scenario.
    Free,
}

/// Part of a girder bridge at which a path is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PathPlace {
    /// Number of the span, from 1 at the start; `None` for the middle one.
    pub span: Option<usize>,
    /// Number of the support: 0 for the abutment at the start, then the piers; `None` for the first pier.
    pub support: Option<usize>,
}

/// Reference path of a task, with a viewing direction at each point.
#[derive(Debug, Clone, PartialEq)]
pub struct TaskPath {
    /// Points, at most 1 m apart, m. A closed path does not repeat its first point.
    pub path_m: Vec<Vec3<Enu>>,
    /// Unit vectors toward the inspected surface.
    pub viewing_directions: Vec<Vec3<Enu>>,
    /// True if the path returns to its start.
    pub closed: bool,
}

/// A path in bridge axes.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalPath {
    /// Points, m.
    pub(super) points: Vec<LocalPoint>,
    /// Directions toward the inspected surface, of any length.
    pub(super) viewing_directions: Vec<LocalPoint>,
    /// True if the path returns to its start.
    pub(super) closed: bool,
}

impl LocalPath {
    /// Transforms the path to site coordinates.
    #[must_use]
    pub fn to_site(&self, placement: &Placement) -> TaskPath {
        TaskPath {
            path_m: self.points.iter().map(|p| placement.point(*p)).collect(),
            viewing_directions: self.viewing_directions.iter().map(|d| placement.direction(*d).unit()).collect(),
            closed: self.closed,
        }
    }
}

/// Returns values from `a` to `b` in equal steps of at most [`SPACING_M`].
pub(super) fn equal_steps(a: f64, b: f64) -> Vec<f64> {
    let n = ((b - a).abs() / SPACING_M).ceil().max(1.0);
    (0..=n as i32).map(|k| a + (b - a) * f64::from(k) / n).collect()
}

/// Returns the path of task 1: a straight line along the right side of the deck, slightly below the slab's surface, facing it.
pub(super) fn slab_side(arch: &Arch, stand_off_m: f64) -> LocalPath {
    let half = 0.5 * arch.span_m;
    let y = -0.5 * arch.deck_width_m - stand_off_m;
    let points: Vec<LocalPoint> = equal_steps(-half, half).into_iter().map(|x| [x, y, -0.6]).collect();
    LocalPath { viewing_directions: vec![[0.0, 1.0, 0.0]; points.len()], points, closed: false }
}

/// Returns the path of task 2: under the arch between the ribs, at the stand-off distance perpendicular to the intrados. The
/// camera looks up and ahead at the arch.
pub(super) fn arch_bottom(arch: &Arch, stand_off_m: f64) -> LocalPath {
    let reach = 0.5 * arch.span_m * 0.78;
    let bend = arch.intrados_curvature_per_m();
    // The ribs are straight between nodes on the curve, so the path stays farther away by their maximum deviation.
    let step = 0.5 * arch.span_m / arch.panels.round();
    let off = stand_off_m + 0.25 * bend * step * step;
    let steepest = 2.0 * bend * reach;
    let n = (2.0 * reach * (1.0 + steepest * steepest).sqrt() / SPACING_M).ceil() as i32;
    let on_curve = (0..=n).map(|k| reach * (2.0 * f64::from(k) / f64::from(n) - 1.0));
    let points: Vec<LocalPoint> = on_curve
        .map(|x| {
            let fall = 2.0 * bend * x;
            let stretch = (1.0 + fall * fall).sqrt();
            [x - off * fall / stretch, 0.0, arch.intrados_z_m(x) - off / stretch]
        })
        .collect();
    let viewing_directions = points.iter().enumerate().map(|(k, p)| under_arch_viewing_direction(arch, *p, off, k)).collect();
    LocalPath { points, viewing_directions, closed: false }
}

/// Returns the viewing direction of task 2 at point `k`: up at the soffits and slightly ahead, panning slowly between
/// the left and right ribs.
fn under_arch_viewing_direction(arch: &Arch, from: LocalPoint, off: f64, k: usize) -> LocalPoint {
    const PERIOD_POINTS: f64 = 30.0;
    let side = math::sin(math::TAU * k as f64 / PERIOD_POINTS);
    // The closest point of the arch is not vertically above the path point but farther from the crown.
    let bend = 2.0 * arch.intrados_curvature_per_m();
    let square = from[0] / (1.0 - off * bend / (1.0 + (bend * from[0]) * (bend * from[0])).sqrt());
    let ahead = (square + 0.3 * off).min(0.5 * arch.span_m);
    [ahead - from[0], 0.5 * arch.rib_spacing_m * side, arch.intrados_z_m(ahead) - from[2]]
}

/// Returns the path of task 3: a horizontal line on the centerline between the deck and the arch, halfway between the
/// floorbeams and the crown.
pub(super) fn interlayer(arch: &Arch) -> LocalPath {
    let half = 0.3 * arch.span_m;
    let z = 0.5 * (arch.floorbeam_bottom_z_m() + arch.extrados_z_m(0.0));
    let points: Vec<LocalPoint> = equal_steps(-half, half).into_iter().map(|x| [x, 0.0, z]).collect();
    let viewing_directions = (0..points.len()).map(interlayer_viewing_direction).collect();
    LocalPath { points, viewing_directions, closed: false }
}

/// Returns the viewing direction of task 3 at point `k`: alternately up at the deck's underside and down at the ribs, panning to
/// both sides.
fn interlayer_viewing_direction(k: usize) -> LocalPoint {
    const PERIOD_POINTS: f64 = 20.0;
    let phase = math::TAU * k as f64 / PERIOD_POINTS;
    [0.6, 0.5 * math::sin(0.5 * phase), 0.8 * math::sin(phase)]
}

/// Returns the path of task 4: one loop around the start pier at the stand-off distance from its faces, rounded at the corners
/// and facing the pier. It is 2 m below the top of the pier, or lower if the stand-off from the girders requires it.
pub(super) fn pier_circle(suspension: &Suspension, stand_off_m: f64) -> Result<LocalPath, String> {
    let center_x = -0.5 * suspension.main_span_m;
    let (hx, hy) = (0.5 * suspension.pier_x_m, 0.5 * suspension.pier_y_m);
    let z = (-suspension.pier_top_m - 2.0).min(suspension.girder_bottom_z_m() - stand_off_m);
    if z < -suspension.pier_top_m - suspension.pier_height_m {
        return Err("a pier that extends to stand_off_m below the girders".into());
    }
    let (points, normals) = rectangle_loop((center_x, z), (hx, hy), stand_off_m);
    let viewing_directions = normals.into_iter().map(|[nx, ny]| [-nx, -ny, 0.0]).collect();
    Ok(LocalPath { points, viewing_directions, closed: true })
}

/// Returns the points of a level loop around a rectangle on the bridge's centerline, at a distance in meters from its sides and rounded
/// at its corners, and the horizontal unit vectors that point away from the rectangle.
pub(super) fn rectangle_loop((x, z): (f64, f64), (hx, hy): (f64, f64), off_m: f64) -> (Vec<LocalPoint>, Vec<[f64; 2]>) {
    let mut points = Vec::new();
    let mut normals = Vec::new();
    let mut add = |from_x: f64, from_y: f64, nx: f64, ny: f64| {
        points.push([x + from_x, from_y, z]);
        normals.push([nx, ny]);
    };
    let corner_steps = (0.5 * math::PI * off_m / SPACING_M).ceil() as i32;
    let corners = [(hx, -hy, -math::FRAC_PI_2), (hx, hy, 0.0), (-hx, hy, math::FRAC_PI_2), (-hx, -hy, math::PI)];
    for (k, (cx, cy, from)) in corners.into_iter().enumerate() {
        for step in 0..=corner_steps {
            let angle = from + math::FRAC_PI_2 * f64::from(step) / f64::from(corner_steps);
            let (s, c) = math::sin_cos(angle);
            add(cx + off_m * c, cy + off_m * s, c, s);
        }
        // The line along the face to the next corner, without its endpoints, which are part of the corners.
        let (nx, ny, _) = corners[(k + 1) % 4];
        let (s, c) = math::sin_cos(from + math::FRAC_PI_2);
        let along = equal_steps(0.0, (nx - cx).abs().max((ny - cy).abs()));
        let last = along.len() - 1;
        for share in along.iter().take(last).skip(1).map(|d| d / along[last]) {
            let (x, y) = (math::lerp(cx, nx, share), math::lerp(cy, ny, share));
            add(x + off_m * c, y + off_m * s, c, s);
        }
    }
    (points, normals)
}

//! Places where a cause may produce a defect.

use super::structure::Surface;
use crate::defect_codes;
use crate::elements::{Element, ElementMaterial};
use crate::frames::{Enu, Vec3};
use crate::scenario::{DefectCause, StainSubstance};
use crate::site::defect_checks::EDGE_MARGIN_M;

/// Position of a defect relative to its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Anchor {
    /// The place is the center of the defect.
    Center,
    /// The defect begins at the place and runs along its direction.
    Start,
    /// The defect ends at the place, along its direction.
    End,
    /// The defect's long side is at the place, from which it extends in this direction.
    Side(Vec3<Enu>),
}

/// A place for a defect.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub(super) cause: DefectCause,
    pub(super) kind: u32,
    /// True for a crack; false for an area, which a pattern of cracks is, too.
    pub(super) line: bool,
    /// Index of the surface in the structure.
    pub(super) surface: usize,
    pub(super) point_m: Vec3<Enu>,
    /// Unit vector along the defect.
    pub(super) along: Vec3<Enu>,
    pub(super) anchor: Anchor,
    /// Largest displacement of the point along the first and the second direction, m. It keeps the places from forming a grid.
    pub(super) jitter_m: [Vec3<Enu>; 2],
    /// Maximum length, m.
    pub(super) max_length_m: f64,
    /// Maximum width of an area, m.
    pub(super) max_width_m: f64,
    /// Minimum distance to edges and other members, m.
    pub(super) margin_m: f64,
    /// Relative frequency among the places of the same cause.
    pub(super) weight: f64,
    pub(super) stain: Option<StainSubstance>,
}

impl Place {
    /// Creates a place for a defect with its center at a point of a surface, without a stain and with equal frequency.
    pub(super) fn new(cause: DefectCause, kind: u32, surface: usize, point_m: Vec3<Enu>, along: Vec3<Enu>) -> Self {
        Self {
            cause,
            kind,
            line: defect_codes::is_line(kind),
            surface,
            point_m,
            along,
            anchor: Anchor::Center,
            jitter_m: [Vec3::zero(); 2],
            max_length_m: f64::INFINITY,
            max_width_m: f64::INFINITY,
            margin_m: EDGE_MARGIN_M,
            weight: 1.0,
            stain: None,
        }
    }
}

/// Axes in a face: `u` level on a wall and along the long side of an underside; `v` up on a wall.
#[derive(Debug, Clone, Copy)]
pub(super) struct FaceAxes {
    pub(super) u: Vec3<Enu>,
    pub(super) v: Vec3<Enu>,
    pub(super) u_m: (f64, f64),
    pub(super) v_m: (f64, f64),
    origin_m: Vec3<Enu>,
}

impl FaceAxes {
    /// Returns the axes of a wall.
    pub(super) fn of_wall(surface: &Surface) -> Self {
        let u = Vec3::new(0.0, 0.0, 1.0).cross(surface.face.normal).unit();
        Self::along(surface, u)
    }

    /// Returns the axes of a face whose first axis is nearest to a direction.
    pub(super) fn along(surface: &Surface, direction: Vec3<Enu>) -> Self {
        let n = surface.face.normal;
        let u = (direction - n * direction.dot(n)).unit();
        let v = n.cross(u);
        Self { u, v, u_m: surface.face.extent_m(u), v_m: surface.face.extent_m(v), origin_m: surface.face.point_m }
    }

    /// Returns the point with these coordinates.
    pub(super) fn point(&self, u_m: f64, v_m: f64) -> Vec3<Enu> {
        let o = self.origin_m;
        o + self.u * (u_m - o.dot(self.u)) + self.v * (v_m - o.dot(self.v))
    }

    /// Returns the lengths of both sides, m.
    pub(super) fn size_m(&self) -> (f64, f64) {
        (self.u_m.1 - self.u_m.0, self.v_m.1 - self.v_m.0)
    }
}

/// Returns evenly spaced values in an interval, at most `step_m` apart, each in the middle of its step.
pub(super) fn spread((low, high): (f64, f64), step_m: f64) -> Vec<f64> {
    let count = ((high - low) / step_m).ceil().max(1.0);
    (0..count as i32).map(|k| low + (high - low) * (f64::from(k) + 0.5) / count).collect()
}

/// Returns the code of cracks in an element of concrete.
pub(super) fn crack_code(element: Element) -> u32 {
    if element.material() == ElementMaterial::PrestressedConcrete { defect_codes::PSC_CRACK } else { defect_codes::CRACK }
}

//! Geometry of the stains that water carries out of defects.

use super::job::PlacedDefect;
use crate::frames::{Enu, Vec3};

/// Rectangle on a surface that a stain covers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StainPatch {
    /// Center, m.
    pub center_m: Vec3<Enu>,
    /// Unit vector along the stain: downhill on a wall.
    pub along: Vec3<Enu>,
    /// Length along [`Self::along`], m.
    pub length_m: f64,
    /// Width, m.
    pub width_m: f64,
}

/// Minimum downhill component of a surface on which water runs (0.3 is an underside that is 17 degrees off level).
const MIN_RUNOFF: f64 = 0.3;
/// Minimum and maximum width of a stain, m (estimate).
const STAIN_WIDTH_M: (f64, f64) = (0.06, 0.5);
/// Width of the lime beside a crack in an underside, m (estimate).
const SOFFIT_STAIN_WIDTH_M: f64 = 0.16;

/// Returns the direction in a surface in which water runs down; `None` on a level surface.
#[must_use]
pub fn downhill(normal: Vec3<Enu>) -> Option<Vec3<Enu>> {
    let down = Vec3::new(0.0, 0.0, -1.0);
    let slope = down - normal * normal.dot(down);
    (slope.norm() > MIN_RUNOFF).then(|| slope.unit())
}

impl PlacedDefect {
    /// Returns the extent of the defect in a direction in its surface, m, from its center.
    #[must_use]
    pub fn half_extent_m(&self, direction: Vec3<Enu>) -> f64 {
        let across = self.normal.cross(self.along);
        0.5 * (self.length_m * self.along.dot(direction).abs() + self.width_m * across.dot(direction).abs())
    }

    /// Returns the rectangle that the defect's stain covers: below the defect on a wall, along it on an underside. `None` if the defect
    /// has no stain.
    #[must_use]
    pub fn stain_patch(&self) -> Option<StainPatch> {
        let stain = self.stain?;
        let Some(down) = downhill(self.normal) else {
            let width_m = if self.line { SOFFIT_STAIN_WIDTH_M } else { self.width_m };
            return Some(StainPatch { center_m: self.position_m, along: self.along, length_m: stain.length_m, width_m });
        };
        let start_m = self.position_m + down * self.half_extent_m(down);
        let across = self.normal.cross(down);
        let width_m = (2.0 * self.half_extent_m(across)).clamp(STAIN_WIDTH_M.0, STAIN_WIDTH_M.1);
        Some(StainPatch { center_m: start_m + down * (0.5 * stain.length_m), along: down, length_m: stain.length_m, width_m })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Stain, StainSubstance};
    use super::*;
    use crate::elements::Element;

    fn stained(normal: Vec3<Enu>, along: Vec3<Enu>) -> PlacedDefect {
        PlacedDefect {
            id: 1,
            element: Element::RcPierCap,
            member: "cap".into(),
            kind: 1080,
            condition_state: 3,
            position_m: Vec3::new(0.0, 0.0, 10.0),
            normal,
            along,
            length_m: 0.4,
            width_m: 0.2,
            line: false,
            cause: None,
            stain: Some(Stain { substance: StainSubstance::Rust, length_m: 0.6 }),
        }
    }

    #[test]
    fn exact_stains_begin_at_the_lower_end_of_their_defect() {
        let wall = stained(Vec3::new(0.0, -1.0, 0.0), Vec3::new(1.0, 0.0, 0.0)).stain_patch().unwrap();
        assert_eq!((wall.center_m, wall.along), (Vec3::new(0.0, 0.0, 9.6), Vec3::new(0.0, 0.0, -1.0)));
        assert_eq!((wall.length_m, wall.width_m), (0.6, 0.4));
        let soffit = stained(Vec3::new(0.0, 0.0, -1.0), Vec3::new(1.0, 0.0, 0.0)).stain_patch().unwrap();
        assert_eq!((soffit.center_m, soffit.along), (Vec3::new(0.0, 0.0, 10.0), Vec3::new(1.0, 0.0, 0.0)));
        let clean = PlacedDefect { stain: None, ..stained(Vec3::new(0.0, -1.0, 0.0), Vec3::new(1.0, 0.0, 0.0)) };
        assert_eq!(clean.stain_patch(), None);
    }

    #[test]
    fn exact_water_runs_down_walls_but_not_along_undersides() {
        assert_eq!(downhill(Vec3::new(0.0, -1.0, 0.0)), Some(Vec3::new(0.0, 0.0, -1.0)));
        assert_eq!(downhill(Vec3::new(0.0, 0.0, -1.0)), None);
    }
}

//! Defects at places that somebody chooses, such as an instructor who points at a drawing, and checks of defects that a file places.

use super::Site;
use super::defect_checks::{EDGE_MARGIN_M, PlacementContext, find_view, fits_in_face, is_exposed};
use super::defects::{CAMERA_CLEARANCE_M, defect_direction};
use super::faces::face_at;
use crate::defect_codes;
use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::bridges::Member;
use crate::scenario::{PlacedDefect, Scenario};
use crate::time::SimTime;

/// Maximum distance from a point to the surface that it means, m (estimate: less than most members are thick).
pub const MAX_SURFACE_DISTANCE_M: f64 = 0.5;
/// Distance before the chosen point at which a line of sight begins, and its length beyond the point, m: more than any site extends.
const SIGHT_REACH_M: f64 = 20_000.0;
/// Fractions of a meter and of a unit vector in the text of a scenario: 0.1 mm, and less than the reader's tolerance.
const POSITION_STEPS_PER_M: f64 = 1e4;
const DIRECTION_STEPS: f64 = 1e6;

/// Point on a bridge that somebody chooses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SurfaceTarget {
    /// First surface along a line of sight.
    Line {
        /// Any point of the line, m.
        through_m: Vec3<Enu>,
        /// Unit vector away from the viewer.
        direction: Vec3<Enu>,
    },
    /// Nearest surface to a point, m, within [`MAX_SURFACE_DISTANCE_M`].
    Near(Vec3<Enu>),
}

/// Kind and size of a defect to place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefectShape {
    /// AASHTO MBEI defect code, one of [`defect_codes::ALL`].
    pub kind: u32,
    /// Condition state, 2 to 4.
    pub condition_state: u8,
    /// Longest extent, m.
    pub length_m: f64,
    /// Extent perpendicular to it, m.
    pub width_m: f64,
    /// Angle of the longest extent on the surface, counterclockwise seen from outside, from the direction that such a defect usually
    /// has there, rad.
    pub turn_rad: f64,
}

/// Reason why a defect can't be at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Misplacement {
    /// No bridge is on the line of sight.
    NoBridge,
    /// The nearest surface is farther away than [`MAX_SURFACE_DISTANCE_M`]; distance, m, infinity if there is no bridge.
    OffSurface(f64),
    /// The site has no member with this name.
    UnknownMember,
    /// The member is another element.
    OtherElement(Element),
    /// This kind of defect does not occur on the element.
    NotPermitted(Element),
    /// The defect reaches the edge of its surface.
    TooLarge,
    /// Another member covers the defect, or there is no room in front of it.
    Covered,
}

impl Site {
    /// Places a defect on the surface of a bridge: of the one with this name, or of any. The ID is 0.
    ///
    /// # Errors
    /// Returns the reason if there is no surface, or the defect can't be there.
    pub fn place_defect(
        &self,
        shape: &DefectShape,
        target: SurfaceTarget,
        bridge: Option<&str>,
    ) -> Result<PlacedDefect, Misplacement> {
        let (index, point_m) = self.surface_at(target, bridge)?;
        let member = &self.members()[index];
        if !member.element.permitted_defects().contains(&shape.kind) {
            return Err(Misplacement::NotPermitted(member.element));
        }
        let face = face_at(&member.solid, point_m).ok_or(Misplacement::TooLarge)?;
        let usual = defect_direction(shape.kind, &face, 0.0);
        let (sin, cos) = math::sin_cos(shape.turn_rad);
        let defect = PlacedDefect {
            id: 0,
            element: member.element,
            member: member.name.clone(),
            kind: shape.kind,
            condition_state: shape.condition_state,
            position_m: rounded(face.point_m, POSITION_STEPS_PER_M),
            normal: rounded(face.normal, DIRECTION_STEPS),
            along: rounded((usual * cos + face.normal.cross(usual) * sin).unit(), DIRECTION_STEPS),
            length_m: shape.length_m,
            width_m: shape.width_m,
            line: defect_codes::is_line(shape.kind),
            cause: None,
            stain: None,
        };
        if !fits_in_face(&defect, &face, EDGE_MARGIN_M) {
            return Err(Misplacement::TooLarge);
        }
        if !is_exposed(&defect, index as u32, &self.cast(), EDGE_MARGIN_M) {
            return Err(Misplacement::Covered);
        }
        Ok(defect)
    }

    /// Returns the member and the point of its surface that a target means.
    fn surface_at(&self, target: SurfaceTarget, bridge: Option<&str>) -> Result<(usize, Vec3<Enu>), Misplacement> {
        let prefix = bridge.map(|name| format!("{name}/")).unwrap_or_default();
        let is_own = |index: usize| self.members()[index].name.starts_with(&prefix);
        match target {
            SurfaceTarget::Line { through_m, direction } => {
                let from_m = through_m - direction * SIGHT_REACH_M;
                // Rays also hit open meshes, such as scans, which have no inside.
                let hit =
                    |index: usize| Some((index, self.geometry().shape(index)?.ray(from_m, direction, 2.0 * SIGHT_REACH_M)?.0));
                let hits = (0..self.members().len()).filter(|index| is_own(*index)).filter_map(hit);
                let (index, distance_m) = hits.min_by(|a, b| a.1.total_cmp(&b.1)).ok_or(Misplacement::NoBridge)?;
                Ok((index, from_m + direction * distance_m))
            }
            SurfaceTarget::Near(point_m) => {
                let shapes = (0..self.members().len()).filter(|index| is_own(*index));
                let nearest = shapes.filter_map(|index| Some((index, self.geometry().shape(index)?.nearest(point_m))));
                let nearest = nearest.min_by(|a, b| a.1.distance_m.abs().total_cmp(&b.1.distance_m.abs()));
                let (index, point) = nearest.ok_or(Misplacement::OffSurface(f64::INFINITY))?;
                let distance_m = point.distance_m.abs();
                if distance_m > MAX_SURFACE_DISTANCE_M {
                    return Err(Misplacement::OffSurface(distance_m));
                }
                Ok((index, point.point_m))
            }
        }
    }

    /// Returns what is wrong with the place of a defect in a file; `None` if it is on a surface where such a defect can occur.
    #[must_use]
    pub fn misplacement(&self, defect: &PlacedDefect) -> Option<Misplacement> {
        let Some(index) = self.members().iter().position(|member: &Member| member.name == defect.member) else {
            return Some(Misplacement::UnknownMember);
        };
        let member = &self.members()[index];
        if member.element != defect.element {
            return Some(Misplacement::OtherElement(member.element));
        }
        if !member.element.permitted_defects().contains(&defect.kind) {
            return Some(Misplacement::NotPermitted(member.element));
        }
        let distance_m = self.geometry().shape(index)?.nearest(defect.position_m).distance_m.abs();
        (distance_m > SURFACE_TOLERANCE_M).then_some(Misplacement::OffSurface(distance_m))
    }

    /// Returns whether the reference camera can photograph a defect from within the threshold of one of the tasks' paths.
    #[must_use]
    pub fn can_be_photographed(&self, scenario: &Scenario, defect: &PlacedDefect) -> bool {
        let cast = self.cast();
        let ambient = |position_m, normal| self.ambient_lux(position_m, Some(normal), SimTime::ZERO);
        let clearance =
            |at_m| self.geometry().nearest(at_m, CAMERA_CLEARANCE_M).map_or(f64::INFINITY, |nearest| nearest.distance_m);
        let context = PlacementContext {
            members: self.members(),
            tasks: &scenario.tasks,
            cast: &cast,
            ambient: &ambient,
            clearance_m: &clearance,
            water_up_m: scenario.terrain.water_level_m,
        };
        let mut with_path = scenario.tasks.iter().filter(|task| !task.path_m.is_empty());
        with_path.any(|task| find_view(defect, task, &context).is_some())
    }
}

/// Maximum distance of a defect in a file from the surface of its member, m (estimate: above the rounding of positions, below what a
/// picture shows).
const SURFACE_TOLERANCE_M: f64 = 0.01;

fn rounded(vector: Vec3<Enu>, steps: f64) -> Vec3<Enu> {
    let [east, north, up] = vector.array().map(|value| (value * steps).round() / steps);
    Vec3::new(east, north, up)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::defect_codes::{CORROSION, CRACK, SPALL};
    use crate::scenario::read;
    use crate::shipped::PRACTICE;
    use crate::site::outline::ParallelView;

    fn job() -> (Scenario, Site) {
        let scenario = read("job.toml", PRACTICE, &|_| Err("none".into())).unwrap();
        let site = Site::without_defects(&scenario);
        (scenario, site)
    }

    fn shape(kind: u32, length_m: f64, width_m: f64) -> DefectShape {
        DefectShape { kind, condition_state: 3, length_m, width_m, turn_rad: 0.0 }
    }

    /// Returns a target in the middle of a face that points in a direction: the one nearest to midspan among the members whose names
    /// begin so.
    fn target(site: &Site, members: &str, toward: Vec3<Enu>) -> SurfaceTarget {
        let own = site.members().iter().filter(|member| member.name.starts_with(members));
        let faces = own.flat_map(|member| super::super::faces::faces(&member.solid).collect::<Vec<_>>());
        let facing = faces.filter(|face| face.normal.dot(toward) > 0.99);
        let nearest = facing.min_by(|a, b| a.point_m.east().abs().total_cmp(&b.point_m.east().abs()));
        SurfaceTarget::Line { through_m: nearest.unwrap().point_m, direction: toward * -1.0 }
    }

    #[test]
    fn exact_a_line_of_sight_ends_on_the_side_that_faces_the_viewer() {
        let (scenario, site) = job();
        let south = ParallelView::side(&scenario.bridges[0]).toward_viewer();
        for (members, toward) in [("arch/rib", south), ("arch/rib", south * -1.0), ("arch/slab", Vec3::new(0.0, 0.0, -1.0))] {
            let placed = site.place_defect(&shape(CRACK, 0.4, 0.002), target(&site, members, toward), Some("arch")).unwrap();
            assert!(placed.normal.dot(toward) > 0.9, "{placed:?}");
            assert!(placed.member.starts_with(members) && placed.line && placed.id == 0);
            assert_eq!(site.misplacement(&placed), None);
            assert!((placed.along.norm() - 1.0).abs() < 1e-5 && placed.along.dot(placed.normal).abs() < 1e-5, "{placed:?}");
        }
    }

    #[test]
    fn exact_a_point_means_the_nearest_surface_and_a_turn_rotates_the_defect_on_it() {
        let (_, site) = job();
        let toward = Vec3::new(0.0, 0.0, -1.0);
        let SurfaceTarget::Line { through_m, .. } = target(&site, "arch/slab", toward) else { panic!() };
        let near = SurfaceTarget::Near(through_m + toward * 0.3);
        let placed = site.place_defect(&shape(CRACK, 0.4, 0.002), near, None).unwrap();
        assert!((placed.position_m - through_m).norm() < 1e-3 && placed.normal.up() < -0.99, "{placed:?}");
        let turned = DefectShape { turn_rad: math::PI / 2.0, ..shape(CRACK, 0.4, 0.002) };
        let turned = site.place_defect(&turned, near, None).unwrap();
        assert!(turned.along.dot(placed.along).abs() < 1e-5);
        let far = site.place_defect(&shape(CRACK, 0.4, 0.002), SurfaceTarget::Near(Vec3::new(0.0, 0.0, 500.0)), None);
        assert!(matches!(far, Err(Misplacement::OffSurface(distance_m)) if distance_m > 300.0), "{far:?}");
    }

    #[test]
    fn exact_places_where_the_defect_cannot_be_have_a_reason() {
        let (_, site) = job();
        let place = |shape: DefectShape, target| site.place_defect(&shape, target, Some("arch")).unwrap_err();
        let below = target(&site, "arch/slab", Vec3::new(0.0, 0.0, -1.0));
        assert!(matches!(place(shape(CORROSION, 0.3, 0.1), below), Misplacement::NotPermitted(_)));
        assert_eq!(place(shape(SPALL, 40.0, 30.0), below), Misplacement::TooLarge);
        let aside = SurfaceTarget::Line { through_m: Vec3::new(4_000.0, 0.0, 0.0), direction: Vec3::new(0.0, 0.0, 1.0) };
        assert_eq!(place(shape(CRACK, 0.3, 0.001), aside), Misplacement::NoBridge);
        let placed = site.place_defect(&shape(CRACK, 0.4, 0.002), below, Some("arch")).unwrap();
        let wrong = |defect: PlacedDefect| site.misplacement(&defect).unwrap();
        assert_eq!(wrong(PlacedDefect { member: "arch/none".into(), ..placed.clone() }), Misplacement::UnknownMember);
        let other = PlacedDefect { element: Element::SteelGirder, ..placed.clone() };
        assert_eq!(wrong(other), Misplacement::OtherElement(placed.element));
        let moved = PlacedDefect { position_m: placed.position_m + placed.normal * 0.2, ..placed.clone() };
        assert!(matches!(wrong(moved), Misplacement::OffSurface(distance_m) if (distance_m - 0.2).abs() < 1e-3));
        assert!(matches!(wrong(PlacedDefect { kind: CORROSION, ..placed }), Misplacement::NotPermitted(_)));
    }

    /// Defects that Spandrel places itself meet the same conditions, anywhere and by their causes.
    #[test]
    fn prop_random_defects_are_in_place_and_can_be_photographed() {
        for (name, text) in crate::shipped::SCENARIOS.iter().filter(|(name, _)| ["practice", "girder"].contains(name)) {
            let job = read(name, &text.replace("placement = \"anywhere\"", ""), &|_| Err("none".into())).unwrap();
            let site = Site::build(&job, 3);
            assert!(!site.defects().is_empty(), "{name}");
            for defect in site.defects() {
                assert_eq!(site.misplacement(defect), None, "{name}: {defect:?}");
                assert!(site.can_be_photographed(&job, defect), "{name}: {defect:?}");
            }
        }
    }
}

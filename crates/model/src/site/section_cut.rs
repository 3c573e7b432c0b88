//! Cuts through bridge members, for drawings of a plane through a bridge.

use super::outline::ParallelView;
use super::plan_hull::hull;
use crate::frames::{Enu, Vec3};
use crate::scenario::bridges::Member;

/// The cut of a plane through a member, in the drawing; m right and up.
#[derive(Debug, Clone, PartialEq)]
pub enum SectionCut {
    /// Corners of the cut through a convex solid, counterclockwise.
    Area(Vec<(f64, f64)>),
    /// Where the triangles of a surface cross the plane, each between two points.
    Lines(Vec<[(f64, f64); 2]>),
}

/// Returns the cut through a member by the plane of a drawing that contains a point; `None` if the plane does not meet the member.
#[must_use]
pub fn section_cut(member: &Member, view: &ParallelView, through_m: Vec3<Enu>) -> Option<SectionCut> {
    let normal = view.toward_viewer();
    let solid = &member.solid;
    let depth_m: Vec<f64> = solid.vertices_m.iter().map(|vertex| (*vertex - through_m).dot(normal)).collect();
    let crossing = |a: u32, b: u32| {
        let (a, b) = (a as usize, b as usize);
        let is_crossed = (depth_m[a] > 0.0) != (depth_m[b] > 0.0);
        let share = depth_m[a] / (depth_m[a] - depth_m[b]);
        is_crossed.then(|| view.at(solid.vertices_m[a].lerp(solid.vertices_m[b], share)))
    };
    let edges = |face: &[u32]| -> Vec<(f64, f64)> {
        let next = face.iter().cycle().skip(1);
        face.iter().zip(next).filter_map(|(a, b)| crossing(*a, *b)).collect()
    };
    if solid.is_convex() {
        let corners = hull(&solid.faces.iter().flat_map(|face| edges(face)).collect::<Vec<_>>());
        return (corners.len() > 2).then_some(SectionCut::Area(corners));
    }
    let lines: Vec<_> = solid.triangles().iter().filter_map(|triangle| <[_; 2]>::try_from(edges(triangle)).ok()).collect();
    (!lines.is_empty()).then_some(SectionCut::Lines(lines))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::Element;
    use crate::scenario::bridges::solid::{MemberBuilder, Placement};

    fn block() -> Member {
        let mut builder = MemberBuilder::new("test", Placement::new(Vec3::new(5.0, 0.0, 10.0), 90.0));
        builder.add_box("deck", Element::RcDeck, [-20.0, -4.0, -1.0], [20.0, 4.0, 1.0]);
        builder.finish().remove(0)
    }

    /// Compares the lowest and highest coordinates, right and up, up to rounding.
    fn assert_bounds(points: &[(f64, f64)], expected: [(f64, f64); 2]) {
        let found = [crate::math::range(points.iter().map(|p| p.0)), crate::math::range(points.iter().map(|p| p.1))];
        let is_equal = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs() < 1e-9 && (a.1 - b.1).abs() < 1e-9;
        assert!(found.iter().zip(&expected).all(is_equal), "{found:?} instead of {expected:?}");
    }

    #[test]
    fn exact_cut_through_a_block_is_its_section() {
        // Looking toward the east, across a block along the east.
        let view = ParallelView { right: Vec3::new(0.0, -1.0, 0.0), up: Vec3::new(0.0, 0.0, 1.0) };
        let Some(SectionCut::Area(corners)) = section_cut(&block(), &view, Vec3::new(7.0, 0.0, 0.0)) else { panic!("no cut") };
        assert_eq!(corners.len(), 4);
        assert_bounds(&corners, [(-4.0, 4.0), (9.0, 11.0)]);
        assert_eq!(section_cut(&block(), &view, Vec3::new(26.0, 0.0, 0.0)), None, "beyond the end");
        let Some(SectionCut::Area(plan)) = section_cut(&block(), &ParallelView::plan(), Vec3::new(0.0, 0.0, 10.5)) else {
            panic!("no cut")
        };
        assert_bounds(&plan, [(-15.0, 25.0), (-4.0, 4.0)]);
    }

    #[test]
    fn exact_cut_through_a_surface_consists_of_one_line_for_each_crossed_triangle() {
        let mut member = block();
        let triangles = member.solid.triangles();
        member.solid.surface =
            Some(crate::scenario::bridges::solid::SolidSurface { triangles, is_closed: true, colors: Vec::new() });
        let view = ParallelView::plan();
        let Some(SectionCut::Lines(lines)) = section_cut(&member, &view, Vec3::new(0.0, 0.0, 10.5)) else { panic!("no cut") };
        // Two triangles on each of the four vertical sides.
        assert_eq!(lines.len(), 8);
        let ends: Vec<(f64, f64)> = lines.into_iter().flatten().collect();
        assert_bounds(&ends, [(-15.0, 25.0), (-4.0, 4.0)]);
    }
}

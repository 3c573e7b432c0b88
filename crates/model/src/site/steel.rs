//! Distortion of the Earth's magnetic field by the steel members of bridges.
//!
//! Each steel member, or each piece of one that is not a prism, stands for an infinitely permeable elliptic cylinder with the same half
//! widths, in a uniform field across its axis. The field around it follows exactly from a conformal mapping. Estimates: members don't
//! magnetize each other, the field along a member's axis and permanent magnetization have no effect, and the finite length scales the
//! result.

use super::boxes::OrientedBox;
use super::steel_pieces::{prism, surface_pieces};
use crate::elements::ElementMaterial;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::bridges::Member;
use nalgebra::Complex;
use std::collections::BTreeMap;

/// Distortion, relative to the total field, below which a member is ignored: where the field is inclined by 63 degrees, it turns the
/// compass by at most 0.25 degrees.
const MIN_DISTORTION: f64 = 0.002;
/// Edge length of the cells in which members are found, m.
const CELL_M: f64 = 4.0;

/// All steel members of a site.
#[derive(Debug, Clone, PartialEq)]
pub struct SteelField {
    /// Size of the distortion relative to that of the cylinders.
    factor: f64,
    cylinders: Vec<EllipticCylinder>,
    /// Indices of the cylinders that matter in a cell, by the cell's lowest corner in units of [`CELL_M`].
    cells: BTreeMap<[i32; 3], Vec<u32>>,
}

/// A cylinder in the box of a member or of a piece of it. The box's first axis is that of the cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
struct EllipticCylinder(OrientedBox);

impl SteelField {
    /// Collects the steel members. `factor` scales the distortion.
    #[must_use]
    pub fn new(members: &[Member], factor: f64) -> Self {
        let steel = members.iter().filter(|member| member.element.material() == ElementMaterial::Steel);
        let boxes = steel.flat_map(|member| match &member.solid.surface {
            None => prism(&member.solid).into_iter().collect(),
            Some(_) => surface_pieces(&member.solid),
        });
        let cylinders: Vec<EllipticCylinder> = boxes.map(EllipticCylinder).collect();
        let mut cells = BTreeMap::<_, Vec<u32>>::new();
        for (index, cylinder) in (0..).zip(&cylinders) {
            for cell in cylinder.cells() {
                cells.entry(cell).or_default().push(index);
            }
        }
        Self { factor, cylinders, cells }
    }

    /// Returns the distortion at a position: the field there minus the undisturbed field. The unit is that of the field.
    #[must_use]
    pub fn distortion(&self, position_m: Vec3<Enu>, undisturbed: Vec3<Enu>) -> Vec3<Enu> {
        let near = self.cells.get(&cell_of(position_m)).map_or(&[][..], Vec::as_slice);
        let sum = |sum, index: &u32| sum + self.cylinders[*index as usize].distortion(position_m, undisturbed);
        near.iter().fold(Vec3::zero(), sum) * self.factor
    }
}

fn cell_of(position_m: Vec3<Enu>) -> [i32; 3] {
    position_m.array().map(|value| (value / CELL_M).floor() as i32)
}

impl EllipticCylinder {
    /// Returns the distance from the axis beyond which the distortion is negligible, m.
    fn range_m(&self) -> f64 {
        // Far away, the relative distortion is at most b (b + c) / (2 r²).
        let [_, b, c] = self.0.half_m;
        let wide = b.max(c);
        (wide * (b + c) / (2.0 * MIN_DISTORTION)).sqrt()
    }

    /// Returns the cells that may contain points in range.
    fn cells(&self) -> impl Iterator<Item = [i32; 3]> + use<> {
        let reach = [self.0.half_m[0], 0.0, 0.0].map(|half| half + self.range_m());
        let extent = |k: usize| (0..3).map(|i| self.0.axes[i].array()[k].abs() * reach[i]).sum::<f64>();
        let extent = Vec3::new(extent(0), extent(1), extent(2));
        let (low, high) = (cell_of(self.0.center_m - extent), cell_of(self.0.center_m + extent));
        (low[0]..=high[0]).flat_map(move |x| (low[1]..=high[1]).flat_map(move |y| (low[2]..=high[2]).map(move |z| [x, y, z])))
    }

    fn distortion(&self, position_m: Vec3<Enu>, undisturbed: Vec3<Enu>) -> Vec3<Enu> {
        let OrientedBox { center_m, axes: [axis, x, y], half_m: [half_length, b, c] } = self.0;
        let from_center = position_m - center_m;
        let (along, at) = (from_center.dot(axis), Complex::new(from_center.dot(x), from_center.dot(y)));
        let across = Complex::new(undisturbed.dot(x), -undisturbed.dot(y));
        let added = plane_field(at, (b, c), across) - across;
        let share = length_share(along, math::hypot(at.re, at.im), half_length);
        (x * added.re - y * added.im) * share
    }
}

/// Returns the field outside an infinitely permeable elliptic cylinder in a uniform field. Both fields are Bx - i By. Points inside
/// the ellipse get the field at its surface.
fn plane_field(at: Complex<f64>, (b, c): (f64, f64), uniform: Complex<f64>) -> Complex<f64> {
    // z = w + k²/w maps the circle |w| = R to the ellipse.
    let (radius, k_squared) = (0.5 * (b + c), 0.25 * (b * b - c * c));
    let root = square_root(at * at - 4.0 * k_squared);
    let outer = if at.re * root.re + at.im * root.im < 0.0 { at - root } else { at + root };
    let w = outer * 0.5;
    let distance = math::hypot(w.re, w.im);
    let w = if distance <= 0.0 { Complex::new(radius, 0.0) } else { w * (radius / distance).max(1.0) };
    let w_squared = w * w;
    (uniform + uniform.conj() * (radius * radius) / w_squared) / (Complex::new(1.0, 0.0) - k_squared / w_squared)
}

/// Returns the principal square root.
fn square_root(z: Complex<f64>) -> Complex<f64> {
    let size = math::hypot(z.re, z.im);
    let (re, im) = ((0.5 * (size + z.re)).max(0.0).sqrt(), (0.5 * (size - z.re)).max(0.0).sqrt());
    Complex::new(re, im.copysign(z.im))
}

/// Returns the field of a line of equal dipoles of finite length, divided by that of an infinitely long line, at a distance from
/// the line and from its middle, for the component along the dipoles' direction across the line of sight.
fn length_share(along_m: f64, distance_m: f64, half_length_m: f64) -> f64 {
    let end = |to_m: f64| to_m / math::hypot(distance_m, to_m).max(f64::MIN_POSITIVE);
    0.5 * (end(half_length_m - along_m) + end(half_length_m + along_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::Element;
    use crate::scenario::bridges::solid::{MemberBuilder, Placement, SolidSurface};

    /// Rounding tolerance, relative to the undisturbed field.
    const ROUNDING: f64 = 1e-12;
    /// Half a unit of the last digit in docs/src/reference/domain.md, µT.
    const PUBLISHED_TOLERANCE_UT: f64 = 0.05;

    /// A long steel pile of circular section, approximated by a square one of the same half width.
    fn pile(half_width_m: f64, half_length_m: f64) -> EllipticCylinder {
        let axes = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
        EllipticCylinder(OrientedBox { center_m: Vec3::zero(), axes, half_m: [half_length_m, half_width_m, half_width_m] })
    }

    #[test]
    fn exact_round_member_distorts_by_its_radius_over_the_distance_squared() {
        let (member, field) = (pile(0.5, 1e9), Vec3::new(0.0, 0.3, -0.4));
        for distance_m in [0.5, 1.0, 2.0, 5.0] {
            let share = 0.25 / (distance_m * distance_m);
            let ahead = member.distortion(Vec3::new(0.0, distance_m, 3.0), field);
            assert!((ahead - Vec3::new(0.0, 0.3 * share, 0.0)).norm() < ROUNDING, "{ahead:?}");
            let beside = member.distortion(Vec3::new(distance_m, 0.0, 3.0), field);
            assert!((beside + Vec3::new(0.0, 0.3 * share, 0.0)).norm() < ROUNDING, "{beside:?}");
        }
    }

    #[test]
    fn val_steel_pile_disturbs_the_field_as_published() {
        // docs/src/reference/domain.md, "Compass near steel": 50 µT, a = 0.5 m.
        let (member, field) = (pile(0.5, 1e9), Vec3::new(0.0, 50.0, 0.0));
        for (distance_m, expected_ut) in [(1.0, 12.5), (2.0, 3.1)] {
            let found = member.distortion(Vec3::new(0.6 * distance_m, 0.8 * distance_m, 0.0), field).norm();
            assert!((found - expected_ut).abs() <= PUBLISHED_TOLERANCE_UT, "{found} at {distance_m} m");
        }
    }

    #[test]
    fn exact_field_enters_a_permeable_plate_at_right_angles() {
        // Half widths of a flange of 400 by 20 mm.
        let (b, c) = (0.2, 0.01);
        for k in 0..64 {
            let (s, c_angle) = math::sin_cos(math::TAU * (f64::from(k) + 0.5) / 64.0);
            let at = Complex::new(b * c_angle, c * s);
            let field = plane_field(at, (b, c), Complex::new(0.6, -0.8));
            // Tangent of the ellipse; the field is Bx - i By.
            let (tangent_x, tangent_y) = (-b * s, c * c_angle);
            let along = (field.re * tangent_x - field.im * tangent_y) / math::hypot(tangent_x, tangent_y);
            assert!(along.abs() < 1e-9, "{along} at {at}");
        }
    }

    #[test]
    fn exact_short_member_distorts_with_the_third_power_of_the_distance() {
        let (member, north) = (pile(0.1, 0.5), Vec3::new(0.0, 1.0, 0.0));
        let at = |distance_m: f64| member.distortion(Vec3::new(distance_m, 0.0, 0.0), north).norm();
        let ratio = at(200.0) / at(100.0);
        assert!((ratio - 0.125).abs() < 1e-5, "{ratio}");
    }

    /// Returns a bridge with a steel beam along x and a concrete one beside it.
    fn members() -> Vec<Member> {
        let mut builder = MemberBuilder::new("test", Placement::new(Vec3::new(3.0, -2.0, 10.0), 30.0));
        builder.add_box("steel", Element::from_number(107), [-15.0, -0.2, -1.0], [15.0, 0.2, -0.5]);
        builder.add_rod("hanger", Element::from_number(148), [0.0, 4.0, -3.0], [0.0, 4.0, 6.0], 0.05, 8);
        builder.add_box("concrete", Element::from_number(110), [-15.0, 2.0, -1.0], [15.0, 2.5, -0.5]);
        builder.finish()
    }

    /// Returns the members with their triangles instead of their faces.
    fn as_surfaces(members: &[Member]) -> Vec<Member> {
        let surface = |member: &Member| {
            let mut member = member.clone();
            let triangles = member.solid.triangles();
            member.solid.surface = Some(SolidSurface { triangles, is_closed: true, colors: Vec::new() });
            member
        };
        members.iter().map(surface).collect()
    }

    #[test]
    fn exact_surface_of_a_prism_distorts_like_the_prism() {
        /// Differences of the corners from rounding, relative to the undisturbed field.
        const TOLERANCE: f64 = 1e-6;
        let undisturbed = Vec3::new(0.02, 0.2, -0.4);
        let [prisms, surfaces] = [members(), as_surfaces(&members())].map(|members| SteelField::new(&members, 1.0));
        for k in 0..200 {
            let position_m = Vec3::new(f64::from(k % 20) - 7.0, f64::from(k % 7) - 5.0, 8.0 + 0.2 * f64::from(k % 13));
            let [expected, found] = [&prisms, &surfaces].map(|field| field.distortion(position_m, undisturbed));
            assert!((found - expected).norm() < TOLERANCE, "{expected:?} {found:?} at {position_m:?}");
        }
    }

    /// Returns a surface of square bars between points in bridge axes.
    fn bars(ends_m: &[[[f64; 3]; 2]]) -> (Vec<Member>, Member) {
        let mut builder = MemberBuilder::new("test", Placement::new(Vec3::zero(), 30.0));
        for (k, [a, b]) in ends_m.iter().enumerate() {
            builder.add_rod(&k.to_string(), Element::from_number(120), *a, *b, 0.2, 4);
        }
        let bars = builder.finish();
        let mut whole = bars[0].clone();
        whole.solid.vertices_m.clear();
        let mut triangles = Vec::new();
        for bar in &bars {
            let first = whole.solid.vertices_m.len() as u32;
            whole.solid.vertices_m.extend(&bar.solid.vertices_m);
            triangles.extend(bar.solid.triangles().iter().map(|triangle| triangle.map(|k| first + k)));
        }
        whole.solid.surface = Some(SolidSurface { triangles, is_closed: true, colors: Vec::new() });
        (bars, whole)
    }

    #[test]
    fn prop_truss_in_one_surface_distorts_about_as_much_as_its_bars() {
        /// Least and largest ratio (estimate: pieces at the nodes contain several bars).
        const RATIO: (f64, f64) = (0.8, 2.5);
        let ends_m = [
            [[-12.0, 0.0, 0.0], [12.0, 0.0, 0.0]],
            [[-12.0, 0.0, 6.0], [12.0, 0.0, 6.0]],
            [[-12.0, 0.0, 0.0], [-6.0, 0.0, 6.0]],
            [[-6.0, 0.0, 6.0], [0.0, 0.0, 0.0]],
            [[0.0, 0.0, 0.0], [6.0, 0.0, 6.0]],
            [[6.0, 0.0, 6.0], [12.0, 0.0, 0.0]],
        ];
        let (bars, whole) = bars(&ends_m);
        let [bars, whole] = [bars, vec![whole]].map(|members| SteelField::new(&members, 1.0));
        let undisturbed = Vec3::new(0.02, 0.2, -0.4);
        let place = Placement::new(Vec3::zero(), 30.0);
        for local in [[0.0, 0.0, -1.5], [3.0, 1.5, 0.0], [-7.0, 0.0, 7.5], [6.0, -2.0, 5.0], [-12.0, 0.0, -2.0]] {
            let [of_bars, found] = [&bars, &whole].map(|field| field.distortion(place.point(local), undisturbed).norm());
            let ratio = found / of_bars;
            assert!((RATIO.0..RATIO.1).contains(&ratio), "{ratio} at {local:?}");
        }
    }

    #[test]
    fn prop_cells_contain_all_members_that_matter_and_concrete_never_does() {
        let field = SteelField::new(&members(), 1.0);
        assert_eq!(field.cylinders.len(), 2);
        let undisturbed = Vec3::new(0.02, 0.2, -0.4);
        for k in 0..2000 {
            let (s, c) = math::sin_cos(f64::from(k) * 0.7);
            let distance_m = 0.5 + f64::from(k % 97) * 0.2;
            let position_m = Vec3::new(3.0 + distance_m * s, -2.0 + distance_m * c, 4.0 + f64::from(k % 13));
            let every = field.cylinders.iter().fold(Vec3::zero(), |sum, one| sum + one.distortion(position_m, undisturbed));
            let found = field.distortion(position_m, undisturbed);
            let most = 2.0 * MIN_DISTORTION * undisturbed.norm();
            assert!((every - found).norm() <= most, "{every:?} {found:?} at {position_m:?}");
        }
    }

    #[test]
    fn prop_girder_bridge_distorts_the_field_between_its_girders_more_than_below_them() {
        use crate::scenario::bridges::BridgeShape;
        use crate::scenario::bridges::beam_bridge::BeamBridge;
        use crate::scenario::bridges::girder::Girder;
        // In a bay, webs are less than 2 m away on both sides; 4 m below the girders, the compass turns by a few degrees at most.
        const IN_BAY: f64 = 0.05;
        const BELOW: f64 = 0.05;
        let girder = Girder::default();
        let mut builder = MemberBuilder::new("test", Placement::new(Vec3::zero(), 30.0));
        girder.build(&mut builder);
        let field = SteelField::new(&builder.finish(), 1.0);
        let undisturbed = Vec3::new(0.02, 0.2, -0.4);
        let at = |z: f64| {
            let position_m = Placement::new(Vec3::zero(), 30.0).point([3.0, 0.0, z]);
            field.distortion(position_m, undisturbed).norm() / undisturbed.norm()
        };
        let bottom_z_m = girder.layout().lines.bottom_z_m;
        let (bay, below) = (at(bottom_z_m + 0.5), at(bottom_z_m - 4.0));
        assert!(bay > IN_BAY && below < BELOW && below > 0.0, "{bay} {below}");
        let far = Placement::new(Vec3::zero(), 30.0).point([3.0, 40.0, -2.0]);
        assert_eq!(field.distortion(far, undisturbed), Vec3::zero());
    }
}

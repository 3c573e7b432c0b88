//! Vertical bodies that stand free in the wind: piers, towers and columns.

use super::air::Stream;
use super::cylinders::{Section, Shedding, Vortices};
use super::plane_wake::{LENGTH_WIDTHS, PlaneWake, WakeAir};
use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::bridges::{Member, Solid};
use crate::site::plan_hull::hull;
use crate::time::SimTime;

/// Elements that stand free in the wind.
const STANDING: [Element; 6] = [
    Element::SteelColumn,
    Element::PscColumn,
    Element::RcColumn,
    Element::SteelTower,
    Element::RcPierWall,
    Element::MasonryPierWall,
];
/// Smallest width and height of a body with a wake, m: that of a column (estimate: thinner wakes are narrower than a drone).
const MIN_SIZE_M: (f64, f64) = (0.5, 3.0);
/// Smallest number of sides of a column that the air takes for round (estimate; measured values for octagons are between those of
/// squares and circles).
const MIN_ROUND_SIDES: usize = 8;

/// Square of the change of the wind's direction, rad², below which the body's extents stay: a nanoradian, far more than rounding.
const SAME_DIRECTION: f64 = 1e-18;

/// A vertical body, and its wake in the present wind.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BluffBody {
    corners_m: Vec<Vec3<Enu>>,
    center_m: Vec3<Enu>,
    pub(super) base_up_m: f64,
    pub(super) top_up_m: f64,
    pub(super) section: Section,
    /// Horizontal distance from the center to the farthest corner, m.
    radius_m: f64,
    phase_rad: f64,
    /// Direction of the wind, and the body's extents along and across it, m.
    facing: (Vec3<Enu>, f64, f64),
    wake: PlaneWake,
}

impl BluffBody {
    /// Returns the body of a column, tower or pier; `None` for other members.
    pub(super) fn of(member: &Member) -> Option<Self> {
        let is_support = STANDING.contains(&member.element);
        let range = |value: fn(&Vec3<Enu>) -> f64| math::range(member.solid.vertices_m.iter().map(value));
        let (east, north, up) = (range(|corner| corner.east()), range(|corner| corner.north()), range(|corner| corner.up()));
        let size_m = (east.1 - east.0).min(north.1 - north.0);
        let middle = |(low, high): (f64, f64)| 0.5 * (low + high);
        let center_m = Vec3::<Enu>::new(middle(east), middle(north), middle(up));
        let is_large = size_m >= MIN_SIZE_M.0 && up.1 - up.0 >= MIN_SIZE_M.1;
        let to_corner_m = |corner: &Vec3<Enu>| (*corner - center_m).horizontal_norm();
        let radius_m = member.solid.vertices_m.iter().map(to_corner_m).fold(0.0, f64::max);
        // The number of triangles of a surface says nothing about its section.
        let sides = if member.solid.is_convex() { member.solid.faces.len().saturating_sub(2) } else { 0 };
        let section = if sides >= MIN_ROUND_SIDES { Section::Round } else { Section::Sharp };
        let wake = PlaneWake { width_m: size_m, shedding: Shedding { drag: 0.0, strouhal: 0.0, regularity: 0.0 } };
        let body = Self {
            corners_m: outer_corners_m(&member.solid),
            center_m,
            base_up_m: up.0,
            top_up_m: up.1,
            section,
            radius_m,
            phase_rad: 0.0,
            facing: (Vec3::zero(), 0.0, 0.0),
            wake,
        };
        (is_support && is_large).then_some(body)
    }

    /// Sets the phase of the vortices at the start.
    pub(super) fn with_phase(self, phase_rad: f64) -> Self {
        Self { phase_rad, ..self }
    }

    /// Turns the wake into a wind, and advances its vortices by one time step.
    pub(super) fn advance(&mut self, wind: &Stream, vortices: Vortices, step: SimTime) {
        // The speed of the wind changes with the aircraft's height, its direction seldom.
        let has_turned = (self.facing.0 - wind.along).norm_squared() > SAME_DIRECTION;
        if has_turned {
            self.facing = (wind.along, self.extent_m(wind.along), self.extent_m(wind.left).max(MIN_SIZE_M.0));
        }
        // The shedding of sharp sections does not depend on the speed of the wind.
        if has_turned || self.section == Section::Round {
            let (_, length_m, width_m) = self.facing;
            let shedding = vortices.of(Shedding::of(self.section, length_m, width_m, wind.speed_m_s));
            self.wake = PlaneWake { width_m, shedding };
        }
        self.phase_rad = self.wake.next_phase_rad(self.phase_rad, wind.speed_m_s, step);
    }

    /// Returns the body's width across the present wind, m.
    pub(super) fn width_m(&self) -> f64 {
        self.wake.width_m
    }

    /// Returns the extent in a horizontal direction, m.
    fn extent_m(&self, direction: Vec3<Enu>) -> f64 {
        let (low, high) = math::range(self.corners_m.iter().map(|corner| (*corner - self.center_m).dot(direction)));
        high - low
    }

    /// Returns false only if the wake does not reach any position within a radius.
    pub(super) fn may_reach(&self, center_m: Vec3<Enu>, radius_m: f64, wind: &Stream) -> bool {
        let from_center = center_m - self.center_m;
        let ahead_m = from_center.dot(wind.along);
        let up_m = center_m.up();
        let width_m = self.wake.width_m;
        ahead_m > -radius_m
            && ahead_m <= LENGTH_WIDTHS.0 * width_m + self.radius_m + radius_m
            && up_m > self.base_up_m - width_m - radius_m
            && up_m < self.top_up_m + width_m + radius_m
            && self.wake.may_reach(ahead_m - 0.5 * self.facing.1 + radius_m, from_center.dot(wind.left).abs() - radius_m)
    }

    /// Returns the wake at a position; `None` outside it. It fades within half a width at the ends of the body (estimate).
    pub(super) fn at(&self, position_m: Vec3<Enu>, wind: &Stream) -> Option<WakeAir> {
        let from_center = position_m - self.center_m;
        let ahead_m = from_center.dot(wind.along);
        let up_m = position_m.up();
        let width_m = self.wake.width_m;
        let reaches = ahead_m > 0.0
            && ahead_m <= LENGTH_WIDTHS.0 * width_m + self.radius_m
            && up_m > self.base_up_m - width_m
            && up_m < self.top_up_m + width_m;
        let share = if reaches { self.share_at_height(up_m) } else { 0.0 };
        if share <= 0.0 {
            return None;
        }
        let behind_m = ahead_m - 0.5 * self.facing.1;
        let WakeAir { deficit, sway, turbulence } = self.wake.at(behind_m, from_center.dot(wind.left), self.phase_rad)?;
        Some(WakeAir { deficit: deficit * share, sway: sway * share, turbulence: turbulence * share })
    }

    /// Returns 1 beside the body, 0 above and below it, and values between near its ends.
    fn share_at_height(&self, up_m: f64) -> f64 {
        let inside_m = (up_m - self.base_up_m).min(self.top_up_m - up_m);
        (2.0 * inside_m / self.wake.width_m + 0.5).clamp(0.0, 1.0)
    }
}

/// Returns the corners that determine the extent in every horizontal direction: all of a convex solid, and the outermost in plan view of a
/// surface, which may have a million.
fn outer_corners_m(solid: &Solid) -> Vec<Vec3<Enu>> {
    if solid.is_convex() {
        return solid.vertices_m.clone();
    }
    let plan: Vec<(f64, f64)> = solid.vertices_m.iter().map(|corner| (corner.east(), corner.north())).collect();
    hull(&plan).into_iter().map(|(east_m, north_m)| Vec3::new(east_m, north_m, 0.0)).collect()
}

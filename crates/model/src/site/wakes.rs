//! Wakes behind piers, towers and columns: the mean wind is weaker there, and vortices that the body sheds make the air sway across
//! the wind.
//!
//! The mean velocity is that of a plane turbulent wake (Schlichting, *Boundary-Layer Theory*), continued up to a quarter of a width
//! behind the body's rearmost corner (estimate); closer to the body, the air has the full wind. The bodies have sharp edges, so that their drag and Strouhal number hardly
//! depend on the wind speed. The flow ahead of a body and the additional small-scale turbulence are missing.

use crate::elements::Element;
use crate::frames::{Enu, Ned, Vec3};
use crate::math;
use crate::random::RandomStream;
use crate::scenario::bridges::Member;
use crate::time::SimTime;

/// Drag coefficient of a square cylinder with a face across the wind (Lyn et al., Journal of Fluid Mechanics 304, 1995: 2.1).
const DRAG_COEFFICIENT: f64 = 2.1;
/// Strouhal number of a square cylinder (Lyn et al. 1995: 0.13).
pub const STROUHAL_NUMBER: f64 = 0.13;
/// Velocity deficit on the axis of a plane wake at x = C_D D, relative to the wind (Schlichting: √10 / (18 · 0.18)).
const DEFICIT: f64 = 0.976;
/// Half width of a plane wake at x = C_D D, in units of C_D D (Schlichting: √10 · 0.18).
const HALF_WIDTH: f64 = 0.569;
/// Deficit of the continued wake at the body (estimate: the air behind it hardly moves on average).
const MAX_DEFICIT: f64 = 1.0;
/// Amplitude of the sway two widths behind the body, relative to the wind (estimate).
const SWAY: f64 = 0.5;
/// Half width of the swaying air, in half widths of the wake (estimate).
const SWAY_HALF_WIDTHS: f64 = 1.5;
/// Speed at which vortices move downstream, relative to the wind (estimate; measured values are 0.75 to 0.9).
const VORTEX_SPEED: f64 = 0.8;
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
/// Wind below which there are no wakes, m/s.
const MIN_WIND_M_S: f64 = 0.2;
/// Length of a wake, and the length over which it ends, in body widths. Its deficit is then about a fifth (estimate: the turbulence of
/// the wind dissolves it).
const LENGTH_WIDTHS: (f64, f64) = (50.0, 10.0);

/// Wakes of a site, with the phase of the vortices that each body sheds.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeField {
    bodies: Vec<BluffBody>,
    phases_rad: Vec<f64>,
}

/// A vertical body with sharp edges.
#[derive(Debug, Clone, PartialEq)]
struct BluffBody {
    corners_m: Vec<Vec3<Enu>>,
    center_m: Vec3<Enu>,
    base_up_m: f64,
    top_up_m: f64,
}

/// A horizontal wind's direction, the direction to its left, and its speed in m/s.
#[derive(Debug, Clone, Copy)]
struct Stream {
    along: Vec3<Enu>,
    left: Vec3<Enu>,
    speed_m_s: f64,
}

impl Stream {
    /// Returns `None` in still air.
    fn of(wind_m_s: Vec3<Ned>) -> Option<Self> {
        let horizontal = Vec3::new(wind_m_s.east(), wind_m_s.north(), 0.0);
        let speed_m_s = horizontal.norm();
        let along = (speed_m_s >= MIN_WIND_M_S).then(|| horizontal / speed_m_s)?;
        Some(Self { along, left: Vec3::new(-along.north(), along.east(), 0.0), speed_m_s })
    }
}

impl WakeField {
    /// Collects the bodies. The seed determines the phases at the start.
    #[must_use]
    pub fn new(members: &[Member], seed: u64) -> Self {
        let mut stream = RandomStream::new(seed, "wind.wakes");
        let bodies: Vec<BluffBody> = members.iter().filter_map(BluffBody::of).collect();
        let phases_rad = bodies.iter().map(|_| stream.uniform() * math::TAU).collect();
        Self { bodies, phases_rad }
    }

    /// Advances the phases by one time step in a wind.
    pub fn advance(&mut self, wind_m_s: Vec3<Ned>, step: SimTime) {
        let Some(wind) = Stream::of(wind_m_s) else { return };
        for (body, phase_rad) in self.bodies.iter().zip(&mut self.phases_rad) {
            let frequency_hz = STROUHAL_NUMBER * wind.speed_m_s / body.extent_m(wind.left).max(MIN_SIZE_M.0);
            *phase_rad = math::wrap_pi(*phase_rad + math::TAU * frequency_hz * step.s());
        }
    }

    /// Returns the velocity that the wakes add to a wind at a position, m/s.
    #[must_use]
    pub fn velocity(&self, position_m: Vec3<Enu>, wind_m_s: Vec3<Ned>) -> Vec3<Ned> {
        let Some(wind) = Stream::of(wind_m_s) else { return Vec3::zero() };
        let wakes = self.bodies.iter().zip(&self.phases_rad).filter_map(|(body, phase)| body.wake(position_m, &wind, *phase));
        // Overlapping deficits add as the root of the sum of squares, as wakes of wind turbines (Katic et al. 1986), so that the air
        // never flows backward.
        let (squares, sway) =
            wakes.fold((0.0, 0.0), |(squares, sway), wake| (squares + wake.deficit * wake.deficit, sway + wake.sway));
        let added = wind.along * -squares.sqrt().min(MAX_DEFICIT) + wind.left * sway;
        (added * wind.speed_m_s).ned()
    }
}

/// One wake at a position, relative to the wind speed.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Wake {
    deficit: f64,
    sway: f64,
}

impl BluffBody {
    /// Returns the body of a column, tower or pier; `None` for other members.
    fn of(member: &Member) -> Option<Self> {
        let is_support = STANDING.contains(&member.element);
        let corners_m = member.solid.vertices_m.clone();
        let range = |value: fn(&Vec3<Enu>) -> f64| math::range(corners_m.iter().map(value));
        let (east, north, up) = (range(|corner| corner.east()), range(|corner| corner.north()), range(|corner| corner.up()));
        let size_m = (east.1 - east.0).min(north.1 - north.0);
        let middle = |(low, high): (f64, f64)| 0.5 * (low + high);
        let center_m = Vec3::new(middle(east), middle(north), middle(up));
        let is_large = size_m >= MIN_SIZE_M.0 && up.1 - up.0 >= MIN_SIZE_M.1;
        (is_support && is_large).then_some(Self { corners_m, center_m, base_up_m: up.0, top_up_m: up.1 })
    }

    /// Returns the extent in a horizontal direction, m.
    fn extent_m(&self, direction: Vec3<Enu>) -> f64 {
        let (low, high) = math::range(self.corners_m.iter().map(|corner| (*corner - self.center_m).dot(direction)));
        high - low
    }

    /// Returns the wake at a position; `None` outside it.
    fn wake(&self, position_m: Vec3<Enu>, wind: &Stream, phase_rad: f64) -> Option<Wake> {
        let from_center = position_m - self.center_m;
        let ahead_m = from_center.dot(wind.along);
        if ahead_m <= 0.0 {
            return None;
        }
        let width_m = self.extent_m(wind.left);
        let behind_m = ahead_m - 0.5 * self.extent_m(wind.along);
        if behind_m <= 0.0 || behind_m > LENGTH_WIDTHS.0 * width_m {
            return None;
        }
        let across_m = from_center.dot(wind.left);
        let half_width_m = half_width_m(behind_m, width_m);
        // The wake begins within a quarter of the width and fades within half a width at the ends of the body (estimates).
        let start = (4.0 * behind_m / width_m).min(1.0);
        let end = ((LENGTH_WIDTHS.0 - behind_m / width_m) / LENGTH_WIDTHS.1).min(1.0);
        let within = start * end * self.share_at_height(position_m.up(), width_m);
        let off_axis = (across_m / half_width_m).abs();
        if within <= 0.0 || off_axis >= SWAY_HALF_WIDTHS {
            return None;
        }
        let profile = squared(1.0 - off_axis.min(1.0) * off_axis.min(1.0).sqrt());
        let sway_profile = squared(1.0 - squared(off_axis / SWAY_HALF_WIDTHS));
        let shape = behind_m / (2.0 * width_m);
        let amplitude = SWAY * 2.0 * shape / (1.0 + shape * shape);
        let lag_rad = math::TAU * behind_m * STROUHAL_NUMBER / (VORTEX_SPEED * width_m);
        let sway = amplitude * sway_profile * math::cos(phase_rad - lag_rad);
        Some(Wake { deficit: axis_deficit(behind_m, width_m) * profile * within, sway: sway * within })
    }

    /// Returns 1 beside the body, 0 above and below it, and values between near its ends.
    fn share_at_height(&self, up_m: f64, width_m: f64) -> f64 {
        let inside_m = (up_m - self.base_up_m).min(self.top_up_m - up_m);
        (2.0 * inside_m / width_m + 0.5).clamp(0.0, 1.0)
    }
}

/// Returns the velocity deficit on the axis, relative to the wind.
fn axis_deficit(behind_m: f64, width_m: f64) -> f64 {
    let drag_width_m = DRAG_COEFFICIENT * width_m;
    // The distance from the wake's apparent origin, at which the far wake would have the largest deficit at the body.
    let origin_m = squared(DEFICIT / MAX_DEFICIT) * drag_width_m;
    DEFICIT * (drag_width_m / (behind_m + origin_m)).sqrt()
}

/// Returns the distance from the axis to the edge of the wake, m. At the body, the wake is as wide as the body.
fn half_width_m(behind_m: f64, width_m: f64) -> f64 {
    let drag_width_m = DRAG_COEFFICIENT * width_m;
    let origin_m = squared(0.5 * width_m / HALF_WIDTH) / drag_width_m;
    HALF_WIDTH * ((behind_m + origin_m) * drag_width_m).sqrt()
}

fn squared(x: f64) -> f64 {
    x * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::bridges::solid::{MemberBuilder, Placement};

    const WIND_M_S: f64 = 6.0;
    const WIDTH_M: f64 = 3.0;

    /// Returns a square pier of 3 m and 20 m height at the origin, beside a deck that has no wake.
    fn pier() -> WakeField {
        let mut builder = MemberBuilder::new("test", Placement::new(Vec3::zero(), 90.0));
        builder.add_box("pier", Element::RcPierWall, [-1.5, -1.5, 0.0], [1.5, 1.5, 20.0]);
        builder.add_box("deck", Element::RcDeck, [-50.0, -5.0, 21.0], [50.0, 5.0, 22.0]);
        WakeField::new(&builder.finish(), 1)
    }

    /// The wind blows toward the east.
    fn wind() -> Vec3<Ned> {
        Vec3::new(0.0, WIND_M_S, 0.0)
    }

    #[test]
    fn exact_far_wake_carries_the_momentum_of_the_drag() {
        // The integral of the deficit across the far wake is half of the drag coefficient times the width (momentum balance). The
        // constants have three digits, and the wake's apparent origin changes its strength by D/x.
        const TOLERANCE: f64 = 0.01;
        let (far_m, step_m) = (1e4 * WIDTH_M, 0.5);
        let half_m = half_width_m(far_m, WIDTH_M);
        let profile = |y: f64| squared(1.0 - math::pow((y.abs() / half_m).min(1.0), 1.5));
        let cells = (half_m / step_m) as i32;
        let area_m: f64 = (-cells..=cells).map(|k| profile(f64::from(k) * step_m) * step_m).sum();
        let momentum = axis_deficit(far_m, WIDTH_M) * area_m / (0.5 * DRAG_COEFFICIENT * WIDTH_M);
        assert!((momentum - 1.0).abs() < TOLERANCE, "{momentum}");
    }

    #[test]
    fn exact_wind_recovers_behind_a_pier_and_is_unchanged_beside_before_and_above_it() {
        let field = pier();
        let along =
            |east_m: f64, north_m: f64, up_m: f64| field.velocity(Vec3::new(east_m, north_m, up_m), wind()).east() / WIND_M_S;
        let deficits = [3.0, 6.0, 15.0, 60.0].map(|east_m| -along(east_m, 0.0, 10.0));
        assert!(deficits.windows(2).all(|pair| pair[0] > pair[1]), "{deficits:?}");
        assert!(deficits[0] > 0.6 && deficits[3] < 0.4, "{deficits:?}");
        assert_eq!(along(-6.0, 0.0, 10.0), 0.0, "ahead");
        assert_eq!(along(6.0, 12.0, 10.0), 0.0, "beside");
        assert_eq!(along(6.0, 0.0, 24.0), 0.0, "above");
    }

    #[test]
    fn val_air_behind_a_pier_sways_at_the_strouhal_frequency() {
        const STEP: SimTime = SimTime::from_ms(10);
        let mut field = pier();
        let mut crossings = Vec::new();
        let mut before = 0.0;
        for k in 0..60_000 {
            field.advance(wind(), STEP);
            let sway = field.velocity(Vec3::new(7.0, 0.0, 10.0), wind()).north();
            if before < 0.0 && sway >= 0.0 {
                crossings.push(f64::from(k) * STEP.s());
            }
            before = sway;
        }
        let periods = (crossings.len() - 1) as f64;
        let frequency_hz = periods / (crossings[crossings.len() - 1] - crossings[0]);
        // The issue of a shedding frequency is its peak within 5%; a sampled cosine is exact to the step.
        let strouhal = frequency_hz * WIDTH_M / WIND_M_S;
        assert!((strouhal / STROUHAL_NUMBER - 1.0).abs() < 0.05, "{strouhal}");
    }

    #[test]
    fn prop_velocity_in_wakes_is_finite_continuous_and_never_backward() {
        // Within a millimeter, the velocity changes by less than the largest gradient allows: the wind over a tenth of the width.
        const STEP_M: f64 = 1e-3;
        let largest = WIND_M_S / (0.1 * WIDTH_M) * STEP_M * 4.0;
        let field = pier();
        for k in 0..400 {
            let (s, c) = math::sin_cos(f64::from(k) * 0.37);
            let wind = Vec3::new(WIND_M_S * s, WIND_M_S * c, 0.0);
            let distance_m = 2.2 + f64::from(k % 50) * 4.0;
            let at = Vec3::new(distance_m * c, distance_m * s, 5.0);
            for shift in [Vec3::new(STEP_M, 0.0, 0.0), Vec3::new(0.0, STEP_M, 0.0), Vec3::new(0.0, 0.0, STEP_M)] {
                let (here, there) = (field.velocity(at, wind), field.velocity(at + shift, wind));
                assert!((here - there).norm() < largest, "{here:?} {there:?} at {at:?}");
                assert!((wind + here).dot(wind) >= -1e-9, "{here:?} at {at:?}");
            }
        }
    }
}

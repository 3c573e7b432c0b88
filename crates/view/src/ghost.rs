//! Ghost: a translucent aircraft that flies along an earlier flight, a little ahead of the trainee and for as long as they need.
//! It is part of the window's overlay, so it never appears in a photograph, a video or a score.

use super::camera::PinholeCamera;
use super::hud::{DrawItem, HudColor};
use super::path_guide::{circle, polygon, segment};
use spandrel_mavlink::contract::truth::Truth;
use spandrel_mavlink::telemetry::Flight;
use spandrel_model::frames::{Enu, Frd, Ned, Rotation, Vec3};
use spandrel_model::math;
use spandrel_model::pose::Pose;
use spandrel_model::vehicle::Vehicle;

/// Distance and turn between two points of the ghost's path, m and rad (estimates: no visible corners). Where the earlier flight
/// hovered, the path has one point, so the ghost never waits there.
const POINT_SPACING_M: f64 = 0.25;
const POINT_TURN_RAD: f64 = 0.26;
/// Distance by which the ghost leads along its path, m (estimate: far enough to be in front of the camera and to show the next
/// turn, near enough to show the stand-off).
const LEAD_M: f64 = 6.0;
/// Part of the path, behind and ahead of the trainee's place, in which they are expected, m.
const BEHIND_M: f64 = 15.0;
const AHEAD_M: f64 = 30.0;
/// A trainee this far from the expected part may be elsewhere on the path; the other place must be this near, m (estimates: half
/// and a quarter of the distance between two tasks of the shipped jobs).
const LOST_M: f64 = 8.0;
const FOUND_M: f64 = 4.0;
/// Largest speed of the ghost along its path, m/s, and distance from which it jumps, m (estimates).
const MAX_SPEED_M_S: f64 = 12.0;
const JUMP_M: f64 = 40.0;
/// Minimum distance of the rotors from the center in the picture, as a fraction of its height (estimate: recognizable as an
/// aircraft).
const MIN_SIZE: f64 = 0.03;
/// Corners of a rotor disk.
const DISK_CORNERS: u32 = 12;
/// Half the width of the body as a fraction of the rotors' distance from the center, and length of the line that shows the
/// heading, as a multiple of it.
const BODY_SHARE: f64 = 0.35;
const HEADING_SHARE: f64 = 1.8;
/// Radius of the ring around the ghost, as a multiple of the rotors' distance from the center. Seen from the side, an aircraft is a
/// thin line.
const RING_SHARE: f64 = 1.9;
/// Width of the lines, as a fraction of the picture's height.
const LINE_WIDTH: f64 = 0.004;

/// A point of an earlier flight.
#[derive(Debug, Clone, Copy, PartialEq)]
struct GhostPoint {
    /// Distance along the path, m.
    along_m: f64,
    pose: Pose<Enu>,
}

/// An earlier flight as a path, without its speed.
#[derive(Debug, Clone, PartialEq)]
pub struct GhostPath(Vec<GhostPoint>);

impl GhostPath {
    /// Returns the path of a flight from its lift-off; `None` if it never lifted off. `pad_height_m` is the height of the pad in
    /// the scenario's frame.
    #[must_use]
    pub fn of(flight: &Flight, pad_height_m: f64, lift_off_height_m: f64) -> Option<Self> {
        let start = flight.lift_off(pad_height_m, lift_off_height_m)?;
        let mut points: Vec<GhostPoint> = Vec::new();
        for Truth { motion, .. } in flight.truths.iter().filter(|truth| truth.time >= start) {
            let pose = motion.pose();
            let Some(last) = points.last() else {
                points.push(GhostPoint { along_m: 0.0, pose });
                continue;
            };
            let moved_m = (pose.position_m - last.pose.position_m).norm();
            let turned_rad = math::wrap_pi(pose.ned_from_frd.yaw_rad() - last.pose.ned_from_frd.yaw_rad()).abs();
            if moved_m >= POINT_SPACING_M || turned_rad >= POINT_TURN_RAD {
                // A turn on the spot takes as long as a short way.
                points.push(GhostPoint { along_m: last.along_m + moved_m.max(POINT_SPACING_M), pose });
            }
        }
        (!points.is_empty()).then_some(Self(points))
    }

    /// Returns the index of the point nearest to a position within a part of the path, and its distance in m.
    fn nearest(&self, position_m: Vec3<Enu>, (from_m, to_m): (f64, f64)) -> Option<(usize, f64)> {
        let part = self.0.iter().enumerate().filter(|(_, point)| (from_m..=to_m).contains(&point.along_m));
        let distances = part.map(|(k, point)| (k, (point.pose.position_m - position_m).norm()));
        distances.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Returns the pose at a distance along the path, clamped to its ends.
    fn at(&self, along_m: f64) -> Option<Pose<Enu>> {
        let after = self.0.partition_point(|point| point.along_m <= along_m);
        let before = self.0.get(after.saturating_sub(1))?;
        let Some(next) = self.0.get(after).filter(|_| after > 0) else { return Some(before.pose) };
        let t = (along_m - before.along_m) / (next.along_m - before.along_m);
        Some(Pose {
            position_m: before.pose.position_m.lerp(next.pose.position_m, t),
            ned_from_frd: before.pose.ned_from_frd.lerp(next.pose.ned_from_frd, t),
        })
    }
}

/// A ghost that follows its path abreast of the trainee.
#[derive(Debug, Clone, PartialEq)]
pub struct Ghost {
    path: GhostPath,
    /// Distance along the path of the point nearest to the trainee, m.
    abreast_m: f64,
    /// Distance along the path at which the ghost is shown, m.
    shown_m: Option<f64>,
}

impl Ghost {
    /// Creates a ghost at the beginning of its path.
    #[must_use]
    pub fn new(path: GhostPath) -> Self {
        Self { path, abreast_m: 0.0, shown_m: None }
    }

    /// Moves the ghost for a trainee at a position, `step_s` after the last call, and returns its pose.
    pub fn advance(&mut self, position_m: Vec3<Enu>, step_s: f64) -> Option<Pose<Enu>> {
        let expected = self.path.nearest(position_m, (self.abreast_m - BEHIND_M, self.abreast_m + AHEAD_M));
        let is_lost = expected.is_none_or(|(_, distance_m)| distance_m > LOST_M);
        let elsewhere = || self.path.nearest(position_m, (0.0, f64::INFINITY)).filter(|(_, distance_m)| *distance_m < FOUND_M);
        let place = if is_lost { elsewhere() } else { expected };
        // Away from the path, the ghost waits.
        if let Some((k, _)) = place {
            self.abreast_m = self.path.0[k].along_m;
        }
        let target_m = self.abreast_m + LEAD_M;
        let most_m = MAX_SPEED_M_S * step_s.max(0.0);
        let shown_m = match self.shown_m {
            Some(shown_m) if (target_m - shown_m).abs() < JUMP_M => shown_m + (target_m - shown_m).clamp(-most_m, most_m),
            Some(_) | None => target_m,
        };
        self.shown_m = Some(shown_m);
        self.path.at(shown_m)
    }
}

/// Inputs for drawing a ghost into a picture.
pub struct GhostView<'a> {
    /// The picture's camera.
    pub eye: &'a PinholeCamera,
    /// Width of the picture over its height.
    pub aspect: f64,
    /// The aircraft whose shape the ghost has.
    pub vehicle: &'a Vehicle,
    /// Whether an object hides the ghost.
    pub is_hidden: bool,
}

impl GhostView<'_> {
    /// Returns the items that draw a ghost at a pose: rotor disks, body, a line that shows its heading, and a ring around it.
    #[must_use]
    pub fn items(&self, pose: Pose<Enu>) -> Vec<DrawItem> {
        let depth_m = (pose.position_m - self.eye.position_m).dot(self.eye.forward);
        if depth_m <= 0.0 {
            return Vec::new();
        }
        let arm_m = self.vehicle.rotors.iter().map(|rotor| rotor.position_m.norm()).fold(0.0, f64::max).max(0.05);
        let (_, half_height) = self.eye.half_extents(self.aspect);
        // A distant ghost is drawn larger than it is.
        let scale = (MIN_SIZE * 2.0 * half_height * depth_m / arm_m).max(1.0);
        let matrix = self.eye.view_projection(self.aspect);
        let color = if self.is_hidden { HudColor::GhostHidden } else { HudColor::Ghost };
        let at = |body_m: Vec3<Frd>| body_point(pose, body_m * scale);
        let disks = self.vehicle.rotors.iter().map(|rotor| {
            let corner = |k: u32| {
                let (sin, cos) = math::sin_cos(math::TAU * f64::from(k) / f64::from(DISK_CORNERS));
                let radius_m = self.vehicle.rotor.radius_m;
                at(rotor.position_m + Vec3::new(radius_m * cos, radius_m * sin, 0.0))
            };
            (0..DISK_CORNERS).map(corner).collect::<Vec<_>>()
        });
        let half_m = BODY_SHARE * arm_m;
        let body = [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)];
        let body = body.map(|(ahead, right)| at(Vec3::new(half_m * ahead, half_m * right, 0.0))).to_vec();
        let shapes =
            disks.chain([body]).filter_map(|corners| Some(DrawItem::Fill { points: polygon(&matrix, &corners)?, color }));
        let nose = segment(&matrix, at(Vec3::zero()), at(Vec3::new(HEADING_SHARE * arm_m, 0.0, 0.0)), LINE_WIDTH, color);
        let to = (pose.position_m - self.eye.position_m).unit();
        let ring = circle(&matrix, (pose.position_m, to), RING_SHARE * arm_m * scale, (LINE_WIDTH, color));
        shapes.chain(nose).chain(ring).collect()
    }
}

/// Returns a point of the body in the scenario's frame.
fn body_point(pose: Pose<Enu>, body_m: Vec3<Frd>) -> Vec3<Enu> {
    let ned_from_frd: Rotation<Frd, Ned> = pose.ned_from_frd;
    pose.position_m + (ned_from_frd * body_m).enu()
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::pose::Motion;
    use spandrel_model::time::SimTime;
    use spandrel_model::{shipped, vehicle};

    /// Tolerance for positions, m: the spacing of the path's points.
    const TOLERANCE_M: f64 = POINT_SPACING_M + 1e-9;
    const STEP_S: f64 = 0.02;

    /// Returns a flight at 50 Hz along corners at 2 m/s, which hovers at each corner for 10 s.
    fn flight(corners: &[(f64, f64)]) -> Flight {
        let mut truths = Vec::new();
        let mut push = |east: f64, north: f64| {
            let time = SimTime::from_ms(20 * truths.len() as i64);
            let motion = Motion {
                position_m: Vec3::new(east, north, 10.0),
                velocity_m_s: Vec3::zero(),
                ned_from_frd: Rotation::from_euler(0.0, 0.0, 0.3),
            };
            truths.push(Truth { time, motion });
        };
        for pair in corners.windows(2) {
            let ((e0, n0), (e1, n1)) = (pair[0], pair[1]);
            let steps = (Vec3::<Enu>::new(e1 - e0, n1 - n0, 0.0).norm() / 0.04).ceil() as usize;
            (0..steps).map(|k| k as f64 / steps as f64).for_each(|t| push(e0 + t * (e1 - e0), n0 + t * (n1 - n0)));
            (0..500).for_each(|_| push(e1, n1));
        }
        Flight { truths, ..Flight::default() }
    }

    fn ghost(corners: &[(f64, f64)]) -> Ghost {
        Ghost::new(GhostPath::of(&flight(corners), 0.0, 0.3).unwrap())
    }

    fn settle(ghost: &mut Ghost, east: f64, north: f64) -> Vec3<Enu> {
        let position_m = Vec3::new(east, north, 10.0);
        (0..500).fold(Vec3::zero(), |_, _| ghost.advance(position_m, STEP_S).unwrap().position_m)
    }

    #[test]
    fn exact_ghost_leads_by_a_distance_and_waits() {
        let mut ghost = ghost(&[(0.0, 0.0), (50.0, 0.0), (50.0, 50.0)]);
        for (east, north, expected) in [
            (0.0, 0.0, (LEAD_M, 0.0)),
            (20.0, 1.0, (20.0 + LEAD_M, 0.0)),
            (47.0, 0.5, (50.0, LEAD_M - 3.0)),
            (50.0, 50.0, (50.0, 50.0)),
        ] {
            let here = settle(&mut ghost, east, north);
            let off_m = (here - Vec3::new(expected.0, expected.1, 10.0)).norm();
            assert!(off_m < 2.0 * TOLERANCE_M, "trainee at {east}, {north}: ghost at {here:?}");
            assert_eq!(settle(&mut ghost, east, north), here, "the ghost waits, however long the earlier flight hovered there");
        }
    }

    #[test]
    fn exact_ghost_waits_for_a_lost_trainee_and_returns_after_a_rewind() {
        let mut ghost = ghost(&[(0.0, 0.0), (100.0, 0.0), (100.0, 60.0), (0.0, 60.0)]);
        settle(&mut ghost, 20.0, 0.0);
        let waiting = settle(&mut ghost, 40.0, 0.0);
        assert_eq!(settle(&mut ghost, 40.0, 30.0), waiting, "30 m from the path");
        let back = settle(&mut ghost, 12.0, 0.0);
        assert!((back.east() - 12.0 - LEAD_M).abs() < 2.0 * TOLERANCE_M, "{back:?}");
        let other = settle(&mut ghost, 60.0, 60.0);
        assert!((other.east() - (60.0 - LEAD_M)).abs() < 2.0 * TOLERANCE_M && (other.north() - 60.0).abs() < 1e-6, "{other:?}");
    }

    #[test]
    fn exact_ghost_moves_smoothly() {
        let mut ghost = ghost(&[(0.0, 0.0), (100.0, 0.0)]);
        let mut last = settle(&mut ghost, 0.0, 0.0);
        for _ in 0..100 {
            let here = ghost.advance(Vec3::new(20.0, 0.0, 10.0), STEP_S).unwrap().position_m;
            assert!((here - last).norm() <= MAX_SPEED_M_S * STEP_S + 1e-9);
            last = here;
        }
        assert!((last.east() - 20.0 - LEAD_M).abs() < 2.0 * TOLERANCE_M);
    }

    #[test]
    fn exact_flight_without_lift_off_has_no_ghost() {
        assert_eq!(GhostPath::of(&flight(&[(0.0, 0.0), (5.0, 0.0)]), 20.0, 0.3), None);
        assert_eq!(GhostPath::of(&Flight::default(), 0.0, 0.3), None);
    }

    #[test]
    fn exact_ghost_is_drawn_in_front_of_the_camera_only() {
        let vehicle = vehicle::read("phantom2.toml", shipped::PHANTOM2).unwrap();
        let eye = PinholeCamera::at(Vec3::zero(), Vec3::new(0.0, 10.0, 0.0), 1.0, 1.5);
        let pose = |north: f64| Pose { position_m: Vec3::new(0.0, north, 0.0), ned_from_frd: Rotation::identity() };
        let items =
            |north: f64, is_hidden: bool| GhostView { eye: &eye, aspect: 1.5, vehicle: &vehicle, is_hidden }.items(pose(north));
        assert!(items(-5.0, false).is_empty());
        let fills = items(5.0, false).iter().filter(|item| matches!(item, DrawItem::Fill { .. })).count();
        assert_eq!(fills, vehicle.rotors.len() + 1, "rotor disks and body");
        let is = |color: HudColor| move |item: &DrawItem| matches!(item, DrawItem::Fill { color: own, .. } | DrawItem::Line { color: own, .. } if *own == color);
        assert!(items(5.0, false).iter().all(is(HudColor::Ghost)) && items(5.0, true).iter().all(is(HudColor::GhostHidden)));
        let width = |north: f64| {
            let xs: Vec<f64> = items(north, false)
                .iter()
                .flat_map(|item| match item {
                    DrawItem::Fill { points, .. } | DrawItem::Line { points, .. } => points.iter().map(|p| p.x).collect(),
                    DrawItem::Panel { .. } | DrawItem::Text { .. } => Vec::new(),
                })
                .collect();
            xs.iter().fold(0.0, |a: f64, b| a.max(*b)) - xs.iter().fold(1.0, |a: f64, b| a.min(*b))
        };
        assert!(width(2.0) > 1.5 * width(4.0), "near ghosts have their true size");
        assert!((width(200.0) / width(400.0) - 1.0).abs() < 0.05, "distant ghosts keep their size");
    }
}

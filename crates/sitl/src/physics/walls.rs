//! Walls beside the aircraft, and closed spaces.
//!
//! The inflow between the rotor tips and a wall lowers the pressure there and pulls the aircraft to the wall (Yang et al., *Wall
//! Inspector: Quadrotor Control in Wall-Proximity Through Model Compensation*, arXiv 2509.21496). The rotors beside the wall also lose
//! thrust, so that the aircraft tilts to it. Sizes and the exponential decrease are estimates: the force is a few percent of the thrust.
//!
//! Between two walls and the ground, the air that a rotor pushed away returns to it, and the thrust decreases to 93%; beside one wall
//! above the ground, it hardly changes (*Thrust variations in small rotors due to corner and vertex effects on the ground side*,
//! Aeronautical Journal, 2025, at 2.5 radii above the ground and 1.5 radii from the walls). Here, this loss needs three closed sides of
//! six, which also fits a bay below a deck.

use super::obstacles::Obstacles;
use super::recirculation::HoverDisk;
use super::state::{MAX_ROTORS, RigidState};
use spandrel_model::frames::{Enu, Frd, Ned, Vec3};
use spandrel_model::math;
use spandrel_model::site::RayHit;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{SEA_LEVEL_AIR_DENSITY_KG_M3, Vehicle};

/// Gaps between the rotor tips and a wall in rotor radii: the suction fades out linearly from the first to the second (estimate).
const SUCTION_FADE_RADII: [f64; 2] = [2.0, 3.0];
/// Distances of a hub from a closed side in rotor radii: up to the first (that of the measurement), recirculation is complete; from the
/// second (estimate), there is none.
const CLOSED_RADII: [f64; 2] = [2.5, 5.0];
/// Cosine of the largest angle between a ray and the normal of the wall that it finds. Of four rays, one is within 45 degrees.
const MIN_INCIDENCE_COSINE: f64 = 0.7;
/// Cosine of the largest angle between the normals of two faces that count as one wall (estimate).
const SAME_WALL_COSINE: f64 = 0.5;
/// Number of closed sides that recirculation needs.
const CLOSED_SIDES: usize = 3;
/// Constants of the effects of walls on one aircraft.
#[derive(Debug, Clone, PartialEq)]
pub struct Walls {
    suction: f64,
    recirculation_loss: f64,
    hubs: Vec<Vec3<Frd>>,
    radius_m: f64,
    /// Distance of the outermost hub from the center, m.
    arm_m: f64,
    disk: HoverDisk,
    /// Induced velocity in a hover at sea level, m/s.
    induced_m_s: f64,
}

/// Effects of the walls at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallEffect {
    /// Force on the aircraft as a fraction of its thrust.
    pub pull: Vec3<Ned>,
    /// Thrust factor of each rotor.
    pub factors: [f64; MAX_ROTORS],
}

impl WallEffect {
    /// The effect far from all walls.
    pub const NONE: Self = Self { pull: Vec3::zero(), factors: [1.0; MAX_ROTORS] };
}

/// A wall that a level ray has hit.
#[derive(Debug, Clone, Copy)]
struct Wall {
    /// Outward unit normal.
    normal: Vec3<Enu>,
    /// Distance of the aircraft's center from the wall's plane, m.
    distance_m: f64,
}

impl Wall {
    /// Returns `None` for a surface that the ray only grazes; another ray hits the same plane more squarely.
    fn of(hit: &RayHit, direction: Vec3<Enu>) -> Option<Self> {
        let cosine = -direction.dot(hit.normal);
        (cosine >= MIN_INCIDENCE_COSINE).then_some(Self { normal: hit.normal, distance_m: hit.distance_m * cosine })
    }

    /// Whether both are one wall: two rays can hit the same one, or neighboring faces of a round pier.
    fn faces_like(&self, other: &Self) -> bool {
        self.normal.dot(other.normal) > SAME_WALL_COSINE
    }
}

impl Walls {
    /// Returns `None` if the vehicle file switches both effects off.
    #[must_use]
    pub fn of(vehicle: &Vehicle) -> Option<Self> {
        let air = &vehicle.aerodynamics;
        let radius_m = vehicle.rotor.radius_m;
        let hubs: Vec<_> = vehicle.rotors.iter().map(|rotor| rotor.position_m).collect();
        let arm_m = hubs.iter().map(|hub| math::hypot(hub.forward(), hub.right())).fold(0.0, f64::max);
        let disk = HoverDisk::of(vehicle);
        let induced_m_s = disk.induced_velocity_m_s(SEA_LEVEL_AIR_DENSITY_KG_M3);
        let (suction, recirculation_loss) = (air.wall_suction, air.recirculation_loss);
        (suction > 0.0 || recirculation_loss > 0.0).then_some(Self {
            suction,
            recirculation_loss,
            hubs,
            radius_m,
            arm_m,
            disk,
            induced_m_s,
        })
    }

    /// Returns the distance of the aircraft's center from a surface from which there is no effect, m.
    #[must_use]
    pub fn reach_m(&self) -> f64 {
        self.arm_m + CLOSED_RADII[1] * self.radius_m
    }

    /// Returns the effects on an aircraft. `vertical_m`: distances of the hubs from the nearest surfaces above and below, m.
    pub fn effect(
        &self,
        rigid: &RigidState,
        vertical_m: [Option<f64>; 2],
        obstacles: &impl Obstacles,
        now: SimTime,
    ) -> WallEffect {
        let walls = self.find(rigid, obstacles, now);
        let closed = self.closure(&walls, vertical_m);
        let mut effect = WallEffect::NONE;
        for wall in walls.iter().flatten() {
            let tip_gap_m = wall.distance_m - self.arm_m - self.radius_m;
            effect.pull += (-wall.normal * self.suction_at(tip_gap_m)).ned();
        }
        for (i, hub) in self.hubs.iter().enumerate() {
            let hub = (rigid.attitude * *hub).enu();
            let beside: f64 = walls.iter().flatten().map(|wall| self.beside(wall, hub)).sum();
            let returning = self.recirculation_loss * closed * self.disk.fluctuation(i, self.induced_m_s, now);
            effect.factors[i] = (1.0 - beside) * (1.0 - returning);
        }
        effect
    }

    /// Casts rays ahead, to the right, back and to the left. Of several faces of one wall, only the nearest counts.
    fn find(&self, rigid: &RigidState, obstacles: &impl Obstacles, now: SimTime) -> [Option<Wall>; 4] {
        let (sin, cos) = math::sin_cos(rigid.attitude.euler().2);
        let ahead = Vec3::<Enu>::new(sin, cos, 0.0);
        let right = Vec3::<Enu>::new(cos, -sin, 0.0);
        let origin_m = rigid.position_m.enu();
        let hits = [ahead, right, -ahead, -right].map(|direction| {
            let hit = obstacles.ray(origin_m, direction, self.reach_m() / MIN_INCIDENCE_COSINE, now)?;
            Wall::of(&hit, direction)
        });
        let is_nearest = |index: usize, wall: &Wall| {
            let others = hits.iter().enumerate().filter(|(other, _)| *other != index);
            let mut same = others.filter_map(|(other, hit)| hit.filter(|hit| hit.faces_like(wall)).map(|hit| (other, hit)));
            same.all(|(other, hit)| (wall.distance_m, index) < (hit.distance_m, other))
        };
        std::array::from_fn(|index| hits[index].filter(|wall| is_nearest(index, wall)))
    }

    /// Returns the fraction of the thrust with which the air pulls at a gap between tips and wall, m.
    fn suction_at(&self, gap_m: f64) -> f64 {
        let radii = gap_m.max(0.0) / self.radius_m;
        let [from, to] = SUCTION_FADE_RADII;
        self.suction * math::exp(-radii) * ((to - radii) / (to - from)).clamp(0.0, 1.0)
    }

    /// Returns the fraction of its thrust that a rotor at an offset from the center loses beside a wall.
    fn beside(&self, wall: &Wall, hub: Vec3<Enu>) -> f64 {
        self.suction_at(wall.distance_m + wall.normal.dot(hub) - self.radius_m)
    }

    /// Returns how closed the space around the aircraft is, 0 to 1: the closeness of the third closest of the six sides.
    fn closure(&self, walls: &[Option<Wall>; 4], vertical_m: [Option<f64>; 2]) -> f64 {
        let level = walls.iter().map(|wall| wall.as_ref().map(|wall| wall.distance_m - self.arm_m));
        let mut sides = [0.0; 6];
        for (side, distance_m) in sides.iter_mut().zip(level.chain(vertical_m)) {
            *side = distance_m.map_or(0.0, |m| closeness(m / self.radius_m));
        }
        sides.sort_by(|a, b| b.total_cmp(a));
        sides[CLOSED_SIDES - 1]
    }
}

/// Returns how much a side at a distance in rotor radii closes the space, 0 to 1.
fn closeness(radii: f64) -> f64 {
    let [full, none] = CLOSED_RADII;
    ((none - radii) / (none - full)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::testing::vehicle_with;
    use crate::sensors::tests::error_free_sensors;
    use spandrel_model::frames::Rotation;
    use spandrel_model::site::{Contact, HullProbe, ObjectId, Surface};

    /// Rounding tolerance.
    const TOLERANCE: f64 = 1e-12;

    /// Planes with an outward normal and the distance of the origin from each, m.
    struct Planes(Vec<(Vec3<Enu>, f64)>);

    impl Obstacles for Planes {
        fn contacts(&self, _: &HullProbe, _: f64, _: SimTime, _: &mut Vec<Contact>) {}
        fn clearance(&self, _: Vec3<Enu>, _: f64, _: SimTime) -> Option<f64> {
            Some(0.0)
        }
        fn ray(&self, from: Vec3<Enu>, along: Vec3<Enu>, max_m: f64, _: SimTime) -> Option<RayHit> {
            let hit = |(normal, distance_m): &(Vec3<Enu>, f64)| {
                let distance_m = (distance_m + from.dot(*normal)) / -along.dot(*normal);
                let valid = along.dot(*normal) < 0.0 && (0.0..=max_m).contains(&distance_m);
                valid.then_some(RayHit { distance_m, normal: *normal, surface: Surface::Bridge, object: ObjectId(1) })
            };
            self.0.iter().filter_map(hit).min_by(|a, b| a.distance_m.total_cmp(&b.distance_m))
        }
    }

    fn walls(suction: f64, recirculation_loss: f64) -> Walls {
        let mut vehicle = vehicle_with(error_free_sensors());
        (vehicle.aerodynamics.wall_suction, vehicle.aerodynamics.recirculation_loss) = (suction, recirculation_loss);
        Walls::of(&vehicle).unwrap()
    }

    fn facing(yaw_rad: f64) -> RigidState {
        let attitude = Rotation::from_euler(0.0, 0.0, yaw_rad);
        RigidState { position_m: Vec3::zero(), attitude, ..crate::sensors::tests::still() }
    }

    /// A wall in the north at a distance from the origin, m.
    fn north_wall(distance_m: f64) -> (Vec3<Enu>, f64) {
        (Vec3::new(0.0, -1.0, 0.0), distance_m)
    }

    #[test]
    fn exact_effects_are_off_without_their_keys() {
        assert_eq!(Walls::of(&vehicle_with(error_free_sensors())), None);
    }

    #[test]
    fn exact_suction_decreases_over_a_radius_and_does_not_depend_on_the_heading() {
        let model = walls(0.04, 0.0);
        for gap_radii in [0.0, 0.5, 1.0, 2.0] {
            let plane = Planes(vec![north_wall(model.arm_m + (1.0 + gap_radii) * model.radius_m)]);
            for yaw_rad in [0.0, 0.3, 0.785, 1.2, 3.0] {
                let pull = model.effect(&facing(yaw_rad), [None; 2], &plane, SimTime::ZERO).pull;
                assert!((pull.north() - 0.04 * math::exp(-gap_radii)).abs() < TOLERANCE, "{gap_radii}, {yaw_rad}: {pull:?}");
                assert!(pull.east().abs() < TOLERANCE && pull.down().abs() < TOLERANCE);
            }
        }
        let far = Planes(vec![north_wall(model.arm_m + 4.0 * model.radius_m)]);
        assert_eq!(model.effect(&facing(0.0), [None; 2], &far, SimTime::ZERO), WallEffect::NONE);
    }

    #[test]
    fn exact_rotors_beside_the_wall_lose_more_thrust() {
        let model = walls(0.04, 0.0);
        let plane = Planes(vec![north_wall(model.arm_m + model.radius_m)]);
        let factors = model.effect(&facing(0.0), [None; 2], &plane, SimTime::ZERO).factors;
        for (hub, factor) in model.hubs.iter().zip(factors) {
            let gap_radii = (model.arm_m - hub.forward()) / model.radius_m;
            let fade = (3.0 - gap_radii).clamp(0.0, 1.0);
            assert!((factor - (1.0 - 0.04 * fade * math::exp(-gap_radii))).abs() < TOLERANCE, "{hub:?}: {factor}");
        }
        assert!(factors[0] < factors[1], "front right beside the wall, rear left not: {factors:?}");
    }

    #[test]
    fn val_thrust_between_two_walls_and_the_ground_is_93_percent() {
        // Aeronautical Journal, 2025: 1.5 radii from two walls, 2.5 radii above the ground. Beside one wall, the change is "minimal".
        let model = walls(0.0, 0.07);
        let wall_m = model.arm_m + 1.5 * model.radius_m;
        let below = [None, Some(2.5 * model.radius_m)];
        let mean = |planes: Vec<_>, vertical_m| {
            let planes = Planes(planes);
            let factor = |ms| model.effect(&facing(0.0), vertical_m, &planes, SimTime::from_ms(ms)).factors[0];
            (0..10_000).map(factor).sum::<f64>() / 10_000.0
        };
        let (north, east) = (north_wall(wall_m), (Vec3::new(-1.0, 0.0, 0.0), wall_m));
        // Tolerance: 10 s are not a whole number of periods of the fluctuation.
        assert!((mean(vec![north, east], below) - 0.93).abs() < 2e-3);
        assert_eq!(mean(vec![north], below), 1.0);
        assert_eq!(mean(vec![north, east], [None; 2]), 1.0);
        // A bay below a deck: two walls and a ceiling.
        assert!(mean(vec![north, east], [Some(2.5 * model.radius_m), None]) < 0.94);
    }
}

//! Ground and ceiling effects on each rotor, as a thrust factor at a given rotor speed.

use super::airframe::AirframeModel;
use super::multirotor_surfaces;
use super::obstacles::Obstacles;
use super::state::{MAX_ROTORS, RigidState};
use spandrel_model::frames::{Enu, Frd, Vec3};
use spandrel_model::math;
use spandrel_model::site::drones::FIRST_DRONE_OBJECT;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::SurfaceEffects;

/// Range of the effects on a single rotor in rotor radii. Farther surfaces change thrust by less than 0.3% (Cheeseman-Bennett at 5 R: 1.0025).
const RANGE_ROTOR_RADII: f64 = 5.0;

/// Returns the range of surface effects, in meters.
#[must_use]
pub fn reach_m(model: &AirframeModel) -> f64 {
    let radii = match model.surface_effects {
        SurfaceEffects::SingleRotor => RANGE_ROTOR_RADII,
        SurfaceEffects::Multirotor => multirotor_surfaces::RANGE_ROTOR_RADII,
    };
    radii * model.rotor.radius_m
}

/// Returns the thrust in ground effect divided by the thrust out of ground effect at equal power, after Cheeseman and
/// Bennett. Valid for z > R/2; constant below.
#[must_use]
pub fn ground_factor(height_over_radius: f64) -> f64 {
    let z = height_over_radius.max(0.5);
    let r = 1.0 / (4.0 * z);
    1.0 / (1.0 - r * r)
}

/// Returns the induced velocity without a ceiling divided by the one with a ceiling (gamma in Hsiao and
/// Chirarattananon). Constant below R/4, as in the public Crazyflie firmware.
#[must_use]
pub fn ceiling_gamma(distance_over_radius: f64) -> f64 {
    let d = distance_over_radius.max(0.25);
    0.5 + 0.5 * (1.0 + 1.0 / (8.0 * d * d)).sqrt()
}

/// Returns the thrust below a ceiling divided by the thrust in open air at constant power: gamma^(2/3).
#[must_use]
pub fn ceiling_factor(distance_over_radius: f64) -> f64 {
    let g = math::cbrt(ceiling_gamma(distance_over_radius));
    g * g
}

/// Distances from the hubs to the surfaces below and above them along the rotor axes, m; `None` if there is none within reach.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceDistances {
    below_m: [Option<f64>; MAX_ROTORS],
    above_m: [Option<f64>; MAX_ROTORS],
}

impl SurfaceDistances {
    /// Returns the smallest distances above and below, m.
    pub fn nearest_m(&self) -> [Option<f64>; 2] {
        [&self.above_m, &self.below_m].map(|distances| distances.iter().flatten().copied().reduce(f64::min))
    }
}

/// Casts rays up and down from each hub.
pub fn distances(model: &AirframeModel, rigid: &RigidState, obstacles: &impl Obstacles, at: SimTime) -> SurfaceDistances {
    let mut out = SurfaceDistances { below_m: [None; MAX_ROTORS], above_m: [None; MAX_ROTORS] };
    let down = (rigid.attitude * Vec3::<Frd>::new(0.0, 0.0, 1.0)).enu();
    for (i, rotor) in model.rotors.iter().enumerate() {
        let hub = (rigid.position_m + rigid.attitude * rotor.position_m).enu();
        out.below_m[i] = surface_m(obstacles, hub, down, model, at);
        out.above_m[i] = surface_m(obstacles, hub, -down, model, at);
    }
    out
}

/// Returns the distance of the surface that a ray meets. Thin parts of another drone are no surface for a rotor's air.
fn surface_m(obstacles: &impl Obstacles, hub: Vec3<Enu>, along: Vec3<Enu>, model: &AirframeModel, at: SimTime) -> Option<f64> {
    let hit = obstacles.ray(hub, along, reach_m(model), at)?;
    (hit.object.0 < FIRST_DRONE_OBJECT).then_some(hit.distance_m)
}

/// Returns each rotor's thrust factor, based on the surfaces below and above its hub along the rotor axis.
#[must_use]
pub fn factors(model: &AirframeModel, found: &SurfaceDistances) -> [f64; MAX_ROTORS] {
    let radius = model.rotor.radius_m;
    match model.surface_effects {
        SurfaceEffects::SingleRotor => combine(
            found.below_m.map(|below_m| below_m.map_or(1.0, |m| ground_factor(m / radius))),
            found.above_m.map(|above_m| above_m.map_or(1.0, |m| ceiling_factor(m / radius))),
        ),
        SurfaceEffects::Multirotor => combine(
            model.layout.ground_factors(&found.below_m),
            found.above_m.map(|above_m| above_m.map_or(1.0, |m| model.layout.ceiling_factor(m))),
        ),
    }
}

/// Returns the products of the factors of ground and ceiling.
fn combine(mut ground: [f64; MAX_ROTORS], ceiling: [f64; MAX_ROTORS]) -> [f64; MAX_ROTORS] {
    ground.iter_mut().zip(ceiling).for_each(|(factor, other)| *factor *= other);
    ground
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::RotorConditions;
    use spandrel_model::frames::Enu;
    use spandrel_model::site::{ObjectId, RayHit, Surface};

    /// Tolerance for published values with three decimals.
    const PUBLISHED_TOLERANCE: f64 = 6e-4;

    #[test]
    fn val_ground_effect_matches_published_values() {
        for (z, expected) in [(0.5, 1.333), (1.0, 1.067), (2.0, 1.016)] {
            assert!((ground_factor(z) - expected).abs() < PUBLISHED_TOLERANCE, "{z}");
        }
        assert_eq!(ground_factor(0.1), ground_factor(0.5));
    }

    #[test]
    fn val_ceiling_gamma_matches_published_values() {
        for (d, expected) in [(0.25, 1.366), (0.5, 1.112)] {
            assert!((ceiling_gamma(d) - expected).abs() < PUBLISHED_TOLERANCE, "{d}");
        }
        assert_eq!(ceiling_gamma(0.1), ceiling_gamma(0.25));
        // docs/src/reference/domain.md, "Surface effects": thrust at constant power, two decimals.
        for (d, expected) in [(0.25, 1.23), (0.5, 1.07), (1.0, 1.02)] {
            assert!((ceiling_factor(d) - expected).abs() < 5e-3, "{d}: {}", ceiling_factor(d));
        }
    }

    /// A floor and a ceiling at the given heights, m up. Each covers one half of the plane, split at north = 0.
    struct FloorAndCeiling(f64, f64);

    impl Obstacles for FloorAndCeiling {
        fn contacts(&self, _: &spandrel_model::site::HullProbe, _: f64, _: SimTime, _: &mut Vec<spandrel_model::site::Contact>) {}
        fn clearance(&self, _: Vec3<Enu>, _: f64, _: SimTime) -> Option<f64> {
            Some(0.0)
        }
        fn ray(&self, from: Vec3<Enu>, along: Vec3<Enu>, max_m: f64, _: SimTime) -> Option<RayHit> {
            let height = if along.up() < 0.0 { self.0 } else { self.1 };
            let distance_m = (height - from.up()) / along.up();
            let hit = distance_m >= 0.0 && distance_m <= max_m && (from + along * distance_m).north() > 0.0;
            let normal = Vec3::new(0.0, 0.0, -along.up().signum());
            hit.then_some(RayHit { distance_m, normal, surface: Surface::Bridge, object: ObjectId(0) })
        }
    }

    #[test]
    fn exact_each_rotor_uses_surfaces_above_and_below_it() {
        let text = include_str!("../../../../vehicle-params/phantom2.toml");
        let mut vehicle = spandrel_model::vehicle::read("phantom2.toml", text).expect("shipped");
        vehicle.aerodynamics.surface_effects = SurfaceEffects::SingleRotor;
        let model = AirframeModel::new(&vehicle, spandrel_model::scenario::BatteryModel::Paper);
        let radius = vehicle.rotor.radius_m;
        // The hubs are 3 cm above the center. The ceiling is one radius away, and the floor two radii.
        let slabs = FloorAndCeiling(0.03 - 2.0 * radius, 0.03 + radius);
        let state = crate::physics::PhysicsState::at_rest(Vec3::zero(), 0.0);
        let got = factors(&model, &distances(&model, &state.rigid, &slabs, SimTime::ZERO));
        let beside = ground_factor(2.0) * ceiling_factor(1.0);
        for (i, rotor) in vehicle.rotors.iter().enumerate() {
            let expected = if rotor.position_m.forward() > 0.0 { beside } else { 1.0 };
            // Rounding tolerance.
            assert!((got[i] - expected).abs() < 1e-12, "rotor {i}: {}, not {expected}", got[i]);
        }
    }

    #[test]
    fn exact_multirotor_model_is_selected_by_the_vehicle_file() {
        let text = include_str!("../../../../vehicle-params/phantom2.toml");
        let mut vehicle = spandrel_model::vehicle::read("phantom2.toml", text).expect("shipped");
        let radius = vehicle.rotor.radius_m;
        let slabs = FloorAndCeiling(0.03 - 2.0 * radius, 0.03 + radius);
        let state = crate::physics::PhysicsState::at_rest(Vec3::zero(), 0.0);
        let mut got = |kind| {
            vehicle.aerodynamics.surface_effects = kind;
            let model = AirframeModel::new(&vehicle, spandrel_model::scenario::BatteryModel::Paper);
            (reach_m(&model) / radius, factors(&model, &distances(&model, &state.rigid, &slabs, SimTime::ZERO))[0])
        };
        let ((near, single), (far, multi)) = (got(SurfaceEffects::SingleRotor), got(SurfaceEffects::Multirotor));
        assert!((near - 5.0).abs() < 1e-12 && (far - 10.0).abs() < 1e-12, "{near} {far}");
        // Two of four rotors over the floor: the effect of the ground is between the one of a single rotor and the one of four.
        assert!((1.016 * 1.02 - single).abs() < 1e-3 && multi > 1.02 * 1.09 && multi < 1.12 * 1.09, "{multi}, {single} alone");
    }

    #[test]
    fn exact_thrust_factor_scales_only_thrust() {
        let text = include_str!("../../../../vehicle-params/phantom2.toml");
        let vehicle = spandrel_model::vehicle::read("phantom2.toml", text).expect("shipped");
        let model = AirframeModel::new(&vehicle, spandrel_model::scenario::BatteryModel::Paper);
        let wrench = |effect| model.rotor_wrench(0, &RotorConditions { effect, ..RotorConditions::at_rest(500.0) });
        let (open, near) = (wrench(1.0), wrench(1.25));
        assert!((near.force_n - open.force_n * 1.25).norm() < 1e-12);
        assert!((near.torque_n_m.down() - open.torque_n_m.down()).abs() < 1e-12);
    }
}

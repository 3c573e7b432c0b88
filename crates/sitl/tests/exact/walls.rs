//! Walls beside the aircraft: the force in a simulation step.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math::{self, GRAVITY_M_S2};
use spandrel_model::scenario::BatteryModel;
use spandrel_model::site::{Contact, HullProbe, ObjectId, RayHit, Surface};
use spandrel_model::time::SimTime;
use spandrel_sitl::physics::{Actuators, AirState, AirframeModel, MAX_ROTORS, Obstacles, PhysicsState, PowerLoad};
use spandrel_testkit::aircraft::quad;

/// A wall in the north, at a distance from the origin, m.
struct NorthWall(f64);

impl Obstacles for NorthWall {
    fn contacts(&self, _: &HullProbe, _: f64, _: SimTime, _: &mut Vec<Contact>) {}
    fn clearance(&self, position_m: Vec3<Enu>, max_m: f64, _: SimTime) -> Option<f64> {
        Some((self.0 - position_m.north()).min(max_m))
    }
    fn ray(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, _: SimTime) -> Option<RayHit> {
        let distance_m = (self.0 - origin_m.north()) / direction.north();
        let hit = direction.north() > 1e-9 && distance_m <= max_m;
        let normal = Vec3::new(0.0, -1.0, 0.0);
        hit.then_some(RayHit { distance_m, normal, surface: Surface::Bridge, object: ObjectId(1) })
    }
}

#[test]
fn exact_wall_pulls_a_hovering_aircraft_with_a_fraction_of_its_thrust() {
    const SUCTION: f64 = 0.2;
    // Tolerance of the acceleration, m/s²: the rotors beside the wall tilt the aircraft a little during the step of 1 ms.
    const TOLERANCE_M_S2: f64 = 0.01;
    let mut vehicle = quad();
    vehicle.aerodynamics.wall_suction = SUCTION;
    let model = AirframeModel::new(&vehicle, BatteryModel::Paper);
    let arm_m =
        vehicle.rotors.iter().map(|rotor| math::hypot(rotor.position_m.forward(), rotor.position_m.right())).fold(0.0, f64::max);
    for (gap_radii, share) in [(0.0, 1.0), (1.0, math::exp(-1.0)), (3.5, 0.0)] {
        let mut state = PhysicsState::at_rest(Vec3::new(0.0, 0.0, -10.0), 0.4);
        state.rigid.rotor_rad_s[..4].fill(model.hover_rotor_rad_s());
        let wall = NorthWall(arm_m + (1.0 + gap_radii) * vehicle.rotor.radius_m);
        let actuators = Actuators { motors: [model.hover_command(); MAX_ROTORS], armed: true };
        let dt = SimTime::from_ms(1);
        model.advance(&mut state, &actuators, &AirState::STILL, &wall, PowerLoad::default(), SimTime::ZERO, dt);
        let north_m_s2 = state.rigid.velocity_m_s.north() / dt.s();
        let expected = SUCTION * share * GRAVITY_M_S2;
        assert!((north_m_s2 - expected).abs() < TOLERANCE_M_S2, "{gap_radii} radii: {north_m_s2} m/s² instead of {expected}");
    }
}

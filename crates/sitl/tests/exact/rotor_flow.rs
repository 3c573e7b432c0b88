//! Rotors that move through the air: inflow, translational lift, air density and the vortex ring state.

use spandrel_model::frames::{Frd, Ned, Vec3};
use spandrel_model::math::{self, GRAVITY_M_S2, PI};
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::BatteryModel;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{AirDensity, SEA_LEVEL_AIR_DENSITY_KG_M3, Vehicle, standard_density_kg_m3};
use spandrel_sitl::physics::rigid::Wrench;
use spandrel_sitl::physics::vortex_ring::VortexRing;
use spandrel_sitl::physics::{Actuators, AirState, AirframeModel, MAX_ROTORS, OpenSky, PhysicsState, PowerLoad, RotorConditions};
use spandrel_testkit::aircraft::quad;

const DT: SimTime = SimTime::from_ms(1);
/// Coefficients of RotorPy's Hummingbird (hummingbird_params.py), N s²/m and N s²/m².
const INFLOW: f64 = 2.32e-4;
const LIFT: f64 = 3.39e-3;

fn with_flow() -> Vehicle {
    let mut vehicle = quad();
    (vehicle.aerodynamics.inflow_coefficient_n_s2_m, vehicle.aerodynamics.translational_lift_n_s2_m2) = (INFLOW, LIFT);
    vehicle
}

fn model(vehicle: &Vehicle) -> AirframeModel {
    AirframeModel::new(vehicle, BatteryModel::Paper)
}

/// Returns the motor command for a rotor speed.
fn command(vehicle: &Vehicle, speed_rad_s: f64) -> f64 {
    let rotor = &vehicle.rotor;
    (speed_rad_s - rotor.idle_speed_rad_s) / (rotor.max_speed_rad_s - rotor.idle_speed_rad_s)
}

fn flying(speed_rad_s: f64) -> PhysicsState {
    let mut state = PhysicsState::at_rest(Vec3::new(0.0, 0.0, -1000.0), 0.0);
    state.rigid.rotor_rad_s[..4].fill(speed_rad_s);
    state
}

fn run(model: &AirframeModel, state: &mut PhysicsState, motors: [f64; MAX_ROTORS], air: &AirState, from: SimTime, seconds: f64) {
    let actuators = Actuators { motors, armed: true };
    for k in 0..(seconds / DT.s()).round() as i64 {
        let now = from + SimTime::from_ns(DT.ns() * k);
        model.advance(state, &actuators, air, &OpenSky, PowerLoad::default(), now, DT);
    }
}

fn bits(state: &PhysicsState) -> Vec<u64> {
    let r = &state.rigid;
    let values = r.position_m.array().into_iter().chain(r.velocity_m_s.array()).chain(r.attitude.wxyz());
    values.chain(r.rates_rad_s.array()).chain(r.rotor_rad_s).map(f64::to_bits).collect()
}

fn moving(hub_air_m_s: Vec3<Frd>, speed_rad_s: f64) -> RotorConditions {
    RotorConditions { hub_air_m_s, ..RotorConditions::at_rest(speed_rad_s) }
}

#[test]
fn exact_thrust_of_a_moving_rotor_is_the_sum_of_its_terms() {
    // Rounding tolerance, N.
    const TOLERANCE: f64 = 1e-14;
    let model = model(&with_flow());
    // Climbs at 3 m/s and moves forward at 2 m/s and to the left at 1 m/s.
    let wrench = model.rotor_wrench(0, &moving(Vec3::new(2.0, -1.0, -3.0), 500.0));
    let thrust = 1.0e-5 * 500.0 * 500.0 - INFLOW * 500.0 * 3.0 + LIFT * (2.0 * 2.0 + 1.0);
    let drag = 4e-5 * 500.0;
    assert!((wrench.force_n - Vec3::new(-2.0 * drag, drag, -thrust)).norm() < TOLERANCE, "{wrench:?}");
}

#[test]
fn exact_change_of_thrust_is_limited() {
    const TOLERANCE: f64 = 1e-14;
    let model = model(&with_flow());
    let thrust = |velocity| -model.rotor_wrench(0, &moving(velocity, 500.0)).force_n.down();
    let still = 1.0e-5 * 500.0 * 500.0;
    assert!(thrust(Vec3::new(0.0, 0.0, -1e3)).abs() < TOLERANCE);
    assert!((thrust(Vec3::new(0.0, 0.0, 1e3)) - 2.0 * still).abs() < TOLERANCE);
    assert!((thrust(Vec3::new(1e3, 0.0, 0.0)) - 1.25 * still).abs() < TOLERANCE);
}

#[test]
fn exact_rotor_at_rest_in_the_air_has_its_static_wrench() {
    let (plain, flow) = (model(&quad()), model(&with_flow()));
    for index in 0..4 {
        let at = RotorConditions { acceleration_rad_s2: 70.0, ..RotorConditions::at_rest(565.0) };
        assert_eq!(plain.rotor_wrench(index, &at), flow.rotor_wrench(index, &at));
    }
}

/// Closed-form wrench of a rotor in the model without the keys, in the order in which it was always computed.
fn static_wrench(vehicle: &Vehicle, index: usize, at: &RotorConditions) -> Wrench {
    let (rotor, m) = (&vehicle.rotors[index], &vehicle.rotor);
    let squared = at.speed_rad_s * at.speed_rad_s;
    let h = -m.drag_coefficient_n_s2_m * at.speed_rad_s;
    let air = at.hub_air_m_s;
    let force_n = Vec3::new(h * air.forward(), h * air.right(), -m.thrust_coefficient_n_s2 * squared * at.effect);
    let yaw = rotor.spin * (m.torque_coefficient_n_m_s2 * squared + m.inertia_kg_m2 * at.acceleration_rad_s2);
    Wrench { force_n, torque_n_m: rotor.position_m.cross(force_n) + Vec3::new(0.0, 0.0, yaw) }
}

#[test]
fn exact_wrench_without_the_keys_has_the_same_bits_as_the_static_model() {
    let mut vehicle = quad();
    // Six rotors: one group of four, and one that is not full.
    vehicle.rotors.extend_from_within(..2);
    for (rotor, side) in vehicle.rotors[4..].iter_mut().zip([1.5, -1.5]) {
        rotor.position_m = rotor.position_m * side;
    }
    let count = vehicle.rotors.len();
    let model = model(&vehicle);
    let mut random = RandomStream::new(1, "rotor flow");
    for k in 0..10_000 {
        let at = RotorConditions {
            hub_air_m_s: Vec3::new(10.0 * random.normal(), 10.0 * random.normal(), 10.0 * random.normal()),
            speed_rad_s: 500.0 + 100.0 * random.normal(),
            acceleration_rad_s2: 1e3 * random.normal(),
            effect: 1.0 + random.uniform(),
            density_ratio: 1.0,
        };
        let (got, expected) = (model.rotor_wrench(k % count, &at), static_wrench(&vehicle, k % count, &at));
        let bits = |w: &Wrench| [w.force_n.array(), w.torque_n_m.array()].map(|v| v.map(f64::to_bits));
        assert_eq!(bits(&got), bits(&expected), "{at:?}");
    }
}

#[test]
fn exact_density_scales_all_forces_of_the_rotor_but_not_its_inertia() {
    const TOLERANCE: f64 = 1e-14;
    let vehicle = with_flow();
    let model = model(&vehicle);
    let at = |density_ratio| RotorConditions { density_ratio, ..moving(Vec3::new(2.0, -1.0, -3.0), 500.0) };
    let (sea, high) = (model.rotor_wrench(1, &at(1.0)), model.rotor_wrench(1, &at(0.8)));
    assert!((sea.force_n * 0.8 - high.force_n).norm() < TOLERANCE);
    assert!((sea.torque_n_m * 0.8 - high.torque_n_m).norm() < TOLERANCE);
    let spinning_up = RotorConditions { acceleration_rad_s2: 100.0, ..at(0.8) };
    let reaction = model.rotor_wrench(1, &spinning_up).torque_n_m.down() - high.torque_n_m.down();
    assert!((reaction - vehicle.rotor.inertia_kg_m2 * 100.0).abs() < TOLERANCE);
}

#[test]
fn exact_vehicle_file_selects_the_density() {
    let mut vehicle = with_flow();
    assert_eq!(model(&vehicle).air_density_kg_m3(2000.0), SEA_LEVEL_AIR_DENSITY_KG_M3);
    assert_eq!(vehicle.at_altitude(2000.0), vehicle);
    vehicle.aerodynamics.air_density = AirDensity::Altitude;
    let density = standard_density_kg_m3(2000.0);
    assert_eq!(model(&vehicle).air_density_kg_m3(2000.0), density);
    let ratio = density / SEA_LEVEL_AIR_DENSITY_KG_M3;
    let (high, sea) = (vehicle.at_altitude(2000.0), &vehicle);
    assert_eq!(high.rotor.thrust_coefficient_n_s2, sea.rotor.thrust_coefficient_n_s2 * ratio);
    // In thinner air, the rotors turn faster in hover and damp vertical motion less.
    assert!((high.heave_damping_1_s() / sea.heave_damping_1_s() / ratio.sqrt() - 1.0).abs() < 1e-12);
}

/// Padfield's heave damping of a rotor in hover, divided by the mass, 1/s: Z_w = 2 a A_b rho Omega R lambda / ((16 lambda + a s) m)
/// (*Helicopter Flight Dynamics*, 2nd edition, section 4.3; A_b is the blade area and s the solidity), for all rotors.
fn padfield_1_s(vehicle: &Vehicle, blades: f64, chord_m: f64, lift_slope: f64) -> f64 {
    let (rotors, radius) = (vehicle.rotors.len() as f64, vehicle.rotor.radius_m);
    let disk = PI * radius * radius;
    let solidity = blades * chord_m / (PI * radius);
    let thrust = vehicle.mass_kg * GRAVITY_M_S2 / rotors;
    let tip_speed = (thrust / vehicle.rotor.thrust_coefficient_n_s2).sqrt() * radius;
    let inflow = (thrust / (2.0 * SEA_LEVEL_AIR_DENSITY_KG_M3 * disk)).sqrt() / tip_speed;
    let slope = 2.0 * lift_slope * solidity * disk * SEA_LEVEL_AIR_DENSITY_KG_M3 * tip_speed * inflow;
    rotors * slope / ((16.0 * inflow + lift_slope * solidity) * vehicle.mass_kg)
}

/// Returns the heave damping that follows from the steady climb and descent with 10% more and 10% less thrust, 1/s.
fn flown_1_s(vehicle: &Vehicle) -> f64 {
    let model = model(vehicle);
    let steady = |share: f64| {
        let speed = model.hover_rotor_rad_s() * f64::sqrt(share);
        let mut state = flying(speed);
        run(&model, &mut state, [command(vehicle, speed); MAX_ROTORS], &AirState::STILL, SimTime::ZERO, 20.0);
        state.rigid.velocity_m_s.down()
    };
    0.2 * GRAVITY_M_S2 / (steady(0.9) - steady(1.1))
}

#[test]
fn val_steady_climb_has_the_heave_damping_of_blade_element_theory() {
    // Relative tolerance.
    const TOLERANCE: f64 = 0.05;
    let mut vehicle = quad();
    vehicle.drag.area_m2 = [0.0; 3];
    // Two blades with a mean chord of 20 mm and a lift slope of 5.7 per rad.
    vehicle.aerodynamics.inflow_coefficient_n_s2_m = 3.4e-4;
    let (theory, flown) = (padfield_1_s(&vehicle, 2.0, 0.02, 5.7), flown_1_s(&vehicle));
    assert!((flown / theory - 1.0).abs() < TOLERANCE, "{flown} 1/s, theory {theory} 1/s");
    assert!((vehicle.heave_damping_1_s() / theory - 1.0).abs() < TOLERANCE);
}

/// Commands for the comparison with RotorPy: duration, s, and rotor speeds, rad/s.
const SCHEDULE: [(f64, [f64; 4]); 9] = [
    (2.0, [575.0, 575.0, 575.0, 575.0]),
    (0.3, [545.0, 575.0, 545.0, 575.0]),
    (0.3, [575.0, 545.0, 575.0, 545.0]),
    (3.4, [570.0, 570.0, 570.0, 570.0]),
    (0.3, [576.0, 560.0, 560.0, 576.0]),
    (0.3, [560.0, 576.0, 576.0, 560.0]),
    (3.4, [572.0, 572.0, 569.0, 569.0]),
    (5.0, [578.0, 578.0, 579.0, 579.0]),
    (5.0, [562.0, 562.0, 562.0, 562.0]),
];

/// Position (NED, m) and velocity (m/s) of RotorPy 3.0.0 from PyPI after 2.6, 10 and 20 s. `Multirotor` with
/// `control_abstraction="cmd_motor_speeds"`, DOP853 at a tolerance of 1e-12, steps of 50 ms, a gravity of 9.80665 m/s², the
/// parameters of [`comparison_vehicle`] (k_eta, k_m, k_d, k_z, k_h, c_D = rho CdA / 2, tau_m) and a constant wind of (3, -2, 0.5) m/s.
const ROTORPY: [(usize, [f64; 3], [f64; 3]); 3] = [
    (
        3,
        [1.367_022_395_840_024, -0.719_905_758_878_128_6, -0.409_823_472_835_503_9],
        [2.433_144_557_579_336, -0.511_276_319_750_169_8, 0.238_590_385_942_075_46],
    ),
    (
        7,
        [46.736_544_962_104_745, -18.215_020_818_807_176, 2.871_857_387_979_413],
        [4.755_885_040_497_525_5, -4.534_790_984_152_517, 0.018_273_245_418_877_735],
    ),
    (
        9,
        [81.300_353_244_651_29, -36.582_896_464_462_67, 1.871_691_712_149_806],
        [2.830_779_146_653_586_8, 0.597_838_420_623_352_8, 0.597_937_241_638_404_1],
    ),
];

/// RotorPy has neither rotor inertia nor angular damping. With hubs in the plane of the center of mass, drag does not tilt the
/// aircraft, so that the flight stays near hover.
fn comparison_vehicle() -> Vehicle {
    let mut vehicle = with_flow();
    vehicle.rotor.inertia_kg_m2 = 0.0;
    vehicle.drag.angular_damping_n_m_s = [0.0; 3];
    for rotor in &mut vehicle.rotors {
        rotor.position_m = Vec3::new(rotor.position_m.forward(), rotor.position_m.right(), 0.0);
    }
    vehicle
}

#[test]
fn val_flight_with_inflow_and_translational_lift_matches_rotorpy() {
    // Tolerances after 20 s, m and m/s; the flight covers 89 m and tilts by 35 degrees.
    const POSITION_TOLERANCE_M: f64 = 1e-4;
    const VELOCITY_TOLERANCE_M_S: f64 = 1e-5;
    let vehicle = comparison_vehicle();
    let (model, mut state) = (model(&vehicle), flying(565.0));
    state.rigid.position_m = Vec3::zero();
    let air = AirState { velocity_m_s: Vec3::new(3.0, -2.0, 0.5), ..AirState::STILL };
    let mut now = SimTime::ZERO;
    for (k, (seconds, speeds)) in SCHEDULE.into_iter().enumerate() {
        let mut motors = [0.0; MAX_ROTORS];
        motors.iter_mut().zip(speeds).for_each(|(motor, speed)| *motor = command(&vehicle, speed));
        run(&model, &mut state, motors, &air, now, seconds);
        now += SimTime::from_s(seconds);
        for (_, position, velocity) in ROTORPY.iter().filter(|(after, ..)| *after == k + 1) {
            let (p, v) = (state.rigid.position_m, state.rigid.velocity_m_s);
            let expected = Vec3::<Ned>::new(position[0], position[1], position[2]);
            assert!((p - expected).norm() < POSITION_TOLERANCE_M, "{now}: {p:?} instead of {expected:?}");
            let expected = Vec3::<Ned>::new(velocity[0], velocity[1], velocity[2]);
            assert!((v - expected).norm() < VELOCITY_TOLERANCE_M_S, "{now}: {v:?} instead of {expected:?}");
        }
    }
    assert!((now.s() - 20.0).abs() < 1e-9);
}

#[test]
fn exact_updraft_at_the_induced_velocity_costs_thrust() {
    // Tolerance for the change of the thrust during one step of 1 ms, m/s².
    const TOLERANCE_M_S2: f64 = 0.01;
    let mut vehicle = quad();
    vehicle.drag.area_m2 = [0.0; 3];
    vehicle.aerodynamics.vortex_ring_loss = 0.2;
    let (model, ring) = (model(&vehicle), VortexRing::of(&vehicle).unwrap());
    let mut state = flying(model.hover_rotor_rad_s());
    let updraft = Vec3::new(0.0, 0.0, -ring.induced_velocity_m_s(SEA_LEVEL_AIR_DENSITY_KG_M3));
    let air = AirState { velocity_m_s: updraft, ..AirState::STILL };
    run(&model, &mut state, [model.hover_command(); MAX_ROTORS], &air, SimTime::ZERO, DT.s());
    // The four rotors' fluctuations at time zero.
    let phases = (0..4).map(|k| math::sin(2.0 * PI * 0.618_034 * f64::from(k)));
    let share = phases.map(|sine| 1.0 - 0.2 * (1.0 + 0.5 * sine)).sum::<f64>() / 4.0;
    let expected = GRAVITY_M_S2 * (1.0 - share);
    assert!((state.rigid.velocity_m_s.down() / DT.s() - expected).abs() < TOLERANCE_M_S2, "{}", state.rigid.velocity_m_s.down());
}

/// Returns the aircraft with every effect on.
fn with_everything() -> Vehicle {
    let mut vehicle = with_flow();
    vehicle.aerodynamics.vortex_ring_loss = 0.5;
    vehicle.aerodynamics.air_density = AirDensity::Altitude;
    vehicle
}

#[test]
fn prop_thrust_is_finite_and_bounded_at_any_velocity() {
    let model = model(&with_everything());
    let mut random = RandomStream::new(2, "rotor flow");
    for _ in 0..100_000 {
        let reach = math::pow(10.0, 7.0 * random.uniform());
        let hub = Vec3::new(reach * random.normal(), reach * random.normal(), reach * random.normal());
        let (speed_rad_s, effect) = (1000.0 * random.uniform(), 2.0 * random.uniform());
        let wrench = model.rotor_wrench(0, &RotorConditions { effect, ..moving(hub, speed_rad_s) });
        let still = 1e-5 * speed_rad_s * speed_rad_s * effect;
        let thrust = -wrench.force_n.down();
        assert!(thrust >= 0.0 && thrust <= 2.25 * still * (1.0 + 1e-12), "{hub:?}: {thrust} N, {still} N in still air");
        assert!(wrench.force_n.norm().is_finite() && wrench.torque_n_m.norm().is_finite());
    }
}

#[test]
fn prop_descent_with_every_effect_is_finite_and_repeatable() {
    let vehicle = with_everything();
    let model = model(&vehicle);
    for descent_m_s in [0.0, 3.0, 5.0, 8.0, 30.0] {
        let fly = || {
            let mut state = flying(500.0);
            state.rigid.velocity_m_s = Vec3::new(1.0, 0.0, descent_m_s);
            run(&model, &mut state, [command(&vehicle, 520.0); MAX_ROTORS], &AirState::STILL, SimTime::from_ms(777), 5.0);
            state
        };
        let state = fly();
        assert!(
            state.rigid.velocity_m_s.norm() < 60.0 && state.rigid.rates_rad_s.norm() < 100.0,
            "{descent_m_s}: {:?}",
            state.rigid
        );
        assert_eq!(bits(&state), bits(&fly()));
    }
}

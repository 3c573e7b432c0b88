//! Free flight compared with closed-form solutions.

use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::math::{self, GRAVITY_M_S2};
use spandrel_model::scenario::BatteryModel;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{AirDensity, SEA_LEVEL_AIR_DENSITY_KG_M3, Vehicle};
use spandrel_sitl::physics::{Actuators, AirState, AirframeModel, MAX_ROTORS, OpenSky, PhysicsState, PowerLoad, RotorConditions};
use spandrel_testkit::aircraft::quad;

const DT: SimTime = SimTime::from_ms(1);

/// Returns the aircraft as a body without rotors, drag or damping.
fn bare() -> Vehicle {
    let mut vehicle = quad();
    vehicle.rotors.clear();
    vehicle.drag.area_m2 = [0.0; 3];
    vehicle.drag.angular_damping_n_m_s = [0.0; 3];
    vehicle
}

fn start() -> PhysicsState {
    PhysicsState::at_rest(Vec3::new(0.0, 0.0, -1000.0), 0.0)
}

fn run(model: &AirframeModel, state: &mut PhysicsState, actuators: &Actuators, air: &AirState, dt: SimTime, steps: i64) {
    for k in 0..steps {
        let now = SimTime::from_ns(dt.ns() * k);
        model.advance(state, actuators, air, &OpenSky, PowerLoad::default(), now, dt);
    }
}

fn coasting() -> Actuators {
    Actuators::default()
}

#[test]
fn exact_free_fall_is_half_g_t_squared() {
    // Relative tolerance: rounding of 2,000 additions.
    const TOLERANCE: f64 = 1e-12;
    let mut state = PhysicsState::at_rest(Vec3::zero(), 0.0);
    run(&AirframeModel::new(&bare(), BatteryModel::Paper), &mut state, &coasting(), &AirState::STILL, DT, 2000);
    let fallen = state.rigid.position_m.down();
    let expected = 0.5 * GRAVITY_M_S2 * 4.0;
    assert!((fallen / expected - 1.0).abs() < TOLERANCE, "{fallen}");
    assert!((state.rigid.velocity_m_s.down() / (2.0 * GRAVITY_M_S2) - 1.0).abs() < TOLERANCE);
    assert!(state.specific_force_m_s2.norm() < 1e-9, "the specific force in free fall must be zero");
}

#[test]
fn exact_terminal_speed_follows_from_drag() {
    // Relative speed tolerance.
    const TOLERANCE: f64 = 1e-6;
    let mut vehicle = bare();
    vehicle.drag.area_m2 = [0.05; 3];
    let mut state = start();
    run(&AirframeModel::new(&vehicle, BatteryModel::Paper), &mut state, &coasting(), &AirState::STILL, DT, 60_000);
    let expected = (2.0 * vehicle.mass_kg * GRAVITY_M_S2 / (SEA_LEVEL_AIR_DENSITY_KG_M3 * 0.05)).sqrt();
    assert!((state.rigid.velocity_m_s.down() / expected - 1.0).abs() < TOLERANCE);
}

#[test]
fn exact_fall_with_drag_follows_the_hyperbolic_tangent() {
    // Tolerance for Runge-Kutta at 1 ms, m/s.
    const TOLERANCE: f64 = 1e-9;
    let mut vehicle = bare();
    vehicle.drag.area_m2 = [0.05; 3];
    let mut state = start();
    run(&AirframeModel::new(&vehicle, BatteryModel::Paper), &mut state, &coasting(), &AirState::STILL, DT, 1500);
    let top = (2.0 * vehicle.mass_kg * GRAVITY_M_S2 / (SEA_LEVEL_AIR_DENSITY_KG_M3 * 0.05)).sqrt();
    let expected = top * math::tanh(GRAVITY_M_S2 * 1.5 / top);
    assert!((state.rigid.velocity_m_s.down() - expected).abs() < TOLERANCE);
}

#[test]
fn exact_hover_thrust_balances_weight() {
    // Force tolerance as a fraction of the weight, and velocity tolerance after one second, m/s and rad/s.
    const TOLERANCE: f64 = 1e-12;
    let model = AirframeModel::new(&quad(), BatteryModel::Paper);
    let mut state = start();
    let lift: f64 =
        (0..4).map(|i| -model.rotor_wrench(i, &RotorConditions::at_rest(model.hover_rotor_rad_s())).force_n.down()).sum();
    assert!((lift / (1.3 * GRAVITY_M_S2) - 1.0).abs() < TOLERANCE, "{lift} N");
    let speed = (1.3 * GRAVITY_M_S2 / 4.0 / 1.0e-5).sqrt();
    state.rigid.rotor_rad_s = [speed; MAX_ROTORS];
    let actuators = Actuators { motors: [model.hover_command(); MAX_ROTORS], armed: true };
    run(&model, &mut state, &actuators, &AirState::STILL, DT, 1000);
    assert!(state.rigid.velocity_m_s.norm() < TOLERANCE, "{:?}", state.rigid.velocity_m_s);
    assert!(state.rigid.rates_rad_s.norm() < TOLERANCE);
}

#[test]
fn exact_motor_step_response_follows_the_time_constant() {
    // Relative tolerance; the exponential is exact.
    const TOLERANCE: f64 = 1e-12;
    let model = AirframeModel::new(&quad(), BatteryModel::Paper);
    let mut state = start();
    run(&model, &mut state, &Actuators { motors: [1.0; MAX_ROTORS], armed: true }, &AirState::STILL, DT, 30);
    let expected = 1000.0 * (1.0 - math::exp(-1.0));
    assert!((state.rigid.rotor_rad_s[0] / expected - 1.0).abs() < TOLERANCE);
}

#[test]
fn val_dropped_sphere_matches_nesc_case_01() {
    // NASA TM-2015-218675, check case 01, simulator 01: altitudes of a sphere without drag, dropped from 30,000 ft above the equator, at
    // 5, 10 and 30 s, ft. The case has a rotating, ellipsoidal Earth; here, the ground is flat and gravity uniform. So gravity is that
    // of the case at the start, less the centrifugal acceleration, and the fall grows by k t²/12 with their gradient and the Coriolis
    // acceleration of the eastward drift, k = 2 g/r - 3 w².
    const ALTITUDES_FT: [(i64, f64); 3] = [(5, 29_600.059_184_3), (10, 28_400.204_631_4), (30, 15_598.905_973_6)];
    const START_FT: f64 = 30_000.0;
    const GRAVITY_FT_S2: f64 = 32.106_536_406_3;
    const RADIUS_FT: f64 = 2.095_564_632_53e7;
    const EARTH_RATE_RAD_S: f64 = 7.292_115e-5;
    // Without this correction, as the share of the fall; and with it, ft.
    const TOLERANCES: (f64, f64) = (3e-4, 0.01);
    const M_PER_FT: f64 = 0.3048;
    let rate2 = EARTH_RATE_RAD_S * EARTH_RATE_RAD_S;
    let apparent_ft_s2 = GRAVITY_FT_S2 - rate2 * RADIUS_FT;
    let gradient_per_s2 = 2.0 * GRAVITY_FT_S2 / RADIUS_FT - 3.0 * rate2;
    let mut model = AirframeModel::new(&bare(), BatteryModel::Paper);
    model.gravity_scale = apparent_ft_s2 * M_PER_FT / GRAVITY_M_S2;
    for (seconds, altitude_ft) in ALTITUDES_FT {
        let mut state = PhysicsState::at_rest(Vec3::zero(), 0.0);
        run(&model, &mut state, &coasting(), &AirState::STILL, DT, 1000 * seconds);
        let (fallen_ft, published_ft) = (state.rigid.position_m.down() / M_PER_FT, START_FT - altitude_ft);
        assert!((fallen_ft / published_ft - 1.0).abs() < TOLERANCES.0, "{seconds} s: {fallen_ft} against {published_ft}");
        let corrected_ft = fallen_ft * (1.0 + gradient_per_s2 * (seconds * seconds) as f64 / 12.0);
        assert!((corrected_ft - published_ft).abs() < TOLERANCES.1, "{seconds} s: {corrected_ft} against {published_ft}");
    }
}

#[test]
fn val_sphere_with_constant_drag_matches_nesc_case_06() {
    // NASA TM-2015-218675, check case 06, simulator 01: altitude (m) and airspeed (m/s) of a sphere of one slug with a drag coefficient of
    // 0.1, dropped from 30,000 ft in the standard atmosphere, every 5 s.
    const PUBLISHED: [(f64, f64); 6] = [
        (9022.240, 48.6469),
        (8658.691, 96.5949),
        (8058.748, 143.0641),
        (7232.051, 187.1251),
        (6193.370, 227.6531),
        (4963.583, 263.3383),
    ];
    const START_M: f64 = 9144.0;
    const MASS_KG: f64 = 14.593_903;
    const DRAG_AREA_M2: f64 = 0.1 * 0.196_349_5 * 0.3048 * 0.3048;
    // Apparent gravity at the start, as in case 01. Its gradient and the height by which the atmosphere counts are those of the flat Earth
    // here: relative to the fall and to the speed, less than 0.04%.
    const GRAVITY_M_S2: f64 = 9.752_108;
    const TOLERANCE: f64 = 4e-4;
    let mut vehicle = Vehicle { mass_kg: MASS_KG, ..bare() };
    vehicle.drag.area_m2 = [DRAG_AREA_M2; 3];
    vehicle.aerodynamics.air_density = AirDensity::Altitude;
    let mut model = AirframeModel::new(&vehicle, BatteryModel::Paper);
    model.gravity_scale = GRAVITY_M_S2 / math::GRAVITY_M_S2;
    let mut state = PhysicsState::at_rest(Vec3::new(0.0, 0.0, -START_M), 0.0);
    for (altitude_m, speed_m_s) in PUBLISHED {
        for _ in 0..5000 {
            let density_kg_m3 = model.air_density_kg_m3(-state.rigid.position_m.down());
            run(&model, &mut state, &coasting(), &AirState { density_kg_m3, ..AirState::STILL }, DT, 1);
        }
        let (fallen_m, published_m) = (START_M + state.rigid.position_m.down(), START_M - altitude_m);
        assert!((fallen_m / published_m - 1.0).abs() < TOLERANCE, "{fallen_m} against {published_m}");
        let speed = state.rigid.velocity_m_s.down();
        assert!((speed / speed_m_s - 1.0).abs() < TOLERANCE, "{speed} against {speed_m_s}");
    }
}

/// Returns the brick of NESC check case 02 (NASA TM-2015-218675): inertia in slug ft², rates in deg/s.
fn brick() -> (AirframeModel, PhysicsState) {
    const KG_M2_PER_SLUG_FT2: f64 = 1.355_817_948_331_400_4;
    let mut vehicle = bare();
    vehicle.inertia_kg_m2 = [0.001_894_22, 0.006_211_019, 0.007_194_665].map(|i| i * KG_M2_PER_SLUG_FT2);
    let mut model = AirframeModel::new(&vehicle, BatteryModel::Paper);
    model.gravity_scale = 0.0;
    let mut state = start();
    state.rigid.rates_rad_s = Vec3::new(10f64.to_radians(), 20f64.to_radians(), 30f64.to_radians());
    (model, state)
}

#[test]
fn val_tumbling_brick_matches_nesc_case_02() {
    // Tolerance relative to the check case's simulator 04, deg/s.
    const TOLERANCE: f64 = 1e-8;
    let (model, mut state) = brick();
    let published = [
        [-2.418_902_222, -23.552_569_520, 28.128_592_630],
        [-5.422_734_680, 22.715_930_576, 28.608_281_747],
        [12.618_390_776, -17.397_474_762, 31.119_588_887],
    ];
    for expected in published {
        run(&model, &mut state, &coasting(), &AirState::STILL, DT, 10_000);
        let rates = state.rigid.rates_rad_s.array().map(f64::to_degrees);
        for (got, wanted) in rates.iter().zip(expected) {
            assert!((got - wanted).abs() < TOLERANCE, "{rates:?} against {expected:?}");
        }
    }
}

#[test]
fn exact_tumbling_conserves_energy_and_angular_momentum() {
    // Relative tolerance over 30 s.
    const TOLERANCE: f64 = 1e-12;
    const KG_M2_PER_SLUG_FT2: f64 = 1.355_817_948_331_400_4;
    let inertia = [0.001_894_22, 0.006_211_019, 0.007_194_665].map(|i| i * KG_M2_PER_SLUG_FT2);
    let (model, mut state) = brick();
    let measure = |s: &PhysicsState| {
        let w = s.rigid.rates_rad_s.array();
        let energy: f64 = (0..3).map(|k| 0.5 * inertia[k] * w[k] * w[k]).sum();
        let body = Vec3::<Frd>::new(inertia[0] * w[0], inertia[1] * w[1], inertia[2] * w[2]);
        (energy, s.rigid.attitude * body)
    };
    let (energy, momentum) = measure(&state);
    run(&model, &mut state, &coasting(), &AirState::STILL, DT, 30_000);
    let (energy_after, momentum_after) = measure(&state);
    assert!((energy_after / energy - 1.0).abs() < TOLERANCE, "{}", energy_after / energy - 1.0);
    let lost = (momentum_after - momentum).norm() / momentum.norm();
    assert!(lost < TOLERANCE, "{lost}: {momentum_after:?} {momentum:?}");
}

#[test]
fn exact_integrator_is_fourth_order() {
    let model = AirframeModel::new(&quad(), BatteryModel::Paper);
    let air = AirState { velocity_m_s: Vec3::new(3.0, -2.0, 0.5), ..AirState::STILL };
    let motors = [0.62, 0.58, 0.60, 0.61, 0.0, 0.0, 0.0, 0.0];
    let end = |per_second: i64| {
        let mut state = start();
        state.rigid.rotor_rad_s = [500.0; MAX_ROTORS];
        let dt = SimTime::from_ns(1_000_000_000 / per_second);
        run(&model, &mut state, &Actuators { motors, armed: true }, &air, dt, 2 * per_second);
        state.rigid.position_m
    };
    // Rates whose periods are whole numbers of nanoseconds.
    let reference = end(3200);
    let (coarse, fine) = ((end(100) - reference).norm(), (end(200) - reference).norm());
    let order = math::ln(coarse / fine) / math::ln(2.0);
    assert!((3.9..=4.3).contains(&order), "order {order}: {coarse} {fine}");
}

#[test]
fn exact_wind_pushes_a_free_body_downwind() {
    let mut vehicle = bare();
    vehicle.drag.area_m2 = [0.05; 3];
    let mut state = start();
    let air = AirState { velocity_m_s: Vec3::new(5.0, 0.0, 0.0), ..AirState::STILL };
    run(&AirframeModel::new(&vehicle, BatteryModel::Paper), &mut state, &coasting(), &air, DT, 100);
    assert!(state.rigid.velocity_m_s.north() > 0.0, "wind to the north must push north");
}

#[test]
fn exact_drag_depends_on_airspeed() {
    // Speed tolerance, m/s.
    const TOLERANCE: f64 = 1e-12;
    let model = AirframeModel::new(&quad(), BatteryModel::Paper);
    let drift = Vec3::<Ned>::new(4.0, -3.0, 1.0);
    let actuators = Actuators { motors: [0.6; MAX_ROTORS], armed: true };
    let mut still = start();
    run(&model, &mut still, &actuators, &AirState::STILL, DT, 500);
    let mut carried = start();
    carried.rigid.velocity_m_s = drift;
    run(&model, &mut carried, &actuators, &AirState { velocity_m_s: drift, ..AirState::STILL }, DT, 500);
    let difference = carried.rigid.velocity_m_s - drift - still.rigid.velocity_m_s;
    assert!(difference.norm() < TOLERANCE, "{difference:?}");
}

#[test]
fn exact_motion_does_not_depend_on_heading() {
    // Position tolerance, m.
    const TOLERANCE: f64 = 1e-9;
    let model = AirframeModel::new(&quad(), BatteryModel::Paper);
    let actuators = Actuators { motors: [0.62, 0.58, 0.60, 0.61, 0.0, 0.0, 0.0, 0.0], armed: true };
    let fly = |yaw: f64| {
        let mut state = start();
        state.rigid.attitude = Rotation::from_euler(0.0, 0.0, yaw);
        run(&model, &mut state, &actuators, &AirState::STILL, DT, 1000);
        Rotation::<Ned, Frd>::assume(Rotation::from_euler(0.0, 0.0, yaw).inverse().raw())
            * (state.rigid.position_m - start().rigid.position_m)
    };
    assert!((fly(0.0) - fly(2.1)).norm() < TOLERANCE);
}

#[test]
fn exact_rotor_torque_is_force_times_arm() {
    // Tolerance for a few rounding errors, N and N m.
    const TOLERANCE: f64 = 1e-14;
    let vehicle = quad();
    let model = AirframeModel::new(&vehicle, BatteryModel::Paper);
    let wrench = model.rotor_wrench(0, &RotorConditions::at_rest(500.0));
    let thrust = 1.0e-5 * 500.0 * 500.0;
    let arm = vehicle.rotors[0].position_m;
    assert!((wrench.force_n - Vec3::new(0.0, 0.0, -thrust)).norm() < TOLERANCE);
    let expected = Vec3::new(-arm.right() * thrust, arm.forward() * thrust, 1.6e-7 * 500.0 * 500.0);
    assert!((wrench.torque_n_m - expected).norm() < TOLERANCE);
}

#[test]
fn exact_tasbid_battery_is_empty_after_its_endurance() {
    // Tolerance for the rounding errors of 1.5 million subtractions, %.
    const TOLERANCE: f64 = 1e-7;
    let mut vehicle = bare();
    vehicle.battery.paper_endurance_s = 15.0;
    let model = AirframeModel::new(&vehicle, BatteryModel::Paper);
    let mut state = start();
    let load = PowerLoad { airborne: true, lamp_on: false };
    for k in 0..7500 {
        model.advance(&mut state, &coasting(), &AirState::STILL, &OpenSky, load, SimTime::from_ms(k), DT);
    }
    assert!((state.battery.remaining_pct() - 50.0).abs() < TOLERANCE);
}

#[test]
fn exact_physical_battery_follows_ohms_law_and_integrates_charge() {
    // Rounding tolerance, V and A, and relative charge tolerance, because the current changes slightly during the
    // second.
    const ROUNDING_TOLERANCE: f64 = 1e-9;
    let vehicle = quad();
    let model = AirframeModel::new(&vehicle, BatteryModel::Physical);
    let mut state = start();
    state.rigid.rotor_rad_s = [600.0; MAX_ROTORS];
    state.rigid.rotor_rad_s[4..].fill(0.0);
    let b = &vehicle.battery;
    let power = 4.0 * 1.6e-7 * 600.0 * 600.0 * 600.0 / 0.5 + b.avionics_power_w + b.lamp_power_w;
    let mut drawn_as = 0.0;
    let load = PowerLoad { airborne: true, lamp_on: true };
    // Commands that keep the rotor speeds constant.
    for k in 0..1000 {
        let top = 1000.0 * state.battery.speed_factor;
        let actuators = Actuators { motors: [(600.0 - 100.0) / (top - 100.0); MAX_ROTORS], armed: true };
        model.advance(&mut state, &actuators, &AirState::STILL, &OpenSky, load, SimTime::from_ms(k), DT);
        let (v, i) = (state.battery.voltage_v, state.battery.current_a);
        drawn_as += i * DT.s();
        assert!((state.rigid.rotor_rad_s[0] - 600.0).abs() < ROUNDING_TOLERANCE);
        assert!((v * i - power).abs() < 1e-6 * power, "{v} V, {i} A, {power} W");
        // The charge is between the two highest points of the curve.
        let before = state.battery.charge + i * DT.s() / (b.capacity_ah * 3600.0);
        let open = 3.0 * (4.1 + (4.2 - 4.1) * (before - 0.9) * 10.0);
        assert!((open - i * b.internal_resistance_ohm - v).abs() < ROUNDING_TOLERANCE, "{open} V open, {v} V");
        assert!((state.battery.speed_factor - v / (3.0 * 4.2)).abs() < ROUNDING_TOLERANCE);
    }
    assert!((1.0 - state.battery.charge - drawn_as / (b.capacity_ah * 3600.0)).abs() < ROUNDING_TOLERANCE);
}

#[test]
fn val_cold_battery_has_the_measured_resistance() {
    // The published ratios to 25 °C have two or three digits.
    const TOLERANCE: f64 = 0.01;
    let vehicle = quad();
    for (temperature_c, ratio) in [(25.0, 1.0), (10.0, 1.75), (0.0, 2.6)] {
        let model = AirframeModel::new(&vehicle, BatteryModel::Physical).with_battery_at(temperature_c);
        let mut state = start();
        state.rigid.rotor_rad_s[..4].fill(600.0);
        let load = PowerLoad { airborne: true, lamp_on: false };
        model.advance(&mut state, &Actuators::default(), &AirState::STILL, &OpenSky, load, SimTime::ZERO, DT);
        // A full pack of three cells has 12.6 V.
        let resistance_ohm = (12.6 - state.battery.voltage_v) / state.battery.current_a;
        let expected_ohm = ratio * vehicle.battery.internal_resistance_ohm;
        assert!((resistance_ohm / expected_ohm - 1.0).abs() < TOLERANCE, "{temperature_c} °C: {resistance_ohm} ohm");
    }
}

#[test]
fn exact_wind_at_all_rotors_equals_a_uniform_wind_for_an_aircraft_without_body_drag() {
    // Speed tolerance, m/s: the two sums differ in rounding.
    const TOLERANCE: f64 = 1e-12;
    let mut vehicle = quad();
    vehicle.drag.area_m2 = [0.0; 3];
    let model = AirframeModel::new(&vehicle, BatteryModel::Paper);
    let wind = Vec3::<Ned>::new(4.0, -3.0, 1.0);
    let actuators = Actuators { motors: [0.6; MAX_ROTORS], armed: true };
    let end = |air: AirState| {
        let mut state = start();
        run(&model, &mut state, &actuators, &air, DT, 500);
        state.rigid.velocity_m_s
    };
    let uniform = end(AirState { velocity_m_s: wind, ..AirState::STILL });
    let at_rotors = end(AirState { rotors_m_s: Some([wind; MAX_ROTORS]), ..AirState::STILL });
    assert!((uniform - at_rotors).norm() < TOLERANCE, "{uniform:?} {at_rotors:?}");
    assert!((uniform - end(AirState::STILL)).norm() > 0.1, "the wind has an effect");
}

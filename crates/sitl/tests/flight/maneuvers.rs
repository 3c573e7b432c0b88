//! Manually flown hover, step, stop, turn, circle and gust maneuvers, with stated bounds, for every shipped aircraft.

use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::math;
use spandrel_sitl::autopilot::{AutopilotRequest, FlightMode, Sticks};
use spandrel_testkit::bench::{Bench, VEHICLES};
use spandrel_testkit::shipped::vehicle;

/// Stick dead band (the tuning's default).
const DEADBAND: f64 = 0.03;

/// Returns the stick deflection for a fraction of the full command.
fn stick(share: f64) -> f64 {
    share * (1.0 - DEADBAND) + DEADBAND * share.signum()
}

#[test]
fn flight_hover_is_steady() {
    // Maximum deviation, m: the receiver's slow drift of 0.4 m (1 sigma) over half a minute.
    const MAX_DEVIATION_M: f64 = 0.8;
    // Maximum tilt, rad: two and a half degrees, most of it the attitude estimate's error under the rotors' vibration.
    const MAX_TILT_RAD: f64 = 0.044;
    // Maximum speed, m/s.
    const MAX_SPEED_M_S: f64 = 0.25;
    for name in VEHICLES {
        let mut bench = Bench::in_position_mode(&vehicle(name), 1, 6.0);
        let start = bench.position();
        let (mut stray, mut lean, mut speed): (f64, f64, f64) = (0.0, 0.0, 0.0);
        bench.run(30.0, |b| {
            let (roll, pitch, _) = b.state.rigid.attitude.euler();
            stray = stray.max((b.position() - start).norm());
            lean = lean.max(roll.abs()).max(pitch.abs());
            speed = speed.max(b.state.rigid.velocity_m_s.norm());
        });
        assert!(
            stray < MAX_DEVIATION_M && lean < MAX_TILT_RAD && speed < MAX_SPEED_M_S,
            "{name}: {stray} m, {lean} rad, {speed} m/s"
        );
    }
}

#[test]
fn flight_stick_step_reaches_its_speed_and_release_stops_the_vehicle() {
    // Velocity estimate tolerance, m/s.
    const MAX_SPEED_M_S: f64 = 0.2;
    // Limits as fractions of the speed: overshoot, and remaining speed that counts as stopped.
    const MAX_SPEED_OVERSHOOT: f64 = 0.08;
    const STOPPED_SPEED_FRACTION: f64 = 0.1;
    // Maximum backward speed after the stop, m/s.
    const MAX_BACKWARD_M_S: f64 = 0.2;
    // Maximum height change during the maneuver, m.
    const MAX_HEIGHT_CHANGE_M: f64 = 0.3;
    // The highest speed that inspection requires: 4.5 m/s, the job's speed limit.
    const INSPECTION_SPEED_M_S: f64 = 4.5;
    for name in VEHICLES {
        let aircraft = vehicle(name);
        let wanted = INSPECTION_SPEED_M_S.min(0.5 * aircraft.limits.forward_m_s);
        let mut bench = Bench::in_sport_mode(&aircraft, 2, 8.0);
        let height = bench.position().down();
        bench.sticks = Some(Sticks { forward: stick(wanted / aircraft.limits.forward_m_s), ..Sticks::default() });
        let (mut peak, mut sag): (f64, f64) = (0.0, 0.0);
        bench.run(6.0, |b| {
            peak = peak.max(b.state.rigid.velocity_m_s.north());
            sag = sag.max((b.position().down() - height).abs());
        });
        let speed = bench.state.rigid.velocity_m_s.north();
        assert!(
            (speed - wanted).abs() < MAX_SPEED_M_S && peak < wanted * (1.0 + MAX_SPEED_OVERSHOOT),
            "{name}: speed {speed}, peak {peak}, target {wanted}"
        );
        bench.sticks = Some(Sticks::default());
        bench.run(aircraft.limits.slow_down_time_s, |_| ());
        let left = bench.state.rigid.velocity_m_s.horizontal_norm();
        assert!(left < STOPPED_SPEED_FRACTION * wanted, "{name}: {left} m/s after the stopping time");
        let mut back: f64 = 0.0;
        bench.run(4.0, |b| {
            back = back.min(b.state.rigid.velocity_m_s.north());
            sag = sag.max((b.position().down() - height).abs());
        });
        assert!(back > -MAX_BACKWARD_M_S && sag < MAX_HEIGHT_CHANGE_M, "{name}: {back} m/s backward, lost {sag} m of height");
    }
}

#[test]
fn flight_full_stick_reaches_full_speed_on_every_axis() {
    // Speed tolerance as a fraction of full speed.
    const SPEED_TOLERANCE: f64 = 0.06;
    for name in VEHICLES {
        let aircraft = vehicle(name);
        let l = aircraft.limits;
        let mut bench = Bench::in_sport_mode(&aircraft, 3, 30.0);
        let mut check = |sticks: Sticks, seconds: f64, wanted: f64, speed: &dyn Fn(&Bench) -> f64| {
            bench.sticks = Some(sticks);
            bench.run(seconds, |_| ());
            let got = speed(&bench);
            assert!((got - wanted).abs() < SPEED_TOLERANCE * wanted, "{name}: {got} instead of {wanted} for {sticks:?}");
            bench.sticks = Some(Sticks::default());
            bench.run(4.0, |_| ());
        };
        check(Sticks { forward: 1.0, ..Sticks::default() }, 9.0, l.forward_m_s, &|b| b.state.rigid.velocity_m_s.north());
        check(Sticks { right: 1.0, ..Sticks::default() }, 9.0, l.sideways_speed_m_s, &|b| b.state.rigid.velocity_m_s.east());
        check(Sticks { up: 1.0, ..Sticks::default() }, 4.0, l.climb_m_s, &|b| -b.state.rigid.velocity_m_s.down());
        check(Sticks { up: -1.0, ..Sticks::default() }, 4.0, l.descend_m_s, &|b| b.state.rigid.velocity_m_s.down());
        check(Sticks { yaw: 1.0, ..Sticks::default() }, 4.0, l.yaw_rate_rad_s, &|b| b.state.rigid.rates_rad_s.down());
    }
}

#[test]
fn flight_manually_flown_circle_is_round() {
    // Radius tolerance as a fraction of the radius.
    const RADIUS_TOLERANCE: f64 = 0.08;
    for name in VEHICLES {
        let aircraft = vehicle(name);
        let mut bench = Bench::in_sport_mode(&aircraft, 3, 8.0);
        let (speed, rate) = (3.0, 0.5);
        bench.sticks = Some(Sticks {
            forward: stick(speed / aircraft.limits.forward_m_s),
            yaw: stick(rate / aircraft.limits.yaw_rate_rad_s),
            ..Sticks::default()
        });
        bench.run(8.0, |_| ());
        let mut points = Vec::new();
        bench.run(math::TAU / rate, |b| points.push(b.position()));
        let center = points.iter().fold(Vec3::zero(), |sum, p| sum + *p) / points.len() as f64;
        let radii: Vec<f64> = points.iter().map(|p| (*p - center).horizontal_norm()).collect();
        let mean = radii.iter().sum::<f64>() / radii.len() as f64;
        let worst = radii.iter().map(|r| (r - mean).abs()).fold(0.0, f64::max);
        assert!((mean - speed / rate).abs() < RADIUS_TOLERANCE * speed / rate, "{name}: radius {mean}");
        assert!(worst < RADIUS_TOLERANCE * mean, "{name}: {worst} off {mean}");
    }
}

#[test]
fn flight_recovers_from_a_gust() {
    // Maximum deviation after a wind step of 6 m/s, m, and deviation that remains after a quarter of a minute.
    const MAX_DEVIATION_M: f64 = 0.9;
    const MAX_REMAINING_DEVIATION_M: f64 = 0.6;
    for name in VEHICLES {
        let mut bench = Bench::in_position_mode(&vehicle(name), 4, 8.0);
        let start = bench.position();
        bench.air.velocity_m_s = Vec3::new(6.0, 0.0, 0.0);
        let mut worst: f64 = 0.0;
        bench.run(15.0, |b| worst = worst.max((b.position() - start).norm()));
        let left = (bench.position() - start).norm();
        assert!(worst < MAX_DEVIATION_M && left < MAX_REMAINING_DEVIATION_M, "{name}: strayed {worst} m, {left} m remain");
        let nose = bench.state.rigid.attitude * Vec3::<Frd>::new(1.0, 0.0, 0.0);
        assert!(nose.down() < 0.0, "{name} must lean back against wind from behind: {nose:?}");
    }
}

#[test]
fn flight_saturated_motors_keep_the_vehicle_upright() {
    // Maximum excess over the tilt limit, rad: saturated motors cannot resist the moments of the rotors' drag in a fast climb.
    const MAX_TILT_EXCESS_RAD: f64 = 0.15;
    for name in VEHICLES {
        let aircraft = vehicle(name);
        let mut bench = Bench::in_position_mode(&aircraft, 5, 20.0);
        // In this mode the throttle stick sets thrust. It is at its maximum, while the other sticks swing from end to
        // end.
        bench.ask(AutopilotRequest::SetMode(FlightMode::Stabilized));
        let (mut full, mut lean): (bool, f64) = (false, 0.0);
        for sign in [1.0, -1.0, 1.0, -1.0] {
            bench.sticks = Some(Sticks { forward: sign, right: -sign, up: 1.0, yaw: -sign });
            bench.run(1.5, |b| {
                full |= b.actuators.motors.iter().any(|m| *m >= 1.0);
                let down = (b.state.rigid.attitude * Vec3::<Frd>::new(0.0, 0.0, 1.0)).down();
                lean = lean.max(math::acos(down));
            });
        }
        assert!(full, "{name}: no motor was saturated, so the test is pointless");
        assert!(lean < aircraft.limits.tilt_rad + MAX_TILT_EXCESS_RAD, "{name}: tilt {lean} rad");
        bench.sticks = Some(Sticks::default());
        bench.ask(AutopilotRequest::SetMode(FlightMode::Position));
        bench.run(8.0, |_| ());
        assert!(bench.state.rigid.velocity_m_s.norm() < 0.3, "{name}: {:?}", bench.state.rigid.velocity_m_s);
    }
}

#[test]
fn flight_stops_from_full_speed_in_time() {
    // Fraction of full speed that counts as stopped.
    const STOPPED_SPEED_FRACTION: f64 = 0.1;
    for name in VEHICLES {
        let aircraft = vehicle(name);
        for sticks in [Sticks { forward: 1.0, ..Sticks::default() }, Sticks { right: -1.0, ..Sticks::default() }] {
            let mut bench = Bench::in_sport_mode(&aircraft, 2, 8.0);
            bench.sticks = Some(sticks);
            bench.run(12.0, |_| ());
            let full = bench.state.rigid.velocity_m_s.horizontal_norm();
            bench.sticks = Some(Sticks::default());
            bench.run(aircraft.limits.slow_down_time_s, |_| ());
            let left = bench.state.rigid.velocity_m_s.horizontal_norm();
            assert!(left < STOPPED_SPEED_FRACTION * full, "{name}: {left} of {full} m/s remain after the stopping time");
        }
    }
}

//! Step, hover, circle and gust flights with stated bounds, for every shipped aircraft.

use super::bench::{Bench, VEHICLES, vehicle};
use spandrel::base::frames::Vec3;
use spandrel::base::math;
use spandrel::sitl::autopilot::{Landed, Mode, Request, Sticks};

#[test]
fn flight_takes_off_holds_and_lands_where_it_was() {
    // m: GNSS noise of 0.5 m, filtered.
    const HOLD_M: f64 = 1.0;
    // m: the barometer's and the GNSS's error in height.
    const HEIGHT_M: f64 = 0.8;
    for name in VEHICLES {
        let mut bench = Bench::airborne(&vehicle(name), 1, 5.0);
        let mut worst: f64 = 0.0;
        bench.run(20.0, |b| worst = worst.max(b.position().horizontal_norm()));
        assert!(worst < HOLD_M, "{name}: strayed {worst} m");
        assert!((bench.position().down() + 5.0).abs() < HEIGHT_M + 0.3, "{name}: {:?}", bench.position());
        bench.ask(Request::Land);
        bench.run(20.0, |_| ());
        let status = bench.autopilot.status().clone();
        assert!(!status.armed && status.landed == Landed::OnGround, "{name}: {status:?} {:?}", bench.position());
    }
}

#[test]
fn flight_a_step_on_the_stick_gives_the_speed_and_letting_go_stops() {
    // m/s: drag, noise and the velocity estimate.
    const SPEED_M_S: f64 = 0.5;
    for name in VEHICLES {
        let aircraft = vehicle(name);
        let mut bench = Bench::airborne(&aircraft, 2, 8.0);
        bench.sticks = Some(Sticks { forward: 0.4, ..Sticks::default() });
        bench.run(0.1, |_| ());
        bench.ask(Request::SetMode(Mode::Position));
        bench.run(6.0, |_| ());
        let wanted = (0.4 - 0.03) / 0.97 * aircraft.limits.forward_m_s;
        let speed = bench.state.rigid.velocity_m_s.north();
        assert!((speed - wanted).abs() < SPEED_M_S, "{name}: {speed} for {wanted}");
        bench.sticks = Some(Sticks::default());
        // From full speed it stops within the slow-down time; the loops need a second more to settle.
        bench.run(aircraft.limits.slow_down_time_s + 1.0, |_| ());
        assert!(bench.state.rigid.velocity_m_s.norm() < SPEED_M_S, "{name}: {:?}", bench.state.rigid.velocity_m_s);
    }
}

#[test]
fn flight_a_circle_by_stick_is_round() {
    // Share of the radius.
    const ROUND: f64 = 0.2;
    for name in VEHICLES {
        let aircraft = vehicle(name);
        let mut bench = Bench::airborne(&aircraft, 3, 8.0);
        let (speed, rate) = (3.0, 0.5);
        let stick = |value: f64| value * 0.97 + 0.03;
        bench.sticks = Some(Sticks {
            forward: stick(speed / aircraft.limits.forward_m_s),
            yaw: rate / aircraft.limits.yaw_rate_rad_s,
            ..Sticks::default()
        });
        bench.run(0.1, |_| ());
        bench.ask(Request::SetMode(Mode::Position));
        bench.run(8.0, |_| ());
        let mut points = Vec::new();
        bench.run(math::TAU / rate, |b| points.push(b.position()));
        let centre = points.iter().fold(Vec3::zero(), |sum, p| sum + *p) / points.len() as f64;
        let radii: Vec<f64> = points.iter().map(|p| (*p - centre).horizontal_norm()).collect();
        let mean = radii.iter().sum::<f64>() / radii.len() as f64;
        assert!((mean - speed / rate).abs() < ROUND * speed / rate, "{name}: radius {mean}");
        assert!(radii.iter().all(|r| (r - mean).abs() < ROUND * mean), "{name}");
    }
}

#[test]
fn flight_a_gust_is_ridden_out() {
    // m for a step of 6 m/s of wind.
    const STRAY_M: f64 = 3.0;
    for name in VEHICLES {
        let mut bench = Bench::airborne(&vehicle(name), 4, 8.0);
        let start = bench.position();
        bench.air.velocity_m_s = Vec3::new(6.0, 0.0, 0.0);
        let mut worst: f64 = 0.0;
        bench.run(15.0, |b| worst = worst.max((b.position() - start).norm()));
        assert!(worst < STRAY_M, "{name}: strayed {worst} m");
        let nose = bench.state.rigid.attitude * Vec3::new(1.0, 0.0, 0.0);
        assert!(nose.down() < 0.0, "{name} leans back against a wind from behind: {nose:?}");
    }
}

#[test]
fn flight_lost_sticks_lead_to_hold() {
    let mut bench = Bench::airborne(&vehicle("phantom2"), 5, 6.0);
    bench.sticks = Some(Sticks { forward: 0.3, ..Sticks::default() });
    bench.run(0.1, |_| ());
    bench.ask(Request::SetMode(Mode::Position));
    bench.run(2.0, |_| ());
    bench.sticks = None;
    bench.run(4.0, |_| ());
    let status = bench.autopilot.status().clone();
    assert_eq!(status.mode, Mode::Hold);
    assert_eq!(status.failsafe.as_deref(), Some("manual control lost"));
    assert!(bench.state.rigid.velocity_m_s.norm() < 0.5);
}

#[test]
fn flight_a_return_comes_home_and_lands() {
    let mut bench = Bench::airborne(&vehicle("phantom2"), 6, 6.0);
    bench.autopilot.tuning.return_height_m = 12.0;
    bench.ask(Request::GoTo { north_east_m: Some((20.0, 10.0)), up_m: None, yaw_rad: None, speed_m_s: None });
    bench.run(15.0, |_| ());
    assert!((bench.position().north() - 20.0).abs() < 1.5, "{:?}", bench.position());
    bench.ask(Request::SetMode(Mode::Return));
    bench.run(60.0, |_| ());
    assert!(!bench.autopilot.status().clone().armed, "{:?} {:?}", bench.autopilot.status().clone(), bench.position());
    assert!(bench.position().horizontal_norm() < 2.0, "{:?}", bench.position());
}

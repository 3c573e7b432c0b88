//! MAVLink's local frame: its origin is the position where the estimator was initialized, and all messages that use the
//! frame agree.

use spandrel_mavlink::dialect::*;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_sitl::endpoint::flavor;
use spandrel_testkit::shipped::scenario;
use spandrel_testkit::station::{Station, p};

/// Maximum drift of an estimate at rest after the origin was set, m: three sigma of the GNSS height's white noise (0.48
/// m), averaged over the first eight fixes.
const SETTLED_TOLERANCE_M: f32 = 0.5;
/// Maximum rounding difference between degrees E7, millimeters and single-precision meters, m.
const ROUNDING_TOLERANCE_M: f64 = 0.03;
/// Maximum height error in the vehicle's own estimate, m.
const HOLD_TOLERANCE_M: f32 = 0.5;
/// Maximum error of the estimated climb in the first seconds of a flight, m: the barometer's offset under the rotors' wash
/// and the height's own noise. An origin that follows the takeoff is wrong by 0.4 m and more.
const CLIMB_TOLERANCE_M: f64 = 0.25;

fn place(latitude: i32, longitude: i32, altitude: i32) -> Geo {
    Geo {
        latitude_deg: f64::from(latitude) * 1e-7,
        longitude_deg: f64::from(longitude) * 1e-7,
        altitude_m: f64::from(altitude) * 1e-3,
    }
}

/// Requests a message by number and returns it.
fn requested<T>(station: &mut Station, number: u32, pick: impl Fn(&MavMessage) -> Option<T>) -> T {
    let result = station.command(1, MavCmd::MAV_CMD_REQUEST_MESSAGE, p(&[number as f32]));
    assert_eq!(result, MavResult::MAV_RESULT_ACCEPTED);
    station.last_message(pick).unwrap()
}

fn local(station: &mut Station) -> [f32; 3] {
    requested(station, 32, |m| if let MavMessage::LOCAL_POSITION_NED(p) = m { Some([p.x, p.y, p.z]) } else { None })
}

/// Returns the local plane defined by GPS_GLOBAL_ORIGIN.
fn plane(station: &mut Station) -> LocalPlane {
    let origin = requested(station, 49, |m| match m {
        MavMessage::GPS_GLOBAL_ORIGIN(o) => Some(place(o.latitude, o.longitude, o.altitude)),
        _ => None,
    });
    LocalPlane::new(origin)
}

fn off(plane: &LocalPlane, geo: Geo, local: [f32; 3]) -> f64 {
    let local: Vec3<Ned> = Vec3::new(f64::from(local[0]), f64::from(local[1]), f64::from(local[2]));
    (plane.enu_from_geo(geo).ned() - local).norm()
}

#[test]
fn regress_local_position_on_the_pad_is_zero_and_matches_origin_and_home() {
    for flavor in [&flavor::px4::FLAVOR, &flavor::ardupilot::FLAVOR] {
        for seed in 1..=5 {
            let mut station = Station::with_flavor(flavor, "two-bridges", seed);
            station.run_ms(5_000);
            let at = local(&mut station);
            let far = at.iter().map(|c| c.abs()).fold(0.0, f32::max);
            assert!(far < SETTLED_TOLERANCE_M, "{}, seed {seed}: {at:?}", flavor.name);
            let plane = plane(&mut station);
            let here = requested(&mut station, 33, |m| match m {
                MavMessage::GLOBAL_POSITION_INT(g) => Some(place(g.lat, g.lon, g.alt)),
                _ => None,
            });
            let at = local(&mut station);
            assert!(off(&plane, here, at) < ROUNDING_TOLERANCE_M, "{here:?} {at:?}");
            let (home, home_local) = requested(&mut station, 242, |m| match m {
                MavMessage::HOME_POSITION(h) => Some((place(h.latitude, h.longitude, h.altitude), [h.x, h.y, h.z])),
                _ => None,
            });
            assert!(off(&plane, home, home_local) < ROUNDING_TOLERANCE_M, "{home:?} {home_local:?}");
            assert!(home_local.iter().all(|c| c.abs() < SETTLED_TOLERANCE_M), "{home_local:?}");
            let odometry =
                requested(&mut station, 331, |m| if let MavMessage::ODOMETRY(o) = m { Some([o.x, o.y, o.z]) } else { None });
            let at = local(&mut station);
            let apart = (0..3).map(|k| (odometry[k] - at[k]).abs()).fold(0.0, f32::max);
            assert!(f64::from(apart) < ROUNDING_TOLERANCE_M, "{odometry:?} {at:?}");
            let altitude = requested(&mut station, 141, |m| match m {
                MavMessage::ALTITUDE(a) => Some(a.altitude_local),
                _ => None,
            });
            assert!(f64::from((altitude + at[2]).abs()) < ROUNDING_TOLERANCE_M, "{altitude} {at:?}");
        }
    }
}

#[test]
fn regress_local_setpoint_is_relative_to_the_pad() {
    let mut station = Station::of(scenario("two-bridges"), "phantom2", 7);
    station.run_ms(3_000);
    let pad = station.sim.truth().rigid.position_m;
    let (north, east, down) = (2.0, 1.0, -6.0);
    let target = MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
        x: north,
        y: east,
        z: down,
        coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        type_mask: PositionTargetTypemask::from_bits_retain(0b1101_1111_1000),
        target_system: 1,
        target_component: 1,
        ..Default::default()
    });
    station.send(&target);
    station.run_ms(5);
    let mode = station.command(1, MavCmd::MAV_CMD_DO_SET_MODE, p(&[1.0, 6.0]));
    let arm = station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, p(&[1.0]));
    assert_eq!([mode, arm], [MavResult::MAV_RESULT_ACCEPTED; 2]);
    for _ in 0..300 {
        station.send(&target);
        station.run_ms(50);
    }
    let at = station.place();
    let held = (at[0] - north).hypot(at[1] - east).hypot(at[2] - down);
    assert!(held < HOLD_TOLERANCE_M, "{at:?}: {held} m off");
    let told = station.last_message(|m| match m {
        MavMessage::POSITION_TARGET_LOCAL_NED(t) => Some([t.x, t.y, t.z]),
        _ => None,
    });
    assert_eq!(told.map(|t| t.map(|c| (c * 100.0).round() / 100.0)), Some([north, east, down]));
    let moved = station.sim.truth().rigid.position_m - pad;
    // Ground truth differs from the estimate, because GNSS drifts by a meter or two.
    assert!(moved.horizontal_norm() < 5.0 && (-8.0..-4.0).contains(&moved.down()), "{moved:?}");
}

#[test]
fn regress_local_origin_does_not_follow_a_takeoff_at_the_first_moment() {
    for seed in 1..=5 {
        let mut station = Station::with_flavor(&flavor::px4::FLAVOR, "drill-hover", seed);
        let pad = station.sim.truth().rigid.position_m;
        let armed = (0..100).any(|_| {
            station.run_ms(20);
            station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, p(&[1.0])) == MavResult::MAV_RESULT_ACCEPTED
        });
        assert!(armed, "seed {seed}");
        let away = station.command(1, MavCmd::MAV_CMD_NAV_TAKEOFF, p(&[-1.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, f32::NAN]));
        assert_eq!(away, MavResult::MAV_RESULT_ACCEPTED);
        station.run_ms(4_000);
        let climbed_m = (pad - station.sim.truth().rigid.position_m).down();
        assert!(climbed_m > 1.0, "seed {seed}: {climbed_m}");
        let apart_m = (climbed_m + f64::from(local(&mut station)[2])).abs();
        assert!(apart_m < CLIMB_TOLERANCE_M, "seed {seed}: climbed {climbed_m} m, {apart_m} m more than the local frame says");
    }
}

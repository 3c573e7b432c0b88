//! What the range finders tell: the site's own distances, in their directions.

use super::station::Station;
use spandrel::base::frames::{Enu, Frd, Vec3};
use spandrel::mav::dialect::*;
use spandrel::site::Site;

/// Noise of the finders and the way flown between a reading and its telemetry, m.
const TOLERANCE_M: f64 = 0.5;
const REACH_M: f64 = 10.0;

#[test]
fn wire_range_finders_tell_the_sites_distances_down_up_and_ahead() {
    let mut station = Station::airborne("two-bridges", 7);
    station.run_ms(3_000);
    let site = Site::build(&super::station::scenario("two-bridges"), 7);
    let truth = station.sim.truth().rigid;
    let now = station.sim.now();
    let here = truth.position_m.enu();
    let ray = |direction: Vec3<Frd>| -> Option<f64> {
        let way: Vec3<Enu> = (truth.attitude * direction).enu();
        site.ray(here, way, REACH_M, now).map(|hit| hit.distance_m)
    };
    for (orientation, direction) in [
        (MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_270, Vec3::new(0.0, 0.0, 1.0)),
        (MavSensorOrientation::MAV_SENSOR_ROTATION_PITCH_90, Vec3::new(0.0, 0.0, -1.0)),
        (MavSensorOrientation::MAV_SENSOR_ROTATION_NONE, Vec3::new(1.0, 0.0, 0.0)),
    ] {
        let told = station.last(|m| match m {
            MavMessage::DISTANCE_SENSOR(d) if d.orientation == orientation => {
                Some((f64::from(d.current_distance) / 100.0, f64::from(d.max_distance) / 100.0))
            }
            _ => None,
        });
        let (told, reach) = told.unwrap_or_else(|| panic!("{orientation:?} says nothing"));
        assert_eq!(reach, REACH_M);
        match ray(direction) {
            Some(distance) => assert!((told - distance).abs() < TOLERANCE_M, "{orientation:?}: {told} for {distance}"),
            None => assert!(told > REACH_M - TOLERANCE_M, "{orientation:?}: {told}, and nothing is there"),
        }
    }
}

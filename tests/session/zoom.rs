//! Tests of a zoom lens in telemetry and in the measures.

use spandrel_mavlink::dialect::*;
use spandrel_mavlink::telemetry::Timeline;
use spandrel_model::geodesy::LocalPlane;
use spandrel_monitor::measures::attention::camera;
use spandrel_testkit::shipped::{scenario, vehicle};
use spandrel_testkit::station::{Station, p};

const CAMERA: u8 = 100;
/// The only shipped aircraft with a zoom lens.
const ZOOM_RATIOS: &str = "m30";
/// Tolerance for the rounding of CAMERA_FOV_STATUS, which has single precision, deg.
const FOV_TOLERANCE_DEG: f32 = 1e-5;

#[test]
fn exact_pictures_are_scored_with_their_own_field_of_view() {
    let job = scenario("drill-hover");
    let origin = job.origin;
    let mut station = Station::of(job, ZOOM_RATIOS, 7);
    station.run_ms(100);
    let accepted = MavResult::MAV_RESULT_ACCEPTED;
    assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_SET_CAMERA_ZOOM, p(&[1.0, 1.0])), accepted);
    for _ in 0..5 {
        station.run_ms(430);
        station.received.clear();
        assert_eq!(station.command(CAMERA, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, p(&[0.0, 0.0, 1.0])), accepted);
        station.run_ms(20);
        let mut timeline = Timeline::new(LocalPlane::new(origin));
        for frame in &station.received {
            timeline.push(&frame.bytes);
        }
        let flight = timeline.flight(0);
        let [(time, _, _)] = flight.snapshots.all() else { panic!("one picture") };
        let judged_deg = camera(&flight, *time, &vehicle(ZOOM_RATIOS).camera).hfov_rad.to_degrees() as f32;
        let sent_deg = station.last_message(|m| if let MavMessage::CAMERA_FOV_STATUS(f) = m { Some(f.hfov) } else { None });
        assert!((judged_deg - sent_deg.unwrap()).abs() < FOV_TOLERANCE_DEG, "{judged_deg} for {sent_deg:?}");
    }
}

//! The response to the sticks: its command, its parameter and its button.

use spandrel_mavlink::contract::stick_request::{PARAMETER, StickRequest};
use spandrel_mavlink::dialect::*;
use spandrel_model::stick_response::StickResponse;
use spandrel_sitl::endpoint::flavor::ardupilot;
use spandrel_testkit::station::Station;

const ACCEPTED: MavResult = MavResult::MAV_RESULT_ACCEPTED;

fn ask(station: &mut Station, request: StickRequest, number: u32) -> MavResult {
    let (command, params) = request.command(number);
    station.command(1, command, params)
}

/// Returns the values of the parameter that the vehicle has sent since the last command, as integers.
fn announced(station: &Station) -> Vec<u32> {
    station.all(|message| match message {
        MavMessage::PARAM_VALUE(value) if value.param_id.to_str() == Ok(PARAMETER) => Some(value.param_value.to_bits()),
        _ => None,
    })
}

#[test]
fn wire_command_changes_the_parameter_and_announces_only_it() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(2_500);
    assert_eq!(ask(&mut station, StickRequest::Select(StickResponse::Tripod), 0), ACCEPTED);
    station.run_ms(200);
    assert_eq!(announced(&station), [2]);
    let others = station.all(|message| matches!(message, MavMessage::PARAM_VALUE(_)).then_some(()));
    assert_eq!(others.len(), 1, "the vehicle must not send its whole list");
    assert!(station.has_text("Sticks: tripod"));
}

#[test]
fn wire_repeated_request_acts_once_and_is_acknowledged_each_time() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(2_500);
    let mut seen = Vec::new();
    for number in [5, 5, 6, 0, 0] {
        assert_eq!(ask(&mut station, StickRequest::Next, number), ACCEPTED);
        station.run_ms(50);
        seen.extend(announced(&station));
    }
    assert_eq!(seen, [1, 2, 0, 1]);
}

#[test]
fn wire_invalid_request_is_denied_with_the_allowed_values() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(2_500);
    for params in [[0.5, 0.0], [3.0, 0.0], [1.0, -1.0]] {
        let params = [params[0], params[1], 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(station.command(1, MavCmd::MAV_CMD_USER_5, params), MavResult::MAV_RESULT_DENIED);
        assert!(!station.texts().is_empty(), "{params:?}");
    }
}

#[test]
fn wire_ardupilot_interface_has_the_command_too() {
    let mut station = Station::with_flavor(&ardupilot::FLAVOR, "drill-hover", 7);
    station.run_ms(2_500);
    assert_eq!(ask(&mut station, StickRequest::Select(StickResponse::Sport), 0), ACCEPTED);
    station.run_ms(50);
    // ArduPilot sends whole numbers as floats.
    assert_eq!(announced(&station), [1.0_f32.to_bits()]);
}

#[test]
fn flight_tripod_is_slow_at_full_stick() {
    let mut station = Station::airborne("drill-hover", 7);
    assert_eq!(ask(&mut station, StickRequest::Select(StickResponse::Tripod), 0), ACCEPTED);
    for _ in 0..200 {
        station.sticks(1_000, 0, 500, 0);
        station.run_ms(20);
    }
    // The response's limit, and the error of the velocity estimate in the job's wind, m/s.
    assert!((station.speed() - 2.0).abs() < 0.4, "{} m/s", station.speed());
}

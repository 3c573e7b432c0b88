//! Basic requests of ground stations and their responses.

use spandrel_mavlink::dialect::{
    MavCmd, MavMessage, MavMissionType, MavModeFlag, MavResult, MavSysStatusSensor, PARAM_REQUEST_LIST_DATA,
};
use spandrel_testkit::station::Station;

#[test]
fn wire_heartbeat_is_immediate_and_vehicle_can_arm_within_2_s() {
    let mut station = Station::new("two-bridges", 7);
    station.run_ms(100);
    assert!(
        station.last_message(|m| matches!(m, MavMessage::HEARTBEAT(_)).then_some(())).is_some(),
        "a heartbeat must arrive within 0.1 s"
    );
    station.run_ms(1900);
    let healthy = station.last_message(|m| match m {
        MavMessage::SYS_STATUS(s) => Some(s.onboard_control_sensors_health),
        _ => None,
    });
    assert!(
        healthy.unwrap().contains(MavSysStatusSensor::MAV_SYS_STATUS_PREARM_CHECK),
        "the vehicle must be armable within 2 s of simulation time"
    );
}

#[test]
fn wire_commands_are_answered_immediately() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(500);
    let commands = [
        MavCmd::MAV_CMD_NAV_TAKEOFF,
        MavCmd::MAV_CMD_NAV_LAND,
        MavCmd::MAV_CMD_DO_REPOSITION,
        MavCmd::MAV_CMD_DO_SET_MODE,
        MavCmd::MAV_CMD_REQUEST_MESSAGE,
        MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL,
        MavCmd::MAV_CMD_DO_ORBIT,
        MavCmd::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW,
        MavCmd::MAV_CMD_IMAGE_START_CAPTURE,
        MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF,
        MavCmd::MAV_CMD_DO_SET_HOME,
        MavCmd::MAV_CMD_DO_CHANGE_SPEED,
        MavCmd::MAV_CMD_INJECT_FAILURE,
        MavCmd::MAV_CMD_DO_SET_ROI_LOCATION,
    ];
    for command in commands {
        for component in [1, 100] {
            station.command(component, command, [f32::NAN, 1e30, -1.0, 0.0, f32::INFINITY, 91.0, 5.0]);
        }
    }
}

#[test]
fn wire_parameter_list_is_complete() {
    let mut station = Station::new("drill-hover", 7);
    station.send(&MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 0 }));
    station.run_ms(500);
    let mut seen = std::collections::BTreeSet::new();
    let mut count = 0;
    for frame in &station.received {
        // The checksum is not part of the list.
        if let Some(MavMessage::PARAM_VALUE(value)) = &frame.message
            && value.param_index != u16::MAX
        {
            count = value.param_count;
            seen.insert(value.param_index);
        }
    }
    assert!(count > 50);
    assert_eq!(seen.len(), usize::from(count));
}

#[test]
fn wire_empty_mission_has_count_zero() {
    let mut station = Station::new("drill-hover", 7);
    for kind in
        [MavMissionType::MAV_MISSION_TYPE_MISSION, MavMissionType::MAV_MISSION_TYPE_FENCE, MavMissionType::MAV_MISSION_TYPE_RALLY]
    {
        station.send(&MavMessage::MISSION_REQUEST_LIST(spandrel_mavlink::dialect::MISSION_REQUEST_LIST_DATA {
            target_system: 1,
            target_component: 1,
            mission_type: kind,
        }));
        station.run_ms(2);
        let count = station.last_message(|m| match m {
            MavMessage::MISSION_COUNT(c) if c.mission_type == kind => Some(c.count),
            _ => None,
        });
        assert_eq!(count, Some(0));
    }
}

#[test]
fn wire_manual_flight_with_pictures_and_lamp() {
    let mut station = Station::airborne("two-bridges", 7);
    let up = station.last_message(|m| match m {
        MavMessage::LOCAL_POSITION_NED(p) => Some(-p.z),
        _ => None,
    });
    assert!(up.unwrap() > 6.0, "climb of 3 s with 70% of the stick, and its braking: {up:?}");
    let one = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(100, MavCmd::MAV_CMD_IMAGE_START_CAPTURE, one), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(5);
    assert!(
        station.last_message(|m| matches!(m, MavMessage::CAMERA_IMAGE_CAPTURED(c) if c.image_index == 0).then_some(())).is_some()
    );
    let again = [263.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(100, MavCmd::MAV_CMD_REQUEST_MESSAGE, again), MavResult::MAV_RESULT_ACCEPTED);
    let on = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF, on), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(600);
    assert_eq!(station.last_message(|m| if let MavMessage::ILLUMINATOR_STATUS(s) = m { Some(s.enable) } else { None }), Some(1));
    let armed = station.last_message(|m| match m {
        MavMessage::HEARTBEAT(b) => Some(b.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED)),
        _ => None,
    });
    assert!(armed.is_some());
}

#[test]
fn flight_same_inputs_give_the_same_digest_even_from_a_snapshot() {
    let mut a = Station::airborne("two-bridges", 7);
    let mut b = Station::airborne("two-bridges", 7);
    let mut snapshot = a.sim.clone();
    a.run_ms(3000);
    b.run_ms(3000);
    assert_eq!(a.sim.digest(), b.sim.digest());
    let until = a.sim.now();
    snapshot.handle_timeout(until);
    assert_eq!(a.sim.digest(), snapshot.digest());
    let mut c = Station::airborne("two-bridges", 8);
    c.run_ms(3000);
    assert_ne!(a.sim.digest(), c.sim.digest());
}

//! The shell command `listener TOPIC`, which prints a topic's latest values under PX4's names.

use super::super::snapshot::VehicleSnapshot;
use super::super::streams::position;
use spandrel_mavlink::dialect::MavMessage;

type TopicFields = Vec<(&'static str, String)>;
type ShellTopic = (&'static str, fn(&VehicleSnapshot) -> TopicFields);

const TOPICS: [ShellTopic; 6] = [
    ("battery_status", battery),
    ("sensor_combined", sensors),
    ("vehicle_attitude", attitude),
    ("vehicle_global_position", global_position),
    ("vehicle_local_position", local_position),
    ("vehicle_status", status),
];

pub(super) fn listen(view: &VehicleSnapshot, rest: &[&str]) -> String {
    let found = rest.first().and_then(|topic| TOPICS.iter().find(|(name, _)| name == topic));
    let Some((name, fields)) = found else {
        let known = TOPICS.map(|(name, _)| format!("  {name}\n")).concat();
        return format!("Usage: listener TOPIC\nTopics:\n{known}");
    };
    let lines: Vec<String> = fields(view).iter().map(|(field, value)| format!("    {field}: {value}\n")).collect();
    format!("\nTOPIC: {name}\n {name}\n    timestamp: {}\n{}\n", view.clock.boot_time_us(), lines.concat())
}

fn vector(values: &[f64]) -> String {
    let numbers: Vec<String> = values.iter().map(|value| format!("{value:.5}")).collect();
    format!("[{}]", numbers.join(", "))
}

fn battery(v: &VehicleSnapshot) -> TopicFields {
    vec![
        ("voltage_v", format!("{:.5}", v.battery.voltage_v)),
        ("current_a", format!("{:.5}", v.battery.current_a)),
        ("remaining", format!("{:.5}", v.battery.remaining_pct() / 100.0)),
    ]
}

fn sensors(v: &VehicleSnapshot) -> TopicFields {
    let Some(imu) = &v.readings.imu else { return TopicFields::new() };
    vec![("gyro_rad", vector(&imu.rates_rad_s.array())), ("accelerometer_m_s2", vector(&imu.specific_force_m_s2.array()))]
}

fn attitude(v: &VehicleSnapshot) -> TopicFields {
    let (roll, pitch, yaw) = v.estimate.attitude.euler();
    let degrees = [roll, pitch, yaw].map(f64::to_degrees);
    vec![(
        "q",
        format!(
            "{} (Roll: {:.1} deg, Pitch: {:.1} deg, Yaw: {:.1} deg)",
            vector(&v.estimate.attitude.wxyz()),
            degrees[0],
            degrees[1],
            degrees[2]
        ),
    )]
}

fn global_position(v: &VehicleSnapshot) -> TopicFields {
    let geo = v.geo();
    vec![
        ("lat", format!("{:.7}", geo.latitude_deg)),
        ("lon", format!("{:.7}", geo.longitude_deg)),
        ("alt", format!("{:.5}", geo.altitude_m)),
        ("eph", format!("{:.5}", v.estimate.horizontal_m)),
        ("epv", format!("{:.5}", v.estimate.vertical_m)),
    ]
}

fn local_position(v: &VehicleSnapshot) -> TopicFields {
    // Same frame as the streamed message.
    let Some(MavMessage::LOCAL_POSITION_NED(p)) = position::local(v) else { return TopicFields::new() };
    let number = |value: f32| format!("{value:.5}");
    vec![
        ("x", number(p.x)),
        ("y", number(p.y)),
        ("z", number(p.z)),
        ("vx", number(p.vx)),
        ("vy", number(p.vy)),
        ("vz", number(p.vz)),
        ("xy_valid", v.estimate.position_valid.to_string()),
    ]
}

fn status(v: &VehicleSnapshot) -> TopicFields {
    vec![
        ("arming_state", if v.status.armed { "2" } else { "1" }.to_owned()),
        ("nav_state", v.mode_row().name.to_owned()),
        ("failsafe", v.status.failsafe.is_some().to_string()),
        ("system_id", v.system_id.to_string()),
    ]
}

//! Plans for the drill site: mission items, and uploads that answer the vehicle's requests.
#![allow(deprecated, reason = "clients still send superseded MAVLink messages")]

use crate::station::Station;
use spandrel_mavlink::dialect::*;

const NAN: f32 = f32::NAN;
/// Degrees of latitude per meter (40,000 km circumference).
const DEGREES_PER_METER: f64 = 360.0 / 40_000_000.0;

pub fn origin() -> (i32, i32) {
    let origin = crate::shipped::scenario("drill-hover").origin;
    ((origin.latitude_deg * 1e7).round() as i32, (origin.longitude_deg * 1e7).round() as i32)
}

pub fn item(seq: u16, command: MavCmd, north_m: f64, z: f32) -> MISSION_ITEM_INT_DATA {
    let (lat, lon) = origin();
    MISSION_ITEM_INT_DATA {
        param4: NAN,
        x: lat + (north_m * DEGREES_PER_METER * 1e7).round() as i32,
        y: lon,
        z,
        seq,
        command,
        target_system: 1,
        target_component: 1,
        frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
        autocontinue: 1,
        ..Default::default()
    }
}

/// Returns the position of the landing pad, in meters north of the origin.
pub fn home_north(station: &Station) -> f64 {
    station.site_position_m()[0]
}

pub fn count(count: u16, mission_type: MavMissionType) -> MavMessage {
    MavMessage::MISSION_COUNT(MISSION_COUNT_DATA { count, target_system: 1, target_component: 1, mission_type, opaque_id: 0 })
}

pub fn asked(m: &MavMessage) -> Option<u16> {
    match m {
        MavMessage::MISSION_REQUEST_INT(r) => Some(r.seq),
        MavMessage::MISSION_REQUEST(r) => Some(r.seq),
        _ => None,
    }
}

pub fn result(m: &MavMessage) -> Option<MavMissionResult> {
    if let MavMessage::MISSION_ACK(a) = m { Some(a.mavtype) } else { None }
}

pub const PLAN: MavMissionType = MavMissionType::MAV_MISSION_TYPE_MISSION;
pub const ACCEPTED: MavMissionResult = MavMissionResult::MAV_MISSION_ACCEPTED;

/// Uploads the requested items and returns the final acknowledgment.
pub fn upload(station: &mut Station, items: &[MISSION_ITEM_INT_DATA]) -> MavMissionResult {
    let kind = items.first().map_or(PLAN, |i| i.mission_type);
    let mut wanted = station.ask(&count(items.len() as u16, kind), asked);
    while let Some(seq) = wanted {
        station.received.clear();
        station.send(&MavMessage::MISSION_ITEM_INT(items[usize::from(seq)].clone()));
        station.run_ms(1);
        wanted = station.last_message(asked);
    }
    station.last_message(result).expect("every upload must end with an acknowledgment")
}

pub fn ready(seed: u64) -> Station {
    let mut station = Station::new("drill-hover", seed);
    station.run_ms(2_500);
    station
}

//! PX4 events in flight, as a client with the vehicle's event definitions reads them.

use spandrel_mavlink::dialect::*;
use spandrel_sitl::endpoint::params::metadata;
use spandrel_sitl::endpoint::params::param_view::PX4;
use spandrel_testkit::station::{Station, one, p};
use std::collections::BTreeMap;
use std::io::Cursor;

const SET_MODE: MavCmd = MavCmd::MAV_CMD_DO_SET_MODE;

/// Returns the messages by event ID, from the definition file on the vehicle.
fn definitions() -> BTreeMap<u32, String> {
    let mut text = Vec::new();
    let file = metadata::files(&PX4).events.as_ref().expect("the metadata must list an event file");
    lzma_rs::xz_decompress(&mut Cursor::new(&file.bytes), &mut text).unwrap();
    let file: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let mut out = BTreeMap::new();
    for (component, definitions) in file["components"].as_object().unwrap() {
        for group in definitions["event_groups"].as_object().unwrap().values() {
            for (id, event) in group["events"].as_object().unwrap() {
                let id = component.parse::<u32>().unwrap() << 24 | id.parse::<u32>().unwrap();
                out.insert(id, event["message"].as_str().unwrap().to_owned());
            }
        }
    }
    out
}

/// Returns the texts of all events so far as a client shows them, with their external log levels.
fn shown(station: &Station) -> Vec<(String, u8)> {
    let known = definitions();
    station.all(|m| {
        let MavMessage::EVENT(event) = m else { return None };
        let message = known.get(&event.id).unwrap_or_else(|| panic!("event {} has no definition", event.id));
        Some((message.clone(), event.log_levels & 0xf))
    })
}

fn assert_shown(station: &Station, message: &str, level: u8) {
    let all = shown(station);
    assert!(all.contains(&(message.to_owned(), level)), "{message}, {level}: {all:?}");
}

#[test]
fn regress_rejections_takeoff_landing_and_rc_loss_are_sent_as_events() {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(2_500);
    assert_ne!(station.command(1, SET_MODE, p(&[1.0, 4.0, 4.0])), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(10);
    assert_shown(&station, "No mission to fly", 2);
    station.sticks(0, 900, 500, 0);
    station.run_ms(60);
    assert_ne!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, one(1.0)), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(10);
    assert_shown(&station, "Arming denied", 2);
    station.sticks(0, 0, 500, 0);
    station.run_ms(60);
    station.climb_manually();
    assert_shown(&station, "Takeoff detected", 6);
    // The pilot stops sending.
    station.run_ms(2_000);
    assert_shown(&station, "Failsafe: manual control lost", 2);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_LAND, p(&[])), MavResult::MAV_RESULT_ACCEPTED);
    assert!(station.run_until(60.0, |s| s.has_text("Landing detected")), "{:?}", station.texts());
    assert_shown(&station, "Landing detected", 6);
}

/// PX4 marks a text that an event repeats with a tab, and QGroundControl then shows only the event. Information that
/// the event omits must stay readable.
#[test]
fn regress_texts_that_are_also_events_end_with_a_tab() {
    let mut station = Station::airborne("drill-hover", 7);
    station.run_ms(2_000);
    let texts = station.texts();
    assert!(texts.contains(&"Takeoff detected\t".to_owned()) && texts.contains(&"Armed".to_owned()), "{texts:?}");
    let mut grounded = Station::new("drill-hover", 7);
    grounded.run_ms(2_500);
    grounded.sticks(0, 900, 500, 0);
    grounded.run_ms(60);
    grounded.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, one(1.0));
    grounded.run_ms(10);
    assert!(grounded.texts().contains(&"Arming denied: Sticks not centered".to_owned()), "{:?}", grounded.texts());
}

#[test]
fn regress_mission_end_and_fence_breach_are_events() {
    let known = definitions();
    for message in ["Mission finished", "Geofence breached", "Low battery", "Critical battery", "Failsafe: ground station lost"] {
        assert!(known.values().any(|own| own == message), "{message}");
    }
    let mut station = Station::airborne("drill-hover", 7);
    // The limit is below the current height.
    let low = MavParamType::MAV_PARAM_TYPE_REAL32;
    assert_eq!(station.set("GF_MAX_VER_DIST", 1.0, low), Some(1.0));
    station.run_ms(1_000);
    assert_shown(&station, "Geofence breached", 2);
}

//! Landings away from home and crashes: whether the vehicle stays or respawns.

use spandrel_mavlink::dialect::*;
use spandrel_model::scenario::AfterCrash;
use spandrel_testkit::shipped::scenario;
use spandrel_testkit::station::{Station, one, p};

/// Flies the vehicle forward with the sticks until it has left the home circle.
fn fly_away(station: &mut Station) {
    let pad = scenario("drill-hover").ground_team.pad_m;
    let away = |station: &Station| (station.sim.truth().rigid.position_m.enu() - pad).horizontal_norm();
    for _ in 0..600 {
        station.sticks(if away(station) < 11.0 { 400 } else { 0 }, 0, 500, 0);
        station.run_ms(20);
    }
    assert!(away(station) > 8.0, "{} m from the pad", away(station));
}

/// After a soft landing 12 m from the pad, the vehicle must stay there for ten seconds and then take off again.
#[test]
fn regress_vehicle_takes_off_again_after_a_soft_landing_away_from_home() {
    let mut station = Station::airborne("drill-hover", 7);
    fly_away(&mut station);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_NAV_LAND, p(&[])), MavResult::MAV_RESULT_ACCEPTED);
    station.received.clear();
    assert!(station.run_until(60.0, |s| s.has_text("Disarmed by landing")), "{:?}", station.texts());
    station.received.clear();
    station.run_ms(10_000);
    let armed = station.last_message(|m| match m {
        MavMessage::HEARTBEAT(b) if b.autopilot == MavAutopilot::MAV_AUTOPILOT_PX4 => {
            Some(b.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED))
        }
        _ => None,
    });
    assert_eq!(armed, Some(false), "{:?}", station.texts());
    assert!(!station.has_text("Respawned at"), "{:?}", station.texts());
    let stands_m = station.sim.truth().rigid.position_m;
    assert_eq!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, one(1.0)), MavResult::MAV_RESULT_ACCEPTED);
    let takeoff = MavCmd::MAV_CMD_NAV_TAKEOFF;
    let nan = f32::NAN;
    assert_eq!(station.command(1, takeoff, [0.0, 0.0, 0.0, nan, nan, nan, nan]), MavResult::MAV_RESULT_ACCEPTED);
    station.run_ms(8_000);
    let risen_m = (station.sim.truth().rigid.position_m - stands_m).down();
    // The takeoff height is 2.5 m above home.
    assert!(risen_m < -1.5 && !station.has_text("Respawned at"), "{risen_m} {:?}", station.texts());
}

/// Lets the vehicle fall from 5 m with its motors stopped. Returns the number of respawns within 15 s.
fn respawns_after_a_fall(rule: Option<AfterCrash>) -> usize {
    let mut station = Station::with_crash_rule("drill-hover", 7, rule);
    station.climb_manually();
    fly_away(&mut station);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, p(&[0.0, 21196.0])), MavResult::MAV_RESULT_ACCEPTED);
    station.received.clear();
    station.run_ms(15_000);
    station.texts().iter().filter(|text| text.contains("Respawned at")).count()
}

#[test]
fn regress_crash_action_follows_the_scenario_or_the_operator() {
    assert_eq!(scenario("drill-hover").rules.after_crash, AfterCrash::Respawn);
    assert_eq!(respawns_after_a_fall(None), 1);
    assert_eq!(respawns_after_a_fall(Some(AfterCrash::Continue)), 0);
}

//! The exported plan is flown by the mission mode: every task on its path, nothing touched, pictures taken.
#![allow(deprecated, reason = "ground stations still write DO_MOUNT_CONTROL into plans")]

use super::plans::{ACCEPTED, upload};
use super::station::{Station, scenario, shipped};
use serde_json::Value;
use spandrel::base::frames::{Enu, Vec3};
use spandrel::base::time::SimTime;
use spandrel::mav::dialect::*;
use spandrel::pilot::flight_plan;
use spandrel::pilot::job::Map;
use spandrel::site::Site;

/// Share of a task's reference points that must be passed within its threshold: the estimate strays by its own error, and a lone
/// point at an end may be missed.
const COVERED: f64 = 0.97;
/// The flight of all four tasks takes less, s of simulation time (battery of the paper: 25 minutes).
const LIMIT_S: f64 = 1_500.0;

fn plan(name: &str) -> (Vec<MISSION_ITEM_INT_DATA>, Value) {
    let scenario = scenario(name);
    let file = "vehicle-params/phantom2.toml";
    let vehicle = spandrel::vehicle::read(file, &shipped(file)).unwrap();
    let site = Site::build(&scenario, 7);
    let plan = flight_plan::plan(&Map { scenario: &scenario, site: &site, vehicle: &vehicle, at: SimTime::ZERO });
    let items = plan["mission"]["items"].as_array().unwrap().iter().enumerate().map(|(k, item)| as_item(k, item)).collect();
    (items, plan)
}

/// As a ground station reads an item.
fn as_item(k: usize, item: &Value) -> MISSION_ITEM_INT_DATA {
    let number = |at: usize| item["params"][at].as_f64().unwrap_or(f64::NAN);
    let placed = item["frame"] == 3;
    let scaled = |value: f64| if placed { (value * 1e7).round() as i32 } else { value as i32 };
    let frame = if placed { MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT } else { MavFrame::MAV_FRAME_MISSION };
    let command = known_command(item["command"].as_u64().unwrap());
    MISSION_ITEM_INT_DATA {
        param1: number(0) as f32,
        param2: number(1) as f32,
        param3: number(2) as f32,
        param4: number(3) as f32,
        x: scaled(number(4)),
        y: scaled(number(5)),
        z: number(6) as f32,
        seq: k as u16,
        command,
        target_system: 1,
        target_component: 1,
        frame,
        autocontinue: 1,
        ..Default::default()
    }
}

fn known_command(command: u64) -> MavCmd {
    use MavCmd as M;
    let known = [
        M::MAV_CMD_NAV_WAYPOINT,
        M::MAV_CMD_NAV_RETURN_TO_LAUNCH,
        M::MAV_CMD_NAV_TAKEOFF,
        M::MAV_CMD_DO_CHANGE_SPEED,
        M::MAV_CMD_DO_SET_ACTUATOR,
        M::MAV_CMD_DO_MOUNT_CONTROL,
        M::MAV_CMD_IMAGE_START_CAPTURE,
        M::MAV_CMD_IMAGE_STOP_CAPTURE,
    ];
    *known.iter().find(|c| **c as u64 == command).unwrap_or_else(|| panic!("command {command} is not in the plan's vocabulary"))
}

#[test]
fn flight_the_exported_plan_flies_every_task_on_its_path_and_touches_nothing() {
    let (items, _) = plan("two-bridges");
    let job = scenario("two-bridges");
    let mut station = Station::new("two-bridges", 7);
    station.run_ms(2_500);
    assert_eq!(upload(&mut station, &items), ACCEPTED);
    assert_eq!(station.command(1, MavCmd::MAV_CMD_MISSION_START, [0.0; 7]), MavResult::MAV_RESULT_ACCEPTED);
    let arm = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    assert_eq!(station.command(1, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, arm), MavResult::MAV_RESULT_ACCEPTED);
    let mut passed: Vec<Vec<bool>> = job.tasks.iter().map(|task| vec![false; task.path_m.len()]).collect();
    let (mut hits, mut pictures, mut landed) = (0, 0, false);
    for _ in 0..(LIMIT_S * 10.0) as usize {
        station.heard.clear();
        station.run_ms(100);
        let here = station.sim.truth().rigid.position_m.enu();
        for (task, passed) in job.tasks.iter().zip(&mut passed) {
            task.path_m.iter().zip(passed).for_each(|(point, seen)| *seen |= (*point - here).norm() <= task.threshold_m);
        }
        for frame in &station.heard {
            match &frame.message {
                Some(MavMessage::NAMED_VALUE_INT(v)) if v.name.to_str() == Ok("hits") => hits = v.value,
                Some(MavMessage::CAMERA_IMAGE_CAPTURED(_)) => pictures += 1,
                Some(MavMessage::STATUSTEXT(t)) if t.text.to_str() == Ok("Disarmed by landing") => landed = true,
                _ => {}
            }
        }
        if landed {
            break;
        }
    }
    assert!(landed, "it comes home, from {:?} at {}", station.place(), station.sim.now());
    // Standing down on the pad is a contact; nothing else is.
    assert!(hits <= 1, "{hits} contacts");
    for (task, passed) in job.tasks.iter().zip(&passed) {
        let share = passed.iter().filter(|seen| **seen).count() as f64 / passed.len() as f64;
        assert!(share >= COVERED, "task {}: {share} of the path", task.name);
    }
    assert!(pictures > 40, "{pictures} pictures");
}

#[test]
fn exact_the_plan_has_what_ground_stations_ask_of_it() {
    let (items, plan) = plan("two-bridges");
    assert_eq!((plan["fileType"].as_str(), plan["version"].as_u64()), (Some("Plan"), Some(1)));
    let mission = &plan["mission"];
    for key in ["cruiseSpeed", "firmwareType", "hoverSpeed", "items", "plannedHomePosition", "vehicleType", "version"] {
        assert!(!mission[key].is_null(), "{key}");
    }
    for (k, item) in mission["items"].as_array().unwrap().iter().enumerate() {
        assert_eq!(item["doJumpId"], k as u64 + 1);
        assert_eq!(item["params"].as_array().map(Vec::len), Some(7));
    }
    let pad: Vec3<Enu> = scenario("two-bridges").ground_team.pad_m;
    assert!(pad.is_finite());
    // A plan that leads below the pad's level does so on purpose only: over the lake.
    let lowest = items.iter().filter(|i| i.command == MavCmd::MAV_CMD_NAV_WAYPOINT).map(|i| i.z).fold(f32::INFINITY, f32::min);
    let water = scenario("two-bridges").terrain.water_level_m - pad.up();
    assert!(f64::from(lowest) > water + 1.0, "{lowest} m over home, the water at {water} m");
}

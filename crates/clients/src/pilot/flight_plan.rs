//! Export of a job as a QGroundControl plan file
//! (<https://docs.qgroundcontrol.com/master/en/qgc-dev-user-guide/file_formats/plan.html>): reference paths of the
//! tasks, transits, speeds, gimbal and lamp commands, and pictures.

use super::goals::{FlightGoal, PlanningContext, hover_point_over_pad};
use super::track::TrackLeg;
use serde_json::{Value, json};
use spandrel_mavlink::dialect::{MavAutopilot, MavType};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::math;

/// Maximum spacing of task waypoints, m. Turns and line-of-sight changes also add waypoints.
const TASK_WAYPOINT_SPACING_M: f64 = 4.0;
const TRANSIT_WAYPOINT_SPACING_M: f64 = 12.0;
const MIN_TURN_ANGLE_RAD: f64 = 0.15;
/// Waypoint acceptance radius, m: the narrowest task threshold in the supplied jobs minus the expected path error
/// (estimate).
const TASK_ACCEPTANCE_RADIUS_M: f64 = 0.8;
const TRANSIT_ACCEPTANCE_RADIUS_M: f64 = 1.2;
/// Maximum leg speed as a fraction of the job's speed limit, which leaves a margin for gusts and estimator error
/// (estimate).
const SPEED_LIMIT_FRACTION: f64 = 0.9;
/// Clearance added to the job's "too close" distance in transit, m (estimate: GNSS drift reaches 1 m, and corners are
/// rounded).
const EXTRA_CLEARANCE_M: f64 = 2.0;
/// Minimum change in gimbal pitch that adds a mission item, degrees.
const GIMBAL_STEP_DEG: f64 = 3.0;
/// Interval between pictures during a task, s (estimate: one for every few meters of path).
const PICTURE_INTERVAL_S: f64 = 2.0;

/// Mission item frames: MAV_FRAME_GLOBAL_RELATIVE_ALT and MAV_FRAME_MISSION.
const FRAME_RELATIVE_ALT: u8 = 3;
const FRAME_MISSION: u8 = 2;
/// Command numbers in the MAVLink common dialect.
const CMD_WAYPOINT: u16 = 16;
const CMD_RETURN: u16 = 20;
const CMD_TAKEOFF: u16 = 22;
const CMD_CHANGE_SPEED: u16 = 178;
const CMD_SET_ACTUATOR: u16 = 187;
const CMD_MOUNT_CONTROL: u16 = 205;
const CMD_START_CAPTURE: u16 = 2000;
const CMD_STOP_CAPTURE: u16 = 2001;
/// Value of MAV_MOUNT_MODE_MAVLINK_TARGETING in a plan item.
const MOUNT_MODE_TARGETING: f64 = 2.0;

/// Builds an ordered list of mission items.
struct PlanWriter {
    plane: LocalPlane,
    pad_height_m: f64,
    items: Vec<Value>,
    speed_m_s: f64,
    max_leg_speed_m_s: f64,
    pitch_deg: f64,
}

impl PlanWriter {
    fn item(&mut self, command: u16, frame: u8, params: [Option<f64>; 7]) {
        let mut item = json!({
            "autoContinue": true,
            "command": command,
            "doJumpId": self.items.len() + 1,
            "frame": frame,
            "params": params,
            "type": "SimpleItem",
        });
        if frame == FRAME_RELATIVE_ALT {
            item["Altitude"] = json!(params[6]);
            // 1: altitude relative to home.
            item["AltitudeMode"] = json!(1);
            item["AMSLAltAboveTerrain"] = Value::Null;
        }
        self.items.push(item);
    }

    fn command_item(&mut self, command: u16, params: [f64; 7]) {
        self.item(command, FRAME_MISSION, params.map(Some));
    }

    fn geo_position(&self, point_m: Vec3<Enu>) -> [f64; 3] {
        let geo = self.plane.geo_from_enu(point_m);
        [geo.latitude_deg, geo.longitude_deg, point_m.up() - self.pad_height_m]
    }

    fn waypoint(&mut self, point_m: Vec3<Enu>, acceptance_radius_m: f64, yaw_deg: Option<f64>) {
        let [lat, lon, height] = self.geo_position(point_m).map(Some);
        self.item(CMD_WAYPOINT, FRAME_RELATIVE_ALT, [Some(0.0), Some(acceptance_radius_m), Some(0.0), yaw_deg, lat, lon, height]);
    }

    fn set_speed(&mut self, speed_m_s: f64) {
        let speed_m_s = speed_m_s.min(self.max_leg_speed_m_s);
        if (self.speed_m_s - speed_m_s).abs() > 0.05 {
            self.speed_m_s = speed_m_s;
            self.command_item(CMD_CHANGE_SPEED, [1.0, speed_m_s, -1.0, 0.0, 0.0, 0.0, 0.0]);
        }
    }

    fn tilt_gimbal(&mut self, pitch_deg: f64) {
        if (self.pitch_deg - pitch_deg).abs() > GIMBAL_STEP_DEG {
            self.pitch_deg = pitch_deg;
            self.command_item(CMD_MOUNT_CONTROL, [pitch_deg, 0.0, 0.0, 0.0, 0.0, 0.0, MOUNT_MODE_TARGETING]);
        }
    }

    fn set_lamp(&mut self, on: bool) {
        let value = if on { 1.0 } else { -1.0 };
        self.item(CMD_SET_ACTUATOR, FRAME_MISSION, [Some(value), None, None, None, None, None, Some(0.0)]);
    }

    fn leg(&mut self, leg: &TrackLeg) {
        for k in waypoint_indices(leg) {
            let task = leg.task[k].is_some();
            self.set_speed(leg.speed_m_s[k]);
            let look = leg.line_of_sight[k];
            if let Some(look) = look {
                self.tilt_gimbal(math::atan2(look.up(), look.horizontal_norm()).to_degrees());
            }
            let yaw_deg = look.map(|look| math::bearing_deg(look.east(), look.north()));
            let accept_m = if task { TASK_ACCEPTANCE_RADIUS_M } else { TRANSIT_ACCEPTANCE_RADIUS_M };
            self.waypoint(leg.points_m[k], accept_m, yaw_deg);
        }
    }
}

/// Returns the indices of the leg points that become waypoints: both ends, every turn, and one per stride.
fn waypoint_indices(leg: &TrackLeg) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    for k in 0..leg.points_m.len() {
        let last = kept.last().copied();
        let stride = if leg.task[k].is_some() { TASK_WAYPOINT_SPACING_M } else { TRANSIT_WAYPOINT_SPACING_M };
        let end = k == 0 || k + 1 == leg.points_m.len();
        let far = last.is_none_or(|last| (leg.points_m[k] - leg.points_m[last]).norm() >= stride);
        if end || far || is_turn(leg, k) || leg.task[k] != leg.task[k - 1] || leg.speed_m_s[k] != leg.speed_m_s[k - 1] {
            kept.push(k);
        }
    }
    kept
}

fn is_turn(leg: &TrackLeg, k: usize) -> bool {
    let way = |a: usize, b: usize| (leg.points_m[b] - leg.points_m[a]).unit();
    let angle = |a: Vec3<Enu>, b: Vec3<Enu>| math::acos(a.dot(b).clamp(-1.0, 1.0));
    let bent = angle(way(k - 1, k), way(k, k + 1)) > MIN_TURN_ANGLE_RAD;
    bent || matches!((leg.line_of_sight[k - 1], leg.line_of_sight[k]), (Some(before), Some(now)) if angle(before, now) > MIN_TURN_ANGLE_RAD)
}

/// Returns the plan: takeoff, all tasks in order (with pictures), and return to launch. Altitudes are relative to the
/// landing pad, which becomes home. `firmware` is the target autopilot.
#[must_use]
pub fn plan(map: &PlanningContext, firmware: MavAutopilot) -> Value {
    let scenario = map.scenario;
    let map = &PlanningContext { transit_clearance_m: Some(scenario.feedback.too_close_m + EXTRA_CLEARANCE_M), ..*map };
    let pad = scenario.ground_team.pad_m;
    let plane = LocalPlane::new(scenario.origin);
    let home = plane.geo_from_enu(pad);
    let max_leg_speed_m_s = SPEED_LIMIT_FRACTION * scenario.scoring.speed_limit_m_s;
    let mut w = PlanWriter {
        plane,
        pad_height_m: pad.up(),
        items: Vec::new(),
        speed_m_s: 0.0,
        max_leg_speed_m_s,
        pitch_deg: f64::INFINITY,
    };
    let mut here = hover_point_over_pad(scenario);
    let [lat, lon, height] = w.geo_position(here).map(Some);
    w.item(CMD_TAKEOFF, FRAME_RELATIVE_ALT, [Some(0.0), Some(0.0), Some(0.0), None, lat, lon, height]);
    for (index, task) in scenario.tasks.iter().enumerate() {
        let leg = map.leg(FlightGoal::Task(index), here);
        let start = leg.task.iter().position(Option::is_some).unwrap_or(0);
        let (way, path) = leg.split_at(start);
        w.leg(&way);
        if task.dark {
            w.set_lamp(true);
        }
        w.command_item(CMD_START_CAPTURE, [0.0, PICTURE_INTERVAL_S, 0.0, 0.0, 0.0, 0.0, 0.0]);
        w.leg(&path);
        w.command_item(CMD_STOP_CAPTURE, [0.0; 7]);
        if task.dark {
            w.set_lamp(false);
        }
        here = path.points_m.last().copied().unwrap_or(here);
    }
    w.leg(&map.leg(FlightGoal::Home, here));
    w.item(CMD_RETURN, FRAME_MISSION, [Some(0.0); 7]);
    plan_file(w.items, home, firmware, max_leg_speed_m_s)
}

fn plan_file(items: Vec<Value>, home: Geo, firmware: MavAutopilot, speed_m_s: f64) -> Value {
    json!({
        "fileType": "Plan",
        "version": 1,
        "groundStation": "QGroundControl",
        "geoFence": { "circles": [], "polygons": [], "version": 2 },
        "rallyPoints": { "points": [], "version": 2 },
        "mission": {
            "version": 2,
            "firmwareType": firmware as u8,
            "vehicleType": MavType::MAV_TYPE_QUADROTOR as u8,
            "globalPlanAltitudeMode": 1,
            "cruiseSpeed": speed_m_s,
            "hoverSpeed": speed_m_s,
            "plannedHomePosition": [home.latitude_deg, home.longitude_deg, home.altitude_m],
            "items": items,
        },
    })
}

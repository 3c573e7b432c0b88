//! A row of the frame export: a frame with attitude, gimbal, task, path distance, wind and estimated position.

use crate::assessment::{AssessError, IdentifiedFlight, identified_flight};
use crate::measures::on_path::{OnPath, ReferencePaths};
use crate::session::Session;
use spandrel_mavlink::telemetry::log_stream::TelemetryLog;
use spandrel_mavlink::telemetry::{Flight, Frame, Navigation, NavigationReader};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::scenario::Scenario;
use spandrel_model::vehicle::Vehicle;

/// The drone's distance from a task's path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskDistance {
    /// Task number in the scenario.
    pub id: u32,
    /// Distance to the task's path, m.
    pub distance_m: Option<f64>,
}

/// One row of the frame export. `None` means that the telemetry has no value for this frame.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameRow {
    /// The scored frame.
    pub frame: Frame,
    /// Time since lift-off, s.
    pub since_lift_off_s: f64,
    /// True roll, pitch and yaw, rad.
    pub roll_pitch_yaw_rad: Option<[f64; 3]>,
    /// Camera pitch relative to the horizon, rad, positive up.
    pub gimbal_pitch_rad: Option<f64>,
    /// Task whose path the drone is on or, if none, the last task entered.
    pub task: Option<TaskDistance>,
    /// Whether the drone is on a task's path.
    pub on_path: bool,
    /// Distance to the nearest surface, m.
    pub clearance_m: Option<f64>,
    /// Wind velocity over ground, m/s.
    pub wind_m_s: Option<Vec3<Enu>>,
    /// Position estimated by the autopilot, m.
    pub estimate_m: Option<Vec3<Enu>>,
}

/// Reads the scored frames from a telemetry log and adds the data for all export columns.
///
/// # Errors
/// Fails if the log cannot be read, belongs to a different scenario or seed, or contains no session.
pub fn frame_rows(
    log: &(impl TelemetryLog + ?Sized),
    scenario: &Scenario,
    vehicle: &Vehicle,
) -> Result<Vec<FrameRow>, AssessError> {
    let (timeline, navigation) = NavigationReader::read_log(log, LocalPlane::new(scenario.origin))?;
    let IdentifiedFlight { epoch, flight, .. } = identified_flight(&timeline, scenario, vehicle)?;
    let session = Session::from_flight(&flight, scenario, vehicle).ok_or(AssessError::NeverFlown)?;
    Ok(rows(session.frames, &flight, &navigation.of(epoch), scenario))
}

/// Adds the remaining export columns to the frames of one flight.
#[must_use]
pub fn rows(frames: Vec<Frame>, flight: &Flight, navigation: &Navigation, scenario: &Scenario) -> Vec<FrameRow> {
    let Some(start) = frames.first().map(|frame| frame.time) else { return Vec::new() };
    let paths = ReferencePaths::new(scenario);
    let on_path = OnPath::measure(&paths, frames.iter().map(|frame| frame.position_m));
    let mut entered: Option<usize> = None;
    let row = |(frame, on): (Frame, &Option<(usize, usize)>)| {
        entered = on.map(|(task, _)| task).or(entered);
        let known = !frame.missing;
        let task = entered.map(|task| TaskDistance {
            id: scenario.tasks[task].id,
            distance_m: paths.nearest(task, frame.position_m).map(|nearest| nearest.distance_m),
        });
        let attitude = flight.between(frame.time).filter(|_| known).map(|between| between.motion.ned_from_frd.euler());
        FrameRow {
            // Dividing by 1e9 yields the double nearest to the decimal value, which prints with few digits. Multiplying
            // by 1e-9 does not.
            since_lift_off_s: (frame.time - start).ns() as f64 / 1e9,
            roll_pitch_yaw_rad: attitude.map(|(roll, pitch, yaw)| [roll, pitch, yaw]),
            gimbal_pitch_rad: flight.gimbal.at(frame.time).filter(|_| known),
            task,
            on_path: on.is_some(),
            clearance_m: frame.clearance_m.filter(|_| known),
            wind_m_s: navigation.wind_m_s(frame.time).filter(|_| known),
            estimate_m: navigation.estimate_m(flight, frame.time).filter(|_| known),
            frame,
        }
    };
    frames.into_iter().zip(&on_path.task).map(row).collect()
}

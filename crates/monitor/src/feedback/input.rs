//! Inputs to the feedback rules.

use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_model::time::SimTime;

/// The drone's position relative to one task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskProximity {
    /// Distance to the task's path (l*), m.
    pub distance_m: f64,
    /// The task's on-path threshold, m.
    pub threshold_m: f64,
    /// Minimum clearance in this task, m; `None` to use the scenario's value.
    pub too_close_m: Option<f64>,
    /// Task number in the scenario.
    pub id: u32,
    /// Whether the trainee may leave the task because its path was flown or the drone is nearest to an end of the path.
    pub may_leave_task: bool,
}

/// Inputs to the feedback rules at one time step.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackInput {
    /// Current simulation time.
    pub time: SimTime,
    /// Whether the session is running (from lift-off to its end).
    pub in_session: bool,
    /// Whether the drone is in the air. On the ground, proximity warnings are suppressed.
    pub airborne: bool,
    /// Speed (magnitude of the velocity), m/s.
    pub speed_m_s: f64,
    /// Remaining battery charge, %.
    pub battery_pct: Option<f64>,
    /// Distance to the nearest surface, m.
    pub clearance_m: Option<f64>,
    /// Kind of object in contact, excluding touchdowns on the pad.
    pub contact: ContactKind,
    /// Name of the object in contact, if the site knows it.
    pub contact_name: Option<String>,
    /// The drone's proximity to each task, in scenario order.
    pub tasks: Vec<TaskProximity>,
    /// Index of the task whose path the drone is on, if any.
    pub current_task: Option<usize>,
    /// Index of the last task entered, if any.
    pub last_task: Option<usize>,
}

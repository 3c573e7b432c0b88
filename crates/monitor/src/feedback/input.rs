//! Input of the feedback rules.

use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_model::time::SimTime;

/// Position of the drone relative to one task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskProximity {
    /// Distance to the task's path (l*), m.
    pub distance_m: f64,
    /// On-path threshold of the task, m.
    pub threshold_m: f64,
    /// Too-close distance specific to the task, m.
    pub too_close_m: Option<f64>,
    /// Task number.
    pub id: u32,
    /// Whether moving away ends the task: its path has been flown, or the nearest point is an end of the path.
    pub may_leave: bool,
}

/// Input of the feedback rules at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct FeedbackInput {
    /// Simulation time.
    pub time: SimTime,
    /// Whether the session is running, from lift-off to its end.
    pub in_session: bool,
    /// Whether the drone is airborne. On the ground, proximity warnings are suppressed.
    pub airborne: bool,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Remaining battery, %.
    pub battery_pct: Option<f64>,
    /// Distance to the nearest surface, m.
    pub clearance_m: Option<f64>,
    /// Contact after applying the pad rule.
    pub contact: ContactKind,
    /// Name of the object in contact, if the site provides one.
    pub touched: Option<String>,
    /// Proximity to each task, in scenario order.
    pub tasks: Vec<TaskProximity>,
    /// Index of the task whose path the drone is on.
    pub current_task: Option<usize>,
    /// Index of the last task entered.
    pub last: Option<usize>,
}

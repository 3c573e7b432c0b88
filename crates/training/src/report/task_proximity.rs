//! The drone's position relative to the tasks in each frame, and totals for each task window.

use super::context::ReviewContext;
use spandrel_mavlink::telemetry::Frame;
use spandrel_monitor::measures::on_path::{OnPath, ReferencePaths};
use spandrel_monitor::measures::on_speed;

/// The drone's position relative to the tasks in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskProximityStep {
    /// Index of the task that the distance refers to: the last task entered, or the nearest one if none has been
    /// entered yet.
    pub task: Option<usize>,
    /// Distance to that task's path, m.
    pub distance_m: Option<f64>,
    /// Whether the drone is on any task's path.
    pub on: bool,
    /// Whether the frame is inside any task's window.
    pub inside: bool,
    /// Whether the frame is inside a window and the speed exceeds the limit.
    pub speeding: bool,
}

/// Measures for one task's window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskTotals {
    /// Time from the first to the last on-path frame, s.
    pub time_s: f64,
    /// Time off the path within the window, s.
    pub off_path_s: f64,
    /// Time above the speed limit within the window, s.
    pub speeding_s: f64,
    /// Mean distance to the path, m.
    pub mean_distance_m: f64,
    /// Maximum distance to the path, m.
    pub max_distance_m: f64,
    /// Maximum speed, m/s.
    pub max_speed_m_s: f64,
    /// Minimum clearance to any surface, m.
    pub min_clearance_m: f64,
}

/// Computes the position relative to the tasks for all frames.
#[must_use]
pub fn steps(paths: &ReferencePaths, on_path: &OnPath, scene: &ReviewContext<'_>) -> Vec<TaskProximityStep> {
    let speeds: Vec<f64> = scene.frames.iter().map(Frame::speed_m_s).collect();
    let speeding = on_speed::speeding(&speeds, &on_path.windows, scene.scenario.scoring.speed_limit_m_s);
    let mut last = None;
    let step = |(i, frame): (usize, &Frame)| {
        let on = on_path.task[i].map(|(task, _)| task);
        last = on.or(last);
        let to = |task: usize| paths.nearest(task, frame.position_m).map(|nearest| (task, nearest.distance_m));
        let nearest = || (0..paths.len()).filter_map(to).min_by(|a, b| a.1.total_cmp(&b.1));
        let flown = match last {
            Some(task) => to(task),
            None => nearest(),
        };
        TaskProximityStep {
            task: flown.map(|(task, _)| task),
            distance_m: flown.map(|(_, distance_m)| distance_m),
            on: on.is_some(),
            inside: on_path.windows.iter().flatten().any(|window| window.contains(i)),
            speeding: speeding[i],
        }
    };
    scene.frames.iter().enumerate().map(step).collect()
}

/// Computes the totals of all tasks.
#[must_use]
pub fn tasks(scene: &ReviewContext<'_>, on_path: &OnPath, steps: &[TaskProximityStep]) -> Vec<TaskTotals> {
    let paths = ReferencePaths::new(scene.scenario);
    let rate_hz = scene.scenario.scoring.frame_rate_hz;
    let of = |task: usize| {
        let Some(window) = on_path.windows[task] else { return TaskTotals::not_entered() };
        let frames = &scene.frames[window.first..=window.last];
        let seconds = |count: usize| count as f64 / rate_hz;
        let away = frames.iter().filter_map(|frame| paths.nearest(task, frame.position_m)).map(|nearest| nearest.distance_m);
        let away: Vec<f64> = away.collect();
        let on = on_path.task[window.first..=window.last].iter().flatten().filter(|(t, _)| *t == task).count();
        TaskTotals {
            time_s: seconds(frames.len()),
            off_path_s: seconds(frames.len() - on),
            speeding_s: seconds(steps[window.first..=window.last].iter().filter(|step| step.speeding).count()),
            mean_distance_m: away.iter().sum::<f64>() / away.len().max(1) as f64,
            max_distance_m: away.iter().copied().fold(0.0, f64::max),
            max_speed_m_s: frames.iter().map(Frame::speed_m_s).fold(0.0, f64::max),
            min_clearance_m: frames.iter().filter_map(|frame| frame.clearance_m).fold(f64::INFINITY, f64::min),
        }
    };
    (0..on_path.windows.len()).map(of).collect()
}

impl TaskTotals {
    fn not_entered() -> Self {
        let unknown = f64::NAN;
        Self {
            time_s: 0.0,
            off_path_s: 0.0,
            speeding_s: 0.0,
            mean_distance_m: unknown,
            max_distance_m: unknown,
            max_speed_m_s: unknown,
            min_clearance_m: unknown,
        }
    }
}

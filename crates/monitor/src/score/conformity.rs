//! Conformity (P_C in the TASBID paper): adherence to the path and the speed limit.

use super::Score;

/// On-path share (P_p) and speeding loss (P_s) of one task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskShares {
    /// Fraction of the task window's frames that are on the path (P_p,t), 0 to 1.
    pub on_path: f64,
    /// The task's speeding loss (P_s,t in TASBID).
    pub speeding: f64,
}

/// Computes the conformity score over all tasks; `None` for a job without tasks. The weights depend on the number of
/// tasks and the two speeds; for the TASBID job, they are 25 and -25/3.
#[must_use]
pub fn score(tasks: &[TaskShares], speed_limit_m_s: f64, max_speed_m_s: f64) -> Option<Score> {
    if tasks.is_empty() {
        return None;
    }
    let count = tasks.len() as f64;
    let path_weight = 100.0 / count;
    let speed_weight = -100.0 * speed_limit_m_s / (count * max_speed_m_s);
    let on_path: f64 = tasks.iter().map(|task| task.on_path).sum();
    let speeding: f64 = tasks.iter().map(|task| task.speeding).sum();
    Some(Score::clamped_to_scale(path_weight * on_path + speed_weight * speeding, -100.0, 100.0))
}

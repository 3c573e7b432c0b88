//! Conformity (the paper's P_C): on path and on speed.

use super::Score;

/// P_p and P_s of one task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaskShares {
    /// P_p,t.
    pub on_path: f64,
    /// P_s,t.
    pub speeding: f64,
}

/// Conformity over all tasks; `None` for a job without tasks. The weights follow from the number of tasks and the two speeds and
/// are 25 and -25/3 in the paper's job.
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
    Some(Score::on_scale(path_weight * on_path + speed_weight * speeding, -100.0, 100.0))
}

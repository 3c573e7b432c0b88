//! On-speed analysis (equation 5 and P_s of the TASBID paper).

use super::on_path::TaskWindow;

/// Returns, for each frame, whether it is inside a task window and exceeds the speed limit (X_s,i).
#[must_use]
pub fn speeding(speeds_m_s: &[f64], windows: &[Option<TaskWindow>], limit_m_s: f64) -> Vec<bool> {
    let mut inside = vec![false; speeds_m_s.len()];
    for window in windows.iter().flatten() {
        inside[window.first..=window.last].fill(true);
    }
    speeds_m_s.iter().zip(inside).map(|(speed, inside)| inside && *speed > limit_m_s).collect()
}

/// Returns the speeding loss (P_s,t): the sum of speed / limit over the speeding frames, divided by the number of all
/// frames in the window; 0 if there is no window.
#[must_use]
pub fn loss(speeds_m_s: &[f64], speeding: &[bool], window: Option<TaskWindow>, limit_m_s: f64) -> f64 {
    let Some(window) = window else { return 0.0 };
    let range = window.first..=window.last;
    let weights = speeds_m_s[range.clone()].iter().zip(&speeding[range]).filter(|(_, on)| **on).map(|(v, _)| v / limit_m_s);
    // Summing an empty list of floats gives -0.0. Adding 0.0 turns it into +0.0.
    (weights.sum::<f64>() + 0.0) / window.frames() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_speed_at_limit_is_not_speeding() {
        let speeds = [5.0, 4.0, 8.0, 4.0, 8.0];
        let windows = [Some(TaskWindow { first: 1, last: 4 }), None];
        let speeding = speeding(&speeds, &windows, 4.0);
        assert_eq!(speeding, [false, false, true, false, true]);
        assert_eq!(loss(&speeds, &speeding, windows[0], 4.0), 1.0);
        assert_eq!(loss(&speeds, &speeding, windows[1], 4.0), 0.0);
    }

    #[test]
    fn exact_speeding_counts_only_in_task_windows() {
        let windows = [Some(TaskWindow { first: 0, last: 0 }), Some(TaskWindow { first: 2, last: 2 })];
        assert_eq!(speeding(&[9.0, 9.0, 9.0], &windows, 4.0), [true, false, true]);
    }
}

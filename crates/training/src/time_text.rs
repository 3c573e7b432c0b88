//! Times as text.

/// Formats a flight time as `minutes:seconds`.
#[must_use]
pub fn clock(t_s: f64) -> String {
    if !t_s.is_finite() {
        return "–".into();
    }
    let whole = t_s.max(0.0).round() as u64;
    format!("{}:{:02}", whole / 60, whole % 60)
}

/// Formats a duration, such as `2 min 5 s`.
#[must_use]
pub fn duration(t_s: f64) -> String {
    let whole = t_s.max(0.0).round() as u64;
    match (whole / 60, whole % 60) {
        (0, seconds) => format!("{seconds} s"),
        (minutes, 0) => format!("{minutes} min"),
        (minutes, seconds) => format!("{minutes} min {seconds} s"),
    }
}

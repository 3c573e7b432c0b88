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

/// Parses a flight time such as `1:25` (minutes and seconds) or `85` (seconds). Returns it in s; `None` if it is no such time.
#[must_use]
pub fn parse_clock(text: &str) -> Option<f64> {
    let number = |text: &str| text.parse::<u32>().ok().filter(|_| text.bytes().all(|byte| byte.is_ascii_digit()));
    let seconds = match text.split_once(':') {
        Some((minutes, seconds)) => {
            let seconds = number(seconds).filter(|number| seconds.len() == 2 && *number < 60)?;
            number(minutes)?.checked_mul(60)?.checked_add(seconds)?
        }
        None => number(text)?,
    };
    Some(f64::from(seconds))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_times_are_parsed_as_they_are_formatted() {
        for (text, t_s) in [("0:00", 0.0), ("1:25", 85.0), ("12:05", 725.0)] {
            assert_eq!((parse_clock(text), clock(t_s).as_str()), (Some(t_s), text));
        }
        assert_eq!(parse_clock("85"), Some(85.0));
        for wrong in ["", ":", "1:5", "1:60", "-1:00", "+5", "1:2:3", "1.5", "99999999:00", "a"] {
            assert_eq!(parse_clock(wrong), None, "{wrong}");
        }
    }
}

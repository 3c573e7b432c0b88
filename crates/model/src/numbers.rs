//! Formats numbers for messages that compare a value with a limit.

/// Maximum number of decimals. A smaller difference from the limit is below any measurement's resolution.
const MAX_DECIMALS: usize = 6;

/// Formats a value with at least `digits` decimals, and with as many more as needed to show which side of the limit it
/// is on.
#[must_use]
pub fn format_with_limit(value: f64, limit: f64, digits: usize) -> String {
    let text = |digits: usize| format!("{value:.digits$}");
    // Compare with the limit as displayed: a limit converted from another unit has a rounding error.
    let limit = self::format_limit(limit).parse::<f64>().unwrap_or(limit);
    let wanted = value.partial_cmp(&limit);
    let same_side = |text: &String| text.parse::<f64>().is_ok_and(|shown| shown.partial_cmp(&limit) == wanted);
    (digits..=MAX_DECIMALS).map(text).find(same_side).unwrap_or_else(|| text(MAX_DECIMALS))
}

/// Formats a limit with at most three decimals, without trailing zeros.
#[must_use]
pub fn format_limit(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_value_is_displayed_on_the_correct_side_of_the_limit() {
        assert_eq!(format_with_limit(60.3, 60.0, 0), "60.3");
        assert_eq!(format_with_limit(60.004, 60.0, 0), "60.004");
        assert_eq!(format_with_limit(60.3, 59.999_999_999_999_99, 0), "60.3");
        assert_eq!(format_with_limit(61.7, 60.0, 0), "62");
        assert_eq!(format_with_limit(79.96, 80.0, 0), "79.96");
        assert_eq!(format_with_limit(4.5, 4.5, 1), "4.5");
        assert_eq!(format_with_limit(2.5, 2.5, 0), "2.5");
        assert_eq!(
            (format_limit(60.000_000_000_01), format_limit(2.54), format_limit(0.0), format_limit(10.0)),
            ("60".into(), "2.54".into(), "0".into(), "10".into())
        );
    }
}

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

/// Formats a value for a pilot: with at least `digits` decimals, and with one more if needed to show which side of the limit
/// it is on. If that is not enough, the value is rounded away from the limit, because no pilot can use more digits.
#[must_use]
pub fn format_beyond_limit(value: f64, limit: f64, digits: usize) -> String {
    let limit = self::format_limit(limit).parse::<f64>().unwrap_or(limit);
    let wanted = value.partial_cmp(&limit);
    let same_side = |text: &String| text.parse::<f64>().is_ok_and(|shown| shown.partial_cmp(&limit) == wanted);
    let most = digits + 1;
    let rounded = (digits..=most).map(|digits| format!("{value:.digits$}")).find(same_side);
    rounded.unwrap_or_else(|| {
        let scale = (0..most).fold(1.0, |scale, _| 10.0 * scale);
        let away = if value < limit { (value * scale).floor() } else { (value * scale).ceil() };
        format!("{:.most$}", away / scale)
    })
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
    fn exact_pilots_see_at_most_one_extra_decimal() {
        let close = |meters| format_beyond_limit(meters, 2.5, 1);
        assert_eq!([2.0, 2.43, 2.47, 2.496, 2.499_9, 2.5].map(close), ["2.0", "2.4", "2.47", "2.49", "2.49", "2.5"]);
        assert_eq!([2.500_1, 2.504, 2.51, 2.58].map(close), ["2.51", "2.51", "2.51", "2.6"]);
        assert_eq!(format_beyond_limit(10.000_1, 10.000_000_000_01, 0), "10.1");
        assert_eq!(format_beyond_limit(10.0, 9.999_999_999_999_99, 0), "10");
    }

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

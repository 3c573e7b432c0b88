//! Formats wall-clock time for display and file names. This crate never reads the clock; callers pass the time.

/// Formats a Unix time in microseconds as UTC in two forms: RFC 3339 with seconds, and `YYYYMMDDThhmmssZ` for file
/// names.
#[must_use]
pub fn utc(unix_us: u64) -> (String, String) {
    let time = i64::try_from(unix_us).ok().and_then(|us| jiff::Timestamp::from_microsecond(us).ok()).unwrap_or_default();
    (time.strftime("%Y-%m-%dT%H:%M:%SZ").to_string(), time.strftime("%Y%m%dT%H%M%SZ").to_string())
}

/// Formats a Unix time in microseconds as UTC to the minute: `2023-11-14 22:13 UTC`.
#[must_use]
pub fn minute(unix_us: u64) -> String {
    let (readable, _) = utc(unix_us);
    readable.get(..16).unwrap_or_default().replace('T', " ") + " UTC"
}

/// Formats a Unix time in microseconds as the day in UTC: `2023-11-14`.
#[must_use]
pub fn day(unix_us: u64) -> String {
    let (readable, _) = utc(unix_us);
    readable.get(..10).unwrap_or_default().to_owned()
}

/// Returns the last microsecond of a day such as `2023-11-14` in UTC, µs since the Unix epoch; `None` if it is not a day
/// since 1970.
#[must_use]
pub fn end_of_day_unix_us(day: &str) -> Option<u64> {
    let date: jiff::civil::Date = day.parse().ok()?;
    let next = date.tomorrow().ok()?.to_zoned_datetime(jiff::tz::TimeZone::UTC).ok()?;
    u64::try_from(next.timestamp().as_microsecond()).ok()?.checked_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_known_time_is_formatted_as_utc() {
        let (readable, compact) = utc(1_700_000_000_000_000);
        assert_eq!(readable, "2023-11-14T22:13:20Z");
        assert_eq!(compact, "20231114T221320Z");
        assert_eq!(minute(1_700_000_000_000_000), "2023-11-14 22:13 UTC");
        assert_eq!(day(1_700_000_000_000_000), "2023-11-14");
    }

    #[test]
    fn exact_day_ends_one_microsecond_before_the_next_one() {
        // 2023-11-15 00:00 UTC is 1,700,006,400 s after the epoch.
        assert_eq!(end_of_day_unix_us("2023-11-14"), Some(1_700_006_399_999_999));
        assert_eq!(end_of_day_unix_us("2023-11-14").map(day).as_deref(), Some("2023-11-14"));
        for wrong in ["", "14.11.2023", "2023-02-29", "2023-13-01", "1969-12-30", "tomorrow", "<b>"] {
            assert_eq!(end_of_day_unix_us(wrong), None, "{wrong}");
        }
    }
}

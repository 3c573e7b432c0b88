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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_known_time_is_formatted_as_utc() {
        let (readable, compact) = utc(1_700_000_000_000_000);
        assert_eq!(readable, "2023-11-14T22:13:20Z");
        assert_eq!(compact, "20231114T221320Z");
        assert_eq!(minute(1_700_000_000_000_000), "2023-11-14 22:13 UTC");
    }
}

//! Display names and number formats. No other code rounds values.

pub use crate::time_text::{clock, duration, parse_clock};

use spandrel_mavlink::contract::modes::ControlSource;
use spandrel_text::{Language, text};

/// Formats a number with `digits` decimal places. Returns a dash if it is not finite.
#[must_use]
pub fn number(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    let text = format!("{value:.digits$}");
    // Values that round to zero are shown without a sign.
    if text.starts_with('-') && text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.')) { text[1..].to_owned() } else { text }
}

/// Returns the display name of a control source.
#[must_use]
pub fn control_source_label(by: Option<ControlSource>, language: Language) -> String {
    match by {
        Some(ControlSource::Pilot) => text!(language, "report-control-pilot"),
        Some(ControlSource::Mission) => text!(language, "report-control-mission"),
        Some(ControlSource::Script) => text!(language, "report-control-script"),
        Some(ControlSource::Autopilot) => text!(language, "report-control-autopilot"),
        None => text!(language, "report-control-unknown"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_numbers_and_times_are_formatted() {
        assert_eq!(number(1.25, 1), "1.2");
        assert_eq!(number(-0.04, 1), "0.0");
        assert_eq!(number(-0.06, 1), "-0.1");
        assert_eq!(number(f64::NAN, 1), "–");
        assert_eq!((clock(0.0), clock(59.6), clock(754.2)), ("0:00".into(), "1:00".into(), "12:34".into()));
        assert_eq!((duration(59.4), duration(60.0), duration(61.0)), ("59 s".into(), "1 min".into(), "1 min 1 s".into()));
    }
}

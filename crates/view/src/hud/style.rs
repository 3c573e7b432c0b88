//! How the window shows texts and values: units and text size.

use spandrel_model::math::M_S_PER_MPH;
use spandrel_text::{Language, text};

/// Length of the international foot, m (exact).
const M_PER_FT: f64 = 0.3048;
/// Lengths below this have a decimal if their value in meters has one, ft (estimate: a decimal of a foot, 3 cm, matters only
/// near a structure).
const MAX_DECIMAL_FT: f64 = 10.0;

/// Units of lengths and speeds on the screen. Files, reports and messages always use SI units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DisplayUnits {
    /// Meters and meters per second.
    #[default]
    Metric,
    /// Feet and miles per hour.
    UsCustomary,
}

impl DisplayUnits {
    /// All units.
    pub const ALL: [Self; 2] = [Self::Metric, Self::UsCustomary];

    /// Returns the name in configuration files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Metric => "metric",
            Self::UsCustomary => "us",
        }
    }

    /// Returns the name for display.
    #[must_use]
    pub fn title(self, language: Language) -> String {
        match self {
            Self::Metric => text!(language, "window-settings-metric"),
            Self::UsCustomary => text!(language, "window-settings-us"),
        }
    }

    /// Formats a length in m without its unit. `decimals` is the number of decimals in meters.
    #[must_use]
    pub fn length_number(self, length_m: f64, decimals: usize) -> String {
        match self {
            Self::Metric => format!("{length_m:.decimals$}"),
            Self::UsCustomary => {
                let length_ft = length_m / M_PER_FT;
                let decimals = if length_ft.abs() < MAX_DECIMAL_FT { decimals.min(1) } else { 0 };
                format!("{length_ft:.decimals$}")
            }
        }
    }

    /// Formats a length in m with its unit. `decimals` is the number of decimals in meters.
    #[must_use]
    pub fn length(self, length_m: f64, decimals: usize) -> String {
        format!("{} {}", self.length_number(length_m, decimals), self.length_symbol())
    }

    /// Returns the symbol of the unit of length.
    #[must_use]
    pub const fn length_symbol(self) -> &'static str {
        match self {
            Self::Metric => "m",
            Self::UsCustomary => "ft",
        }
    }

    /// Returns the length of the unit of length, m.
    #[must_use]
    pub const fn length_unit_m(self) -> f64 {
        match self {
            Self::Metric => 1.0,
            Self::UsCustomary => M_PER_FT,
        }
    }

    /// Formats a speed in m/s with its unit.
    #[must_use]
    pub fn speed(self, speed_m_s: f64) -> String {
        match self {
            Self::Metric => format!("{speed_m_s:.1} m/s"),
            Self::UsCustomary => format!("{:.1} mph", speed_m_s / M_S_PER_MPH),
        }
    }

    /// Converts the lengths and speeds in a text, such as "140 m, 30 deg left" or "12 to 24 m". Other numbers stay.
    #[must_use]
    pub fn words(self, text: &str) -> String {
        match self {
            Self::Metric => text.to_owned(),
            Self::UsCustomary => self.convert(text),
        }
    }

    fn convert(self, text: &str) -> String {
        let mut converted = String::with_capacity(text.len());
        let mut rest = text;
        let mut after_word = false;
        while let Some(sign) = rest.chars().next() {
            let number = leading_number(rest).filter(|_| !after_word);
            if let Some(quantity) = number.and_then(|number| Quantity::of(number, rest.get(number.len()..).unwrap_or_default())) {
                converted.push_str(&quantity.words(self));
                rest = rest.get(quantity.length..).unwrap_or_default();
                after_word = true;
                continue;
            }
            let skipped = number.map_or(sign.len_utf8(), str::len);
            converted.push_str(rest.get(..skipped).unwrap_or_default());
            after_word = number.is_some() || sign.is_alphanumeric() || sign == '.' || sign == '_';
            rest = rest.get(skipped..).unwrap_or_default();
        }
        converted
    }
}

/// Returns the number at the beginning of a text: digits with at most one decimal point between them.
fn leading_number(text: &str) -> Option<&str> {
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let whole = digits(text);
    let fraction = text.get(whole..)?.strip_prefix('.').map_or(0, digits);
    let end = if fraction > 0 { whole + 1 + fraction } else { whole };
    text.get(..end).filter(|_| whole > 0)
}

/// Words of all languages that join two numbers with one unit.
const JOINTS: [&str; 4] = [" to ", " ± ", " bis ", " a "];

/// A number, or two with one unit, at the beginning of a text.
struct Quantity<'a> {
    numbers: [Option<&'a str>; 2],
    joint: &'static str,
    /// Text between the last number and the unit.
    gap: &'a str,
    is_speed: bool,
    /// Length of the text with its unit, bytes.
    length: usize,
}

impl<'a> Quantity<'a> {
    /// Reads what follows a number; `None` if there is no unit to convert.
    fn of(number: &'a str, rest: &'a str) -> Option<Self> {
        if let Some((gap, is_speed, length)) = unit(rest) {
            return Some(Self { numbers: [Some(number), None], joint: "", gap, is_speed, length: number.len() + length });
        }
        JOINTS.into_iter().find_map(|joint| {
            let rest = rest.strip_prefix(joint)?;
            let second = leading_number(rest)?;
            let (gap, is_speed, length) = unit(rest.get(second.len()..)?)?;
            let length = number.len() + joint.len() + second.len() + length;
            Some(Self { numbers: [Some(number), Some(second)], joint, gap, is_speed, length })
        })
    }

    fn words(&self, units: DisplayUnits) -> String {
        let one = |number: &str| {
            let value = number.parse::<f64>().unwrap_or_default();
            let decimals = number.split_once('.').map_or(0, |(_, decimals)| decimals.len());
            if self.is_speed { format!("{:.decimals$}", value / M_S_PER_MPH) } else { units.length_number(value, decimals) }
        };
        let numbers: Vec<String> = self.numbers.iter().flatten().map(|number| one(number)).collect();
        let symbol = if self.is_speed { "mph" } else { units.length_symbol() };
        format!("{}{}{symbol}", numbers.join(self.joint), self.gap)
    }
}

/// Reads a unit at the beginning of a text. Returns the gap before it, whether it is a speed, and the length of both in bytes.
fn unit(text: &str) -> Option<(&str, bool, usize)> {
    let gap = usize::from(text.starts_with([' ', '\u{a0}'])) * text.chars().next().map_or(0, char::len_utf8);
    let (space, rest) = (text.get(..gap)?, text.get(gap..)?);
    let ends = |rest: &str| !rest.starts_with(|sign: char| sign.is_alphanumeric() || "/²³".contains(sign));
    [("m/s", true), ("m", false)].into_iter().find_map(|(symbol, is_speed)| {
        let after = rest.strip_prefix(symbol)?;
        ends(after).then_some((space, is_speed, gap + symbol.len()))
    })
}

/// Size of all texts relative to their normal size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TextScale {
    /// Normal.
    #[default]
    Normal,
    /// A quarter larger.
    Larger,
    /// Half as large again.
    Large,
    /// Twice as large.
    Double,
}

impl TextScale {
    /// All sizes, from the smallest.
    pub const ALL: [Self; 4] = [Self::Normal, Self::Larger, Self::Large, Self::Double];

    /// Returns the size in percent of the normal one.
    #[must_use]
    pub const fn pct(self) -> i64 {
        match self {
            Self::Normal => 100,
            Self::Larger => 125,
            Self::Large => 150,
            Self::Double => 200,
        }
    }

    /// Returns the size relative to the normal one.
    #[must_use]
    pub const fn factor(self) -> f64 {
        self.pct() as f64 / 100.0
    }
}

/// Language, units and text size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DisplayStyle {
    /// Language of all texts.
    pub language: Language,
    /// Units of lengths and speeds.
    pub units: DisplayUnits,
    /// Size of all texts.
    pub text_scale: TextScale,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_lengths_and_speeds_in_feet_and_miles_per_hour() {
        let us = DisplayUnits::UsCustomary;
        assert_eq!([us.length(30.48, 0), us.length(0.3048, 1), us.length(21.4, 1)], ["100 ft", "1.0 ft", "70 ft"]);
        assert_eq!(us.speed(4.4704), "10.0 mph");
        assert_eq!([DisplayUnits::Metric.length(21.44, 1), DisplayUnits::Metric.speed(3.25)], ["21.4 m", "3.2 m/s"]);
    }

    #[test]
    fn exact_quantities_in_a_text_are_converted_and_other_numbers_stay() {
        for (metric, us) in [
            ("140 m, 30 deg left, 12 m up", "459 ft, 30 deg left, 39 ft up"),
            ("Too close: 1.2 m, limit 2.5 m", "Too close: 3.9 ft, limit 8.2 ft"),
            (
                "152 m long, 12 to 24 m above the pad, stand-off 5.0 ± 1.5 m",
                "499 ft long, 39 to 79 ft above the pad, stand-off 16 ± 4.9 ft",
            ),
            ("You flew up to 6.2 m/s in tasks 1, 2 and 4", "You flew up to 13.9 mph in tasks 1, 2 and 4"),
            ("hardest at 16:02 (2.1 m/s)", "hardest at 16:02 (4.7 mph)"),
            ("12 mph, 0.4 mm, 3 m², 5 m/s², 4 minutes, a4 m, 1.2.3 m", "12 mph, 0.4 mm, 3 m², 5 m/s², 4 minutes, a4 m, 1.2.3 m"),
            ("2 to 5 tasks, 30 m", "2 to 5 tasks, 98 ft"),
            ("take off to 2 m", "take off to 7 ft"),
            ("12 bis 24 m, 12 a 24 m", "39 bis 79 ft, 39 a 79 ft"),
            ("Größe 1 m", "Größe 3 ft"),
            ("", ""),
        ] {
            assert_eq!(DisplayUnits::UsCustomary.words(metric), us);
            assert_eq!(DisplayUnits::UsCustomary.words(us), us, "feet stay");
            assert_eq!(DisplayUnits::Metric.words(metric), metric);
        }
    }

    #[test]
    fn exact_text_sizes_are_their_percentages() {
        assert_eq!(TextScale::ALL.map(TextScale::pct), [100, 125, 150, 200]);
        assert_eq!(TextScale::Larger.factor(), 1.25);
    }
}

//! How the window shows texts and values: units and text size.

use spandrel_model::math::M_S_PER_MPH;
use spandrel_model::numbers::{format_beyond_limit, format_limit};
use spandrel_model::speed_unit::SpeedUnit;
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
        self.length_numbers([length_m], decimals).concat()
    }

    /// Formats lengths in m that stand together, such as a value and its tolerance, with the same decimals and without their unit.
    /// `decimals` is the number of decimals in meters.
    #[must_use]
    pub fn length_numbers<const N: usize>(self, lengths_m: [f64; N], decimals: usize) -> [String; N] {
        let lengths = lengths_m.map(|length_m| length_m / self.length_unit_m());
        let decimals = self.length_decimals(&lengths, decimals);
        lengths.map(|length| format!("{length:.decimals$}"))
    }

    /// Returns the number of decimals of lengths in this unit that stand together.
    fn length_decimals(self, lengths: &[f64], decimals: usize) -> usize {
        match self {
            Self::Metric => decimals,
            Self::UsCustomary if lengths.iter().all(|length| length.abs() < MAX_DECIMAL_FT) => decimals.min(1),
            Self::UsCustomary => 0,
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

    /// Returns the unit of speeds.
    #[must_use]
    pub const fn speed_unit(self) -> SpeedUnit {
        match self {
            Self::Metric => SpeedUnit::MetersPerSecond,
            Self::UsCustomary => SpeedUnit::MilesPerHour,
        }
    }

    /// Formats a speed in m/s with its unit, with one decimal, or two if they are needed to show on which side of the limit it is.
    #[must_use]
    pub fn speed(self, speed_m_s: f64, limit_m_s: f64) -> String {
        let unit = self.speed_unit();
        format!("{} {}", format_beyond_limit(unit.from_m_s(speed_m_s), unit.from_m_s(limit_m_s), 1), unit.symbol())
    }

    /// Formats a speed limit in m/s with its unit and at most two decimals.
    #[must_use]
    pub fn speed_limit(self, limit_m_s: f64) -> String {
        let unit = self.speed_unit();
        format!("{} {}", format_limit((100.0 * unit.from_m_s(limit_m_s)).round() / 100.0), unit.symbol())
    }

    /// Converts the lengths and speeds in a text that are in other units, such as "140 m, 30 deg left", "12 to 24 m" or "10 mph".
    /// Other numbers stay.
    #[must_use]
    pub fn words(self, text: &str) -> String {
        let mut converted = String::with_capacity(text.len());
        let mut rest = text;
        let mut after_word = false;
        while let Some(sign) = rest.chars().next() {
            let number = leading_number(rest).filter(|_| !after_word);
            if let Some(quantity) = number.and_then(|number| Quantity::of(number, rest)) {
                converted.push_str(&quantity.words(self));
                rest = rest.get(quantity.text.len()..).unwrap_or_default();
                after_word = true;
                continue;
            }
            let skipped = number.map_or(sign.len_utf8(), str::len);
            converted.push_str(rest.get(..skipped).unwrap_or_default());
            // A number after a colon is part of a time.
            after_word = number.is_some() || sign.is_alphanumeric() || ".:_".contains(sign);
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

/// Words of all languages before the last of several numbers with one unit.
const JOINTS: [&str; 13] = [" to ", " ± ", " bis ", " a ", "–", " and ", " und ", " y ", " e ", " or ", " oder ", " o ", " u "];
/// Sign between the others.
const SEPARATOR: &str = ", ";
/// Decimals of a speed that is converted from miles per hour to m/s.
const CONVERTED_DECIMALS: usize = 2;

/// Numbers with one unit at the beginning of a text, such as "5 m", "12 to 24 m" or "1, 3 and 8 m".
struct Quantity<'a> {
    /// The numbers, each with the text after it: a joint, or the gap before the unit.
    numbers: Vec<(&'a str, &'a str)>,
    unit: TextUnit,
    /// Whole text with its unit.
    text: &'a str,
}

impl<'a> Quantity<'a> {
    /// Reads the quantity that begins with a number; `None` if there is no unit.
    fn of(first: &'a str, text: &'a str) -> Option<Self> {
        let (mut numbers, mut number, mut end, mut is_last) = (Vec::new(), first, first.len(), false);
        loop {
            let rest = text.get(end..)?;
            // After a comma, only a list with a last joint has one unit: "Task 2, 140 m" is none.
            if let Some((gap, unit, length)) = TextUnit::read(rest).filter(|_| is_last || numbers.is_empty()) {
                numbers.push((number, gap));
                return Some(Self { numbers, unit, text: text.get(..end + length)? });
            }
            if is_last {
                return None;
            }
            let joint = JOINTS.into_iter().find(|joint| rest.starts_with(joint));
            is_last = joint.is_some();
            let joint = joint.or_else(|| rest.starts_with(SEPARATOR).then_some(SEPARATOR))?;
            let next = leading_number(rest.get(joint.len()..)?)?;
            numbers.push((number, rest.get(..joint.len())?));
            (number, end) = (next, end + joint.len() + next.len());
        }
    }

    /// Returns the quantity in the units, or unchanged if it is in one of them.
    fn words(&self, units: DisplayUnits) -> String {
        let values: Vec<f64> = self.numbers.iter().map(|(number, _)| number.parse().unwrap_or_default()).collect();
        let decimals = self.numbers.iter().map(|(number, _)| decimals(number)).max().unwrap_or_default();
        let Some((values, decimals, symbol)) = self.unit.converted(units, &values, decimals) else { return self.text.to_owned() };
        let one = |(value, (_, after)): (&f64, &(&str, &str))| format!("{value:.decimals$}{after}");
        values.iter().zip(&self.numbers).map(one).collect::<String>() + symbol
    }
}

/// Returns the number of decimals of a number.
fn decimals(number: &str) -> usize {
    number.split_once('.').map_or(0, |(_, decimals)| decimals.len())
}

/// Unit of a quantity in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TextUnit {
    Meters,
    MetersPerSecond,
    MilesPerHour,
}

impl TextUnit {
    /// Units with their symbols; one that begins with another comes first.
    const SYMBOLS: [(&str, Self); 3] = [("m/s", Self::MetersPerSecond), ("mph", Self::MilesPerHour), ("m", Self::Meters)];

    /// Reads a unit at the beginning of a text. Returns the gap before it and the length of both in bytes, too.
    fn read(text: &str) -> Option<(&str, Self, usize)> {
        let gap = usize::from(text.starts_with([' ', '\u{a0}'])) * text.chars().next().map_or(0, char::len_utf8);
        let (space, rest) = (text.get(..gap)?, text.get(gap..)?);
        let ends = |rest: &str| !rest.starts_with(|sign: char| sign.is_alphanumeric() || "/²³".contains(sign));
        Self::SYMBOLS.into_iter().find_map(|(symbol, unit)| {
            let after = rest.strip_prefix(symbol)?;
            ends(after).then_some((space, unit, gap + symbol.len()))
        })
    }

    /// Returns values of this unit in the unit of the display with their decimals and its symbol; `None` if it is the same.
    fn converted(self, units: DisplayUnits, values: &[f64], decimals: usize) -> Option<(Vec<f64>, usize, &'static str)> {
        let scaled = |factor: f64| values.iter().map(|value| value * factor).collect::<Vec<f64>>();
        match (self, units) {
            (Self::Meters | Self::MetersPerSecond, DisplayUnits::Metric) | (Self::MilesPerHour, DisplayUnits::UsCustomary) => {
                None
            }
            (Self::Meters, DisplayUnits::UsCustomary) => {
                let lengths = scaled(1.0 / units.length_unit_m());
                let decimals = units.length_decimals(&lengths, decimals);
                Some((lengths, decimals, units.length_symbol()))
            }
            (Self::MetersPerSecond, DisplayUnits::UsCustomary) => {
                Some((scaled(1.0 / M_S_PER_MPH), decimals, SpeedUnit::MilesPerHour.symbol()))
            }
            (Self::MilesPerHour, DisplayUnits::Metric) => {
                Some((scaled(M_S_PER_MPH), CONVERTED_DECIMALS, SpeedUnit::MetersPerSecond.symbol()))
            }
        }
    }
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
        assert_eq!(DisplayUnits::Metric.length(21.44, 1), "21.4 m");
        assert_eq!(us.length_numbers([5.0, 1.5], 1), ["16", "5"], "values that stand together have the same decimals");
        assert_eq!(us.length_numbers([2.0, 0.5], 1), ["6.6", "1.6"]);
    }

    #[test]
    fn regress_speed_and_limit_have_the_unit_of_the_display_and_show_which_is_higher() {
        let shown = |units: DisplayUnits, speed_m_s, limit_m_s| [units.speed(speed_m_s, limit_m_s), units.speed_limit(limit_m_s)];
        let limit_m_s = 10.0 * M_S_PER_MPH;
        assert_eq!(shown(DisplayUnits::Metric, 3.21, limit_m_s), ["3.2 m/s", "4.47 m/s"]);
        assert_eq!(shown(DisplayUnits::Metric, 4.46, limit_m_s), ["4.46 m/s", "4.47 m/s"]);
        assert_eq!(shown(DisplayUnits::Metric, 5.0, 4.5), ["5.0 m/s", "4.5 m/s"]);
        assert_eq!(shown(DisplayUnits::UsCustomary, 4.48, limit_m_s), ["10.02 mph", "10 mph"]);
        assert_eq!(shown(DisplayUnits::UsCustomary, 3.21, 4.5), ["7.2 mph", "10.07 mph"]);
    }

    #[test]
    fn exact_quantities_in_a_text_are_converted_and_other_numbers_stay() {
        for (metric, us) in [
            ("140 m, 30 deg left, 12 m up", "459 ft, 30 deg left, 39 ft up"),
            ("Too close: 1.2 m, limit 2.5 m", "Too close: 3.9 ft, limit 8.2 ft"),
            (
                "152 m long, 12 to 24 m above the pad, stand-off 5.0 ± 1.5 m",
                "499 ft long, 39 to 79 ft above the pad, stand-off 16 ± 5 ft",
            ),
            ("You flew up to 6.2 m/s in tasks 1, 2 and 4", "You flew up to 13.9 mph in tasks 1, 2 and 4"),
            ("hardest at 16:02 (2.1 m/s)", "hardest at 16:02 (4.7 mph)"),
            ("0.4 mm, 3 m², 5 m/s², 4 minutes, a4 m, 1.2.3 m", "0.4 mm, 3 m², 5 m/s², 4 minutes, a4 m, 1.2.3 m"),
            ("from 1, 3 and 8 m", "from 3, 10 and 26 ft"),
            ("aus 1, 3 und 8 m, a 1, 3 y 8 m", "aus 3, 10 und 26 ft, a 3, 10 y 26 ft"),
            (
                "tasks 1, 2 and 4, 30 m; Task 2, 140 m; at 16:02 and 3 m",
                "tasks 1, 2 and 4, 98 ft; Task 2, 459 ft; at 16:02 and 10 ft",
            ),
            ("0.5 to 2 m/s", "1.1 to 4.5 mph"),
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
    fn regress_miles_per_hour_in_a_text_are_converted_to_metric_units() {
        let metric = |text: &str| DisplayUnits::Metric.words(text);
        assert_eq!(metric("Too fast: 11 mph, limit 10 mph"), "Too fast: 4.92 m/s, limit 4.47 m/s");
        assert_eq!(DisplayUnits::UsCustomary.words("Too fast: 11 mph, limit 10 mph"), "Too fast: 11 mph, limit 10 mph");
    }

    #[test]
    fn exact_text_sizes_are_their_percentages() {
        assert_eq!(TextScale::ALL.map(TextScale::pct), [100, 125, 150, 200]);
        assert_eq!(TextScale::Larger.factor(), 1.25);
    }
}

//! Units in which a scenario states its speed limit. Messages show speeds in the same unit.

use crate::math::M_S_PER_MPH;
use crate::numbers::{format_beyond_limit, format_limit};

/// Unit of a speed limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SpeedUnit {
    /// Miles per hour, as in the TASBID paper.
    #[default]
    MilesPerHour,
    /// Meters per second.
    MetersPerSecond,
}

impl SpeedUnit {
    /// Returns the unit's symbol.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::MilesPerHour => "mph",
            Self::MetersPerSecond => "m/s",
        }
    }

    /// Converts a speed in m/s to this unit.
    #[must_use]
    pub fn from_m_s(self, speed_m_s: f64) -> f64 {
        match self {
            Self::MilesPerHour => speed_m_s / M_S_PER_MPH,
            Self::MetersPerSecond => speed_m_s,
        }
    }

    /// Number of decimals that are usually enough for a speed in this unit.
    fn decimals(self) -> usize {
        match self {
            Self::MilesPerHour => 0,
            Self::MetersPerSecond => 1,
        }
    }

    /// Formats a speed without its unit, with as many decimals as needed to show whether it exceeds the limit.
    #[must_use]
    pub fn format_speed(self, speed_m_s: f64, limit_m_s: f64) -> String {
        format_beyond_limit(self.from_m_s(speed_m_s), self.from_m_s(limit_m_s), self.decimals())
    }

    /// Formats a limit with its unit, such as "10 mph".
    #[must_use]
    pub fn format_limit(self, limit_m_s: f64) -> String {
        format!("{} {}", format_limit(self.from_m_s(limit_m_s)), self.symbol())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_speeds_are_shown_in_the_unit_of_the_limit() {
        let mph = |speed_mph: f64| SpeedUnit::MilesPerHour.format_speed(speed_mph * M_S_PER_MPH, 10.0 * M_S_PER_MPH);
        assert_eq!((mph(13.42), mph(10.5), mph(10.01), mph(9.97)), ("13".into(), "10.5".into(), "10.1".into(), "9.9".into()));
        let m_s = |speed| SpeedUnit::MetersPerSecond.format_speed(speed, 4.5);
        assert_eq!((m_s(4.83), m_s(4.52), m_s(4.501), m_s(4.5)), ("4.8".into(), "4.52".into(), "4.51".into(), "4.5".into()));
        assert_eq!(SpeedUnit::MilesPerHour.format_limit(10.0 * M_S_PER_MPH), "10 mph");
        assert_eq!(SpeedUnit::MetersPerSecond.format_limit(4.5), "4.5 m/s");
    }
}

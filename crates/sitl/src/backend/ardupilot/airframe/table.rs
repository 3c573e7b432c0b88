//! A list of parameters under construction.

use crate::backend::launch::LaunchParam;

/// Parameters in the order in which they were added.
#[derive(Debug, Default)]
pub struct Table(Vec<LaunchParam>);

impl Table {
    /// Adds an integer.
    pub fn integer(&mut self, name: &str, value: i64) {
        self.push(name, value.to_string());
    }

    /// Adds a real number, limited to `range`.
    pub fn real(&mut self, name: &str, value: f64, range: (f64, f64)) {
        self.push(name, format(value.clamp(range.0, range.1)));
    }

    /// Adds a value under its name in ArduPilot 4.6, in hundredths of its unit, and under its name since 4.7, in its unit. `range`
    /// is in the unit.
    pub fn renamed(&mut self, (old, new): (&str, &str), value: f64, range: (f64, f64)) {
        let limited = value.clamp(range.0, range.1);
        self.push(old, format((limited * 100.0).round()));
        self.push(new, format(limited));
    }

    /// Adds an integer under its names before and since a version.
    pub fn both(&mut self, names: [&str; 2], value: i64) {
        for name in names {
            self.integer(name, value);
        }
    }

    /// Returns the parameters.
    pub fn finish(self) -> Vec<LaunchParam> {
        self.0
    }

    fn push(&mut self, name: &str, value: String) {
        self.0.push(LaunchParam { name: name.into(), value });
    }
}

/// Formats a number without trailing zeros.
fn format(value: f64) -> String {
    let text = format!("{value:.5}");
    text.trim_end_matches('0').trim_end_matches('.').into()
}

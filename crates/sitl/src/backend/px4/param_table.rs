//! A list of PX4 parameters, each within the range that PX4's metadata allows.

use crate::backend::launch::LaunchParam;

/// Parameters in the order in which they were added.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct ParamTable {
    rows: Vec<LaunchParam>,
}

impl ParamTable {
    /// Adds an integer parameter, limited to PX4's range. PX4 rejects integers with a decimal point.
    pub(super) fn integer(&mut self, name: impl Into<String>, value: f64, (low, high): (f64, f64)) {
        let value = format!("{}", value.clamp(low, high).round() as i64);
        self.rows.push(LaunchParam { name: name.into(), value });
    }

    /// Adds a floating-point parameter, limited to PX4's range and rounded to PX4's precision.
    pub(super) fn real(&mut self, name: impl Into<String>, value: f64, (low, high): (f64, f64)) {
        let value = format!("{:?}", value.clamp(low, high) as f32);
        self.rows.push(LaunchParam { name: name.into(), value });
    }

    /// Returns the parameters, sorted by name.
    pub(super) fn into_rows(mut self) -> Vec<LaunchParam> {
        self.rows.sort_by(|a, b| a.name.cmp(&b.name));
        self.rows
    }
}

//! Named lists of numbers (DEBUG_FLOAT_ARRAY), in which NaN stands for a missing value.

use crate::dialect::{DEBUG_FLOAT_ARRAY_DATA, MavMessage};

/// Number of values in the message.
const CAPACITY: usize = 58;

/// Encodes a list; the remaining values are 0. `time_us` is the simulation time, µs.
pub(super) fn message<const N: usize>(name: &str, time_us: u64, values: [f32; N]) -> MavMessage {
    let mut data = [0.0; CAPACITY];
    data[..N].copy_from_slice(&values);
    MavMessage::DEBUG_FLOAT_ARRAY(DEBUG_FLOAT_ARRAY_DATA { time_usec: time_us, name: name.into(), array_id: 0, data })
}

/// Returns an optional value for a list.
pub(super) fn optional(value: Option<f64>) -> f32 {
    value.map_or(f32::NAN, |value| value as f32)
}

/// A received list.
pub(super) struct FloatArray<'a>(&'a DEBUG_FLOAT_ARRAY_DATA);

impl<'a> FloatArray<'a> {
    /// Returns the list in a message; `None` for other messages and other lists.
    pub fn named(name: &str, message: &'a MavMessage) -> Option<Self> {
        let MavMessage::DEBUG_FLOAT_ARRAY(array) = message else { return None };
        (array.name.to_str() == Ok(name)).then_some(Self(array))
    }

    /// Returns a value as it was sent.
    pub fn raw(&self, index: usize) -> f32 {
        self.0.data[index]
    }

    /// Returns a finite value.
    pub fn finite(&self, index: usize) -> Option<f64> {
        Some(f64::from(self.raw(index))).filter(|value| value.is_finite())
    }

    /// Returns a number of things.
    pub fn count(&self, index: usize) -> Option<u32> {
        self.finite(index).filter(|value| (0.0..1e6).contains(value)).map(|value| value as u32)
    }

    /// Returns three values that exist together, from `index` on.
    pub fn triple(&self, index: usize) -> Option<[f64; 3]> {
        Some([self.finite(index)?, self.finite(index + 1)?, self.finite(index + 2)?])
    }
}

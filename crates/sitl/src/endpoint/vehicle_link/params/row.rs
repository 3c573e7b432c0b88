//! A row of a parameter table: a parameter with its metadata for ground stations.

use super::param_value::ParamValue::{self, Int, Real};
use spandrel_mavlink::dialect::MavParamType;

/// Source of a parameter's value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ParamSource {
    /// Its own stored value.
    Own,
    /// Another parameter's value, multiplied by a factor.
    Scaled(&'static str, f64),
    /// Another parameter's value, a fraction of the battery capacity, converted to mAh.
    Capacity(&'static str),
    /// Another parameter's value with a different numbering: pairs of (own number, other number).
    Mapped(&'static str, &'static [(i32, i32)]),
}

/// A parameter's definition.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// Name, at most 16 characters.
    pub name: &'static str,
    /// Default value.
    pub default: ParamValue,
    /// Minimum allowed value.
    pub low: f64,
    /// Maximum allowed value.
    pub high: f64,
    /// Unit, in the notation of ground stations.
    pub unit: &'static str,
    /// Group under which it is listed.
    pub group: &'static str,
    /// Short description.
    pub short: &'static str,
    /// Value labels.
    pub values: &'static [(i32, &'static str)],
    /// Bit labels, if it is a bit mask.
    pub bits: &'static [(i32, &'static str)],
    /// Whether it describes the vehicle and cannot be set.
    pub read_only: bool,
    /// Whether the vehicle itself changes it.
    pub volatile: bool,
    /// Whether it has no effect and exists only for clients that expect it.
    pub token: bool,
    /// Type on the wire.
    pub wire: MavParamType,
    /// Source of the value.
    pub source: ParamSource,
}

/// Creates a row with its own value, with the wire type of its default.
pub(super) const fn row(
    name: &'static str,
    default: ParamValue,
    range: (f64, f64),
    unit: &'static str,
    group: &'static str,
    short: &'static str,
) -> Row {
    Row {
        name,
        default,
        low: range.0,
        high: range.1,
        unit,
        group,
        short,
        values: &[],
        bits: &[],
        read_only: false,
        volatile: false,
        token: false,
        wire: match default {
            Int(_) => MavParamType::MAV_PARAM_TYPE_INT32,
            Real(_) => MavParamType::MAV_PARAM_TYPE_REAL32,
        },
        source: ParamSource::Own,
    }
}

impl Row {
    pub(super) const fn values(mut self, values: &'static [(i32, &'static str)]) -> Self {
        self.values = values;
        self
    }

    pub(super) const fn bits(mut self, bits: &'static [(i32, &'static str)]) -> Self {
        self.bits = bits;
        self
    }

    pub(super) const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    pub(super) const fn wire(mut self, wire: MavParamType) -> Self {
        self.wire = wire;
        self
    }

    pub(super) const fn read_only(mut self) -> Self {
        self.read_only = true;
        self
    }

    pub(super) const fn volatile(mut self) -> Self {
        self.volatile = true;
        self
    }

    pub(super) const fn token(mut self) -> Self {
        self.token = true;
        self
    }
}

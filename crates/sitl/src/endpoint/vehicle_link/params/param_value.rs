//! A parameter value and its type.

/// A parameter value and its type.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ParamValue {
    /// An integer, sent as INT32.
    Int(i32),
    /// A floating-point number, sent as REAL32.
    Real(f32),
}

impl ParamValue {
    /// Returns the value encoded bytewise in the message's float field.
    #[must_use]
    pub fn to_wire(self) -> f32 {
        match self {
            Self::Int(i) => f32::from_bits(i.cast_unsigned()),
            Self::Real(r) => r,
        }
    }

    /// Returns the value converted to float, as a C cast does.
    #[must_use]
    pub fn cast(self) -> f32 {
        self.number() as f32
    }

    /// Converts a number to a value of the same type.
    pub(super) fn with_number(self, number: f64) -> Self {
        match self {
            Self::Int(_) => Self::Int(number.round() as i32),
            Self::Real(_) => Self::Real(number as f32),
        }
    }

    /// Returns the value as a number.
    pub(super) fn number(self) -> f64 {
        match self {
            Self::Int(i) => f64::from(i),
            Self::Real(r) => f64::from(r),
        }
    }
}

//! Dimensions of the bridge types. One table per type lists each key with its range, default and meaning. The type's
//! fields, the scenario file reader and the check of scenarios/README.md are all derived from it.

/// A numeric key of a bridge type in scenario files.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BridgeField {
    /// Key, including its unit.
    pub key: &'static str,
    /// Minimum allowed value.
    pub min: f64,
    /// Maximum allowed value.
    pub max: f64,
    /// Value if the key is missing.
    pub default: f64,
    /// Meaning with its source, as in scenarios/README.md.
    pub meaning: &'static str,
}

/// A dimension that is within its range but inconsistent with other dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct Inconsistency {
    /// Key of the dimension.
    pub key: &'static str,
    /// Value of the dimension.
    pub value: f64,
    /// Allowed values, given the other dimensions.
    pub allowed: String,
}

/// Collects inconsistencies while the dimensions of a bridge are compared.
#[derive(Debug, Default)]
pub struct InconsistencyList(pub(super) Vec<Inconsistency>);

impl InconsistencyList {
    pub(super) fn require_integer(&mut self, key: &'static str, value: f64) {
        if value.fract() != 0.0 {
            self.0.push(Inconsistency { key, value, allowed: "a whole number".into() });
        }
    }

    pub(super) fn require_even(&mut self, key: &'static str, value: f64) {
        if value.round() % 2.0 != 0.0 || value.fract() != 0.0 {
            self.0.push(Inconsistency { key, value, allowed: "an even number".into() });
        }
    }

    pub(super) fn require_one_of(&mut self, key: &'static str, value: f64, allowed: &[f64], why: &str) {
        if !allowed.contains(&value) {
            let numbers: Vec<String> = allowed.iter().map(f64::to_string).collect();
            self.0.push(Inconsistency { key, value, allowed: format!("{why}: {}", numbers.join(", ")) });
        }
    }

    pub(super) fn require_at_least(&mut self, key: &'static str, value: f64, low: f64, why: &str) {
        if value < low {
            self.0.push(Inconsistency { key, value, allowed: format!("{why}: at least {low:.2}") });
        }
    }

    pub(super) fn require_at_most(&mut self, key: &'static str, value: f64, high: f64, why: &str) {
        if value > high {
            self.0.push(Inconsistency { key, value, allowed: format!("{why}: at most {high:.2}") });
        }
    }
}

/// Defines the dimensions of a bridge type from one table: key, range, default, meaning. The type's name in scenario
/// files comes from the struct name.
macro_rules! bridge_dimensions {
    (
        $(#[$doc:meta])*
        $bridge:ident $name:literal {
            $($key:ident $min:literal to $max:literal, $default:literal, $meaning:literal;)+
        }
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq)]
        pub struct $bridge {
            $(#[doc = $meaning] pub $key: f64,)+
        }

        impl $bridge {
            /// Value of `type` in scenario files, and name of the dimensions table.
            pub const TYPE: &'static str = $name;

            /// Dimension keys in scenario files.
            pub const FIELDS: &'static [$crate::scenario::bridges::BridgeField] = &[
                $($crate::scenario::bridges::BridgeField {
                    key: stringify!($key),
                    min: $min,
                    max: $max,
                    default: $default,
                    meaning: $meaning,
                },)+
            ];

            /// Creates a bridge from values in the order of `FIELDS`; missing values get their defaults.
            #[must_use]
            pub fn from_values(values: &[f64]) -> Self {
                let mut values = values.iter().copied();
                Self { $($key: values.next().unwrap_or($default),)+ }
            }
        }

        impl Default for $bridge {
            fn default() -> Self {
                Self::from_values(&[])
            }
        }
    };
}

pub(super) use bridge_dimensions;

//! Kinds of crashes as all figures over several sessions show them.

use crate::record::Crashes;

/// Style and name; persons and vehicles are one kind, for either ends a session.
pub const KINDS: [(&str, &str); 5] = [
    ("k-bridge", "bridge"),
    ("k-terrain", "ground"),
    ("k-water", "water"),
    ("k-other", "other"),
    ("k-grave", "person or vehicle"),
];

/// Counts in the order of [`KINDS`].
pub fn counted(crashes: &Crashes) -> [usize; 5] {
    [crashes.bridge, crashes.terrain, crashes.water, crashes.other, crashes.person + crashes.vehicle]
}

/// Counts with their styles.
pub fn segments(crashes: &Crashes) -> Vec<(&'static str, usize)> {
    KINDS.iter().zip(counted(crashes)).map(|((class, _), count)| (*class, count)).collect()
}

//! Crash kinds as shown in figures over several sessions.

use crate::record::Crashes;

/// Style and name of each kind. People and vehicles are combined because either ends a session.
pub const KINDS: [(&str, &str); 5] = [
    ("k-bridge", "bridge"),
    ("k-terrain", "ground"),
    ("k-water", "water"),
    ("k-other", "other"),
    ("k-grave", "person or vehicle"),
];

/// Returns the counts in the order of [`KINDS`].
pub fn counted(crashes: &Crashes) -> [usize; 5] {
    [crashes.bridge, crashes.terrain, crashes.water, crashes.other, crashes.person + crashes.vehicle]
}

/// Returns the counts with their styles.
pub fn segments(crashes: &Crashes) -> Vec<(&'static str, usize)> {
    KINDS.iter().zip(counted(crashes)).map(|((class, _), count)| (*class, count)).collect()
}

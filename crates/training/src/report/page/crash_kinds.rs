//! Kinds of crashes, as grouped in multi-session figures.

use crate::record::Crashes;

/// CSS class and name of each kind. People and vehicles share one kind because hitting either ends a session.
pub const KINDS: [(&str, &str); 5] = [
    ("k-bridge", "bridge"),
    ("k-terrain", "ground"),
    ("k-water", "water"),
    ("k-other", "other"),
    ("k-grave", "person or vehicle"),
];

/// Returns the number of crashes of each kind, in the order of [`KINDS`].
pub fn crash_counts(crashes: &Crashes) -> [usize; 5] {
    [crashes.bridge, crashes.terrain, crashes.water, crashes.other, crashes.person + crashes.vehicle]
}

/// Returns the CSS class and number of crashes of each kind.
pub fn segments(crashes: &Crashes) -> Vec<(&'static str, usize)> {
    KINDS.iter().zip(crash_counts(crashes)).map(|((class, _), count)| (*class, count)).collect()
}

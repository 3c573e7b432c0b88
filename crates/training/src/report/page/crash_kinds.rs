//! Kinds of crashes, as grouped in multi-session figures.

use crate::record::Crashes;
use crate::terms::contact_title;
use spandrel_text::{Language, text};

/// CSS class of each kind. People and vehicles share one kind because hitting either ends a session.
const CLASSES: [&str; 5] = ["k-bridge", "k-terrain", "k-water", "k-other", "k-grave"];

/// Returns the CSS class and name of each kind.
pub fn kinds(language: Language) -> [(&'static str, String); 5] {
    let [bridge, terrain, water, other, grave] = CLASSES;
    [
        (bridge, contact_title("bridge", language)),
        (terrain, contact_title("terrain", language)),
        (water, contact_title("water", language)),
        (other, contact_title("other", language)),
        (grave, text!(language, "report-contact-grave")),
    ]
}

/// Returns the number of crashes of each kind, in the order of [`kinds`].
pub fn crash_counts(crashes: &Crashes) -> [usize; 5] {
    [crashes.bridge, crashes.terrain, crashes.water, crashes.other, crashes.person + crashes.vehicle]
}

/// Returns the CSS class and number of crashes of each kind.
pub fn segments(crashes: &Crashes) -> Vec<(&'static str, usize)> {
    CLASSES.into_iter().zip(crash_counts(crashes)).collect()
}

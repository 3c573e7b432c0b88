//! Classes: named groups of trainees. A trainee may be in several classes.

/// A class and its members.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TrainingClass {
    /// Unique name, valid in URLs.
    pub name: String,
    /// Pseudonyms of the members, in alphabetical order.
    pub members: Vec<String>,
}

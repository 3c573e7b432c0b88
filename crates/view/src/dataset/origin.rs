//! Origin of a data set: what its files say about how it was made, and its license.

/// License of the pictures and labels.
pub const LICENSE: &str = "MIT OR Apache-2.0, as Spandrel; imported models and aerial photographs keep their own licenses";

/// Origin of a data set.
#[derive(Debug, Clone, Copy)]
pub struct DatasetOrigin<'a> {
    /// Version of the program.
    pub version: &'a str,
    /// Name of the scenario.
    pub scenario: &'a str,
    /// Seed.
    pub seed: u64,
    /// Quality preset.
    pub quality: &'a str,
    /// Name of the graphics device.
    pub renderer: &'a str,
}

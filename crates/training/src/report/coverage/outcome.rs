//! Possible outcomes of surface coverage.

use spandrel_text::{Language, text};

/// Coverage outcome of a surface patch, from worst to best. If several pictures show the patch, the best one counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SurfaceOutcome {
    /// Never in the camera's view at the required distance and angle.
    NeverInView,
    /// In view but not photographed.
    NotPhotographed,
    /// Photographed from too far away, so the pixel size is too large.
    TooFar,
    /// Photographed at more than 60 degrees from the surface normal.
    TooOblique,
    /// Too dark, with the lamp off.
    DarkLampOff,
    /// Too dark, even with the lamp on.
    DarkLampOn,
    /// Too much motion blur.
    Blurred,
    /// Captured well in a picture.
    Shown,
}

impl SurfaceOutcome {
    /// All outcomes, best first, in the order of legends and columns.
    pub const ALL: [Self; 8] = [
        Self::Shown,
        Self::Blurred,
        Self::DarkLampOn,
        Self::DarkLampOff,
        Self::TooOblique,
        Self::TooFar,
        Self::NotPhotographed,
        Self::NeverInView,
    ];

    /// Returns the name shown in the report.
    #[must_use]
    pub fn name(self, language: Language) -> String {
        match self {
            Self::Shown => text!(language, "report-coverage-shown"),
            Self::Blurred => text!(language, "report-coverage-blurred"),
            Self::DarkLampOn => text!(language, "report-coverage-dark-on"),
            Self::DarkLampOff => text!(language, "report-coverage-dark-off"),
            Self::TooOblique => text!(language, "report-coverage-oblique"),
            Self::TooFar => text!(language, "report-coverage-far"),
            Self::NotPhotographed => text!(language, "report-coverage-unpictured"),
            Self::NeverInView => text!(language, "report-coverage-unseen"),
        }
    }

    /// Returns the CSS class that colors the outcome in the report.
    #[must_use]
    pub fn class(self) -> &'static str {
        match self {
            Self::Shown => "f-shown",
            Self::Blurred => "f-blurred",
            Self::DarkLampOn => "f-dark-on",
            Self::DarkLampOff => "f-dark-off",
            Self::TooOblique => "f-oblique",
            Self::TooFar => "f-far",
            Self::NotPhotographed => "f-unpictured",
            Self::NeverInView => "f-unseen",
        }
    }
}

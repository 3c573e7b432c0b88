//! Possible outcomes of surface coverage.

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
    pub fn name(self) -> &'static str {
        match self {
            Self::Shown => "captured well",
            Self::Blurred => "blurred",
            Self::DarkLampOn => "too dark, lamp on",
            Self::DarkLampOff => "too dark, lamp off",
            Self::TooOblique => "too oblique",
            Self::TooFar => "too far",
            Self::NotPhotographed => "in view, not photographed",
            Self::NeverInView => "never in view",
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

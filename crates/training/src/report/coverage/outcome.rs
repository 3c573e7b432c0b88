//! What can become of a piece of surface.

/// What became of a piece of surface, from nothing to all that is asked for: its best picture counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SurfaceOutcome {
    /// The camera never had it before it, near and square enough.
    Unseen,
    /// The camera had, and no picture was taken.
    Unpictured,
    /// A pixel covers too much of it.
    TooFar,
    /// More than 60 degrees off square.
    TooOblique,
    /// Too little light, and the lamp was off.
    DarkLampOff,
    /// Too little light, though the lamp was on.
    DarkLampOn,
    /// Smeared by the drone's motion.
    Blurred,
    /// A picture shows it well.
    Shown,
}

impl SurfaceOutcome {
    /// All, the best first: the order of legends and columns.
    pub const ALL: [Self; 8] = [
        Self::Shown,
        Self::Blurred,
        Self::DarkLampOn,
        Self::DarkLampOff,
        Self::TooOblique,
        Self::TooFar,
        Self::Unpictured,
        Self::Unseen,
    ];

    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Shown => "shown well",
            Self::Blurred => "blurred",
            Self::DarkLampOn => "too dark, lamp on",
            Self::DarkLampOff => "too dark, lamp off",
            Self::TooOblique => "too oblique",
            Self::TooFar => "too far",
            Self::Unpictured => "in view, no picture",
            Self::Unseen => "never in view",
        }
    }

    /// Name of its style.
    #[must_use]
    pub fn class(self) -> &'static str {
        match self {
            Self::Shown => "f-shown",
            Self::Blurred => "f-blurred",
            Self::DarkLampOn => "f-dark-on",
            Self::DarkLampOff => "f-dark-off",
            Self::TooOblique => "f-oblique",
            Self::TooFar => "f-far",
            Self::Unpictured => "f-unpictured",
            Self::Unseen => "f-unseen",
        }
    }
}

//! A card: what a picture shows and from which distance it was taken.

use spandrel_model::defect_codes;

/// Subject in the middle of a picture. Ordered by defect code; sound surfaces come first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Subject {
    /// A surface without defects.
    Sound,
    /// A defect with this AASHTO MBEI code.
    Defect(u32),
}

/// Distance between the lens and the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Distance {
    /// 1 m.
    Near,
    /// 3 m, a usual stand-off.
    Middle,
    /// 8 m, the largest distance at which off-path warnings appear in the TASBID paper.
    Far,
}

/// A card. The order is by distance, because new cards are asked from near to far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Card {
    /// Distance of the camera.
    pub distance: Distance,
    /// Subject of the picture.
    pub subject: Subject,
}

impl Distance {
    /// All distances, from near to far.
    pub const ALL: [Self; 3] = [Self::Near, Self::Middle, Self::Far];

    /// Returns the distance in whole meters.
    #[must_use]
    pub const fn m(self) -> u32 {
        match self {
            Self::Near => 1,
            Self::Middle => 3,
            Self::Far => 8,
        }
    }
}

/// Code of a sound surface in file names of cards. No defect has this code.
const SOUND_CODE: u32 = 0;

impl Card {
    /// Returns the name used in files: defect code (0 for a sound surface) and distance, such as `1130@3m`.
    #[must_use]
    pub fn name(self) -> String {
        let code = match self.subject {
            Subject::Sound => SOUND_CODE,
            Subject::Defect(code) => code,
        };
        format!("{code}@{}m", self.distance.m())
    }

    /// Returns the card with this name, or `None` if there is no such card.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let (code, distance) = name.strip_suffix('m')?.split_once('@')?;
        let distance = Distance::ALL.into_iter().find(|known| known.m().to_string() == distance)?;
        let subject = match code.parse().ok()? {
            SOUND_CODE => Subject::Sound,
            code if defect_codes::ALL.contains(&code) => Subject::Defect(code),
            _ => return None,
        };
        let card = Self { distance, subject };
        // Only one spelling of each name is accepted, so that no card has two entries in a file.
        (card.name() == name).then_some(card)
    }
}

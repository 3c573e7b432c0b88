//! Contact kinds: the codes in the `contact` named value.

use serde::Serialize;

/// Kind of object that the aircraft touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Default)]
#[serde(rename_all = "lowercase")]
pub enum ContactKind {
    /// No contact.
    #[default]
    None,
    /// A bridge member.
    Bridge,
    /// The ground.
    Terrain,
    /// The water surface.
    Water,
    /// A car or truck.
    Vehicle,
    /// A pedestrian or a member of the ground crew.
    Person,
    /// Anything else, including unknown codes.
    Other,
}

impl ContactKind {
    /// All kinds, indexed by code.
    pub const ALL: [Self; 7] = [Self::None, Self::Bridge, Self::Terrain, Self::Water, Self::Vehicle, Self::Person, Self::Other];

    /// Returns the kind for a MAVLink code; [`Self::Other`] if the code is unknown.
    #[must_use]
    pub fn from_code(code: i32) -> Self {
        usize::try_from(code).ok().and_then(|code| Self::ALL.get(code)).copied().unwrap_or(Self::Other)
    }

    /// Returns the MAVLink code, 0 to 6.
    #[must_use]
    pub fn code(self) -> i32 {
        match self {
            Self::None => 0,
            Self::Bridge => 1,
            Self::Terrain => 2,
            Self::Water => 3,
            Self::Vehicle => 4,
            Self::Person => 5,
            Self::Other => 6,
        }
    }

    /// Returns the label used in exported files.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Bridge => "bridge",
            Self::Terrain => "terrain",
            Self::Water => "water",
            Self::Vehicle => "vehicle",
            Self::Person => "person",
            Self::Other => "other",
        }
    }

    /// Returns the severity, 0 to 6. If there are several contacts, only the most severe is published. Order, most
    /// severe first: person, vehicle, bridge, terrain, water, other, none.
    #[must_use]
    pub fn severity(self) -> u8 {
        match self {
            Self::None => 0,
            Self::Other => 1,
            Self::Water => 2,
            Self::Terrain => 3,
            Self::Bridge => 4,
            Self::Vehicle => 5,
            Self::Person => 6,
        }
    }

    /// Returns the more severe of two contacts.
    #[must_use]
    pub fn more_severe(self, other: Self) -> Self {
        if other.severity() > self.severity() { other } else { self }
    }

    /// Returns whether the contact counts toward X_o in TASBID, which covers contacts with anything except people and
    /// vehicles.
    #[must_use]
    pub fn is_other_crash(self) -> bool {
        matches!(self, Self::Bridge | Self::Terrain | Self::Water | Self::Other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_contact_codes_round_trip_and_unknown_codes_are_other() {
        for contact in ContactKind::ALL {
            assert_eq!(ContactKind::from_code(contact.code()), contact);
        }
        assert_eq!([7, -1].map(ContactKind::from_code), [ContactKind::Other; 2]);
    }
}

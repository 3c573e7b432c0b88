//! Crash counts in a session record.

use serde::{Deserialize, Serialize};
use spandrel_mavlink::contract::contact::ContactKind;

/// Crash counts by kind of object hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Crashes {
    /// Crashes into bridges.
    pub bridge: usize,
    /// Crashes into the ground.
    pub terrain: usize,
    /// Crashes into water.
    pub water: usize,
    /// Crashes into any other object.
    pub other: usize,
    /// Crashes into cars and trucks.
    pub vehicle: usize,
    /// Crashes into people.
    pub person: usize,
}

impl Crashes {
    /// Counts one crash.
    pub(super) fn add(&mut self, with: ContactKind) {
        match with {
            ContactKind::None => {}
            ContactKind::Bridge => self.bridge += 1,
            ContactKind::Terrain => self.terrain += 1,
            ContactKind::Water => self.water += 1,
            ContactKind::Other => self.other += 1,
            ContactKind::Vehicle => self.vehicle += 1,
            ContactKind::Person => self.person += 1,
        }
    }

    /// Returns the sum of two counts.
    #[must_use]
    pub fn combined_with(self, more: Self) -> Self {
        Self {
            bridge: self.bridge + more.bridge,
            terrain: self.terrain + more.terrain,
            water: self.water + more.water,
            other: self.other + more.other,
            vehicle: self.vehicle + more.vehicle,
            person: self.person + more.person,
        }
    }

    /// Returns the key and number of crashes of each kind.
    #[must_use]
    pub fn by_kind(&self) -> [(&'static str, usize); 6] {
        [
            ("bridge", self.bridge),
            ("terrain", self.terrain),
            ("water", self.water),
            ("other", self.other),
            ("vehicle", self.vehicle),
            ("person", self.person),
        ]
    }

    /// Returns the total number of crashes.
    #[must_use]
    pub fn total(&self) -> usize {
        self.by_kind().iter().map(|(_, count)| count).sum()
    }
}

//! Changes of a site during a flight that telemetry reports: bridge closures and the inspector's walks.

use super::bridge_closures::BridgeClosures;
use super::inspector_walks::InspectorWalks;

/// Changes during a flight. Everyone who has the scenario, the seed and these changes computes the same positions of traffic and
/// inspector.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SiteChanges {
    /// Times at which the bridges were closed and reopened.
    pub closures: BridgeClosures,
    /// The inspector's walks.
    pub walks: InspectorWalks,
}

impl SiteChanges {
    /// Returns true if nothing has changed.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.closures.is_empty() && self.walks.is_empty()
    }
}

//! State of a return.

use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::time::SimTime;

/// Phase of a return.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ReturnPhase {
    /// Climbing to the return height.
    #[default]
    Climb,
    /// Flying to the destination.
    Cruise,
    /// Waiting above the destination.
    Wait,
    /// Holding above the destination instead of landing.
    Stay,
    /// Landing.
    Land,
}

/// Phase, destination and wait of a return.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ReturnState {
    /// Phase of the return.
    pub phase: ReturnPhase,
    /// Destination, m.
    pub target_m: Option<Vec3<Ned>>,
    /// End of the wait above the destination.
    pub wait_until: Option<SimTime>,
}

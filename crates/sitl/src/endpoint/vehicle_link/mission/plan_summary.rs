//! Summary of the stored plans.

/// Summary of the stored plans.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PlanSummary {
    /// Number of mission items.
    pub mission_items: u16,
    /// IDs of mission, fence and rally points, which stations use to detect changes; 0 for an empty plan.
    pub ids: [u32; 3],
    /// Number of leading items in a transferred mission that are not flown (home).
    pub lead: u16,
}

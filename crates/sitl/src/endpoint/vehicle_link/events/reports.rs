//! Sent events, kept for retransmission.

use super::super::snapshot::VehicleSnapshot;
use super::definitions::{MISSION_GROUP, MODE_GROUPS, check, sub_id};
use spandrel_mavlink::dialect::EVENT_DATA;
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Number of events kept for retransmission (estimate: several reports).
pub(super) const HISTORY_LENGTH: usize = 64;

/// Events sent, and the contents of the last report.
#[derive(Debug, Clone, Default)]
pub struct EventReports {
    pub(super) sequence: u16,
    pub(super) history: VecDeque<EVENT_DATA>,
    pub(super) reported: Option<(Vec<String>, [u32; 5])>,
    pub(super) next_report: SimTime,
    pub(super) next_sequence: SimTime,
    /// Whether to send a report even if nothing has changed.
    pub requested: bool,
}

impl EventReports {
    pub(super) fn add(&mut self, name: &str, log_levels: u8, payload: &[u8], now_ms: u32) {
        let mut arguments = [0; 40];
        arguments.iter_mut().zip(payload).for_each(|(slot, byte)| *slot = *byte);
        self.sequence = self.sequence.wrapping_add(1);
        let (id, sequence) = (sub_id(name) | 1 << 24, self.sequence);
        let event = EVENT_DATA {
            id,
            event_time_boot_ms: now_ms,
            sequence,
            destination_component: 0,
            destination_system: 0,
            log_levels,
            arguments,
        };
        if self.history.len() == HISTORY_LENGTH {
            self.history.pop_front();
        }
        self.history.push_back(event);
    }
}

/// Returns the bit masks: failed checks, modes that allow arming, modes that can run, components present, components
/// failing.
pub(super) fn masks(view: &VehicleSnapshot) -> [u32; 5] {
    let s = view.status;
    let errors = s.arming_blockers.iter().fold(0, |mask, reason| mask | 1 << check(reason).2);
    let flyable = |(nav, _, _, needs_position): &(u8, &str, u32, bool)| {
        (view.estimate.position_valid || !needs_position) && (*nav != MISSION_GROUP || view.plans.mission_items > 0)
    };
    let can_run = MODE_GROUPS.iter().filter(|group| flyable(group)).fold(0, |mask, group| mask | 1 << group.0);
    let can_arm = if s.arming_blockers.is_empty() { can_run } else { 0 };
    let present = [1, 3, 11, 27, 29].iter().fold(0, |mask, bit| mask | 1_u32 << bit);
    let failing = u32::from(!s.health.barometer) << 1 | u32::from(!s.health.compass) << 27;
    [errors, can_arm, can_run, present, failing]
}

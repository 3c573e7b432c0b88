//! The AVAILABLE_MODES message, which describes the flight modes.

use super::VehicleLink;
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::link::{LinkId, Links};
use spandrel_mavlink::dialect::{AVAILABLE_MODES_DATA, MavMessage, MavModeProperty, MavResult};

impl VehicleLink {
    /// Sends one mode, or all modes if `index` is 0.
    pub(crate) fn send_modes(&self, index: f64, link: LinkId, links: &mut Links) -> MavResult {
        let modes = self.flavor.modes;
        let count = modes.len();
        let requested = if index.is_finite() && index >= 0.0 { index as usize } else { return MavResult::MAV_RESULT_DENIED };
        if requested > count {
            return MavResult::MAV_RESULT_DENIED;
        }
        for (k, row) in modes.iter().enumerate().filter(|(k, _)| requested == 0 || requested == k + 1) {
            let mut properties = MavModeProperty::empty();
            properties.set(MavModeProperty::MAV_MODE_PROPERTY_NOT_USER_SELECTABLE, !row.selectable);
            properties.set(MavModeProperty::MAV_MODE_PROPERTY_AUTO_MODE, row.auto);
            let message = MavMessage::AVAILABLE_MODES(AVAILABLE_MODES_DATA {
                custom_mode: row.number,
                properties,
                number_modes: count as u8,
                mode_index: (k + 1) as u8,
                standard_mode: row.standard,
                mode_name: row.name.into(),
            });
            links.answer(AUTOPILOT, link, &message);
        }
        MavResult::MAV_RESULT_ACCEPTED
    }
}

//! Commands that the simulator executes beside an external autopilot: for the equipment, the instructor and restarts.

use super::RelayEndpoint;
use crate::endpoint::component_ids::{AUTOPILOT, CAMERA, LAMP};
use crate::endpoint::link::LinkId;
use crate::endpoint::payload::commands as payload_commands;
use crate::endpoint::refused_request::queue_or_refuse;
use crate::endpoint::simulated_aircraft::SimulatedAircraft;
use crate::endpoint::vehicle_command::VehicleCommand;
use crate::endpoint::vehicle_link::FailureInjection;
use spandrel_mavlink::dialect::{MavCmd, MavResult, MavSeverity};

const COMMAND_ACK: u32 = 77;

impl RelayEndpoint {
    /// Executes and acknowledges a command for the simulator. Returns false if the command is for the autopilot.
    pub(super) fn handle_command(&mut self, id: LinkId, command: &VehicleCommand, aircraft: &SimulatedAircraft) -> bool {
        let Some(result) = self.execute(id, command, aircraft) else { return false };
        let component = if command.component == 0 { AUTOPILOT } else { command.component };
        let number = command.number.to_le_bytes();
        if let Some(link) = self.links.get_mut(id) {
            // Encoded manually because the command number may be unknown to the dialect.
            let payload = [number[0], number[1], result as u8, 0, 0, 0, 0, 0, command.from.0, command.from.1];
            link.send_payload(component, COMMAND_ACK, &payload);
        }
        true
    }

    /// Executes a command; `None` if it is for the autopilot.
    fn execute(&mut self, id: LinkId, c: &VehicleCommand, aircraft: &SimulatedAircraft) -> Option<MavResult> {
        if let Some(result) = self.handle_message_request(id, c, aircraft) {
            return Some(result);
        }
        let for_autopilot = c.component <= AUTOPILOT;
        if for_autopilot && let Some(result) = self.practice_requests.take(&aircraft.practice, c, &mut self.texts) {
            return Some(result);
        }
        match c.number {
            n if n == MavCmd::MAV_CMD_INJECT_FAILURE as u16 && for_autopilot => return Some(self.inject(c, aircraft)),
            n if n == MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN as u16 && for_autopilot => return self.restart(c),
            _ => {}
        }
        let input = &self.input(aircraft);
        let equipment = &mut self.payload.equipment;
        let unsupported = Some(MavResult::MAV_RESULT_UNSUPPORTED);
        match c.component {
            CAMERA => payload_commands::handle_camera(c, input, equipment).or(unsupported),
            LAMP => payload_commands::handle_lamp(c, input, equipment).or(unsupported),
            0 | AUTOPILOT => payload_commands::handle_lamp(c, input, equipment)
                .or_else(|| payload_commands::handle_inspector(c, input, equipment)),
            other if self.links.is_own(other) => unsupported,
            _ => None,
        }
    }

    /// Queues a failure of the simulated hardware. The autopilot's own failure injection is never used as well.
    fn inject(&mut self, c: &VehicleCommand, aircraft: &SimulatedAircraft) -> MavResult {
        queue_or_refuse(FailureInjection::from_command(c, aircraft.vehicle), &mut self.injections, &mut self.texts)
    }

    /// Requests a restart of the process of an autopilot that cannot reboot itself. Parameter 1: 1 or 3 reboots.
    fn restart(&mut self, c: &VehicleCommand) -> Option<MavResult> {
        if !self.rules.restarts_by_process || !matches!(c.p[0], 1.0 | 3.0) {
            return None;
        }
        if self.report.is_armed() {
            self.push_text(MavSeverity::MAV_SEVERITY_CRITICAL, "Reboot denied: vehicle is armed");
            return Some(MavResult::MAV_RESULT_TEMPORARILY_REJECTED);
        }
        self.restart_requested = true;
        Some(MavResult::MAV_RESULT_ACCEPTED)
    }
}

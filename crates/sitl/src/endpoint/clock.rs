//! Clocks used in messages: time since autopilot boot, simulation time, and UTC.

use super::link::LinkKind;
use spandrel_mavlink::dialect::{MavMessage, TIMESYNC_DATA};
use spandrel_model::time::SimTime;

/// One instant in time, expressed on each clock.
#[derive(Debug, Clone, Copy)]
pub struct VehicleClock {
    /// Simulation time.
    pub now: SimTime,
    /// Simulation time of the last autopilot boot.
    pub autopilot_boot_time: SimTime,
    /// UTC at simulation start, in seconds since the Unix epoch.
    pub start_unix_s: i64,
    /// Kind of link that receives the times.
    pub link_kind: LinkKind,
}

impl VehicleClock {
    /// Returns the same instant for another kind of link.
    #[must_use]
    pub fn for_link(self, link_kind: LinkKind) -> Self {
        Self { link_kind, ..self }
    }

    /// Converts a time to the autopilot's clock, which restarts when the autopilot boots. Payload processes receive
    /// simulation time instead, so that scoring uses a single clock.
    #[must_use]
    pub fn since_boot(&self, at: SimTime) -> SimTime {
        if self.link_kind == LinkKind::Payload { at } else { at.saturating_sub(self.autopilot_boot_time) }
    }

    /// Returns the response to a time request from a system and component. Uses the clock of the message timestamps, so that
    /// clients can convert them.
    #[must_use]
    pub fn time_response(&self, request: &TIMESYNC_DATA, (target_system, target_component): (u8, u8)) -> MavMessage {
        let tc1 = self.since_boot(self.now).ns().max(1);
        MavMessage::TIMESYNC(TIMESYNC_DATA { tc1, ts1: request.ts1, target_system, target_component })
    }

    /// Returns the time since autopilot boot in ms, modulo 2^32 because MAVLink's field has 32 bits.
    #[must_use]
    pub fn boot_time_ms(&self) -> u32 {
        self.since_boot(self.now).ms() as u32
    }

    /// Returns the time since autopilot boot in microseconds.
    #[must_use]
    pub fn boot_time_us(&self) -> u64 {
        self.since_boot(self.now).us().max(0).cast_unsigned()
    }

    /// Returns the time since simulation start in ms, modulo 2^32. The camera and the scoring data use this clock,
    /// which does not restart when the autopilot reboots.
    #[must_use]
    pub fn sim_time_ms(&self) -> u32 {
        self.now.ms() as u32
    }

    /// Returns the time since simulation start in microseconds.
    #[must_use]
    pub fn sim_time_us(&self) -> u64 {
        self.now.us().max(0).cast_unsigned()
    }

    /// Returns the time since the Unix epoch in microseconds.
    #[must_use]
    pub fn unix_time_us(&self) -> u64 {
        (self.start_unix_s * 1_000_000 + self.now.us()).max(0).cast_unsigned()
    }
}

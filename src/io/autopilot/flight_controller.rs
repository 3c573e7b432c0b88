//! A flight controller on a serial port: its clock, its reboots, and its system ID.

use spandrel_mavlink::codec::ReceivedFrame;
use spandrel_mavlink::dialect::{MavCmd, MavMessage, MavResult};
use spandrel_mavlink::station;
use spandrel_model::time::SimTime;
use spandrel_sitl::backend::px4::{ClockOffset, MeasuredOffset};
use std::time::Duration;

/// Component ID of the autopilot.
const AUTOPILOT: u8 = 1;
/// Silence after which the next frame comes from a flight controller that has rebooted. One that runs sends several hundred frames
/// per second, and one that boots sends nothing for several seconds.
const REBOOT_SILENCE: Duration = Duration::from_secs(1);
/// Time within which a flight controller acknowledges the command to reboot.
const ACKNOWLEDGMENT_TIMEOUT: Duration = Duration::from_secs(3);
/// Parameter 2 of MAV_CMD_COMPONENT_ARM_DISARM that disarms in flight, too.
const FORCE: f32 = 21_196.0;
/// Parameter 1 of MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN that reboots the autopilot.
const REBOOT: f32 = 1.0;

/// How to use a frame from the flight controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameUse {
    /// The vehicle's MAVLink interface gets the frame.
    Forward,
    /// The frame has been handled.
    Consumed,
    /// The frame is the first one after a reboot.
    Rebooted,
}

/// A reboot that has not ended yet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Reboot {
    /// Time at which the command was sent; `None` before that.
    sent: Option<Duration>,
    /// Time of the latest frame.
    last_frame: Duration,
    acknowledged: bool,
    /// Whether the log asks the user to restart the flight controller.
    needs_user: bool,
}

/// State of a flight controller.
#[derive(Debug)]
pub struct FlightController {
    system_id: u8,
    clock: ClockOffset,
    reported_clock: bool,
    reboot: Option<Reboot>,
    reported_system_id: bool,
}

impl FlightController {
    /// Creates the state of a flight controller that should have this system ID.
    pub fn new(system_id: u8) -> Self {
        Self { system_id, clock: ClockOffset::default(), reported_clock: false, reboot: None, reported_system_id: false }
    }

    /// Returns whether only the user can continue, by restarting the flight controller.
    pub fn needs_user(&self) -> bool {
        self.reboot.is_some_and(|reboot| reboot.needs_user)
    }

    /// Begins a reboot.
    pub fn begin_reboot(&mut self, wall: Duration) {
        self.reboot = Some(Reboot { sent: None, last_frame: wall, acknowledged: false, needs_user: false });
    }

    /// Ends a reboot: the flight controller has started again.
    pub fn finish_reboot(&mut self) {
        self.reboot = None;
        self.clock = ClockOffset::default();
        self.reported_clock = false;
    }

    /// Returns the messages that are due: requests for the time, or the commands of a reboot.
    pub fn messages(&mut self, wall: Duration) -> Vec<MavMessage> {
        let Some(reboot) = &mut self.reboot else { return self.clock.request(clock_time(wall)).into_iter().collect() };
        match reboot.sent {
            None => {
                reboot.sent = Some(wall);
                let command = |command, first, second| {
                    let params = [first, second, 0.0, 0.0, 0.0, 0.0, 0.0];
                    MavMessage::COMMAND_LONG(station::command(self.system_id, AUTOPILOT, command, params))
                };
                // PX4 refuses to reboot while it is armed.
                vec![
                    command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 0.0, FORCE),
                    command(MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, REBOOT, 0.0),
                ]
            }
            Some(sent) => {
                let is_late = wall.saturating_sub(sent) > ACKNOWLEDGMENT_TIMEOUT;
                if is_late && !reboot.acknowledged {
                    reboot.ask_user("has not acknowledged the command to reboot");
                }
                self.clock.request(clock_time(wall)).into_iter().collect()
            }
        }
    }

    /// Takes a frame that arrived at `wall`, which is on the same clock as [`Self::messages`].
    pub fn handle(&mut self, frame: &ReceivedFrame, wall: Duration) -> FrameUse {
        if let Some(reboot) = &mut self.reboot {
            let silence = wall.saturating_sub(std::mem::replace(&mut reboot.last_frame, wall));
            // A busy computer reads the frames from before a silence late and doesn't notice it, but the clock has restarted, too.
            if silence >= REBOOT_SILENCE || has_restarted(&self.clock, frame) {
                return FrameUse::Rebooted;
            }
            reboot.read(frame);
            return FrameUse::Consumed;
        }
        self.check_system_id(frame);
        match &frame.message {
            Some(MavMessage::TIMESYNC(sync)) if self.clock.receive(sync, clock_time(wall)) => {
                self.report_clock();
                FrameUse::Consumed
            }
            _ => FrameUse::Forward,
        }
    }

    /// Logs the offset once.
    fn report_clock(&mut self) {
        let Some(MeasuredOffset { offset, round_trip }) = self.clock.measured() else { return };
        if !std::mem::replace(&mut self.reported_clock, true) {
            tracing::info!(
                "the flight controller's clock is {:+.4} s from the simulator's, round trip {:.1} ms (TIMESYNC)",
                offset.s(),
                1000.0 * round_trip.s()
            );
        }
    }

    fn check_system_id(&mut self, frame: &ReceivedFrame) {
        let is_wrong = frame.component_id == AUTOPILOT && frame.system_id != self.system_id;
        if is_wrong && !std::mem::replace(&mut self.reported_system_id, true) {
            tracing::warn!(
                "the flight controller has system ID {0}, but this vehicle has {1}: use --instance {2}, or set MAV_SYS_ID to {1}",
                frame.system_id,
                self.system_id,
                frame.system_id.saturating_sub(1)
            );
        }
    }
}

impl Reboot {
    /// Reads the acknowledgment of the command.
    fn read(&mut self, frame: &ReceivedFrame) {
        let Some(MavMessage::COMMAND_ACK(ack)) = &frame.message else { return };
        if ack.command != MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN || self.sent.is_none() {
            return;
        }
        self.acknowledged = true;
        if ack.result != MavResult::MAV_RESULT_ACCEPTED {
            self.ask_user("refuses to reboot");
        }
    }

    fn ask_user(&mut self, what: &str) {
        if !std::mem::replace(&mut self.needs_user, true) {
            tracing::warn!("the flight controller {what}: disconnect its power for a moment; the simulation then continues");
        }
    }
}

/// Returns whether the frame shows that the flight controller's clock has restarted.
fn has_restarted(clock: &ClockOffset, frame: &ReceivedFrame) -> bool {
    matches!(&frame.message, Some(MavMessage::TIMESYNC(sync)) if clock.has_restarted(sync))
}

/// Returns a wall time as a time stamp.
fn clock_time(wall: Duration) -> SimTime {
    SimTime::from_ns(i64::try_from(wall.as_nanos()).unwrap_or(i64::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::codec::{Decoder, Encoder};
    use spandrel_mavlink::dialect::{COMMAND_ACK_DATA, TIMESYNC_DATA};

    const SYSTEM_ID: u8 = 3;

    fn frame(message: &MavMessage) -> ReceivedFrame {
        Decoder::new().push(&Encoder::new(SYSTEM_ID, AUTOPILOT).encode(message)).remove(0)
    }

    fn acknowledgment(result: MavResult) -> ReceivedFrame {
        let command = MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN;
        frame(&MavMessage::COMMAND_ACK(COMMAND_ACK_DATA { command, result, ..Default::default() }))
    }

    fn at_ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    /// Returns a flight controller that has been sent the commands of a reboot at time 0.
    fn rebooting() -> FlightController {
        let mut controller = FlightController::new(SYSTEM_ID);
        controller.begin_reboot(Duration::ZERO);
        let commands: Vec<(MavCmd, f32, u8)> = controller
            .messages(Duration::ZERO)
            .into_iter()
            .filter_map(|message| match message {
                MavMessage::COMMAND_LONG(command) => Some((command.command, command.param1, command.target_system)),
                _ => None,
            })
            .collect();
        let [disarm, reboot] = [MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN];
        assert_eq!(commands, [(disarm, 0.0, SYSTEM_ID), (reboot, 1.0, SYSTEM_ID)]);
        controller
    }

    #[test]
    fn wire_reboot_ends_with_the_first_frame_after_a_silence() {
        let mut controller = rebooting();
        let beat = frame(&station::heartbeat());
        assert_eq!(controller.handle(&acknowledgment(MavResult::MAV_RESULT_ACCEPTED), at_ms(10)), FrameUse::Consumed);
        assert_eq!(controller.handle(&beat, at_ms(900)), FrameUse::Consumed, "frames from before the reboot");
        assert!(matches!(controller.messages(at_ms(8_000))[..], [MavMessage::TIMESYNC(_)]));
        assert!(!controller.needs_user());
        assert_eq!(controller.handle(&beat, at_ms(9_000)), FrameUse::Rebooted);
        controller.finish_reboot();
        assert_eq!(controller.handle(&beat, at_ms(9_010)), FrameUse::Forward);
    }

    #[test]
    fn wire_refused_or_ignored_reboot_needs_the_user() {
        let mut refused = rebooting();
        refused.handle(&acknowledgment(MavResult::MAV_RESULT_DENIED), at_ms(10));
        assert!(refused.needs_user());
        let mut ignored = rebooting();
        ignored.messages(at_ms(2_900));
        assert!(!ignored.needs_user());
        ignored.messages(at_ms(3_100));
        assert!(ignored.needs_user());
        // The user restarts it.
        assert_eq!(ignored.handle(&frame(&station::heartbeat()), at_ms(20_000)), FrameUse::Rebooted);
        ignored.finish_reboot();
        assert!(!ignored.needs_user());
    }

    /// Returns a reply to the latest request for the time.
    fn time_reply(request: &[MavMessage], clock: Duration) -> ReceivedFrame {
        let [MavMessage::TIMESYNC(request)] = request else { panic!("no request: {request:?}") };
        frame(&MavMessage::TIMESYNC(TIMESYNC_DATA { tc1: clock_time(clock).ns(), ts1: request.ts1, ..Default::default() }))
    }

    #[test]
    fn wire_reboot_ends_with_a_restarted_clock_although_no_silence_was_noticed() {
        let mut controller = FlightController::new(SYSTEM_ID);
        let request = controller.messages(at_ms(0));
        assert_eq!(controller.handle(&time_reply(&request, at_ms(90_000)), at_ms(10)), FrameUse::Consumed);
        controller.begin_reboot(at_ms(1_000));
        assert_eq!(controller.messages(at_ms(1_000)).len(), 2, "disarm and reboot");
        let request = controller.messages(at_ms(1_100));
        // A reply from before the reboot: its delay does not count, the clock goes on.
        assert_eq!(controller.handle(&time_reply(&request, at_ms(91_100)), at_ms(1_900)), FrameUse::Consumed);
        let beat = frame(&station::heartbeat());
        assert_eq!(controller.handle(&beat, at_ms(2_800)), FrameUse::Consumed);
        let request = controller.messages(at_ms(3_000));
        assert_eq!(controller.handle(&time_reply(&request, at_ms(1_500)), at_ms(3_010)), FrameUse::Rebooted);
    }

    #[test]
    fn wire_replies_to_the_simulators_timesync_are_not_forwarded() {
        let mut controller = FlightController::new(SYSTEM_ID);
        for second in 0..5 {
            let wall = Duration::from_secs(second);
            let [MavMessage::TIMESYNC(request)] = &controller.messages(wall)[..] else { panic!("no request at {second} s") };
            let sync = |tc1, ts1| frame(&MavMessage::TIMESYNC(TIMESYNC_DATA { tc1, ts1, ..Default::default() }));
            assert_eq!(controller.handle(&sync(0, 77), wall), FrameUse::Forward, "a request of the flight controller");
            assert_eq!(controller.handle(&sync(5, request.ts1 + 1), wall), FrameUse::Forward, "a reply to a client");
            let now_ns = request.ts1 + 90_000_000_000;
            assert_eq!(controller.handle(&sync(now_ns, request.ts1), wall), FrameUse::Consumed);
        }
        assert_eq!(controller.clock.measured().map(|found| found.offset), Some(SimTime::from_ms(90_000)));
        assert!(controller.reported_clock && !controller.reported_system_id);
    }
}

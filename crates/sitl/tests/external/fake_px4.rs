//! A small autopilot that obeys the rules of PX4's simulator interface: it advances only with HIL_SENSOR 0 and answers each one
//! with one HIL_ACTUATOR_CONTROLS. It holds its attitude with a rate controller and climbs with the throttle stick.

use spandrel_mavlink::codec::{Decoder, Encoder, ReceivedFrame};
use spandrel_mavlink::dialect::*;
use spandrel_mavlink::router;

/// Readings after the start before the first answer, as PX4 needs some to start its controllers.
const SILENT_READINGS: u32 = 10;
/// Readings after the start before the autopilot reports that it can arm.
const READINGS_UNTIL_READY: u32 = 250;
/// Motor command at hover of the tests' aircraft (phantom2).
const HOVER: f64 = 0.59;
/// Gains on the angular rate, per rad/s, and on the tilt from the specific force, per m/s²; enough to stay upright in still air.
const RATE_GAIN: f64 = 0.05;
const TILT_GAIN: f64 = 0.004;
/// Change of the motor command at full throttle stick.
const CLIMB: f64 = 0.06;
/// Interval between the messages on the MAVLink link, in readings.
const REPORT_INTERVAL: u32 = 50;

/// The autopilot.
#[derive(Debug)]
pub struct FakePx4 {
    system_id: u8,
    simulator: (Encoder, Decoder),
    mavlink: (Encoder, Decoder),
    readings: u32,
    /// Number of readings after which the autopilot can arm.
    ready_after: u32,
    /// Whether the motors are armed.
    pub armed: bool,
    throttle: f64,
    tilt: [f64; 2],
    /// All frames that arrived on the MAVLink link.
    pub received: Vec<ReceivedFrame>,
    out: Vec<Vec<u8>>,
}

impl FakePx4 {
    /// Creates a process that has just started.
    pub fn new(system_id: u8) -> Self {
        Self {
            system_id,
            simulator: (Encoder::new(system_id, 1), Decoder::new()),
            mavlink: (Encoder::new(system_id, 1), Decoder::new()),
            readings: 0,
            ready_after: READINGS_UNTIL_READY,
            armed: false,
            throttle: 0.0,
            tilt: [0.0; 2],
            received: Vec::new(),
            out: Vec::new(),
        }
    }

    /// Returns whether the autopilot reports that it can arm.
    pub fn is_ready(&self) -> bool {
        self.readings > self.ready_after
    }

    /// Reports that the autopilot cannot arm, for as long as after a start.
    pub fn withdraw_readiness(&mut self) {
        self.ready_after = self.readings + READINGS_UNTIL_READY;
    }

    /// Returns what PX4 sends when it has connected.
    pub fn greeting(&mut self) -> Vec<u8> {
        let heartbeat =
            MavMessage::HEARTBEAT(HEARTBEAT_DATA { autopilot: MavAutopilot::MAV_AUTOPILOT_PX4, ..Default::default() });
        self.simulator.0.encode(&heartbeat)
    }

    /// Takes bytes of the simulator interface and returns the answers.
    pub fn simulator(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut answers = Vec::new();
        for frame in self.simulator.1.push(bytes) {
            if let Some(MavMessage::HIL_SENSOR(sensor)) = &frame.message
                && sensor.id == 0
            {
                self.readings += 1;
                self.report();
                if self.readings > SILENT_READINGS {
                    answers.extend(self.answer(sensor));
                }
            }
        }
        answers
    }

    fn answer(&mut self, sensor: &HIL_SENSOR_DATA) -> Vec<u8> {
        self.tilt = [f64::from(sensor.yacc), f64::from(-sensor.xacc)].map(|force| force * TILT_GAIN);
        let mut controls = [0.0f32; 16];
        if self.armed {
            let roll = self.tilt[0] - RATE_GAIN * f64::from(sensor.xgyro);
            let pitch = self.tilt[1] - RATE_GAIN * f64::from(sensor.ygyro);
            let lift = if self.throttle < 0.02 { 0.1 } else { HOVER + CLIMB * (self.throttle - 0.5) * 2.0 };
            // Front right, rear left, front left, rear right.
            for (control, (side, front)) in controls.iter_mut().zip([(-1.0, 1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0)]) {
                *control = (lift + side * roll + front * pitch).clamp(0.0, 1.0) as f32;
            }
        }
        let mut mode = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED;
        mode.set(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED, self.armed);
        let flags = HilActuatorControlsFlags::from_bits_truncate(1);
        let time_usec = sensor.time_usec;
        self.simulator.0.encode(&MavMessage::HIL_ACTUATOR_CONTROLS(HIL_ACTUATOR_CONTROLS_DATA {
            time_usec,
            flags,
            controls,
            mode,
        }))
    }

    /// Sends the periodic messages on the MAVLink link.
    fn report(&mut self) {
        if self.readings % REPORT_INTERVAL != 1 {
            return;
        }
        let mut base_mode = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED;
        base_mode.set(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED, self.armed);
        self.send(&MavMessage::HEARTBEAT(HEARTBEAT_DATA {
            custom_mode: 3 << 16,
            mavtype: MavType::MAV_TYPE_QUADROTOR,
            autopilot: MavAutopilot::MAV_AUTOPILOT_PX4,
            base_mode,
            system_status: MavState::MAV_STATE_STANDBY,
            mavlink_version: 3,
        }));
        let mut health = MavSysStatusSensor::empty();
        health.set(MavSysStatusSensor::MAV_SYS_STATUS_PREARM_CHECK, self.is_ready());
        self.send(&MavMessage::SYS_STATUS(SYS_STATUS_DATA { onboard_control_sensors_health: health, ..Default::default() }));
        let landed_state = if self.armed && self.throttle > 0.4 {
            MavLandedState::MAV_LANDED_STATE_IN_AIR
        } else {
            MavLandedState::MAV_LANDED_STATE_ON_GROUND
        };
        self.send(&MavMessage::EXTENDED_SYS_STATE(EXTENDED_SYS_STATE_DATA { landed_state, ..Default::default() }));
    }

    /// Sends a message on the MAVLink link.
    pub fn send(&mut self, message: &MavMessage) {
        let frame = self.mavlink.0.encode(message);
        self.out.push(frame);
    }

    /// Takes a datagram of the MAVLink link.
    pub fn mavlink(&mut self, bytes: &[u8]) {
        for frame in self.mavlink.1.datagram(bytes) {
            match &frame.message {
                Some(MavMessage::COMMAND_LONG(command)) if router::target(&frame).1 <= 1 => {
                    self.command(&command.clone(), &frame)
                }
                Some(MavMessage::MANUAL_CONTROL(sticks)) => self.throttle = f64::from(sticks.z) / 1000.0,
                _ => {}
            }
            self.received.push(frame);
        }
    }

    fn command(&mut self, command: &COMMAND_LONG_DATA, frame: &ReceivedFrame) {
        if command.command == MavCmd::MAV_CMD_COMPONENT_ARM_DISARM {
            self.armed = command.param1 > 0.5;
        }
        self.send(&MavMessage::COMMAND_ACK(COMMAND_ACK_DATA {
            command: command.command,
            result: MavResult::MAV_RESULT_ACCEPTED,
            target_system: frame.system_id,
            target_component: frame.component_id,
            ..Default::default()
        }));
    }

    /// Returns the datagrams for the MAVLink link.
    pub fn take_mavlink(&mut self) -> Vec<Vec<u8>> {
        std::mem::take(&mut self.out)
    }

    /// Returns the commands that arrived on the MAVLink link.
    pub fn commands(&self) -> Vec<MavCmd> {
        let command = |frame: &ReceivedFrame| match &frame.message {
            Some(MavMessage::COMMAND_LONG(command)) => Some(command.command),
            _ => None,
        };
        self.received.iter().filter_map(command).collect()
    }

    /// Returns the system ID.
    pub fn system_id(&self) -> u8 {
        self.system_id
    }
}

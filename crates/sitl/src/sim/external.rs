//! Exchange with an external autopilot. Between ticks, the simulation sends the readings that are due and waits for the motor
//! commands. While a new process starts, the aircraft does not move, and only the autopilot's clock runs.

use super::controller::{Controller, ExternalController};
use super::{STEP, Sim, SimConfig, SimEvent, place_on_pad, with_receiver};
use crate::backend::interface::{InterfaceEvent, SimulatorInterface, StepInput};
use crate::backend::{ExternalAutopilot, Phase};
use crate::endpoint::RelayEndpoint;
use crate::endpoint::relay::{AutopilotReport, RelayRules};
use crate::physics::{Actuators, MAX_ROTORS};
use crate::sensors::{FeltMotion, ImuReading};
use spandrel_mavlink::dialect::{MavMessage, MavSeverity};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::math::GRAVITY_M_S2;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::SensorSpec;
use std::sync::Arc;

/// State of an external autopilot, for the host that owns its process and its sockets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AutopilotState {
    /// Simulation time is stopped until [`Sim::connect_autopilot`] is called.
    Disconnected,
    /// The process starts; simulation time is stopped.
    Starting {
        /// Whether the autopilot has answered. Before that, readings must be sent in real time, because the autopilot starts only
        /// while its clock runs.
        has_answered: bool,
        /// Whether readings must be sent in real time throughout, because the autopilot's own clock runs in real time.
        in_real_time: bool,
        /// Whether the answer to the latest readings is outstanding.
        is_waiting: bool,
    },
    /// The autopilot flies the aircraft.
    Running {
        /// Whether the answer to the latest readings is outstanding.
        is_waiting: bool,
    },
}

impl Sim {
    /// Creates the vehicle on its landing pad, flown by an external autopilot. Simulation time is stopped until the autopilot has
    /// connected and started.
    #[must_use]
    pub fn with_external_autopilot(
        config: SimConfig,
        site: Arc<Site>,
        interface: Box<dyn SimulatorInterface>,
        rules: RelayRules,
    ) -> Self {
        let config = with_receiver(config);
        let sensors = SensorSpec { imu_rate_hz: interface.rate_hz(), ..config.vehicle.sensors };
        let (pad_m, _) = place_on_pad(&config);
        let controller = Controller::External(Box::new(ExternalController {
            autopilot: ExternalAutopilot::new(interface, &sensors, config.seed),
            endpoint: RelayEndpoint::new(config.instance + 1, rules, pad_m),
        }));
        Self::with_controller(config, site, controller, &sensors)
    }

    /// Returns the state of the external autopilot; `None` with the built-in one.
    #[must_use]
    pub fn autopilot_state(&self) -> Option<AutopilotState> {
        let autopilot = &self.controller.external()?.autopilot;
        let is_waiting = autopilot.interface.is_waiting();
        Some(match autopilot.phase() {
            Phase::Disconnected => AutopilotState::Disconnected,
            Phase::Starting { .. } => AutopilotState::Starting {
                has_answered: autopilot.interface.has_answered(),
                in_real_time: autopilot.interface.runs_in_real_time(),
                is_waiting,
            },
            Phase::Running => AutopilotState::Running { is_waiting },
        })
    }

    /// Returns what the external autopilot has reported about itself; `None` with the built-in one.
    #[must_use]
    pub fn autopilot_report(&self) -> Option<&AutopilotReport> {
        Some(&self.controller.external()?.endpoint.report)
    }

    /// Returns the interval between the readings that the external autopilot gets; `None` with the built-in one.
    #[must_use]
    pub fn autopilot_period(&self) -> Option<SimTime> {
        Some(self.controller.external()?.autopilot.period())
    }

    /// Sends a message from the simulator's component to the external autopilot.
    pub fn send_to_autopilot(&mut self, message: &MavMessage) {
        if let Some(external) = self.controller.external_mut() {
            external.endpoint.send_to_autopilot(message);
        }
    }

    /// Starts the exchange with a process that has connected to the simulator interface.
    pub fn connect_autopilot(&mut self) {
        let now = self.now;
        if let Some(external) = self.controller.external_mut() {
            external.autopilot.connect(now);
            external.endpoint.forget_autopilot();
        }
    }

    /// Receives bytes from the simulator interface.
    pub fn handle_autopilot_bytes(&mut self, bytes: &[u8]) {
        let now = self.now;
        let Some(external) = self.controller.external_mut() else { return };
        external.autopilot.interface.receive(bytes);
        self.handle_interface_events(now);
    }

    fn handle_interface_events(&mut self, now: SimTime) {
        let Some(external) = self.controller.external_mut() else { return };
        while let Some(event) = external.autopilot.interface.poll_event() {
            match event {
                InterfaceEvent::Rejected(problem) | InterfaceEvent::Warning(problem) => {
                    self.events.push_back(SimEvent::AutopilotProblem { problem });
                }
                InterfaceEvent::Restarted => {
                    external.autopilot.begin_start(now);
                    external.endpoint.forget_autopilot();
                }
            }
        }
    }

    /// Returns the next bytes for the simulator interface.
    pub fn poll_autopilot_transmit(&mut self) -> Option<Vec<u8>> {
        self.controller.external_mut()?.autopilot.interface.poll_transmit()
    }

    /// Runs a step of the autopilot's start, if it is starting. Returns true if simulation time must not advance.
    pub(super) fn run_autopilot_start(&mut self) -> bool {
        let now = self.now;
        let Some(external) = self.controller.external_mut() else { return false };
        match external.autopilot.phase() {
            Phase::Running => return false,
            Phase::Disconnected => return true,
            Phase::Starting { .. } if external.autopilot.interface.is_waiting() => return true,
            Phase::Starting { .. } => {}
        }
        if let Some((took, is_ready)) = external.autopilot.finish_start(now, external.endpoint.report.is_ready) {
            external.endpoint.request_parameters();
            self.events.push_back(SimEvent::AutopilotStarted { took, is_ready });
            return false;
        }
        external.autopilot.advance_clock(now);
        let period = external.autopilot.period();
        self.stand_still(period);
        self.send_readings();
        self.publish();
        true
    }

    /// Sends the readings that are due to the external autopilot. Returns false while its answer is outstanding.
    pub(super) fn exchange_with_autopilot(&mut self) -> bool {
        let now = self.now;
        let Some(external) = self.controller.external_mut() else { return true };
        if external.autopilot.phase() != Phase::Running {
            return false;
        }
        if external.autopilot.take_due(now) {
            self.send_readings();
        }
        let Some(external) = self.controller.external_mut() else { return true };
        if external.autopilot.interface.is_waiting() {
            return false;
        }
        self.actuators = external.autopilot.interface.actuators();
        self.apply_motor_failures();
        true
    }

    /// Samples the sensors and sends their readings.
    fn send_readings(&mut self) {
        let Some(clock) = self.controller.external().map(|external| external.autopilot.clock(self.now)) else { return };
        let fresh = self.sample_sensors(self.now, clock);
        self.readings.update_latest(&fresh);
        let battery = self.battery_reading();
        let (pad_m, _) = place_on_pad(&self.config);
        let Controller::External(external) = &mut self.controller else { return };
        let at_rest = ImuReading { specific_force_m_s2: Vec3::new(0.0, 0.0, -GRAVITY_M_S2), rates_rad_s: Vec3::zero() };
        let imus = external.autopilot.read_imus(fresh.imu.or(self.readings.imu).unwrap_or(at_rest), self.sensors.vibration());
        external.autopilot.interface.send(&StepInput {
            now: clock,
            imus: &imus,
            fresh: &fresh,
            latest: &self.readings,
            battery,
            truth: &self.state.rigid,
            wind_m_s: self.air.velocity_m_s,
            pad_m,
            plane: self.site.plane(),
            start_unix_s: self.config.scenario.light.start_unix_s,
        });
        while let Some(message) = external.autopilot.interface.poll_message() {
            external.endpoint.send_to_autopilot(&message);
        }
        self.handle_interface_events(self.now);
    }

    /// Integrates the inertial sensors over a physics step.
    pub(super) fn integrate_imus(&mut self, dt: SimTime) {
        self.integrate_motion(&FeltMotion::of(&self.state), dt);
    }

    fn integrate_motion(&mut self, motion: &FeltMotion, dt: SimTime) {
        self.sensors.integrate_imu(motion, dt);
        if let Some(external) = self.controller.external_mut() {
            external.autopilot.integrate_imus(motion.specific_force_m_s2, motion.rates_rad_s, dt);
        }
    }

    /// Integrates the inertial sensors of the aircraft at rest, while simulation time is stopped.
    fn stand_still(&mut self, period: SimTime) {
        let up = Vec3::<Ned>::new(0.0, 0.0, -GRAVITY_M_S2);
        let felt = self.state.rigid.attitude.inverse() * up;
        let still = FeltMotion { specific_force_m_s2: felt, rates_rad_s: Vec3::zero(), rotor_rad_s: [0.0; MAX_ROTORS] };
        for _ in 0..(period.ns() / STEP.ns()).max(1) {
            self.integrate_motion(&still, STEP);
        }
    }

    /// Places the aircraft on the landing pad after a crash and requests a new process: an external autopilot cannot be told that
    /// the aircraft was moved.
    pub(super) fn respawn_on_pad(&mut self) {
        let (position_m, yaw_rad) = place_on_pad(&self.config);
        self.place_after_crash(position_m, yaw_rad, 0.0);
        self.restart_external_autopilot("the aircraft was placed on the pad after a crash");
    }

    /// Stops simulation time and requests a new process of the external autopilot.
    pub(super) fn restart_external_autopilot(&mut self, reason: &str) {
        self.actuators = Actuators::default();
        if let Some(external) = self.controller.external_mut() {
            external.autopilot.disconnect();
            external.endpoint.forget_autopilot();
        }
        self.controller.push_text(MavSeverity::MAV_SEVERITY_NOTICE, "Restarting the autopilot");
        self.events.push_back(SimEvent::AutopilotRestart { reason: reason.to_owned() });
    }
}

//! The simulator interface of an autopilot that runs in another process. Implementations are sans-IO: they turn sensor readings
//! into bytes and received bytes into motor commands.

use crate::physics::{Actuators, RigidState};
use crate::sensors::{BatteryReading, ImuReading, Readings};
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::time::SimTime;

/// Number of inertial sensors that an external autopilot receives.
pub const IMU_COUNT: usize = 3;

/// The simulated aircraft at the end of a control period, as input of an external autopilot.
#[derive(Debug, Clone, Copy)]
pub struct StepInput<'a> {
    /// The autopilot's clock. It never goes back while the autopilot's process lives, and also advances while simulation time is
    /// stopped for a restart of the autopilot.
    pub now: SimTime,
    /// Inertial readings, averaged over the control period. Each sensor has its own noise and bias; the first one is also in
    /// `fresh`.
    pub imus: &'a [ImuReading; IMU_COUNT],
    /// Readings that became available in this control period.
    pub fresh: &'a Readings,
    /// The latest reading of each sensor.
    pub latest: &'a Readings,
    /// Terminal values of the battery.
    pub battery: BatteryReading,
    /// True motion of the aircraft, for interfaces in which the autopilot derives sensors itself.
    pub truth: &'a RigidState,
    /// Wind at the aircraft, m/s.
    pub wind_m_s: Vec3<Ned>,
    /// Position of the landing pad, where the autopilot's home is, m, site frame.
    pub pad_m: Vec3<Ned>,
    /// Local tangent plane of the site.
    pub plane: &'a LocalPlane,
    /// Start of the simulation, s since 1970-01-01 UTC, for the time that the GNSS receiver reports.
    pub start_unix_s: i64,
}

/// A problem or an event on the simulator interface.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum InterfaceEvent {
    /// The autopilot restarted by itself: its counters began anew.
    Restarted,
    /// Data that the interface does not allow, with a description for the log. The data was ignored.
    Rejected(String),
    /// A condition that affects the flight, with a description for the log.
    Warning(String),
}

/// Copies a [`SimulatorInterface`] behind a pointer. Implemented for every interface that is `Clone`.
pub trait CloneInterface {
    /// Returns a copy.
    fn clone_box(&self) -> Box<dyn SimulatorInterface>;
}

impl<T: SimulatorInterface + Clone + 'static> CloneInterface for T {
    fn clone_box(&self) -> Box<dyn SimulatorInterface> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn SimulatorInterface> {
    fn clone(&self) -> Self {
        self.clone_box()
    }
}

/// One side of a simulator interface: the simulator's.
pub trait SimulatorInterface: CloneInterface + std::fmt::Debug + Send + Sync {
    /// Rate at which the autopilot takes sensor readings, Hz.
    fn rate_hz(&self) -> f64;

    /// Returns whether the autopilot has its own clock, which runs in real time: hardware in the loop. Readings must then always be
    /// sent in real time, also while the autopilot starts.
    fn runs_in_real_time(&self) -> bool {
        false
    }

    /// Handles a new connection or a restarted process: discards incomplete data and waits for a first answer again.
    fn connect(&mut self);

    /// Encodes the readings of one control period. Call it only if [`Self::is_waiting`] returns false.
    fn send(&mut self, step: &StepInput<'_>);

    /// Decodes received bytes: any part of the stream for PX4, one datagram for ArduPilot.
    fn receive(&mut self, bytes: &[u8]);

    /// Returns the next bytes to send to the autopilot.
    fn poll_transmit(&mut self) -> Option<Vec<u8>>;

    /// Returns the next MAVLink message for the autopilot's ordinary MAVLink link, for sensors that the simulator interface lacks.
    fn poll_message(&mut self) -> Option<MavMessage>;

    /// Returns the next event.
    fn poll_event(&mut self) -> Option<InterfaceEvent>;

    /// Returns whether the autopilot has answered since the last [`Self::connect`].
    fn has_answered(&self) -> bool;

    /// Returns whether the answer to the latest readings is outstanding. Before the first answer, this is always false for PX4,
    /// which starts only while its clock runs.
    fn is_waiting(&self) -> bool;

    /// Returns the motor commands of the latest answer.
    fn actuators(&self) -> Actuators;
}

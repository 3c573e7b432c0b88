//! State of an external autopilot: its interface, its clock, and the phases of its process.
//!
//! The autopilot's clock advances with the simulation's, and also while the simulation waits on the ground for a new process to
//! become ready. No scored time passes then.

use super::interface::{IMU_COUNT, SimulatorInterface};
use crate::sensors::ImuReading;
use crate::sensors::imu::Imu;
use spandrel_model::frames::{Frd, Vec3};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::SensorSpec;

/// Time on the autopilot's clock within which it should report that it can arm (estimate: ArduPilot's GNSS checks take up to 42 s).
const READY_TIMEOUT: SimTime = SimTime::from_ms(90_000);
/// Time on the autopilot's clock for which it must report without a break that it can arm. PX4 withdraws its first report for up to 2 s
/// while its height estimate settles.
const READY_HOLD: SimTime = SimTime::from_ms(3_000);
/// Offset between the seeds of the inertial sensors: any odd number, so that their noise differs.
const SEED_STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// Phase of the autopilot's process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// No process is connected. Simulation time is stopped.
    Disconnected,
    /// The process starts while the aircraft stands on the ground. Only the autopilot's clock runs.
    Starting {
        /// The autopilot's clock when the process connected.
        since: SimTime,
    },
    /// The autopilot flies the aircraft.
    Running,
}

/// An autopilot in another process.
#[derive(Debug, Clone)]
pub struct ExternalAutopilot {
    /// The simulator interface.
    pub interface: Box<dyn SimulatorInterface>,
    phase: Phase,
    clock_offset: SimTime,
    more_imus: Vec<Imu>,
    sent_at: Option<SimTime>,
    /// The autopilot's clock since which it has reported that it can arm.
    ready_since: Option<SimTime>,
}

impl ExternalAutopilot {
    /// Creates an autopilot that is not connected yet.
    #[must_use]
    pub fn new(interface: Box<dyn SimulatorInterface>, sensors: &SensorSpec, seed: u64) -> Self {
        let seeds = (1..IMU_COUNT as u64).map(|k| seed.wrapping_add(k.wrapping_mul(SEED_STEP)));
        let more_imus = seeds.map(|seed| Imu::new(sensors, seed)).collect();
        Self { interface, phase: Phase::Disconnected, clock_offset: SimTime::ZERO, more_imus, sent_at: None, ready_since: None }
    }

    /// Returns the phase of its process.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Returns the autopilot's clock at a simulation time.
    #[must_use]
    pub fn clock(&self, now: SimTime) -> SimTime {
        now + self.clock_offset
    }

    /// Returns the period at which the autopilot gets readings.
    #[must_use]
    pub fn period(&self) -> SimTime {
        SimTime::period(self.interface.rate_hz())
    }

    /// Begins the start of a process that has connected.
    pub fn connect(&mut self, now: SimTime) {
        self.interface.connect();
        self.begin_start(now);
    }

    /// Begins the start of a process that has restarted on the same connection.
    pub fn begin_start(&mut self, now: SimTime) {
        self.phase = Phase::Starting { since: self.clock(now) };
        self.sent_at = None;
        self.ready_since = None;
    }

    /// Stops simulation time until another process has connected.
    pub fn disconnect(&mut self) {
        self.phase = Phase::Disconnected;
    }

    /// Ends the start if the autopilot stays ready to arm or takes too long. Returns whether it has just ended, with the time that the
    /// start took and whether the autopilot is ready.
    pub fn finish_start(&mut self, now: SimTime, is_ready: bool) -> Option<(SimTime, bool)> {
        let Phase::Starting { since } = self.phase else { return None };
        let clock = self.clock(now);
        let took = clock - since;
        self.ready_since = if is_ready { self.ready_since.or(Some(clock)) } else { None };
        let stays_ready = self.ready_since.is_some_and(|ready| clock - ready >= READY_HOLD);
        if self.interface.has_answered() && (stays_ready || took >= READY_TIMEOUT) {
            self.phase = Phase::Running;
            return Some((took, is_ready));
        }
        None
    }

    /// Advances the autopilot's clock by one period while simulation time is stopped, after which readings are due.
    pub fn advance_clock(&mut self, now: SimTime) {
        self.clock_offset += self.period();
        self.sent_at = Some(self.clock(now));
    }

    /// Returns whether readings are due that have not been sent yet, and marks them as sent.
    pub fn take_due(&mut self, now: SimTime) -> bool {
        let clock = self.clock(now);
        let due = self.sent_at.is_none_or(|sent| clock >= sent + self.period());
        if due {
            self.sent_at = Some(clock);
        }
        due
    }

    /// Integrates the additional inertial sensors over a physics step.
    pub fn integrate_imus(&mut self, specific_force_m_s2: Vec3<Frd>, rates_rad_s: Vec3<Frd>, dt: SimTime) {
        for imu in &mut self.more_imus {
            imu.integrate(specific_force_m_s2, rates_rad_s, dt);
        }
    }

    /// Returns the readings of all inertial sensors; `first` is the reading of the aircraft's own sensor, and `vibration` the part of
    /// it that the frame shakes in all of them.
    pub fn read_imus(&mut self, first: ImuReading, vibration: ImuReading) -> [ImuReading; IMU_COUNT] {
        let mut readings = [first; IMU_COUNT];
        for (reading, imu) in readings.iter_mut().skip(1).zip(&mut self.more_imus) {
            if let Some(own) = imu.read() {
                *reading = own + vibration;
            }
        }
        readings
    }
}

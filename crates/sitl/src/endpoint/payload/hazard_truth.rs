//! State of a job's hazards at the aircraft.

use spandrel_mavlink::contract::hazards::{HazardReport, RadioMargins, WaterSensors};
use spandrel_model::frames::{Ned, Vec3};

/// True state of the radio links between the pilot and the aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadioTruth {
    /// Margins of control and video.
    pub margins: RadioMargins,
    /// Strength of the control signal, dBm.
    pub signal_dbm: f64,
    /// Number of intervals of 0.1 s in which no control data arrived.
    pub silent_intervals: u32,
}

/// True state of the hazards that a job simulates and that no other message reports.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HazardTruth {
    /// Angle by which steel turns the compass, rad, clockwise positive; `None` if the job does not simulate it.
    pub compass_rad: Option<f64>,
    /// Radio links; `None` if the job does not simulate them.
    pub radio: Option<RadioTruth>,
    /// Largest velocity that wakes added to the wind in the last half second, m/s; `None` if the job does not simulate wakes.
    pub wake_m_s: Option<Vec3<Ned>>,
    /// Sensors that look down on water; `None` if the job does not simulate it.
    pub water: Option<WaterSensors>,
}

impl HazardTruth {
    /// Returns the state as it is sent; `None` if there is nothing to send.
    #[must_use]
    pub fn report(&self) -> Option<HazardReport> {
        let Self { compass_rad, radio, wake_m_s, water } = *self;
        let report = HazardReport { compass_rad, radio: radio.map(|radio| radio.margins), wake_m_s, water };
        (report != HazardReport::default()).then_some(report)
    }
}

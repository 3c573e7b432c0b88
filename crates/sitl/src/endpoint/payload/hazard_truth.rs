//! State of a job's hazards at the aircraft.

use spandrel_mavlink::contract::hazards::{HazardReport, RadioMargins};

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
}

impl HazardTruth {
    /// Returns the state as it is sent; `None` if there is nothing to send.
    #[must_use]
    pub fn report(&self) -> Option<HazardReport> {
        let report = HazardReport { compass_rad: self.compass_rad, radio: self.radio.map(|radio| radio.margins) };
        (report != HazardReport::default()).then_some(report)
    }
}

//! Python binding for the telemetry log scorer.

use crate::errors::AssessmentError;
use crate::job;
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use spandrel_monitor::sidecar::build_site;
use spandrel_monitor::{AssessError, assess_log, export};
use std::fs;
use std::path::PathBuf;

/// Scores a telemetry log of a flight in this scenario or, unless the scenario's name selects one, in any form or difficulty
/// level of it. Returns the text of `spandrel assess --json` and the scored frames as CSV.
#[pyfunction]
pub fn assess(py: Python<'_>, tlog: PathBuf, scenario: &str, vehicle: &str) -> PyResult<(String, String)> {
    let (mut job, aircraft) = (job::read_scenario(scenario)?, job::read_vehicle(vehicle)?);
    py.detach(|| {
        let log = fs::read(&tlog).map_err(|error| PyOSError::new_err(format!("{}: {error}", tlog.display())))?;
        let mut assessed_session = assess_log(&log[..], &job, &aircraft, build_site);
        if let Err(AssessError::OtherScenario { received, .. }) = assessed_session
            && let Some(flown) = job::read_variant_with_crc(scenario, received)?
        {
            job = flown;
            assessed_session = assess_log(&log[..], &job, &aircraft, build_site);
        }
        let assessed_session = assessed_session.map_err(|error| AssessmentError::new_err(error.to_string()))?;
        let rows = export::frame_rows(&log[..], &job, &aircraft).map_err(|error| AssessmentError::new_err(error.to_string()))?;
        Ok((export::json_text(&assessed_session.assessment), export::frames_csv(&rows)))
    })
}

//! Errors as Python exceptions, with the messages of the Rust crates.

use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use spandrel_model::toml::Problems;
use spandrel_sitl::testing::MissedExpectation;

pyo3::create_exception!(spandrel, SpandrelError, PyException, "Base class for all errors raised by this package.");
pyo3::create_exception!(spandrel, JobError, SpandrelError, "A scenario or vehicle file is missing or invalid.");
pyo3::create_exception!(spandrel, RefusedError, SpandrelError, "The vehicle rejected a command or did not reply.");
pyo3::create_exception!(spandrel, LateError, SpandrelError, "A condition was not met in time.");
pyo3::create_exception!(spandrel, AssessmentError, SpandrelError, "A telemetry log cannot be scored.");

/// Registers the exceptions in the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let python = module.py();
    module.add("SpandrelError", python.get_type::<SpandrelError>())?;
    module.add("JobError", python.get_type::<JobError>())?;
    module.add("RefusedError", python.get_type::<RefusedError>())?;
    module.add("LateError", python.get_type::<LateError>())?;
    module.add("AssessmentError", python.get_type::<AssessmentError>())
}

/// Converts all errors in a scenario or vehicle file to an exception.
pub fn problems(problems: &Problems) -> PyErr {
    JobError::new_err(problems.to_string())
}

/// Converts an unmet expectation to an exception.
pub fn failure(failure: &MissedExpectation) -> PyErr {
    match failure {
        MissedExpectation::Refused { .. } | MissedExpectation::NoResponse(_) => RefusedError::new_err(failure.to_string()),
        MissedExpectation::TimedOut { .. } => LateError::new_err(failure.to_string()),
    }
}

//! The monitor observes an inspection flight solely through telemetry, gives feedback during the flight, and scores it
//! afterward. It is independent of the simulator, so flights with a real autopilot are scored the same way.
//!
//! [`assessment::assess`] is the only scorer. Both the live [`Monitor`] and [`assess_log`] call it, so rescoring a
//! recorded flight gives exactly the same scores:
//!
//! ```
//! use spandrel_monitor::{AssessError, assess_log, sidecar::build_site};
//! use spandrel_model::{scenario, shipped, vehicle};
//!
//! # fn main() -> Result<(), spandrel_model::toml::Problems> {
//! let job = scenario::read("two-bridges.toml", shipped::TWO_BRIDGES, &|file| Err(format!("{file} not found")))?;
//! let aircraft = vehicle::read("phantom2.toml", shipped::PHANTOM2)?;
//! // Contents of a telemetry.tlog file. An empty file is not a telemetry log, so scoring it fails.
//! let log: &[u8] = &[];
//! let graded = assess_log(log, &job, &aircraft, build_site);
//! assert_eq!(graded.err(), Some(AssessError::NotTelemetry));
//! # Ok(())
//! # }
//! ```
//!
//! [`measures`] computes measures from the frames (on path, speeding, crashes, picture contents), [`feedback`] raises cues,
//! [`guidance`] determines the next step, [`score`] computes conformity, efficiency, safety and accuracy, and [`session`]
//! determines where a session starts and ends.

pub mod assessment;
pub mod detour;
pub mod export;
pub mod feedback;
pub mod folder;
pub mod guidance;
pub mod lesson;
pub mod measures;
pub mod recording;
pub mod score;
pub mod session;
pub mod sidecar;
pub mod stored_text;

pub use assessment::{AssessError, AssessedSession, Assessment, ScoringJob, assess, assess_log};
pub use sidecar::{Monitor, MonitorConfig, SessionOutput};

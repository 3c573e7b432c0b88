//! The monitor: watches an inspection flight through its telemetry alone, gives cues while it lasts, and scores it when it is over. It cannot
//! look inside the simulator, because it does not depend on it; so it scores a real autopilot just as well.
//!
//! [`assessment::assess`] is the one scorer. The live [`watch::Monitor`] and [`assess_log`] on its recording both end there, so a stored flight
//! can be scored again to the last digit:
//!
//! ```
//! use spandrel_monitor::{AssessError, assess_log, watch::build_site};
//! use spandrel_model::{scenario, shipped, vehicle};
//!
//! # fn main() -> Result<(), spandrel_model::toml::Problems> {
//! let job = scenario::read("two-bridges.toml", shipped::TWO_BRIDGES, &|file| Err(format!("{file} is not there")))?;
//! let aircraft = vehicle::read("phantom2.toml", shipped::PHANTOM2)?;
//! // The bytes of a telemetry.tlog; an empty one holds nothing to score, and that is said.
//! let log: &[u8] = &[];
//! let graded = assess_log(log, &job, &aircraft, build_site);
//! assert_eq!(graded.err(), Some(AssessError::NoTruth));
//! # Ok(())
//! # }
//! ```
//!
//! [`measures`] turn frames into what happened (on the path, too fast, too close, what a picture shows), [`feedback`] into cues, [`score`] into
//! conformity, efficiency, safety and accuracy; [`session`] says when a session begins and ends.

pub mod assessment;
pub mod export;
pub mod feedback;
pub mod folder;
pub mod measures;
pub mod recording;
pub mod score;
pub mod session;
pub mod sidecar;

pub use assessment::{AssessError, AssessedSession, Assessment, ScoringJob, assess, assess_log};
pub use sidecar::{Monitor, MonitorConfig, SessionOutput};

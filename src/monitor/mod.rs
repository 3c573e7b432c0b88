//! Wing 2, the sidecar: watches a flight through telemetry alone, speaks up while it lasts and scores it when it is over. It never
//! looks inside the simulator; shared/assessment.md in the project's papers settles every rule that is followed here.
//!
//! [`assessment::assess`] is the one scorer: the live [`watch::Monitor`] and a replay of its log both end there.

pub mod assessment;
pub mod export;
pub mod feedback;
pub mod folder;
pub mod measures;
pub mod recording;
pub mod score;
pub mod session;
pub mod watch;

pub use assessment::{AssessError, Assessment, Graded, Job, assess, assess_log};
pub use watch::{Monitor, MonitorConfig, Record};
